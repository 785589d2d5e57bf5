/* What is said of motions that shooting has found: gaps at the ends of the half period and where the motion closes,
 * states at T/2, and starts from which Newton's method runs away. */
#include "support.h"

#include "witness/recorded_run.h"
#include "witness/shooting_solution.h"

static const double turn = 6.283185307179586;

/* A cos t with a wall that it meets 0.3 before it turns there at the other end of the half period: beyond the wall. */
static void even_motions_that_turn_beyond_what_they_hit_elsewhere_are_inadmissible(void **state) {
  (void)state;
  static const size_t wall = 0;
  const ric_obstacle obstacle = ric_obstacle_wall(0, 1);
  const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const double period = 2 * (turn - 0.3), q = 1, u = 0.5;
  for (size_t half = 0; half < 2; half++) {
    const ric_shooting_problem problem = {.kind = RIC_MOTION_EVEN,
                                          .at_start = &wall,
                                          .start_count = 1 - half,
                                          .at_half = &wall,
                                          .half_count = half,
                                          .flow = ric_flow_options_default()};
    shooting_solution s = shooting_solution_of_system(lattice_system(&lattice, &obstacle, 1), &problem);
    shooting_solution_guess(&s, &q, &u, NULL, period);
    shooting_solution_solve(&s);
    assert_close(half ? s.orbit.q[0] : s.orbit.q_half[0], 1 / cos(0.3), 1e-11);
    assert_int_equal(s.orbit.outcome, RIC_INADMISSIBLE);
    assert_non_null(strstr(s.orbit.reason, "smallest gap -0.046751"));
    shooting_solution_clear(&s);
  }
}

/* A particle over two floors, one 0.2 under the other: who hits the lower one has gone through the upper one. */
static ric_system *two_floors(void) {
  static const ric_obstacle floors[2] = {{0, +1, -1, 1, INFINITY}, {0, +1, -1.2, 1, INFINITY}};
  const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  return lattice_system(&lattice, floors, 2);
}

static void assert_goes_through_the_upper_floor(shooting_solution *s, double time) {
  char word[64];
  snprintf(word, sizeof word, "%s its floor (obstacle 0) at t = %.4g", time > 0 ? "passes" : "is below", time);
  shooting_solution_solve(s);
  assert_int_equal(s->orbit.outcome, RIC_INADMISSIBLE);
  if (!strstr(s->orbit.reason, "smallest gap -0.2") || !strstr(s->orbit.reason, word))
    fail_msg("\"%s\" does not say \"%s\"", s->orbit.reason, word);
  shooting_solution_clear(s);
}

/* At 0 or T/2 of an even motion, the upper floor hit at the other end, or in between. */
static void even_motions_thrown_back_beyond_what_they_hit_elsewhere_are_inadmissible(void **state) {
  (void)state;
  static const size_t upper = 0, lower = 1;
  const double q = 0, u = 1.6, time = 4.3; /* 2 cos(t - 2.2) */
  for (int low_first = 0; low_first < 2; low_first++) {
    const ric_shooting_problem ends = {.kind = RIC_MOTION_EVEN,
                                       .at_start = low_first ? &lower : &upper,
                                       .start_count = 1,
                                       .at_half = low_first ? &upper : &lower,
                                       .half_count = 1,
                                       .flow = ric_flow_options_default()};
    shooting_solution s = shooting_solution_of_system(two_floors(), &ends);
    shooting_solution_guess(&s, &q, &u, NULL, 9);
    assert_goes_through_the_upper_floor(&s, low_first ? 0 : 4.5);
  }
  const ric_shooting_problem between = {.kind = RIC_MOTION_EVEN,
                                        .at_start = &lower,
                                        .start_count = 1,
                                        .sequence = &upper,
                                        .count = 1,
                                        .flow = ric_flow_options_default()};
  shooting_solution s = shooting_solution_of_system(two_floors(), &between);
  shooting_solution_guess(&s, &q, &u, &time, 2 * 6.4);
  assert_goes_through_the_upper_floor(&s, 0);
}

/* In the sequence of a motion that is not even, wherever it begins. */
static void motions_thrown_back_beyond_what_they_hit_elsewhere_are_inadmissible(void **state) {
  (void)state;
  static const size_t hits[3] = {0, 1, 0};
  for (int low_first = 0; low_first < 2; low_first++) {
    const ric_shooting_problem problem = {
        .kind = RIC_MOTION_CONSERVATIVE, .sequence = hits + low_first, .count = 2, .flow = ric_flow_options_default()};
    const double q = low_first ? -1.2 : -1, u = 1.2, times[2] = {0, 4.5};
    shooting_solution s = shooting_solution_of_system(two_floors(), &problem);
    shooting_solution_guess(&s, &q, &u, times, 9);
    assert_goes_through_the_upper_floor(&s, low_first ? 0 : 4.5);
  }
}

/* Two masses that share inertia: an impact of one turns the gap of the other around. */
static shooting_solution shared_inertia(bool turned) {
  static const double mass[4] = {1, 0.5, 0.5, 1}, stiffness[4] = {2, 0, 0, 1};
  static const size_t hits[3] = {0, 1, 0};
  const ric_mck model = {.coordinates = 2, .mass = {.values = mass}, .stiffness = {.values = stiffness}};
  const ric_obstacle obstacles[2] = {ric_obstacle_wall(0, 0.2), ric_obstacle_floor(1, 0.1)};
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_CONSERVATIVE, .sequence = hits + turned, .count = 2, .flow = ric_flow_options_default()};
  const double q[2] = {0.2, turned ? 0.1 : -0.04}, u[2] = {turned ? -0.08 : -0.154, turned ? 0.02 : 0.077};
  const double times[2] = {0, 1.7};
  ric_system *system = NULL;
  ric_error error;
  if (ric_system_create_mck(&model, obstacles, 2, &system, &error) != RIC_OK)
    fail_msg("%s", error.message);
  shooting_solution s = shooting_solution_of_system(system, &problem);
  shooting_solution_guess(&s, q, u, times, 3.4);
  return s;
}

static void verdicts_do_not_depend_on_where_the_motion_is_begun(void **state) {
  (void)state;
  shooting_solution a = shared_inertia(false), b = shared_inertia(true);
  shooting_solution_solve(&a);
  memcpy(b.z, a.z + 4, 4 * sizeof *b.z);
  memcpy(b.z + 4, a.z, 4 * sizeof *b.z);
  b.z[8] = 3.4 - a.z[8];
  shooting_solution_solve(&b);
  assert_close(a.orbit.energy, b.orbit.energy, 1e-12);
  assert_int_equal(a.orbit.outcome, RIC_INADMISSIBLE);
  assert_int_equal(b.orbit.outcome, RIC_INADMISSIBLE);
  assert_non_null(strstr(a.orbit.reason, "smallest gap -0.139"));
  assert_non_null(strstr(b.orbit.reason, "smallest gap -0.139"));
  shooting_solution_clear(&a);
  shooting_solution_clear(&b);
}

/* Of two impacts half a period apart the second one is not passed yet. */
static void states_at_half_the_period_are_those_before_an_impact_there(void **state) {
  (void)state;
  shooting_solution a = shared_inertia(false);
  shooting_solution_solve(&a);
  assert_close(a.orbit.impact_time[0], 1.7, 1e-11); /* the second of the sequence is listed first */
  assert_close(a.orbit.q_half[1], 0.1, 1e-11);
  assert_close(a.orbit.v_half[1], a.orbit.gap_rate[0], 1e-11);
  shooting_solution_clear(&a);
}

/* Impacts of two particles at one time, by a symmetry, are in order whichever comes first in rounding. */
static void impacts_of_one_time_are_in_order(void **state) {
  (void)state;
  static const size_t hits[2] = {0, 1};
  const ric_obstacle obstacles[2] = {ric_obstacle_floor(0, -0.5), ric_obstacle_floor(1, -0.5)};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  lattice.link.linear = 0.2;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_CONSERVATIVE, .sequence = hits, .count = 2, .flow = ric_flow_options_default()};
  const double q[2] = {-0.5, -0.5}, u[2] = {0.9, 0.9}, times[2] = {0, 0};
  shooting_solution s = shooting_solution_of_system(lattice_system(&lattice, obstacles, 2), &problem);
  shooting_solution_guess(&s, q, u, times, 5);
  shooting_solution_solve(&s);
  for (int sign = -1; sign <= 1; sign += 2) {
    s.z[8] = sign * 1e-14;
    assert_int_equal(ric_shooting_orbit(s.shooting, s.z, s.given, &s.orbit, NULL), RIC_OK);
    if (s.orbit.outcome != RIC_ADMISSIBLE)
      fail_msg("%s: %s", ric_outcome_name(s.orbit.outcome), s.orbit.reason);
  }
  shooting_solution_clear(&s);
}

/* Of A cos(w t) on two masses that do not feel each other, and of a particle that is thrown up from a floor. */
static void amplitudes_are_those_of_the_whole_period(void **state) {
  (void)state;
  static const double force[2] = {0.3, -0.1}, off[2] = {0, 0};
  static const size_t floor = 0;
  const ric_obstacle obstacle = ric_obstacle_floor(0, -1);
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  const double w = 1.3, q[2] = {0}, u[2] = {0.1, 2}, lag = 1 - w * w, drag = 0.2 * w;
  double amplitude;
  lattice.on_site.damping = 0.2;
  lattice.force_cos = force;
  lattice.force_sin = off;
  lattice.frequency = w;
  const ric_shooting_problem forced = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()};
  shooting_solution s = shooting_solution_of_system(lattice_system(&lattice, NULL, 0), &forced);
  shooting_solution_guess(&s, q, u, NULL, turn / w);
  shooting_solution_solve(&s);
  assert_int_equal(ric_shooting_amplitude(s.shooting, s.z, s.given, &amplitude, NULL), RIC_OK);
  assert_close(amplitude, 0.3 / hypot(lag, drag), 1e-13);
  shooting_solution_clear(&s);
  lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const ric_shooting_problem even = {
      .kind = RIC_MOTION_EVEN, .at_half = &floor, .half_count = 1, .flow = ric_flow_options_default()};
  for (double period = 3.3; period < 6.2; period += 0.7) { /* -cos(t - T/2) / cos(T/2), about t = T/2 of this motion */
    s = shooting_solution_of_system(lattice_system(&lattice, &obstacle, 1), &even);
    shooting_solution_guess(&s, q, u, NULL, period);
    shooting_solution_solve(&s);
    assert_int_equal(ric_shooting_amplitude(s.shooting, s.z, s.given, &amplitude, NULL), RIC_OK);
    assert_close(amplitude, -1 / cos(period / 2), 1e-12 * amplitude);
    shooting_solution_clear(&s);
  }
}

/* The half that is run along and its mirror image, and a motion that is run along as a whole, are the same. */
static void states_are_those_of_the_whole_period(void **state) {
  (void)state;
  static const size_t wall = 0;
  static const ric_spring links[3] = {{3, 0, 0, 0}, {1, 0, 0.1, 0}, {0, 0, 0, 0}};
  const ric_obstacle obstacle = ric_obstacle_wall(1, 2);
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  const double guess[2] = {0.65, 2}, speed[2] = {0, -0.3}, time = 0;
  const ric_shooting_problem even = {
      .kind = RIC_MOTION_EVEN, .at_start = &wall, .start_count = 1, .flow = ric_flow_options_default()};
  const ric_shooting_problem whole = {
      .kind = RIC_MOTION_CONSERVATIVE, .sequence = &wall, .count = 1, .flow = ric_flow_options_default()};
  shooting_solution a = shooting_solution_of_system(lattice_system(&lattice, &obstacle, 1), &even);
  shooting_solution b = shooting_solution_of_system(lattice_system(&lattice, &obstacle, 1), &whole);
  shooting_solution_guess(&a, guess, speed, NULL, 6.8);
  shooting_solution_guess(&b, guess, speed, &time, 6.8);
  shooting_solution_solve(&a);
  shooting_solution_solve(&b);
  for (size_t count = 2; count < 40; count += 7) {
    double q[2][40][2], v[2][40][2];
    assert_int_equal(ric_shooting_states(a.shooting, a.z, a.given, count, q[0][0], v[0][0], NULL), RIC_OK);
    assert_int_equal(ric_shooting_states(b.shooting, b.z, b.given, count, q[1][0], v[1][0], NULL), RIC_OK);
    for (size_t k = 0; k < count; k++)
      for (int i = 0; i < 2; i++) {
        assert_close(q[0][k][i], q[1][k][i], 1e-10);
        assert_close(v[0][k][i], v[1][k][i], 1e-10);
      }
    assert_close(q[0][0][1], 2, 1e-12);
    assert_close(v[0][count - 1][1], -v[0][0][1], 1e-12); /* before the impact */
  }
  assert_int_equal(ric_shooting_states(a.shooting, a.z, a.given, 1, a.z, a.z, NULL), RIC_EINVAL);
  shooting_solution_clear(&a);
  shooting_solution_clear(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(even_motions_that_turn_beyond_what_they_hit_elsewhere_are_inadmissible),
      cmocka_unit_test(even_motions_thrown_back_beyond_what_they_hit_elsewhere_are_inadmissible),
      cmocka_unit_test(motions_thrown_back_beyond_what_they_hit_elsewhere_are_inadmissible),
      cmocka_unit_test(verdicts_do_not_depend_on_where_the_motion_is_begun),
      cmocka_unit_test(states_at_half_the_period_are_those_before_an_impact_there),
      cmocka_unit_test(impacts_of_one_time_are_in_order),
      cmocka_unit_test(amplitudes_are_those_of_the_whole_period),
      cmocka_unit_test(states_are_those_of_the_whole_period),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

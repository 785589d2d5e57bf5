/* Kinds of motion: conservative ones against even ones, self-excited ones against event-driven runs, strongly unstable
 * ones in pieces; and what is refused. */
#include "support.h"

#include "witness/recorded_run.h"
#include "witness/shooting_solution.h"
#include "witness/van_der_pol.h"

static ric_system *two_masses(void) {
  static const ric_spring links[3] = {{3, 0, 0, 0}, {1, 0, 0.1, 0}, {0, 0, 0, 0}};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  const ric_obstacle wall = ric_obstacle_wall(1, 2);
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  return lattice_system(&lattice, &wall, 1);
}

/* The even motion of period 6.8, and the same as a conservative one that knows nothing of its symmetry. */
static void conservative_motions_are_the_even_ones(void **state) {
  (void)state;
  static const size_t wall = 0;
  const double q[2] = {0.6, 2}, u[2] = {0, -0.4}, time = 0, period = 6.8;
  for (int energy = 0; energy < 2; energy++)
    for (size_t pieces = 1; pieces <= 3; pieces += 2) {
      const ric_shooting_problem a = {.kind = RIC_MOTION_EVEN,
                                      .energy_given = energy,
                                      .at_start = &wall,
                                      .start_count = 1,
                                      .pieces = pieces,
                                      .flow = ric_flow_options_default()};
      const ric_shooting_problem b = {.kind = RIC_MOTION_CONSERVATIVE,
                                      .energy_given = energy,
                                      .sequence = &wall,
                                      .count = 1,
                                      .pieces = pieces,
                                      .flow = ric_flow_options_default()};
      shooting_solution even = shooting_solution_of_system(two_masses(), &a),
                        free = shooting_solution_of_system(two_masses(), &b);
      ric_multipliers mu[2];
      shooting_solution_guess(&even, q, u, NULL, period);
      shooting_solution_guess(&free, q, u, &time, period);
      if (energy)
        even.given = free.given = 1.8;
      shooting_solution_solve(&even);
      shooting_solution_solve(&free);
      assert_int_equal(even.orbit.outcome, RIC_ADMISSIBLE);
      assert_int_equal(free.orbit.outcome, RIC_ADMISSIBLE);
      assert_close(free.orbit.period, even.orbit.period, 1e-11);
      assert_close(free.orbit.energy, even.orbit.energy, 1e-11);
      assert_close(free.z[free.unknowns - 1], 0, 1e-12); /* lambda */
      for (int i = 0; i < 2; i++) {
        assert_close(free.orbit.q[i], even.orbit.q[i], 1e-10);
        assert_close(free.orbit.v[i], even.orbit.v[i], 1e-10);
        assert_close(free.orbit.q_half[i], even.orbit.q_half[i], 1e-10);
      }
      shooting_solution *both[2] = {&even, &free};
      for (int k = 0; k < 2; k++) {
        assert_int_equal(ric_multipliers_init(&mu[k], 4, NULL), RIC_OK);
        assert_int_equal(ric_shooting_multipliers(both[k]->shooting, both[k]->z, both[k]->given, NULL, &mu[k], NULL),
                         RIC_OK);
      }
      assert_int_equal(mu[0].stable, mu[1].stable);
      for (size_t i = 0; i < 4; i++) {
        double nearest = INFINITY;
        for (size_t j = 0; j < 4; j++)
          nearest = fmin(nearest, hypot(mu[0].mu[i].re - mu[1].mu[j].re, mu[0].mu[i].im - mu[1].mu[j].im));
        assert_true(nearest < 1e-6);
      }
      ric_multipliers_clear(&mu[0]);
      ric_multipliers_clear(&mu[1]);
      shooting_solution_clear(&even);
      shooting_solution_clear(&free);
    }
}

/* 6.3806... for mu = 0.5: the period of the cycle from a long run, by its crossings. */
static void limit_cycles_are_those_that_runs_tend_to(void **state) {
  (void)state;
  double wall[2] = {5, 1.5};
  static const size_t hits = 0;
  for (size_t count = 0; count < 2; count++) {
    ric_shooting_problem problem = {.kind = RIC_MOTION_AUTONOMOUS,
                                    .sequence = &hits,
                                    .count = count,
                                    .flow = {.tolerance = 1e-13, .longest_step = INFINITY}};
    double x[2] = {count ? 1.5 : 2, count ? -0.6 : 0}, time = 0, settled[2];
    shooting_solution s = shooting_solution_of_system(van_der_pol_system(&wall[count]), &problem);
    shooting_solution_guess(&s, x, NULL, &time, count ? 5 : 6.4);
    shooting_solution_solve(&s);
    assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
    /* A run from afar settles on it: after any number of periods more it is where it was. */
    recorded_run r = record_run(s.system, NULL, s.orbit.q, NULL, 40 * s.orbit.period + 0.1);
    memcpy(settled, r.q, sizeof settled);
    assert_int_equal(recorded_run_impacts(&r), count * 41 - count); /* the first state is just after one */
    recorded_run_clear(&r);
    r = record_run(s.system, NULL, s.orbit.q, NULL, 0.1);
    assert_close(r.q[0], settled[0], 1e-8);
    assert_close(r.q[1], settled[1], 1e-8);
    recorded_run_clear(&r);
    ric_multipliers mu;
    assert_int_equal(ric_multipliers_init(&mu, 2, NULL), RIC_OK);
    assert_int_equal(ric_shooting_multipliers(s.shooting, s.z, s.given, NULL, &mu, NULL), RIC_OK);
    assert_int_equal(mu.stable, RIC_STABLE);
    assert_close(hypot(mu.mu[0].re - 1, mu.mu[0].im), 0, 1e-7);
    ric_multipliers_clear(&mu);
    shooting_solution_clear(&s);
  }
}

/* --- pieces ------------------------------------------------------------------------------------------------------- */

/* x'' = 9 x - cos t: the motion cos t / 10, whose neighbours leave it by exp(6 pi) in a period. */
static void pieces_find_unstable_motions_from_farther_away(void **state) {
  (void)state;
  const double force = -1;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.on_site.linear = -9;
  lattice.on_site.cubic = 0.01;
  lattice.force_cos = &force;
  lattice.frequency = 1;
  int steps[2];
  ric_status status[2];
  for (int k = 0; k < 2; k++) {
    ric_shooting_problem problem = {
        .kind = RIC_MOTION_FORCED, .pieces = k ? 12 : 1, .flow = ric_flow_options_default()};
    shooting_solution s = shooting_solution_of_system(lattice_system(&lattice, NULL, 0), &problem);
    const double period = 6.283185307179586;
    for (size_t i = 0; i < s.unknowns; i++)
      s.z[i] = 0; /* not the motion from there, which runs away */
    status[k] = ric_shooting_solve(s.shooting, s.z, period, 0, &steps[k], NULL);
    if (status[k] == RIC_OK && k) {
      assert_int_equal(ric_shooting_orbit(s.shooting, s.z, period, &s.orbit, NULL), RIC_OK);
      assert_close(s.orbit.q[0], 0.1, 1e-4);
      assert_true(s.orbit.residual < 1e-12);
    }
    shooting_solution_clear(&s);
  }
  print_message("[ one piece: %s, %d steps; twelve: %d steps ]\n", ric_status_text(status[0]), steps[0], steps[1]);
  assert_int_equal(status[1], RIC_OK);
  assert_true(steps[1] <= 5);
  assert_true(status[0] != RIC_OK || steps[0] > 2 * steps[1]);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void assert_refused(ric_system *system, const ric_shooting_problem *problem, const char *word) {
  ric_shooting *shooting = NULL;
  ric_error error;
  assert_int_equal(ric_shooting_create(system, problem, &shooting, &error), RIC_EINVAL);
  assert_null(shooting);
  if (!strstr(error.message, word))
    fail_msg("\"%s\" does not say \"%s\"", error.message, word);
}

static void problems_that_make_no_sense_are_refused(void **state) {
  (void)state;
  static const size_t one = 1, twice[2] = {0, 0}, none = 0;
  ric_system *system = two_masses();
  const ric_flow_options flow = ric_flow_options_default();
  assert_refused(system, &(ric_shooting_problem){.kind = (ric_motion_kind)7, .flow = flow}, "kind = 7");
  assert_refused(system, &(ric_shooting_problem){.kind = RIC_MOTION_FORCED, .energy_given = true, .flow = flow},
                 "energy");
  assert_refused(system,
                 &(ric_shooting_problem){.kind = RIC_MOTION_EVEN, .at_start = &one, .start_count = 1, .flow = flow},
                 "obstacle 1, expected one below 1");
  assert_refused(system,
                 &(ric_shooting_problem){.kind = RIC_MOTION_EVEN, .at_half = twice, .half_count = 2, .flow = flow},
                 "at one time");
  assert_refused(system,
                 &(ric_shooting_problem){.kind = RIC_MOTION_FORCED, .at_start = &none, .start_count = 1, .flow = flow},
                 "not even");
  assert_refused(system, &(ric_shooting_problem){.kind = RIC_MOTION_FORCED, .pieces = 20000, .flow = flow}, "20000");
  ric_system_destroy(&system);

  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -1);
  floor.restitution = 0.5;
  system = lattice_system(&lattice, &floor, 1);
  assert_refused(system, &(ric_shooting_problem){.kind = RIC_MOTION_EVEN, .flow = flow}, "restitution = 0.5");
  ric_system_destroy(&system);
  floor.stiffness = 100;
  system = lattice_system(&lattice, &floor, 1);
  assert_refused(system,
                 &(ric_shooting_problem){.kind = RIC_MOTION_FORCED, .sequence = &none, .count = 1, .flow = flow},
                 "compliant");
  ric_system_destroy(&system);
}

static void starts_that_do_not_converge_say_so(void **state) {
  (void)state;
  static const size_t hits = 0;
  ric_error error;
  int iterations;
  ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &hits, .start_count = 1, .flow = ric_flow_options_default()};
  shooting_solution s = shooting_solution_of_system(two_masses(), &problem);
  double q[2] = {300, 2}, u[2] = {0, -500};
  shooting_solution_guess(&s, q, u, NULL, 6.8);
  ric_status status = ric_shooting_solve(s.shooting, s.z, -1, 0, &iterations, &error);
  assert_int_equal(status, RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "period = -1"));
  assert_int_equal(ric_shooting_guess(s.shooting, q, u, NULL, -2, s.z, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "period = -2"));
  shooting_solution_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(conservative_motions_are_the_even_ones),
      cmocka_unit_test(limit_cycles_are_those_that_runs_tend_to),
      cmocka_unit_test(pieces_find_unstable_motions_from_farther_away),
      cmocka_unit_test(problems_that_make_no_sense_are_refused),
      cmocka_unit_test(starts_that_do_not_converge_say_so),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* First guesses: against quadratures, closed forms and event-driven runs. */
#include "support.h"

#include "witness/shooting_solution.h"
#include "witness/solved_orbit.h"

static const double turn = 6.283185307179586;

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

static ric_guess guess_for(size_t particles) {
  ric_guess guess;
  ric_error error;
  check(ric_guess_init(&guess, particles, &error), &error);
  return guess;
}

/* --- particles that swing alone ----------------------------------------------------------------------------------- */

/* Exact period of q'' + w^2 q + c q^3 = 0 at an amplitude, by the trapezoidal rule, which is exact for a smooth
 * periodic integrand but for rounding. */
static double duffing_period(double w, double c, double amplitude) {
  enum { POINTS = 64 };
  double sum = 0;
  for (int k = 0; k < POINTS; k++) {
    const double s = sin(turn * k / POINTS);
    sum += 1 / sqrt(w * w + c * amplitude * amplitude * (1 + s * s) / 2);
  }
  return turn * sum / POINTS;
}

/* The amplitude has an error of its third power. */
static void excited_particles_swing_with_their_period_up_to_the_fourth_power_of_the_amplitude(void **state) {
  (void)state;
  const double mass = 2, stiffness = 3, w = sqrt(stiffness / mass);
  for (int sign = -1; sign <= 1; sign += 2) {
    ric_lattice lattice = ric_lattice_default(3, RIC_ENDS_FREE);
    ric_guess guess = guess_for(3);
    ric_error error;
    const size_t excited[2] = {2, 0};
    double before = 0;
    lattice.mass = mass;
    lattice.on_site = (ric_spring){.linear = stiffness, .cubic = 0.4 * sign};
    for (int k = 0; k < 3; k++) {
      const double change = 0.04 * pow(0.5, k), period = turn / w * (1 - sign * change);
      check(ric_guess_particles(&lattice, excited, 2, period, &guess, &error), &error);
      assert_true(guess.q[0] == guess.q[2] && guess.q[1] == 0 && guess.q[0] > 0 && guess.period == period);
      assert_true(guess.v[0] == 0 && guess.v[1] == 0 && guess.v[2] == 0 && guess.rise == 0);
      const double off = fabs(duffing_period(w, 0.4 * sign / mass, guess.q[0]) - period);
      if (k > 0) /* change goes with the square of the amplitude */
        assert_close(before / off, 4, 0.4);
      before = off;
    }
    ric_guess_clear(&guess);
  }
}

static void particles_without_an_on_site_spring_swing_on_the_link_before_them(void **state) {
  (void)state;
  const ric_spring links[3] = {{2, 0, 0.1, 0}, {1, 0, 0.2, 0}, {0, 0, 0, 0}};
  ric_lattice series = ric_lattice_default(2, RIC_ENDS_FIXED), own = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_guess a = guess_for(2), b = guess_for(2);
  ric_error error;
  const size_t excited = 1;
  series.on_site = (ric_spring){0};
  series.links = links;
  own.on_site = links[1];
  check(ric_guess_particles(&series, &excited, 1, 6, &a, &error), &error);
  check(ric_guess_particles(&own, &excited, 1, 6, &b, &error), &error);
  assert_true(a.q[1] == b.q[1] && a.q[1] > 0);
  ric_guess_clear(&a);
  ric_guess_clear(&b);
}

/* --- normal modes ------------------------------------------------------------------------------------------------- */

/* Accelerations are -w^2 q, and the potential energy is what was asked for. */
static void modes_have_their_energy_and_turn_at_rest(void **state) {
  (void)state;
  enum { N = 5 };
  const double masses[N] = {1, 2, 0.5, 3, 1}, energy = 0.37;
  ric_lattice lattice = ric_lattice_default(N, RIC_ENDS_FIXED);
  ric_guess guess = guess_for(N);
  ric_error error;
  double before = INFINITY;
  lattice.masses = masses;
  lattice.link = (ric_spring){.linear = 0.7, .cubic = 0};
  for (size_t mode = 0; mode < N; mode++) {
    double acceleration[N];
    check(ric_guess_mode(&lattice, mode, energy, &guess, &error), &error);
    const double w = turn / guess.period;
    assert_close(ric_lattice_energy(&lattice, guess.q, guess.v), energy, 1e-13);
    ric_lattice_acceleration(&lattice, 0, guess.q, guess.v, acceleration);
    for (size_t i = 0; i < N; i++) {
      assert_close(acceleration[i], -w * w * guess.q[i], 1e-12 * w * w);
      assert_true(guess.v[i] == 0);
    }
    assert_true(guess.period < before);
    before = guess.period;
  }
  ric_guess_clear(&guess);
}

/* --- even motions ------------------------------------------------------------------------------------------------- */

static ric_shooting_problem even(const size_t *starts, size_t start_count, const size_t *halves, size_t half_count) {
  return (ric_shooting_problem){.kind = RIC_MOTION_EVEN,
                                .at_start = starts,
                                .start_count = start_count,
                                .at_half = halves,
                                .half_count = half_count,
                                .flow = ric_flow_options_default()};
}

static void put_floors(ric_obstacle *obstacles, size_t count) {
  for (size_t i = 0; i < count; i++)
    obstacles[i] = ric_obstacle_floor(i, -1);
}

/* Impulse responses know nothing of shooting. */
static void even_guesses_of_chains_are_their_orbits(void **state) {
  (void)state;
  enum { N = 6 };
  const size_t starts[2] = {0, 3}, halves[1] = {4};
  ric_obstacle floors[N];
  solved_orbit exact = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s..sh.", 1, RIC_ENDS_FIXED, 0.1, 5.5));
  const ric_lattice lattice = ric_lattice_of_chain(&exact.scenario.chain);
  const ric_shooting_problem motion = even(starts, 2, halves, 1);
  const ric_guess_problem problem = {&lattice, floors, N, &motion};
  ric_guess guess = guess_for(N);
  ric_error error;
  put_floors(floors, N);
  check(ric_guess_even(&problem, 5.5, &guess, &error), &error);
  assert_true(guess.period == 5.5);
  for (size_t i = 0; i < N; i++) {
    assert_close(guess.q[i], exact.orbit.q[i], 1e-10);
    assert_close(guess.v[i], exact.orbit.v[i], 1e-10);
  }
  ric_guess_clear(&guess);
  solved_orbit_clear(&exact);
}

/* A ring of nonlinear springs, one particle of which hits its floor. */
enum { RING = 5 };
static const size_t ring_hit = 2;
static const double ring_period = 5;

static ric_lattice nonlinear_ring(void) {
  ric_lattice lattice = ric_lattice_default(RING, RIC_ENDS_PERIODIC);
  lattice.on_site = (ric_spring){.linear = 1, .cubic = 0.1};
  lattice.link = (ric_spring){.linear = 0.05, .quadratic = 0.01, .cubic = 0.02};
  return lattice;
}

/* The flow from one impact to the next finds the obstacle where and when the guess says. */
static void even_guesses_of_nonlinear_lattices_are_motions(void **state) {
  (void)state;
  ric_obstacle floors[RING];
  const ric_lattice lattice = nonlinear_ring();
  const ric_shooting_problem motion = even(&ring_hit, 1, NULL, 0);
  const ric_guess_problem problem = {&lattice, floors, RING, &motion};
  ric_guess guess = guess_for(RING);
  ric_verification verification;
  ric_system *system = NULL;
  ric_error error;
  ric_orbit orbit;
  put_floors(floors, RING);
  check(ric_guess_even(&problem, ring_period, &guess, &error), &error);
  check(ric_system_create_lattice(&lattice, floors, RING, &system, &error), &error);
  shooting_solution s = shooting_solution_of_system(system, &motion);
  shooting_solution_guess(&s, guess.q, guess.v, NULL, ring_period);
  check(ric_orbit_init_for(&orbit, system, 1, &error), &error);
  check(ric_shooting_orbit(s.shooting, s.z, ring_period, &orbit, &error), &error);
  assert_int_equal(orbit.outcome, RIC_ADMISSIBLE);
  check(ric_shooting_verify(s.shooting, s.z, ring_period, &orbit, NULL, &verification, &error), &error);
  if (verification.result != RIC_VERIFIED)
    fail_msg("%s", verification.reason);
  ric_orbit_clear(&orbit);
  ric_guess_clear(&guess);
  shooting_solution_clear(&s);
}

/* Impacts in between have times that are no linear unknowns. */
static void even_guesses_with_impacts_in_between_are_those_of_the_linear_part_without_them(void **state) {
  (void)state;
  ric_obstacle floors[RING];
  const size_t between = 0;
  ric_lattice lattice = nonlinear_ring();
  ric_shooting_problem motion = even(&ring_hit, 1, NULL, 0);
  const ric_guess_problem problem = {&lattice, floors, RING, &motion};
  ric_guess with = guess_for(RING), without = guess_for(RING);
  ric_error error;
  put_floors(floors, RING);
  motion.sequence = &between;
  motion.count = 1;
  check(ric_guess_even(&problem, ring_period, &with, &error), &error);
  motion.count = 0;
  lattice.on_site.cubic = lattice.link.quadratic = lattice.link.cubic = 0;
  check(ric_guess_even(&problem, ring_period, &without, &error), &error);
  assert_memory_equal(with.q, without.q, RING * sizeof *with.q);
  assert_memory_equal(with.v, without.v, RING * sizeof *with.v);
  ric_guess_clear(&with);
  ric_guess_clear(&without);
}

static void particles_that_press_a_hertz_contact_rest_where_its_work_took_their_energy(void **state) {
  (void)state;
  const double mass = 1.7, k = 300;
  ric_obstacle floors[RING];
  ric_lattice lattice = nonlinear_ring();
  const ric_shooting_problem motion = even(&ring_hit, 1, NULL, 0);
  const ric_guess_problem problem = {&lattice, floors, RING, &motion};
  ric_guess rigid = guess_for(RING), pressed = guess_for(RING);
  ric_error error;
  lattice.mass = mass;
  put_floors(floors, RING);
  check(ric_guess_even(&problem, 6, &rigid, &error), &error);
  for (size_t i = 0; i < RING; i++)
    floors[i].stiffness = k;
  check(ric_guess_even(&problem, 6, &pressed, &error), &error);
  const double speed = rigid.v[ring_hit], depth = -1 - pressed.q[ring_hit];
  assert_true(depth > 0 && pressed.v[ring_hit] == 0);
  assert_close(0.4 * k * pow(depth, 2.5), mass * speed * speed / 2, 1e-13 * mass * speed * speed);
  for (size_t i = 0; i < RING; i++)
    assert_true(i == ring_hit || pressed.q[i] == rigid.q[i]);
  ric_guess_clear(&rigid);
  ric_guess_clear(&pressed);
}

/* --- modes that graze --------------------------------------------------------------------------------------------- */

/* Two masses on springs 3, from the ground, and 1 with the cubic part eps; a wall at 2 before the second. The squares
 * of the frequencies are (5 -+ sqrt 13) / 2, the modes (1, 4 - square). */
typedef struct series {
  ric_spring links[3];
  ric_lattice lattice;
  ric_obstacle wall;
  size_t hit;
  ric_shooting_problem motion;
  ric_guess_problem problem;
} series;

static void series_init(series *s, double eps) {
  *s = (series){.links = {{3, 0, 0, 0}, {1, 0, eps, 0}, {0, 0, 0, 0}},
                .lattice = ric_lattice_default(2, RIC_ENDS_FIXED),
                .wall = ric_obstacle_wall(1, 2)};
  s->lattice.on_site = (ric_spring){0};
  s->lattice.links = s->links;
  s->motion = even(&s->hit, 1, NULL, 0);
  s->problem = (ric_guess_problem){&s->lattice, &s->wall, 1, &s->motion};
}

static double square_of(size_t mode) {
  return (5 + (mode ? 1 : -1) * sqrt(13)) / 2;
}

static void modes_of_the_linear_part_graze_where_their_closed_form_says(void **state) {
  (void)state;
  series s;
  ric_guess guess = guess_for(2);
  ric_error error;
  series_init(&s, 0);
  for (size_t mode = 0; mode < 2; mode++)
    for (size_t swings = 1; swings < 4; swings++) {
      check(ric_guess_grazing_mode(&s.problem, mode, swings, &guess, &error), &error);
      assert_close(guess.period, (double)swings * turn / sqrt(square_of(mode)), 1e-12 * guess.period);
      assert_true(guess.q[1] == 2);
      assert_close(guess.v[1], 0, 1e-9);
      assert_close(guess.q[0], 2 / (4 - square_of(mode)), 1e-12);
    }
  ric_guess_clear(&guess);
}

/* Without the wall the same motion is smooth, turns at the wall, and is solved by shooting without impacts. */
static void nonlinear_modes_that_graze_are_smooth_motions_that_turn_at_the_obstacle(void **state) {
  (void)state;
  series s;
  ric_guess guess = guess_for(2);
  ric_error error;
  series_init(&s, 0.1);
  for (size_t swings = 1; swings < 4; swings++) {
    ric_system *system = NULL;
    double amplitude, q[3][2], v[3][2];
    const ric_shooting_problem smooth = even(NULL, 0, NULL, 0);
    check(ric_guess_grazing_mode(&s.problem, 0, swings, &guess, &error), &error);
    assert_close(guess.v[1], 0, 1e-9);
    check(ric_system_create_lattice(&s.lattice, NULL, 0, &system, &error), &error);
    shooting_solution free_motion = shooting_solution_of_system(system, &smooth);
    shooting_solution_guess(&free_motion, guess.q, guess.v, NULL, guess.period);
    shooting_solution_solve(&free_motion);
    for (int i = 0; i < 2; i++)
      assert_close(free_motion.orbit.q[i], guess.q[i], 1e-8);
    check(ric_shooting_amplitude(free_motion.shooting, free_motion.z, guess.period, &amplitude, &error), &error);
    assert_close(amplitude, 2, 1e-8);
    check(ric_shooting_states(free_motion.shooting, free_motion.z, guess.period, 3, &q[0][0], &v[0][0], &error),
          &error);
    if (swings == 2) /* once more in the middle */
      assert_close(q[1][1], 2, 1e-7);
    shooting_solution_clear(&free_motion);
  }
  ric_guess_clear(&guess);
}

static int keep_impulse(const ric_family_point *point, void *user) {
  if (point->kind == RIC_FAMILY_REGULAR)
    *(double *)user = point->orbit->impulse[0];
  return 0;
}

/* On the side to which `rise` points the impulse pushes, on the other it pulls. */
static void impulses_push_on_the_side_that_the_guess_names(void **state) {
  (void)state;
  series s;
  ric_guess guess = guess_for(2);
  ric_error error;
  for (int k = 0; k < 4; k++) {
    series_init(&s, k < 2 ? 0 : 0.1);
    check(ric_guess_grazing_mode(&s.problem, (size_t)k % 2, 1, &guess, &error), &error);
    assert_true(guess.rise == 1 || guess.rise == -1);
    const double energy = ric_lattice_energy(&s.lattice, guess.q, guess.v);
    for (int side = -1; side <= 1; side += 2) {
      ric_family *family = NULL;
      ric_system *system = NULL;
      ric_family_options options = ric_family_options_default();
      ric_curve_run run;
      double z[3], impulse = NAN;
      options.curve.direction = side * guess.rise;
      options.curve.points = 6;
      check(ric_system_create_lattice(&s.lattice, &s.wall, 1, &system, &error), &error);
      ric_family_problem problem = {.system = system, .motion = s.motion, .parameters = 1, .given = energy};
      problem.motion.energy_given = true;
      check(ric_family_create(&problem, &options, &family, &error), &error);
      check(ric_family_start(family, energy, guess.q, guess.v, NULL, guess.period, z, NULL, &error), &error);
      check(ric_family_follow(family, z, energy, NULL, keep_impulse, &impulse, &run, &error), &error);
      assert_true(impulse * side > 1e-3);
      ric_family_destroy(&family);
      ric_system_destroy(&system);
    }
  }
  ric_guess_clear(&guess);
}

/* --- the motion of a guess ---------------------------------------------------------------------------------------- */

static void guesses_become_the_motion_of_their_period_with_its_energy(void **state) {
  (void)state;
  series s;
  ric_guess guess = guess_for(2);
  ric_system *system = NULL;
  ric_error error;
  double energy, F[2];
  const double period = 0.95 * turn / sqrt(square_of(0));
  series_init(&s, 0);
  check(ric_guess_even(&s.problem, period, &guess, &error), &error);
  const double q[2] = {guess.q[0], guess.q[1]}, v = guess.v[1];
  s.links[1].cubic = 0.05; /* of which the guess knows nothing */
  check(ric_system_create_lattice(&s.lattice, &s.wall, 1, &system, &error), &error);
  shooting_solution found = shooting_solution_of_system(system, &s.motion);
  check(ric_guess_solve(found.shooting, NULL, &guess, &energy, &error), &error);
  assert_true(guess.period == period && guess.q[1] == q[1] && guess.q[0] != q[0] && guess.v[1] != v);
  assert_close(energy, ric_lattice_energy(&s.lattice, guess.q, guess.v), 1e-12);
  const double z[2] = {guess.q[0], guess.v[1]};
  check(ric_shooting_residual(found.shooting, z, period, F, NULL, NULL, &error), &error);
  assert_close(hypot(F[0], F[1]), 0, 1e-11);
  shooting_solution_clear(&found);
  ric_guess_clear(&guess);
}

/* --- what is refused ---------------------------------------------------------------------------------------------- */

static int stop(void *user) {
  (void)user;
  return 1;
}

/* A guess that is refused keeps what it had. */
static void assert_refused(ric_status status, ric_status expected, const ric_guess *guess, const ric_error *error,
                           const char *words) {
  assert_int_equal(status, expected);
  if (!strstr(error->message, words))
    fail_msg("\"%s\" does not say \"%s\"", error->message, words);
  assert_true(guess->q[0] == 0.25 && guess->period == -1);
}

static void guesses_that_do_not_exist_are_refused_with_their_reason(void **state) {
  (void)state;
  series s;
  ric_guess guess = guess_for(2);
  ric_error error;
  const size_t far = 2, near = 0;
  series_init(&s, -0.5);
  guess.q[0] = 0.25;
  guess.period = -1;
  ric_lattice linear = ric_lattice_default(2, RIC_ENDS_FREE);
  assert_refused(ric_guess_particles(&linear, &near, 1, 6, &guess, &error), RIC_EINVAL, &guess, &error,
                 "at no amplitude");
  assert_refused(ric_guess_particles(&linear, &far, 1, 6, &guess, &error), RIC_EINVAL, &guess, &error, "particle 2");
  assert_refused(ric_guess_mode(&linear, 2, 1, &guess, &error), RIC_EINVAL, &guess, &error, "mode = 2");
  assert_refused(ric_guess_mode(&linear, 0, 0, &guess, &error), RIC_EINVAL, &guess, &error, "energy 0");
  assert_refused(ric_guess_mode(&linear, 0, NAN, &guess, &error), RIC_EINVAL, &guess, &error, "energy nan");
  assert_refused(ric_guess_even(&s.problem, 0.9 * turn / sqrt(square_of(0)), &guess, &error), RIC_ENUMERIC, &guess,
                 &error, "its family has a fold at");
  assert_refused(ric_guess_grazing_mode(&s.problem, 2, 1, &guess, &error), RIC_EINVAL, &guess, &error, "mode = 2");
  assert_refused(ric_guess_grazing_mode(&s.problem, 0, 0, &guess, &error), RIC_EINVAL, &guess, &error, "0 swings");
  s.wall.stiffness = 100;
  assert_refused(ric_guess_grazing_mode(&s.problem, 0, 1, &guess, &error), RIC_EINVAL, &guess, &error, "compliant");
  s.wall.stiffness = INFINITY;
  s.hit = 1;
  assert_refused(ric_guess_even(&s.problem, 6, &guess, &error), RIC_EINVAL, &guess, &error, "at_start[0] = 1");
  s.hit = 0;
  s.motion.kind = RIC_MOTION_CONSERVATIVE;
  assert_refused(ric_guess_even(&s.problem, 6, &guess, &error), RIC_EINVAL, &guess, &error, "even motions");
  ric_guess_clear(&guess);
  assert_int_equal(ric_guess_init(&guess, 0, &error), RIC_EINVAL);
}

static void modes_that_do_not_move_the_particle_graze_nothing(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(3, RIC_ENDS_FIXED);
  const ric_obstacle floor = ric_obstacle_floor(1, -1);
  const size_t hit = 0;
  const ric_shooting_problem motion = even(&hit, 1, NULL, 0);
  const ric_guess_problem problem = {&lattice, &floor, 1, &motion};
  ric_guess guess = guess_for(3);
  ric_error error;
  lattice.link.linear = 1; /* in the second of three modes the middle one stands still */
  assert_int_equal(ric_guess_grazing_mode(&problem, 1, 1, &guess, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "moves particle 1 by"));
  ric_guess_clear(&guess);
}

static void the_poll_stops_a_homotopy(void **state) {
  (void)state;
  series s;
  ric_guess guess = guess_for(2);
  ric_error error;
  series_init(&s, 0.1);
  s.motion.poll = (ric_poll){stop, NULL};
  assert_int_equal(ric_guess_even(&s.problem, 7, &guess, &error), RIC_ESTOPPED);
  assert_int_equal(ric_guess_grazing_mode(&s.problem, 0, 1, &guess, &error), RIC_ESTOPPED);
  ric_guess_clear(&guess);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(excited_particles_swing_with_their_period_up_to_the_fourth_power_of_the_amplitude),
      cmocka_unit_test(particles_without_an_on_site_spring_swing_on_the_link_before_them),
      cmocka_unit_test(modes_have_their_energy_and_turn_at_rest),
      cmocka_unit_test(even_guesses_of_chains_are_their_orbits),
      cmocka_unit_test(even_guesses_of_nonlinear_lattices_are_motions),
      cmocka_unit_test(even_guesses_with_impacts_in_between_are_those_of_the_linear_part_without_them),
      cmocka_unit_test(particles_that_press_a_hertz_contact_rest_where_its_work_took_their_energy),
      cmocka_unit_test(modes_of_the_linear_part_graze_where_their_closed_form_says),
      cmocka_unit_test(nonlinear_modes_that_graze_are_smooth_motions_that_turn_at_the_obstacle),
      cmocka_unit_test(impulses_push_on_the_side_that_the_guess_names),
      cmocka_unit_test(guesses_become_the_motion_of_their_period_with_its_energy),
      cmocka_unit_test(guesses_that_do_not_exist_are_refused_with_their_reason),
      cmocka_unit_test(modes_that_do_not_move_the_particle_graze_nothing),
      cmocka_unit_test(the_poll_stops_a_homotopy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

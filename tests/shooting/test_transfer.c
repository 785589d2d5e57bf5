/* Derivatives of a motion's state between two of its times: against tangent vectors of event-driven runs, by their
 * composition, and by their eigenvalues over a period. */
#include "support.h"

#include "witness/shooting_solution.h"

enum { N = 4 };

static ric_system *two_masses(const double *force) {
  static const ric_spring links[3] = {{3, 0, 0, 0.2}, {1, 0, 0.1, 0.1}, {0, 0, 0, 0}};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  ric_obstacle wall = ric_obstacle_wall(1, 1);
  ric_system *system = NULL;
  wall.restitution = 0.7;
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  lattice.force_cos = force;
  lattice.frequency = 1;
  assert_int_equal(ric_system_create_lattice(&lattice, &wall, 1, &system, NULL), RIC_OK);
  return system;
}

static const double period = 6.283185307179586;

/* A forced motion that hits the wall once in a period: where runs settle. */
static shooting_solution forced_motion(size_t pieces) {
  static const double force[2] = {0.2, 0.9};
  static const size_t wall = 0;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_FORCED, .sequence = &wall, .count = 1, .pieces = pieces, .flow = ric_flow_options_default()};
  shooting_solution s = shooting_solution_of_system(two_masses(force), &problem);
  const double q[2] = {0.1, 1}, u[2] = {0.1, -0.5}, time = 0.5;
  shooting_solution_guess(&s, q, u, &time, period);
  shooting_solution_solve(&s);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  return s;
}

static void find(shooting_solution *s, double from, double to, double *x, double *matrix) {
  ric_error error;
  if (ric_shooting_transfer(s->shooting, s->z, s->given, from, to, x, matrix, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

/* The same by a trajectory. */
static void run(const shooting_solution *s, double from, double to, const double *x, double *matrix) {
  ric_trajectory *t = NULL;
  ric_run run;
  double dq[2 * N] = {1, 0, 0, 0, 0, 1, 0, 0}, du[2 * N] = {0, 0, 1, 0, 0, 0, 0, 1};
  assert_int_equal(ric_trajectory_create(s->system, NULL, &t, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(t, from, x, x + 2, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_carry(t, N, dq, du, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(t, to, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  memcpy(matrix, ric_trajectory_dq(t), sizeof dq);
  memcpy(matrix + 2 * N, ric_trajectory_du(t), sizeof du);
  ric_trajectory_destroy(&t);
}

static void they_are_those_of_event_driven_runs(void **state) {
  (void)state;
  for (size_t pieces = 1; pieces <= 3; pieces += 2) {
    shooting_solution s = forced_motion(pieces);
    const double hit = s.orbit.impact_time[0];
    const double times[][2] = {{hit - 1, hit + 1},
                               {hit + 0.5, hit + 2},
                               {hit - 0.3, hit - 0.3 + period},
                               {-4.5, 0.1},
                               {9, 9},
                               {hit + 0.1, hit + period + 0.05}};
    for (size_t k = 0; k < sizeof times / sizeof *times; k++) {
      double x[N], found[N * N], expected[N * N];
      find(&s, times[k][0], times[k][1], x, found);
      run(&s, times[k][0], times[k][1], x, expected);
      for (size_t i = 0; i < N * N; i++)
        assert_close(found[i], expected[i], 1e-9);
    }
    shooting_solution_clear(&s);
  }
}

static void parts_of_a_period_make_the_whole(void **state) {
  (void)state;
  shooting_solution s = forced_motion(1);
  double x[N], after[N], first[N * N], second[N * N], whole[N * N];
  const double from = 2, middle = s.orbit.impact_time[0] + period, to = from + period;
  find(&s, from, middle, x, first); /* through the impact at its end */
  find(&s, middle, to, after, second);
  find(&s, from, to, x, whole);
  assert_true(after[3] < 0); /* after it */
  for (size_t i = 0; i < N; i++)
    for (size_t j = 0; j < N; j++) {
      double sum = 0;
      for (size_t l = 0; l < N; l++)
        sum += second[i * N + l] * first[l * N + j];
      assert_close(sum, whole[i * N + j], 1e-12);
    }
  shooting_solution_clear(&s);
}

/* From any time: the multipliers of the motion. */
static void over_a_period_they_have_the_multipliers(void **state) {
  (void)state;
  shooting_solution s = forced_motion(1);
  ric_multipliers mu, found;
  double x[N], matrix[N * N];
  assert_int_equal(ric_multipliers_init(&mu, N, NULL), RIC_OK);
  assert_int_equal(ric_multipliers_init(&found, N, NULL), RIC_OK);
  assert_int_equal(ric_shooting_multipliers(s.shooting, s.z, s.given, NULL, &mu, NULL), RIC_OK);
  for (double from = 0; from < period; from += 0.7) {
    find(&s, from, from + period, x, matrix);
    assert_int_equal(ric_multipliers_of_matrix(matrix, N, 0, NULL, &found, NULL), RIC_OK);
    for (size_t k = 0; k < N; k++)
      assert_close(hypot(found.mu[k].re - mu.mu[k].re, found.mu[k].im - mu.mu[k].im), 0, 1e-10);
  }
  ric_multipliers_clear(&mu);
  ric_multipliers_clear(&found);
  shooting_solution_clear(&s);
}

/* Nearer to the end of a piece, or of the period, than rounding tells. */
static void states_at_ends_of_pieces_are_found(void **state) {
  (void)state;
  shooting_solution s = forced_motion(3);
  const double hit = s.orbit.impact_time[0], nearly[] = {0, 1e-13, -1e-13, 1e-15, -1e-15, 3e-12, -3e-12};
  for (size_t k = 0; k < 3; k++)
    for (size_t i = 0; i < sizeof nearly / sizeof *nearly; i++) {
      const double cut = hit + (double)k * period / 3;
      double x[N] = {NAN, NAN, NAN, NAN}, expected[N], matrix[N * N];
      if (k == 0 && nearly[i] < -1e-12)
        continue; /* before the impact */
      find(&s, cut, cut, expected, NULL);
      find(&s, cut + nearly[i] * period, cut + nearly[i] * period, x, matrix);
      for (size_t j = 0; j < N; j++)
        assert_close(x[j], expected[j], 1e-9);
      for (size_t j = 0; j < N * N; j++)
        assert_close(matrix[j], j % (N + 1) == 0 ? 1 : 0, 1e-9);
    }
  shooting_solution_clear(&s);
}

static void times_out_of_order_are_refused(void **state) {
  (void)state;
  shooting_solution s = forced_motion(1);
  const double times[][2] = {{1, 0.5}, {0, 7}, {NAN, 1}, {0, NAN}, {-INFINITY, 0}, {INFINITY, INFINITY}};
  double x[N];
  ric_error error;
  for (size_t k = 0; k < sizeof times / sizeof *times; k++) {
    assert_int_equal(ric_shooting_transfer(s.shooting, s.z, s.given, times[k][0], times[k][1], x, NULL, &error),
                     RIC_EINVAL);
    assert_non_null(strstr(error.message, "expected from <= to"));
  }
  shooting_solution_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(they_are_those_of_event_driven_runs), cmocka_unit_test(parts_of_a_period_make_the_whole),
      cmocka_unit_test(over_a_period_they_have_the_multipliers), cmocka_unit_test(states_at_ends_of_pieces_are_found),
      cmocka_unit_test(times_out_of_order_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

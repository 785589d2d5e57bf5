/* The list of singular points against a scan of the determinant that shares nothing with it: the contact matrix summed
 * over the modes of the whole chain, its sign by elimination, a fine grid between neighbouring resonances. */
#include "support.h"

#include "witness/solved_orbit.h"

enum { MOST_IMPACTS = 4, MOST_POINTS = 256, GRID = 3000 };

static const double pi = 3.14159265358979323846;

/* The parameter that varies. */
typedef struct scan {
  const scenario *s;
  ric_along along;
} scan;

/* Sign of the determinant of G_kl = sum_j phi_j(k) phi_j(l) g_j, where g_j = cos x / (2 omega sin x) for impacts at the
 * same time, 1 / (2 omega sin x) for impacts half a period apart, x = omega_j T / 2. */
static void contact_matrix(const scan *c, double parameter, double g[MOST_IMPACTS][MOST_IMPACTS]) {
  ric_chain chain = c->s->chain;
  double period = c->along == RIC_ALONG_PERIOD ? parameter : c->s->period;
  size_t m = ric_pattern_impacts(c->s->pattern);
  if (c->along == RIC_ALONG_GAMMA)
    chain.gamma = parameter;
  memset(g, 0, MOST_IMPACTS * sizeof *g);
  for (size_t j = 0; j < chain.particles; j++) {
    double omega = ric_chain_frequency(&chain, j), x = omega * period / 2;
    for (size_t a = 0; a < m; a++)
      for (size_t b = 0; b < m; b++) {
        size_t k = ric_pattern_impact(c->s->pattern, a), l = ric_pattern_impact(c->s->pattern, b);
        int together = ric_pattern_role(c->s->pattern, k) == ric_pattern_role(c->s->pattern, l);
        g[a][b] += ric_chain_mode_shape(&chain, j, k) * ric_chain_mode_shape(&chain, j, l) * (together ? cos(x) : 1) /
                   (2 * omega * sin(x));
      }
  }
}

static int determinant_sign(const scan *c, double parameter) {
  double g[MOST_IMPACTS][MOST_IMPACTS];
  size_t m = ric_pattern_impacts(c->s->pattern);
  int sign = 1;
  contact_matrix(c, parameter, g);
  for (size_t k = 0; k < m; k++) {
    size_t pivot = k;
    for (size_t r = k + 1; r < m; r++)
      pivot = fabs(g[r][k]) > fabs(g[pivot][k]) ? r : pivot;
    for (size_t j = 0; j < m && pivot != k; j++) {
      double swap = g[k][j];
      g[k][j] = g[pivot][j];
      g[pivot][j] = swap;
    }
    sign *= (pivot == k ? 1 : -1) * (g[k][k] > 0 ? 1 : -1);
    for (size_t r = k + 1; r < m; r++)
      for (size_t j = m; j-- > k;)
        g[r][j] -= g[r][k] / g[k][k] * g[k][j];
  }
  return sign;
}

static double bisect(const scan *c, double low, double high) {
  int sign = determinant_sign(c, low);
  for (int i = 0; i < 60; i++) {
    double middle = (low + high) / 2;
    if (determinant_sign(c, middle) == sign)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Zeros in (low, high), a range without poles inside; the grid is finest at its ends, where poles have zeros close by.
 */
static size_t scan_interval(const scan *c, double low, double high, double *zeros, size_t count) {
  double left = low + (high - low) * 1e-9;
  int sign = determinant_sign(c, left);
  for (int k = 1; k <= GRID; k++) {
    double right = low + (high - low) * fmin(fmax((1 - cos(pi * k / GRID)) / 2, 1e-9), 1 - 1e-9);
    int next = determinant_sign(c, right);
    if (next != sign && count < MOST_POINTS)
      zeros[count++] = bisect(c, left, right);
    left = right;
    sign = next;
  }
  return count;
}

static size_t scan_range(const scan *c, double low, double high, double *zeros) {
  ric_resonance poles[MOST_POINTS];
  size_t pole_count, count = 0;
  double left = low;
  assert_int_equal(
      ric_chain_resonances(&c->s->chain, c->along, c->s->period, low, high, poles, MOST_POINTS, &pole_count, NULL),
      RIC_OK);
  assert_true(pole_count < MOST_POINTS);
  for (size_t k = 0; k <= pole_count; k++) {
    double right = k < pole_count ? poles[k].parameter : high;
    if (right - left > 1e-9)
      count = scan_interval(c, left, right, zeros, count);
    left = right;
  }
  return count;
}

static void compare(scenario s, ric_along along, double low, double high) {
  scan c = {.s = &s, .along = along};
  double scanned[MOST_POINTS], points[MOST_POINTS];
  size_t count, expected = scan_range(&c, low, high, scanned);
  ric_orbit_solver *solver;
  ric_error error = {0};
  assert_int_equal(ric_orbit_solver_create(NULL, &solver, NULL), RIC_OK);
  if (ric_orbit_singular_points(solver, &s.chain, s.pattern, along, s.period, low, high, points, MOST_POINTS, &count,
                                &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_int_equal(count, expected);
  for (size_t k = 0; k < count; k++)
    assert_close(points[k], scanned[k], 1e-10 * high);
  ric_orbit_solver_destroy(&solver);
  scenario_clear(&s);
}

static void one_impact_has_the_scanned_points_along_gamma(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    compare(scenario_single(12, (ric_ends)ends, 0, 1.5 * pi, 5), RIC_ALONG_GAMMA, 0, 1.3);
    compare(scenario_single(9, (ric_ends)ends, 0, 8, 2), RIC_ALONG_GAMMA, 0.1, 2);
    compare(scenario_single(1, (ric_ends)ends, 0, 2, 0), RIC_ALONG_GAMMA, 0, 9);
  }
}

static void two_and_three_impacts_have_the_scanned_points_along_gamma(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    compare(scenario_word("s..h.....", 1, (ric_ends)ends, 0, 1.5 * pi), RIC_ALONG_GAMMA, 0, 1.3);
    compare(scenario_word(".s..s......", 1, (ric_ends)ends, 0, 5), RIC_ALONG_GAMMA, 0, 1.3);
    compare(scenario_word("ssh.....", 1, (ric_ends)ends, 0, 3.5), RIC_ALONG_GAMMA, 0, 1.3);
    compare(scenario_word("s.s..h......", 1, (ric_ends)ends, 0, 7), RIC_ALONG_GAMMA, 0.05, 1);
  }
}

static void points_along_the_period_are_the_scanned_ones(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    compare(scenario_single(10, (ric_ends)ends, 0.3, 1, 4), RIC_ALONG_PERIOD, 1, 14);
    compare(scenario_word("s..h....", 1, (ric_ends)ends, 0.8, 1), RIC_ALONG_PERIOD, 0.5, 10);
    compare(scenario_word("hs.s....", 1, (ric_ends)ends, 0.1, 1), RIC_ALONG_PERIOD, 2, 10);
  }
}

/* For one impact p = b / G: its sign changes through infinity at the points and through zero at the resonances. */
static void impulses_change_sign_through_infinity_there(void **state) {
  (void)state;
  double points[MOST_POINTS];
  size_t count;
  ric_error error;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_single(30, RIC_ENDS_PERIODIC, 0, 1.5 * pi, 15));
  assert_int_equal(ric_orbit_singular_points(x.solver, &x.scenario.chain, x.scenario.pattern, RIC_ALONG_GAMMA, 1.5 * pi,
                                             0.15, 1.2, points, MOST_POINTS, &count, &error),
                   RIC_OK);
  assert_true(count > 10 && count < MOST_POINTS);
  for (size_t k = 0; k < count; k++) {
    double p[2];
    for (int side = 0; side < 2; side++) {
      x.scenario.chain.gamma = points[k] + (side ? 1e-8 : -1e-8);
      assert_int_equal(ric_orbit_solve(x.solver, &x.scenario.chain, x.scenario.pattern, 1.5 * pi, &x.orbit, &error),
                       RIC_OK);
      p[side] = x.orbit.impulse[0];
    }
    assert_true(p[0] * p[1] < 0);
    assert_true(fabs(p[0]) > 1e3 && fabs(p[1]) > 1e3);
    assert_true(k == 0 || points[k] > points[k - 1]);
  }
  solved_orbit_clear(&x);
}

static void count_goes_on_beyond_the_capacity(void **state) {
  (void)state;
  double points[3] = {0, 0, -1}, all[MOST_POINTS];
  size_t few, many;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_single(30, RIC_ENDS_PERIODIC, 0, 1.5 * pi, 15));
  const scenario *s = &x.scenario;
  assert_int_equal(ric_orbit_singular_points(x.solver, &s->chain, s->pattern, RIC_ALONG_GAMMA, s->period, 0.1, 1, all,
                                             MOST_POINTS, &many, NULL),
                   RIC_OK);
  assert_int_equal(ric_orbit_singular_points(x.solver, &s->chain, s->pattern, RIC_ALONG_GAMMA, s->period, 0.1, 1,
                                             points, 2, &few, NULL),
                   RIC_OK);
  assert_int_equal(few, many);
  assert_close(points[0], all[0], 0);
  assert_close(points[1], all[1], 0);
  assert_close(points[2], -1, 0);
  solved_orbit_clear(&x);
}

/* On the unit cell: every third particle of a ring of 12 has the points of a ring of 3. */
static void periodic_patterns_have_the_points_of_their_cell(void **state) {
  (void)state;
  const char *words[] = {"s..", "sh", "s.", "s", "sh.", "s.h."};
  for (size_t w = 0; w < sizeof words / sizeof *words; w++) {
    double ring[MOST_POINTS], cell[MOST_POINTS];
    size_t on_ring, on_cell;
    solved_orbit large = solve_orbit(RIC_METHOD_IMPULSE, scenario_word(words[w], 8, RIC_ENDS_PERIODIC, 0.1, 5));
    solved_orbit small = solve_orbit(RIC_METHOD_IMPULSE, scenario_word(words[w], 4, RIC_ENDS_PERIODIC, 0.1, 5));
    ric_orbit_singular_points(large.solver, &large.scenario.chain, large.scenario.pattern, RIC_ALONG_GAMMA, 5, 0, 4,
                              ring, MOST_POINTS, &on_ring, NULL);
    ric_orbit_singular_points(small.solver, &small.scenario.chain, small.scenario.pattern, RIC_ALONG_GAMMA, 5, 0, 4,
                              cell, MOST_POINTS, &on_cell, NULL);
    assert_int_equal(on_ring, on_cell);
    for (size_t k = 0; k < on_ring; k++) {
      assert_close(ring[k], cell[k], 1e-14);
      large.scenario.chain.gamma = ring[k];
      assert_int_equal(
          ric_orbit_solve(large.solver, &large.scenario.chain, large.scenario.pattern, 5, &large.orbit, NULL), RIC_OK);
      assert_true(large.orbit.condition > ric_orbit_options_default().singular_condition);
      assert_true(large.orbit.outcome == RIC_SINGULAR || large.orbit.outcome == RIC_RESONANT);
    }
    solved_orbit_clear(&large);
    solved_orbit_clear(&small);
  }
}

static ric_status ask(double period, double low, double high, ric_along along, ric_error *error) {
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_single(5, RIC_ENDS_PERIODIC, 0.1, 5, 2));
  double points[MOST_POINTS];
  size_t count;
  ric_status status = ric_orbit_singular_points(x.solver, &x.scenario.chain, x.scenario.pattern, along, period, low,
                                                high, points, MOST_POINTS, &count, error);
  solved_orbit_clear(&x);
  return status;
}

static void ranges_and_periods_out_of_bounds_are_refused(void **state) {
  (void)state;
  ric_error error;
  const double ranges[][2] = {{-1, 1}, {1, 0.5}, {0, INFINITY}, {NAN, 1}, {0, NAN}};
  for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++) {
    assert_int_equal(ask(5, ranges[k][0], ranges[k][1], RIC_ALONG_GAMMA, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, "range"));
  }
  const double periods[] = {0, -1, NAN, INFINITY};
  for (size_t k = 0; k < sizeof periods / sizeof *periods; k++) {
    assert_int_equal(ask(periods[k], 0, 1, RIC_ALONG_GAMMA, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, "period"));
  }
  assert_int_equal(ask(NAN, 1, 2, RIC_ALONG_PERIOD, &error), RIC_OK);
}

/* A period of 0 is a legal end of the range, though no orbit has it. */
static void range_along_the_period_may_begin_at_zero(void **state) {
  (void)state;
  ric_error error = {0};
  assert_int_equal(ask(5, 0, 4, RIC_ALONG_PERIOD, &error), RIC_OK);
  compare(scenario_word("s.h..", 1, RIC_ENDS_FIXED, 0.3, 1), RIC_ALONG_PERIOD, 0, 9);
}

static void too_many_resonances_are_refused(void **state) {
  (void)state;
  ric_error error;
  assert_int_equal(ask(5, 0, 1e6, RIC_ALONG_PERIOD, &error), RIC_ELIMIT);
  assert_non_null(strstr(error.message, "resonances"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_impact_has_the_scanned_points_along_gamma),
      cmocka_unit_test(two_and_three_impacts_have_the_scanned_points_along_gamma),
      cmocka_unit_test(points_along_the_period_are_the_scanned_ones),
      cmocka_unit_test(impulses_change_sign_through_infinity_there),
      cmocka_unit_test(count_goes_on_beyond_the_capacity),
      cmocka_unit_test(periodic_patterns_have_the_points_of_their_cell),
      cmocka_unit_test(ranges_and_periods_out_of_bounds_are_refused),
      cmocka_unit_test(range_along_the_period_may_begin_at_zero),
      cmocka_unit_test(too_many_resonances_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Localised orbits converge with n to that of the infinite chain. Images of the impact lie n apart, and the response of
 * the infinite chain at distance n is a sum over harmonics l of 2 pi / T of terms exp(-kappa_l n), where (12) at
 * omega = 2 pi l / T has an imaginary wave number: cosh kappa_0 = 1 + 1 / (2 gamma) below the band, cosh kappa_l =
 * (omega^2 - 1) / (2 gamma) - 1 above it. The slowest decay wins. */
#include "support.h"

#include "witness/solved_orbit.h"

static const double pi = 3.14159265358979323846;

static double expected_rate(double gamma, double period) {
  double frequency = 2 * pi / period;
  double below = acosh(1 + 1 / (2 * gamma)), above = acosh((frequency * frequency - 1) / (2 * gamma) - 1);
  return fmin(below, above);
}

static double impulse_with(size_t n, ric_ends ends, double gamma, double period) {
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(n, ends, gamma, period));
  double impulse = x.orbit.impulse[0];
  solved_orbit_clear(&x);
  return impulse;
}

/* Least-squares slope of the logarithm of the error against n, with steps of two: the sign of the staggered term
 * alternates with n, and chains with ends have their impact in the middle for odd n. */
static double measured_rate(ric_ends ends, double gamma, double period, size_t first, size_t last) {
  double limit = impulse_with(401, ends, gamma, period), s = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (size_t n = first; n <= last; n += 2) {
    double error = fabs(impulse_with(n, ends, gamma, period) - limit), a = (double)n, b = log(error);
    assert_true(error > 1e-14 * fabs(limit));
    s++, x += a, y += b, xx += a * a, xy += a * b;
  }
  return -(s * xy - x * y) / (s * xx - x * x);
}

static void check_rate(ric_ends ends, double gamma, double period, size_t first, size_t last) {
  double measured = measured_rate(ends, gamma, period, first, last), expected = expected_rate(gamma, period);
  print_message("ends %d, gamma = %g, T = %.4g: kappa = %.5f measured, %.5f expected\n", (int)ends, gamma, period,
                measured, expected);
  assert_close(measured, expected, 0.03 * expected);
}

static void rings_converge_at_the_rate_of_the_evanescent_wave_above_the_band(void **state) {
  (void)state;
  check_rate(RIC_ENDS_PERIODIC, 0.15, 1.5 * pi, 6, 24);
  check_rate(RIC_ENDS_PERIODIC, 0.12, 1.5 * pi, 6, 20);
  check_rate(RIC_ENDS_PERIODIC, 0.15, 1.5 * pi, 7, 23);
}

static void rings_converge_at_the_rate_of_the_evanescent_wave_below_the_band(void **state) {
  (void)state;
  check_rate(RIC_ENDS_PERIODIC, 1, 2, 8, 24);
}

static void chains_with_ends_converge_at_the_same_rate(void **state) {
  (void)state;
  check_rate(RIC_ENDS_FIXED, 0.15, 1.5 * pi, 7, 23);
  check_rate(RIC_ENDS_FREE, 0.15, 1.5 * pi, 7, 23);
}

/* Amplitudes fall off from the impact at the same rate. */
static void displacements_decay_from_the_impact_at_that_rate(void **state) {
  (void)state;
  const double gamma = 0.15, period = 1.5 * pi;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(101, RIC_ENDS_PERIODIC, gamma, period));
  double q10 = x.orbit.q[50 + 10] - x.orbit.q_half[50 + 10], q20 = x.orbit.q[50 + 20] - x.orbit.q_half[50 + 20];
  assert_close(log(q10 / q20) / 10, expected_rate(gamma, period), 1e-3);
  solved_orbit_clear(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rings_converge_at_the_rate_of_the_evanescent_wave_above_the_band),
      cmocka_unit_test(rings_converge_at_the_rate_of_the_evanescent_wave_below_the_band),
      cmocka_unit_test(chains_with_ends_converge_at_the_same_rate),
      cmocka_unit_test(displacements_decay_from_the_impact_at_that_rate),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

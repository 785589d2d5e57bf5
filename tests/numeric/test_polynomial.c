/* Polynomials on the unit interval: Bernstein form, bounds, minima, reflection. */
#include "support.h"

#include <ricochet/polynomial.h>

#include "scenario/random_source.h"

enum { DEGREE = 24, RANDOM = 400, SAMPLES = 4000 };

/* Rounding of a value in [0, 1]: one unit per operation on the sum of the coefficients' sizes. */
static double rounding_of(const double *c, int degree) {
  double sum = 0;
  for (int j = 0; j <= degree; j++)
    sum += fabs(c[j]);
  return 4 * (degree + 1) * 1.2e-16 * sum;
}

/* Coefficients like those of a Taylor series (shrinking as growth^j / j!) or of one size (growth < 0). */
static void random_polynomial(random_source *source, double growth, double *c) {
  double size = 1;
  for (int j = 0; j <= DEGREE; j++) {
    c[j] = random_uniform(source, -1, 1) * (growth < 0 ? 1 : size);
    size *= growth / (j + 1);
  }
}

typedef void (*property)(random_source *source, const double *c);

static void for_random_polynomials(property holds) {
  const double growths[] = {-1, 1, 4, 9};
  random_source source = {.state = 8};
  double c[DEGREE + 1];
  for (int k = 0; k < RANDOM; k++) {
    random_polynomial(&source, growths[k % 4], c);
    holds(&source, c);
  }
}

static void check_value(random_source *source, const double *c) {
  double x = random_uniform(source, 0, 1), slope, sum = 0, derivative = 0;
  for (int j = 0; j <= DEGREE; j++) {
    sum += c[j] * pow(x, j);
    derivative += j > 0 ? j * c[j] * pow(x, j - 1) : 0;
  }
  assert_close(ric_poly_value(c, DEGREE, x, &slope), sum, rounding_of(c, DEGREE));
  assert_close(slope, derivative, DEGREE * rounding_of(c, DEGREE));
  assert_close(ric_poly_value(c, DEGREE, x, NULL), sum, rounding_of(c, DEGREE));
}

static void value_and_slope_are_sums_of_powers(void **state) {
  (void)state;
  for_random_polynomials(check_value);
}

static void check_bernstein(random_source *source, const double *c) {
  (void)source;
  double b[DEGREE + 1], low = INFINITY, high = -INFINITY, rounding = rounding_of(c, DEGREE);
  ric_poly_bernstein(c, DEGREE, b);
  for (int j = 0; j <= DEGREE; j++) {
    low = fmin(low, b[j]);
    high = fmax(high, b[j]);
  }
  assert_close(b[0], ric_poly_value(c, DEGREE, 0, NULL), rounding);
  assert_close(b[DEGREE], ric_poly_value(c, DEGREE, 1, NULL), rounding);
  for (int k = 0; k <= 200; k++) {
    double value = ric_poly_value(c, DEGREE, k / 200.0, NULL);
    assert_true(value >= low - rounding && value <= high + rounding);
  }
}

static void bernstein_coefficients_end_at_the_values_and_enclose_the_polynomial(void **state) {
  (void)state;
  for_random_polynomials(check_bernstein);
}

/* p(x) = sum_j b_j binomial(d, j) x^j (1 - x)^(d - j). */
static void check_bernstein_sum(random_source *source, const double *c) {
  double b[DEGREE + 1], x = random_uniform(source, 0, 1), sum = 0, binomial = 1;
  ric_poly_bernstein(c, DEGREE, b);
  for (int j = 0; j <= DEGREE; j++) {
    sum += b[j] * binomial * pow(x, j) * pow(1 - x, DEGREE - j);
    binomial *= (double)(DEGREE - j) / (j + 1);
  }
  assert_close(sum, ric_poly_value(c, DEGREE, x, NULL), 2 * rounding_of(c, DEGREE));
}

static void bernstein_form_is_the_polynomial(void **state) {
  (void)state;
  for_random_polynomials(check_bernstein_sum);
}

static void check_lower_bound(random_source *source, const double *c) {
  (void)source;
  double bound = ric_poly_lower_bound(c, DEGREE);
  for (int k = 0; k <= 200; k++)
    assert_true(ric_poly_value(c, DEGREE, k / 200.0, NULL) >= bound - rounding_of(c, DEGREE));
}

static void lower_bound_is_never_above_a_value(void **state) {
  (void)state;
  for_random_polynomials(check_lower_bound);
}

static double sampled_minimum(const double *c, int degree) {
  double least = INFINITY;
  for (int k = 0; k <= SAMPLES; k++)
    least = fmin(least, ric_poly_value(c, degree, (double)k / SAMPLES, NULL));
  return least;
}

static void check_minimum(random_source *source, const double *c) {
  double tolerance = pow(10, random_uniform(source, -14, -2)), at, value, rounding = rounding_of(c, DEGREE);
  assert_int_equal(ric_poly_minimum(c, DEGREE, INFINITY, tolerance, &at, &value), 1);
  assert_true(at >= 0 && at <= 1);
  assert_close(ric_poly_value(c, DEGREE, at, NULL), value, rounding);
  assert_true(value <= sampled_minimum(c, DEGREE) + tolerance + rounding);
}

static void minimum_is_attained_and_never_above_a_sampled_value(void **state) {
  (void)state;
  for_random_polynomials(check_minimum);
}

static void check_cutoff(random_source *source, const double *c) {
  double at = -1, value = -7, true_at, least, cutoff = random_uniform(source, -1.5, 1),
         rounding = rounding_of(c, DEGREE);
  ric_poly_minimum(c, DEGREE, INFINITY, 1e-13, &true_at, &least);
  int found = ric_poly_minimum(c, DEGREE, cutoff, 1e-13, &at, &value);
  assert_int_equal(found, least <= cutoff);
  if (found)
    assert_close(value, least, 1e-13 + rounding);
  else
    assert_true(at == -1 && value == -7);
}

static void minima_above_the_cutoff_are_not_reported(void **state) {
  (void)state;
  for_random_polynomials(check_cutoff);
}

static void check_reflection(random_source *source, const double *c) {
  double r[DEGREE + 1], twice[DEGREE + 1], x = random_uniform(source, 0, 1);
  ric_poly_reflect(c, DEGREE, r);
  double size = rounding_of(r, DEGREE) + rounding_of(c, DEGREE);
  assert_close(ric_poly_value(r, DEGREE, x, NULL), ric_poly_value(c, DEGREE, 1 - x, NULL), size);
  ric_poly_reflect(r, DEGREE, twice);
  for (int j = 0; j <= DEGREE; j++)
    assert_close(twice[j], c[j], 1e-16 * 16 * pow(4, DEGREE)); /* binomials twice: 2^d each way */
}

static void reflection_turns_the_interval_around(void **state) {
  (void)state;
  for_random_polynomials(check_reflection);
}

static void expect_minimum(const double *c, int degree, double at, double value) {
  double x, y;
  assert_int_equal(ric_poly_minimum(c, degree, INFINITY, 1e-15, &x, &y), 1);
  assert_close(y, value, 1e-15 + rounding_of(c, degree));
  if (!isnan(at))
    assert_close(x, at, 1e-7); /* a minimum is located to the root of the rounding */
}

static void minima_of_known_polynomials_are_found(void **state) {
  (void)state;
  const double constant[] = {0.7}, rising[] = {-1, 2, 0, 1}, falling[] = {3, -1, 0, -0.5};
  const double parabola[] = {0.09, -0.6, 1}, touching_end[] = {0, 0, 1}, flat[] = {1, 0, 0, 0, 0};
  const double quartic_touch[] = {0.0625, -0.5, 1.5, -2, 1}; /* (x - 1/2)^4 */
  expect_minimum(constant, 0, NAN, 0.7);
  expect_minimum(flat, 4, NAN, 1);
  expect_minimum(rising, 3, 0, -1);
  expect_minimum(falling, 3, 1, 1.5);
  expect_minimum(parabola, 2, 0.3, 0);
  expect_minimum(touching_end, 2, 0, 0);
  expect_minimum(quartic_touch, 4, NAN, 0);
}

/* (x - a)^2 (x - b)^2 + tilt x: two wells, the tilt decides. */
static void deeper_of_two_wells_is_found(void **state) {
  (void)state;
  for (int side = -1; side <= 1; side += 2)
    for (int k = 1; k <= 8; k++) {
      double a = 0.2, b = 0.8, s = a + b, p = a * b, tilt = side * pow(10, -k);
      double c[] = {p * p, -2 * s * p + tilt, s * s + 2 * p, -2 * s, 1}, at, value;
      assert_int_equal(ric_poly_minimum(c, 4, INFINITY, 1e-14, &at, &value), 1);
      assert_close(at, side > 0 ? a : b, tilt == 0 ? 0 : fabs(tilt) * 2 + 1e-7);
      assert_true(value <= tilt * (side > 0 ? a : b) + 1e-15);
    }
}

/* Chebyshev polynomials shifted to [0, 1]: every minimum is -1. */
static void minima_of_chebyshev_polynomials_are_minus_one(void **state) {
  (void)state;
  double before[DEGREE + 1] = {1}, now[DEGREE + 1] = {-1, 2};
  for (int degree = 1; degree <= 12; degree++) {
    double at, value, next[DEGREE + 1] = {0};
    assert_int_equal(ric_poly_minimum(now, degree, INFINITY, 1e-12, &at, &value), 1);
    assert_close(value, -1, 1e-12 + rounding_of(now, degree));
    for (int j = 0; j <= degree; j++) { /* T_{k+1}(y) = 2 y T_k - T_{k-1}, y = 2 x - 1 */
      next[j + 1] += 4 * now[j];
      next[j] -= 2 * now[j] + before[j];
    }
    memcpy(before, now, sizeof now);
    memcpy(now, next, sizeof now);
  }
}

/* Nearly constant polynomials: derivatives are rounding, subdivision must end all the same. */
static void nearly_constant_polynomials_are_no_trouble(void **state) {
  (void)state;
  random_source source = {.state = 9};
  double c[DEGREE + 1], at, value;
  for (int k = 0; k < 200; k++) {
    c[0] = 1;
    for (int j = 1; j <= DEGREE; j++)
      c[j] = random_uniform(&source, -1, 1) * pow(10, -12 - k % 8);
    assert_int_equal(ric_poly_minimum(c, DEGREE, INFINITY, 1e-15, &at, &value), 1);
    assert_close(value, sampled_minimum(c, DEGREE), 1e-15 + rounding_of(c, DEGREE));
  }
}

/* The first sample lower than both its neighbours lies at the first minimum, unless one too shallow for the samples or
 * above the cutoff comes before it. */
static void check_first_minimum(random_source *source, const double *c) {
  double cutoff = random_uniform(source, -1, 1), at = -1, value, slope, sampled = -1;
  for (int s = 1; s < SAMPLES && sampled < 0; s++) {
    double x = (double)s / SAMPLES, here = ric_poly_value(c, DEGREE, x, NULL);
    if (here < ric_poly_value(c, DEGREE, x - 1.0 / SAMPLES, NULL) - rounding_of(c, DEGREE) &&
        here < ric_poly_value(c, DEGREE, x + 1.0 / SAMPLES, NULL) - rounding_of(c, DEGREE) && here < cutoff - 1e-3)
      sampled = x;
  }
  int found = ric_poly_first_minimum(c, DEGREE, cutoff, &at, &value);
  assert_true(found || sampled < 0);
  if (!found)
    return;
  assert_true(at >= 0 && at <= 1 && value <= cutoff);
  assert_true(sampled < 0 || at <= sampled + 1.0 / SAMPLES);
  assert_close(ric_poly_value(c, DEGREE, at, &slope), value, rounding_of(c, DEGREE));
  assert_close(slope, 0, 1e3 * DEGREE * rounding_of(c, DEGREE));
}

static void first_minimum_is_flat_low_and_not_after_a_sampled_one(void **state) {
  (void)state;
  for_random_polynomials(check_first_minimum);
}

static void first_minimum_is_the_first_of_two_wells(void **state) {
  (void)state;
  /* ((x - a)(x - b))^2 has its wells at a and b, also where halving meets them exactly */
  const double wells[][2] = {{0.25, 0.75}, {0.5, 0.9}, {0.125, 0.5}, {0.3, 0.31}};
  for (int k = 0; k < 4; k++) {
    double a = wells[k][0], b = wells[k][1], p = a + b, q = a * b, at, value;
    const double c[5] = {q * q, -2 * p * q, p * p + 2 * q, -2 * p, 1};
    assert_int_equal(ric_poly_first_minimum(c, 4, 1e-12, &at, &value), 1);
    assert_close(at, a, 1e-7);
    assert_close(value, 0, 1e-15);
    assert_int_equal(ric_poly_first_minimum(c, 4, -1e-6, &at, &value), 0);
  }
  const double rising[] = {0, 1, 1}, falling[] = {1, -1};
  double at, value;
  assert_int_equal(ric_poly_first_minimum(rising, 2, 1, &at, &value), 0);
  assert_int_equal(ric_poly_first_minimum(falling, 1, 1, &at, &value), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(value_and_slope_are_sums_of_powers),
      cmocka_unit_test(bernstein_coefficients_end_at_the_values_and_enclose_the_polynomial),
      cmocka_unit_test(bernstein_form_is_the_polynomial),
      cmocka_unit_test(lower_bound_is_never_above_a_value),
      cmocka_unit_test(minimum_is_attained_and_never_above_a_sampled_value),
      cmocka_unit_test(minima_above_the_cutoff_are_not_reported),
      cmocka_unit_test(reflection_turns_the_interval_around),
      cmocka_unit_test(minima_of_known_polynomials_are_found),
      cmocka_unit_test(deeper_of_two_wells_is_found),
      cmocka_unit_test(minima_of_chebyshev_polynomials_are_minus_one),
      cmocka_unit_test(nearly_constant_polynomials_are_no_trouble),
      cmocka_unit_test(first_minimum_is_flat_low_and_not_after_a_sampled_one),
      cmocka_unit_test(first_minimum_is_the_first_of_two_wells),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

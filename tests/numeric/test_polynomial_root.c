/* First roots on the unit interval: the first x at which the polynomial is <= 0. */
#include "support.h"

#include <ricochet/polynomial.h>

#include "scenario/random_source.h"

enum { DEGREE = 24 };

/* Coefficients of scale prod (x - roots). */
static void from_roots(const double *roots, int count, double scale, double *c) {
  memset(c, 0, (size_t)(count + 1) * sizeof *c);
  c[0] = scale;
  for (int r = 0; r < count; r++)
    for (int j = r + 1; j >= 0; j--)
      c[j] = (j > 0 ? c[j - 1] : 0) - roots[r] * c[j];
}

/* A root is known to rounding over the slope there. */
static void expect_root(const double *c, int degree, double root) {
  double at = NAN, slope, sum = 0;
  for (int j = 0; j <= degree; j++)
    sum += fabs(c[j]);
  assert_int_equal(ric_poly_first_root(c, degree, &at), 1);
  assert_false(ric_poly_is_positive(c, degree));
  ric_poly_value(c, degree, root, &slope);
  assert_close(at, root, 1e-15 + 1e-16 * 8 * (degree + 1) * sum / fabs(slope));
}

static void expect_none(const double *c, int degree) {
  double at = -3;
  assert_int_equal(ric_poly_first_root(c, degree, &at), 0);
  assert_true(ric_poly_is_positive(c, degree));
  assert_close(at, -3, 0);
}

static void first_of_several_roots_is_found(void **state) {
  (void)state;
  const double sets[][4] = {{0.1, 0.2, 0.3, 0.9}, {0.5, 0.6, 0.7, 0.8}, {-0.5, -0.1, 0.4, 0.9}, {0.99, 1.2, 2, 3}};
  const double firsts[] = {0.1, 0.5, 0.4, 0.99};
  double c[5];
  for (int k = 0; k < 4; k++) {
    from_roots(sets[k], 4, 1, c); /* positive before the first: an even number of roots to the right of 0 */
    expect_root(c, 4, firsts[k]);
  }
}

static void two_roots_close_together_are_not_skipped(void **state) {
  (void)state;
  double c[5];
  for (int k = 1; k <= 6; k++)
    for (double root = 0.05; root < 0.95; root += 0.137) {
      const double roots[] = {root, root + pow(10, -k), -2, -3};
      from_roots(roots, 4, 1, c);
      expect_root(c, 4, root);
    }
}

static void two_close_roots_of_high_degree_are_not_skipped(void **state) {
  (void)state;
  double c[DEGREE + 1];
  for (int k = 1; k <= 4; k++) {
    double roots[DEGREE];
    for (int r = 0; r < DEGREE; r++)
      roots[r] = r % 2 ? 3 + 0.1 * r : -3 - 0.1 * r;
    roots[0] = 0.613;
    roots[1] = 0.613 + pow(10, -k);
    from_roots(roots, DEGREE, 1, c);
    double scale = c[0] > 0 ? 1 / c[0] : -1 / c[0];
    for (int j = 0; j <= DEGREE; j++)
      c[j] *= scale;
    if (c[0] > 0)
      expect_root(c, DEGREE, 0.613);
  }
}

static void values_that_start_below_zero_have_their_root_at_the_start(void **state) {
  (void)state;
  const double zero_at_start[] = {0, 1, 2}, negative[] = {-0.5, 1}, always[] = {-1}, null[] = {0};
  expect_root(zero_at_start, 2, 0);
  double at;
  assert_int_equal(ric_poly_first_root(negative, 1, &at), 1);
  assert_close(at, 0, 0);
  assert_int_equal(ric_poly_first_root(always, 0, &at), 1);
  assert_close(at, 0, 0);
  assert_int_equal(ric_poly_first_root(null, 0, &at), 1);
  assert_close(at, 0, 0);
}

static void root_at_the_end_belongs_to_the_interval(void **state) {
  (void)state;
  const double falling[] = {1, -1}, later[] = {1, -1 + 1e-12};
  expect_root(falling, 1, 1);
  expect_none(later, 1);
}

static void positive_polynomials_have_no_root(void **state) {
  (void)state;
  const double constant[] = {1e-300}, parabola[] = {0.25 + 1e-9, -1, 1}, rising[] = {1e-12, 1, 1};
  expect_none(constant, 0);
  expect_none(parabola, 2);
  expect_none(rising, 2);
}

/* A double root is a root, though rounding may lift it: then the polynomial is positive as it stands. */
static void touching_roots_are_found_where_the_values_reach_zero(void **state) {
  (void)state;
  const double exact[] = {0.25, -1, 1}; /* (x - 1/2)^2 without rounding */
  double at;
  assert_int_equal(ric_poly_first_root(exact, 2, &at), 1);
  assert_close(at, 0.5, 1e-8);
  const double deeper[] = {0.25 - 1e-14, -1, 1};
  assert_int_equal(ric_poly_first_root(deeper, 2, &at), 1);
  assert_close(at, 0.5 - 1e-7, 1e-8);
}

/* Random polynomials: zero at the root, no sample <= 0 before it; no sample <= 0 at all when there is none. */
static void no_sample_below_zero_comes_before_the_first_root(void **state) {
  (void)state;
  enum { POLYNOMIALS = 1000, SAMPLES = 1000 };
  random_source source = {.state = 10};
  double c[DEGREE + 1];
  int found = 0;
  for (int k = 0; k < POLYNOMIALS; k++) {
    double size = 1, growth = 1 + k % 9, sum = 0, at = 1, slope;
    for (int j = 0; j <= DEGREE; j++, size *= growth / j) {
      c[j] = random_uniform(&source, -1, 1) * size;
      c[0] = fabs(c[0]);
      sum += fabs(c[j]);
    }
    double rounding = 1e-16 * 8 * DEGREE * sum;
    int any = ric_poly_first_root(c, DEGREE, &at);
    if (any)
      assert_close(ric_poly_value(c, DEGREE, at, &slope), 0, rounding);
    for (int s = 0; s < SAMPLES; s++)
      assert_true(ric_poly_value(c, DEGREE, at * s / SAMPLES, NULL) > -rounding);
    found += any;
  }
  assert_true(found > POLYNOMIALS / 4 && found < POLYNOMIALS * 3 / 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_of_several_roots_is_found),
      cmocka_unit_test(two_roots_close_together_are_not_skipped),
      cmocka_unit_test(two_close_roots_of_high_degree_are_not_skipped),
      cmocka_unit_test(values_that_start_below_zero_have_their_root_at_the_start),
      cmocka_unit_test(root_at_the_end_belongs_to_the_interval),
      cmocka_unit_test(positive_polynomials_have_no_root),
      cmocka_unit_test(touching_roots_are_found_where_the_values_reach_zero),
      cmocka_unit_test(no_sample_below_zero_comes_before_the_first_root),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Cheap tests of polynomials: their answers are correct, and they decide nearly all cases in motions. */
#include "support.h"

#include "numeric/polynomial.h"
#include "ricochet/polynomial.h"
#include "scenario/random_source.h"

enum { DEGREE = 26, SAMPLES = 2000, TRIES = 20000 };

/* A sum of oscillations and creeping over a step in which the fastest turns by 2.2, like a segment of a motion. */
static void motion(random_source *source, double *c) {
  for (int j = 0; j <= DEGREE; j++)
    c[j] = 0;
  for (int k = 0; k < 3; k++) {
    double rate = random_uniform(source, 0, 2.2), size = random_uniform(source, -1, 1), term = size;
    double phase = random_uniform(source, 0, 6.3);
    for (int j = 0; j <= DEGREE; j++) {
      c[j] += k < 2 ? term * cos(phase + j * 1.5707963267948966) : term * (j % 2 ? -1 : 1);
      term *= rate / (j + 1);
    }
  }
}

/* Coefficients of any size at any power. */
static void anything(random_source *source, double *c) {
  for (int j = 0; j <= DEGREE; j++)
    c[j] = pow(10, random_uniform(source, -3, 0)) * (random_uniform(source, 0, 1) < 0.5 ? -1 : 1);
}

static double smallest(const double *c, double end) {
  double least = INFINITY;
  for (int i = 0; i <= SAMPLES; i++)
    least = fmin(least, ric_poly_value(c, DEGREE, end * i / SAMPLES, NULL));
  return least;
}

static bool is_least_at_an_end(const double *c) {
  return fmin(c[0], ric_poly_value(c, DEGREE, 1, NULL)) < smallest(c, 1) + 1e-3;
}

/* Puts the smallest value close to zero, above or below, where tests have to be sharp. */
static void come_near(random_source *source, double *c) {
  double off = pow(10, random_uniform(source, -9, 0)) * (random_uniform(source, 0, 1) < 0.5 ? -1 : 1);
  c[0] += off - smallest(c, 1);
}

static void check_above(const double *c, double value, poly_look seen) {
  if (seen == POLY_ABOVE)
    assert_true(smallest(c, 1) > value);
  double at, least;
  if (seen == POLY_FALLS)
    assert_true(ric_poly_minimum(c, DEGREE, INFINITY, 1e-15, &at, &least) && least <= value);
}

static void what_is_said_to_be_above_is_above(void **state) {
  (void)state;
  random_source source = {5};
  double c[DEGREE + 1];
  size_t open = 0;
  for (int i = 0; i < TRIES; i++) {
    if (i % 2)
      anything(&source, c);
    else
      motion(&source, c);
    come_near(&source, c);
    double value = i % 3 ? 0 : 1e-10;
    poly_look seen = poly_look_above(c, DEGREE, value);
    check_above(c, value, seen);
    open += i % 2 == 0 && seen == POLY_UNDECIDED && !is_least_at_an_end(c);
  }
  print_message("%zu of %d motions undecided away from the ends\n", open, TRIES / 2);
  assert_true(open < TRIES / 2 / 50);
}

/* At a fall the polynomial is zero for the first time, and has come down all the way from where it was above. */
static void check_fall(const double *c, double value, double at) {
  double slope, end = ric_poly_value(c, DEGREE, at, &slope), before = INFINITY;
  assert_close(end, 0, 1e-13);
  assert_true(slope < 0);
  bool low = false;
  for (int i = 0; i < SAMPLES; i++) {
    double y = ric_poly_value(c, DEGREE, at * i / SAMPLES, NULL);
    assert_true(y > -1e-14);
    assert_true(!low || y <= before + 1e-14);
    low |= y <= value;
    before = y;
  }
}

static void falls_are_first_roots(void **state) {
  (void)state;
  random_source source = {6};
  double c[DEGREE + 1], at, root;
  size_t open = 0, falls = 0;
  for (int i = 0; i < TRIES; i++) {
    double value = i % 3 ? 1e-10 : 1e-3;
    motion(&source, c);
    come_near(&source, c);
    poly_look seen = poly_look_fall(c, DEGREE, value, &at);
    open += seen == POLY_UNDECIDED && c[0] > 1e-3;
    falls += seen == POLY_FALLS;
    if (seen == POLY_ABOVE)
      assert_true(smallest(c, 1) > value);
    if (seen != POLY_FALLS)
      continue;
    check_fall(c, value, at);
    assert_true(ric_poly_first_root(c, DEGREE, &root));
    double slope;
    ric_poly_value(c, DEGREE, at, &slope);
    assert_close(root, at, 1e-15 + 1e-14 / fabs(slope));
  }
  print_message("%zu falls, %zu undecided\n", falls, open);
  assert_true(falls > TRIES / 8 && open < TRIES / 5);
}

static void what_leaves_does_not_come_back(void **state) {
  (void)state;
  random_source source = {7};
  double c[DEGREE + 1], at, least;
  size_t leaves = 0;
  for (int i = 0; i < TRIES; i++) {
    motion(&source, c);
    c[0] = random_uniform(&source, -1, 1) * 1e-16;
    c[1] = fabs(c[1]) * pow(10, random_uniform(&source, -6, 0));
    if (!poly_look_leaves(c, DEGREE, 1e-10))
      continue;
    leaves++;
    for (int k = 1; k <= SAMPLES; k++)
      assert_true(ric_poly_value(c, DEGREE, (double)k / SAMPLES, NULL) > 0);
    assert_false(ric_poly_first_minimum(c, DEGREE, 1e-10, &at, &least));
  }
  print_message("%zu of %d leave\n", leaves, TRIES);
  assert_true(leaves > TRIES / 10);
}

static void numbers_that_are_none_are_not_above(void **state) {
  (void)state;
  for (int j = 0; j <= DEGREE; j++) {
    double c[DEGREE + 1] = {1}, at;
    c[j] = NAN;
    assert_true(poly_look_above(c, DEGREE, 0) != POLY_ABOVE);
    assert_true(poly_look_fall(c, DEGREE, 0, &at) == POLY_UNDECIDED);
    assert_false(poly_look_leaves(c, DEGREE, 0));
  }
}

static void low_degrees_are_looked_at_too(void **state) {
  (void)state;
  double at, fall[2] = {0.25, -1}, valley[3] = {0.26, -1, 1}, touch[3] = {0.25, -1, 1}, constant = 2;
  assert_int_equal(poly_look_above(&constant, 0, 1), POLY_ABOVE);
  assert_int_equal(poly_look_above(&constant, 0, 3), POLY_FALLS);
  assert_int_equal(poly_look_fall(fall, 1, 0, &at), POLY_FALLS);
  assert_close(at, 0.25, 1e-16);
  assert_int_equal(poly_look_above(valley, 2, 0.009), POLY_ABOVE);
  assert_int_equal(poly_look_above(valley, 2, 0.011), POLY_FALLS);
  assert_int_equal(poly_look_fall(touch, 2, 1e-10, &at), POLY_UNDECIDED);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_said_to_be_above_is_above), cmocka_unit_test(falls_are_first_roots),
      cmocka_unit_test(what_leaves_does_not_come_back),    cmocka_unit_test(numbers_that_are_none_are_not_above),
      cmocka_unit_test(low_degrees_are_looked_at_too),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Multipliers of a matrix, and the verdict. */
#include "support.h"

#include <ricochet/ricochet.h>

/* Verdict on a diagonal matrix of size 4 that has `trivial` multipliers at 1. */
static ric_multipliers judged(double a, double b, double c, double d, size_t trivial) {
  double M[16] = {a, 0, 0, 0, 0, b, 0, 0, 0, 0, c, 0, 0, 0, 0, d};
  ric_multipliers m;
  assert_int_equal(ric_multipliers_init(&m, 4, NULL), RIC_OK);
  assert_int_equal(ric_multipliers_of_matrix(M, 4, trivial, NULL, &m, NULL), RIC_OK);
  return m;
}

static void check(ric_multipliers m, ric_stability expected, size_t outside) {
  assert_int_equal(m.stable, expected);
  assert_int_equal(m.outside, outside);
  assert_int_equal(m.reason[0] == '\0', expected == RIC_STABLE);
  ric_multipliers_clear(&m);
}

static void verdict_leaves_out_the_trivial_multipliers(void **state) {
  (void)state;
  check(judged(1, 1, 0.5, -0.5, 2), RIC_STABLE, 0);
  check(judged(1 + 3e-8, 1 - 3e-8, 0.5, -0.5, 2), RIC_STABLE, 0);
  check(judged(1, 1, 0.5, -0.5, 1), RIC_UNDECIDED, 0);
  check(judged(0.9, 0.8, 0.5, -0.5, 0), RIC_STABLE, 0);
}

static void verdict_is_undecided_in_the_bands(void **state) {
  (void)state;
  check(judged(1, 1, 0.5, -1 - 1e-10, 2), RIC_STABLE, 0);
  check(judged(1, 1, 0.5, -1 - 1e-7, 2), RIC_UNDECIDED, 0);
  check(judged(1, 1, 0.5, -1 - 1e-5, 2), RIC_UNSTABLE, 1);
  check(judged(1, 1, 1 + 5e-5, 1 - 5e-5, 2), RIC_UNDECIDED, 0);
  check(judged(1, 1, 1 + 2e-4, 1 - 2e-4, 2), RIC_UNSTABLE, 1);
}

static void multipliers_outside_are_counted_by_kind(void **state) {
  (void)state;
  double M[16] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, -1.5};
  ric_multipliers m;
  assert_int_equal(ric_multipliers_init(&m, 4, NULL), RIC_OK);
  assert_int_equal(ric_multipliers_of_matrix(M, 4, 0, NULL, &m, NULL), RIC_OK);
  assert_int_equal(m.outside, 4);
  assert_int_equal(m.real_above, 1);
  assert_int_equal(m.real_below, 1);
  assert_int_equal(m.complex_outside, 2);
  assert_close(m.largest, 3, 1e-14);
  assert_close(m.margin, 2, 1e-14);
  assert_non_null(strstr(m.reason, "multiplier 3 lies 2 outside the unit circle, 4 in all"));
  ric_multipliers_clear(&m);
}

static void multipliers_are_sorted_by_modulus_then_argument(void **state) {
  (void)state;
  double M[16] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, -1.5};
  const ric_complex expected[] = {{3, 0}, {0, 2}, {0, -2}, {-1.5, 0}};
  ric_multipliers m;
  ric_multipliers_init(&m, 4, NULL);
  ric_multipliers_of_matrix(M, 4, 0, NULL, &m, NULL);
  for (size_t i = 0; i < 4; i++) {
    assert_close(m.mu[i].re, expected[i].re, 1e-14);
    assert_close(m.mu[i].im, expected[i].im, 1e-14);
  }
  ric_multipliers_clear(&m);
}

static void bad_arguments_are_refused(void **state) {
  (void)state;
  double M[4] = {1, 0, 0, NAN};
  ric_multiplier_options options = ric_multiplier_options_default();
  ric_multipliers m;
  ric_error error;
  assert_int_equal(ric_multipliers_init(&m, 0, &error), RIC_EINVAL);
  assert_int_equal(ric_multipliers_init(&m, 2, &error), RIC_OK);
  assert_int_equal(m.stable, RIC_STABILITY_UNKNOWN);
  assert_int_equal(ric_multipliers_of_matrix(M, 2, 0, NULL, &m, &error), RIC_EINVAL);
  assert_string_equal(error.message, "entry [1][1] = nan, expected a finite number");
  M[3] = 1;
  assert_int_equal(ric_multipliers_of_matrix(M, 2, 3, NULL, &m, &error), RIC_EINVAL);
  options.band = NAN;
  assert_int_equal(ric_multipliers_of_matrix(M, 2, 2, &options, &m, &error), RIC_EINVAL);
  assert_int_equal(ric_multipliers_of_matrix(M, 2, 2, NULL, &m, &error), RIC_OK);
  check(m, RIC_STABLE, 0); /* nothing besides the trivial ones */
}

static void verdicts_and_kinds_have_names(void **state) {
  (void)state;
  assert_string_equal(ric_stability_name(RIC_UNDECIDED), "undecided");
  assert_string_equal(ric_stability_name(RIC_STABILITIES), "unknown stability");
  assert_string_equal(ric_critical_name(RIC_CRITICAL_COLLISION), "collision");
  assert_string_equal(ric_critical_name(RIC_CRITICAL_KINDS), "unknown kind");
}

/* A motion has no trivial multipliers that are not at 1. */
static void multipliers_far_from_1_are_not_trivial(void **state) {
  (void)state;
  static const double M[4] = {2, 0, 0, 0.5};
  ric_multipliers m;
  assert_int_equal(ric_multipliers_init(&m, 2, NULL), RIC_OK);
  assert_int_equal(ric_multipliers_of_matrix(M, 2, 2, NULL, &m, NULL), RIC_OK);
  assert_int_equal(m.stable, RIC_UNDECIDED);
  assert_non_null(strstr(m.reason, "lies 1 from 1"));
  ric_multipliers_clear(&m);
}

/* GSL 2.7 gives up on this one: zeros on the diagonal beside entries that are next to nothing. */
static void zeros_on_the_diagonal_do_not_prevent_convergence(void **state) {
  (void)state;
  static const double M[9] = {-0.125, 0, 0, 0x1p-43, 0, -1, 0x1p-26, 1, 0};
  ric_multipliers m;
  assert_int_equal(ric_multipliers_init(&m, 3, NULL), RIC_OK);
  assert_int_equal(ric_multipliers_of_matrix(M, 3, 0, NULL, &m, NULL), RIC_OK);
  assert_close(m.mu[0].re, 0, 1e-14);
  assert_close(m.mu[0].im, 1, 1e-14);
  assert_close(m.mu[2].re, -0.125, 1e-14);
  ric_multipliers_clear(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(verdict_leaves_out_the_trivial_multipliers),
      cmocka_unit_test(verdict_is_undecided_in_the_bands),
      cmocka_unit_test(multipliers_outside_are_counted_by_kind),
      cmocka_unit_test(multipliers_are_sorted_by_modulus_then_argument),
      cmocka_unit_test(bad_arguments_are_refused),
      cmocka_unit_test(verdicts_and_kinds_have_names),
      cmocka_unit_test(multipliers_far_from_1_are_not_trivial),
      cmocka_unit_test(zeros_on_the_diagonal_do_not_prevent_convergence),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

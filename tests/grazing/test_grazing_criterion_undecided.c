/* The criterion where it gives no answer or refuses, and what it predicts of windows. */
#include "support.h"

#include "witness/grazing_maps.h"
#include "criterion_map.h"
#include "scenario/random_source.h"

/* --- what is undecided -------------------------------------------------------------------------------------------- */

static void assert_undecided(ric_grazing_map map, const char *reason) {
  ric_grazing_criterion c = find_criterion_once(map);
  if (c.verdict != RIC_GRAZING_UNDECIDED || !strstr(c.reason, reason))
    fail_msg("%s: %s, expected undecided: %s", ric_grazing_verdict_name(c.verdict), c.reason, reason);
}

static void zero_coefficients_are_undecided(void **state) {
  (void)state;
  const double first[] = {1, -1}, second[] = {1, 1};
  ric_grazing_map map = diagonal_map(2, (double[]){0.5, 0.25}, first, second);
  ric_grazing_criterion c = find_criterion(&map);
  assert_int_equal(c.verdict, RIC_GRAZING_UNDECIDED);
  assert_int_equal(c.first_zero, 0);
  assert_string_equal(c.reason, "c_0 is zero within the tolerance: higher orders decide");
  change_coordinates(&map, (double[]){3, 1, 1, -2});
  assert_undecided(map, "c_0 is zero");
  map = diagonal_map(2, (double[]){0.5, 0.25}, second, (double[]){1, -2});
  map.eta[1] = 1;
  c = find_criterion_once(map); /* c_0 = -1 */
  assert_int_equal(c.first_negative, 0);
  map = diagonal_map(3, (double[]){0.5, 0.25, -0.125}, (double[]){1, 1, 1}, (double[]){1, -1, 2});
  c = find_criterion(&map); /* c_1 = 0.5 - 0.25 - 0.25 */
  assert_int_equal(c.verdict, RIC_GRAZING_UNDECIDED);
  assert_int_equal(c.first_zero, 1);
  map.xi[2] = 2 + 1e-7;
  c = find_criterion(&map);
  assert_int_equal(c.first_negative, 1);
  map.xi[2] = 2 - 1e-7;
  c = find_criterion_once(map);
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
}

/* On both sides of the zero it is discontinuous. */
static void negative_coefficients_after_a_zero_decide(void **state) {
  (void)state;
  ric_grazing_criterion c =
      find_criterion_once(diagonal_map(2, (double[]){0.5, 0.25}, (double[]){1, 1}, (double[]){-1, 1}));
  assert_int_equal(c.verdict, RIC_GRAZING_DISCONTINUOUS);
  assert_int_equal(c.first_zero, 0);
  assert_int_equal(c.first_negative, 1);
}

static void degenerate_spectra_are_undecided(void **state) {
  (void)state;
  const double ones[] = {1, 1, 1, 1};
  assert_undecided(diagonal_map(2, (double[]){0.5, 0.5}, ones, ones), "0.5 is not simple");
  assert_undecided(map_of(2, (double[]){0.5, 1, 0, 0.5}, ones, ones), "0.5 is not simple");
  assert_undecided(diagonal_map(2, (double[]){0.5, -0.5}, ones, (double[]){1, 0.1}), "0.5 is not simple");
  assert_undecided(diagonal_map(2, (double[]){0.5, 0.5 - 1e-8}, ones, ones), "0.5 is not simple");
  assert_undecided(map_of(3, (double[]){0.2, 0, 0, 0, 0, -0.5, 0, 0.5, 0}, (double[]){1, 0, 0}, ones), "is complex");
  assert_undecided(diagonal_map(2, (double[]){0.2, -0.5}, (double[]){1, 0}, ones), "-0.5 is negative");
  assert_undecided(diagonal_map(2, (double[]){0.5, 0.2}, (double[]){0, 1}, ones), "eta has no component along");
  assert_undecided(diagonal_map(2, (double[]){0.5, 0.2}, ones, (double[]){0, 1}), "xi does not excite");
  assert_undecided(diagonal_map(2, (double[]){1.5, 0.2}, ones, ones), "multiplier 1.5 of modulus 1.5 does not lie");
  assert_undecided(diagonal_map(2, (double[]){1, 0.2}, ones, ones), "multiplier 1 of modulus 1 does not lie");
  ric_grazing_criterion c = find_criterion_once(diagonal_map(2, (double[]){1.5, 0.2}, ones, (double[]){1, -2}));
  assert_int_equal(c.first_negative, 0); /* whatever the spectrum */
  c = find_criterion_once(map_of(2, (double[]){0.5, 1, 0, 0.5}, ones, (double[]){1, -0.1}));
  assert_int_equal(c.first_negative, 5); /* (0.9 - 0.2 i) 0.5^i */
}

static void zero_multipliers_are_undecided_when_all(void **state) {
  (void)state;
  const double ones[] = {1, 1, 1};
  assert_undecided(diagonal_map(1, (double[]){0}, ones, ones), "all multipliers are zero");
  assert_undecided(map_of(3, (double[]){0, 1, 0, 0, 0, 1, 0, 0, 0}, ones, ones), "all multipliers are zero");
  ric_grazing_criterion c =
      find_criterion_once(map_of(3, (double[]){0, 1, 0, 0, 0, -3, 0, 0, 0}, ones, (double[]){1, 1, 0.5}));
  assert_int_equal(c.first_negative, 1);
  c = find_criterion_once(map_of(3, (double[]){0, 1, 0, 0, 0, 0, 0, 0, 0.1}, ones, ones));
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  c = find_criterion_once(diagonal_map(1, (double[]){0.3}, ones, ones));
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  assert_int_equal(c.settled, 0);
  assert_true(c.second == 0);
}

/* In skew coordinates rounding splits what coincides, and fills what is zero: no certain sign may come of it. */
static void degenerate_maps_stay_undecided_in_any_coordinates(void **state) {
  (void)state;
  random_source source = {15};
  const double ones[] = {1, 1, 1, 1};
  double S[16];
  for (size_t trial = 0; trial < 10; trial++) {
    ric_grazing_map maps[] = {
        diagonal_map(4, (double[]){0.5, 0.5, 0.2, 0.1}, ones, ones),
        map_of(4, (double[]){0.5, 1, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.1}, ones, ones),
        map_of(4, (double[]){0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0}, ones, ones),
        diagonal_map(4, (double[]){0.9, 0.5, 0.4, 0.3}, (double[]){0, 1, 1, 1}, ones),
        diagonal_map(4, (double[]){0.9, 0.5, 0.4, 0.3}, ones, (double[]){0, 1, 1, 1}),
        diagonal_map(4, (double[]){-0.9, 0.5, 0.4, 0.3}, ones, (double[]){0, 1, 1, 1}),
    };
    random_coordinates(&source, trial % 2 ? 4 : 0, 4, S);
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++) {
      change_coordinates(&maps[k], S);
      assert_undecided(maps[k], k == 3 ? "eta has no component along" : k == 4 ? "xi does not excite" : "");
    }
  }
}

static void tails_longer_than_allowed_are_undecided(void **state) {
  (void)state;
  ric_grazing_map map = diagonal_map(2, (double[]){0.5, -0.499}, (double[]){1, 1}, (double[]){1, 0.999});
  ric_grazing_criterion_options options = ric_grazing_criterion_options_default();
  ric_grazing_criterion c = find_criterion(&map);
  assert_int_equal(c.verdict, RIC_GRAZING_CONTINUOUS);
  options.most = c.settled - 1;
  assert_int_equal(ric_grazing_criterion_find(&map, &options, &c, NULL, 0, NULL, NULL), RIC_OK);
  assert_int_equal(c.verdict, RIC_GRAZING_UNDECIDED);
  assert_non_null(strstr(c.reason, "may outweigh"));
  ric_grazing_map_clear(&map);
}

/* --- refusals, names, windows ------------------------------------------------------------------------------------- */

static void bad_arguments_are_refused(void **state) {
  (void)state;
  const double bad[] = {-1e-9, 1, NAN, INFINITY};
  ric_grazing_map map = example_map(0.5, 0.3);
  ric_grazing_criterion c = {.settled = 77};
  ric_grazing_criterion_options options;
  ric_error error;
  for (size_t k = 0; k < 4; k++) {
    options = ric_grazing_criterion_options_default();
    options.zero_tol = bad[k];
    assert_int_equal(ric_grazing_criterion_find(&map, &options, &c, NULL, 0, NULL, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, "zero_tol = "));
    options = ric_grazing_criterion_options_default();
    options.apart_tol = bad[k];
    assert_int_equal(ric_grazing_criterion_find(&map, &options, &c, NULL, 0, NULL, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, "apart_tol = "));
  }
  options = ric_grazing_criterion_options_default();
  options.most = 0;
  assert_int_equal(ric_grazing_criterion_find(&map, &options, &c, NULL, 0, NULL, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, NULL, 1, NULL, &error), RIC_EINVAL);
  double *entries[] = {map.L, map.eta, map.xi};
  for (size_t k = 0; k < 3; k++) {
    double kept = entries[k][1];
    entries[k][1] = NAN;
    assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, NULL, 0, NULL, &error), RIC_EINVAL);
    entries[k][1] = kept;
  }
  map.eta[0] = 0;
  assert_int_equal(ric_grazing_criterion_find(&map, NULL, &c, NULL, 0, NULL, &error), RIC_EINVAL);
  assert_int_equal(c.settled, 77);
  ric_grazing_map_clear(&map);
}

static void verdicts_and_regimes_have_names(void **state) {
  (void)state;
  assert_string_equal(ric_grazing_verdict_name(RIC_GRAZING_DISCONTINUOUS), "discontinuous");
  assert_string_equal(ric_grazing_verdict_name(RIC_GRAZING_VERDICTS), "unknown verdict");
  assert_string_equal(ric_grazing_regime_name(RIC_REGIME_WINDOWS), "windows");
  assert_string_equal(ric_grazing_regime_name(RIC_GRAZING_REGIMES), "unknown regime");
}

/* A map of one dimension is its own limit map; windows close at 2/3 and meet at 1/4. */
static void predicted_windows_scale_by_the_square_of_lambda(void **state) {
  (void)state;
  const double lambdas[] = {2.0 / 3, 0.5, 0.25, 0.1, 0.9};
  for (size_t k = 0; k < 5; k++) {
    double lambda = lambdas[k], border, flip, next_border, next_flip;
    ric_grazing_criterion c = find_criterion_once(diagonal_map(1, &lambda, (double[]){2}, (double[]){1.5}));
    assert_int_equal(ric_grazing_predict_window(&c, 0.7, 2, &border, &flip, NULL), RIC_OK);
    assert_close(border, 2.1 * 2.1 * (1 - lambda), 1e-13);
    assert_close(flip, 2.1 * 2.1 * 0.75 * lambda * lambda, 1e-13);
    assert_int_equal(ric_grazing_predict_window(&c, 0.7, 3, &next_border, &next_flip, NULL), RIC_OK);
    assert_close(next_border / border, lambda * lambda, 1e-13);
    assert_close(next_flip / flip, lambda * lambda, 1e-13);
    if (k == 0)
      assert_close(flip, border, 1e-13);
    if (k == 2)
      assert_close(flip, next_border, 1e-13);
    assert_int_equal(border<flip, lambda> 2.0 / 3 + 1e-6);
    assert_int_equal(flip < next_border, lambda < 0.25 - 1e-6);
  }
}

static void windows_are_predicted_for_continuous_bifurcations_only(void **state) {
  (void)state;
  double border = 7, flip = 7;
  ric_error error;
  ric_grazing_criterion c = find_criterion_once(diagonal_map(1, (double[]){-0.5}, (double[]){1}, (double[]){1})),
                        good = find_criterion_once(example_map(0.5, 0.3));
  assert_int_equal(ric_grazing_predict_window(&c, 1, 4, &border, &flip, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "discontinuous"));
  assert_int_equal(ric_grazing_predict_window(&good, 1, 1, &border, &flip, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_predict_window(&good, 0, 4, &border, &flip, &error), RIC_EINVAL);
  assert_int_equal(ric_grazing_predict_window(&good, NAN, 4, &border, &flip, &error), RIC_EINVAL);
  assert_true(border == 7 && flip == 7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(zero_coefficients_are_undecided),
      cmocka_unit_test(negative_coefficients_after_a_zero_decide),
      cmocka_unit_test(degenerate_spectra_are_undecided),
      cmocka_unit_test(zero_multipliers_are_undecided_when_all),
      cmocka_unit_test(degenerate_maps_stay_undecided_in_any_coordinates),
      cmocka_unit_test(tails_longer_than_allowed_are_undecided),
      cmocka_unit_test(bad_arguments_are_refused),
      cmocka_unit_test(verdicts_and_regimes_have_names),
      cmocka_unit_test(predicted_windows_scale_by_the_square_of_lambda),
      cmocka_unit_test(windows_are_predicted_for_continuous_bifurcations_only),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

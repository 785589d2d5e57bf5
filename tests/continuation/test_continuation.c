/* Walks along curves that are known: where they go, how they step, how they end. */
#include "support.h"

#include "curves.h"

static const double pi = 3.14159265358979323846;

static ric_curve_options defaults(void) {
  return ric_curve_options_default();
}

static void circle_is_closed_and_has_its_length(void **state) {
  (void)state;
  double error[2];
  for (int k = 0; k < 2; k++) {
    ric_curve_options options = defaults();
    options.step = options.step_most = k ? 0.05 : 0.1;
    const double u = 0.9;
    walked *w = walk(&circle, &options, &u, 0.4, NULL);
    assert_int_equal(w->run.end, RIC_CURVE_CLOSED);
    assert_true(last(w)->p == 0.4 && last(w)->u == w->points[0].u);
    for (size_t i = 0; i < w->count; i++)
      assert_close(hypot(w->points[i].u, w->points[i].p), 1, 1e-14);
    error[k] = fabs(last(w)->arclength - 2 * pi);
    print_message("step %g: %zu points, length off by %.3g\n", options.step, w->run.points, error[k]);
    free(w);
  }
  assert_true(error[0] < 1e-5 && error[1] < error[0] / 12); /* of order step^4 */
}

static void folds_of_a_circle_are_at_one(void **state) {
  (void)state;
  const double u = 0.9;
  walked *w = walk(&circle, NULL, &u, 0.4, NULL);
  assert_int_equal(count_special(w, RIC_CURVE_FOLD), 2);
  assert_int_equal(w->run.special, 2);
  for (size_t k = 0; k < 2; k++) {
    const shown_point *fold = special(w, RIC_CURVE_FOLD, k);
    assert_close(fold->p, k == 0 ? 1 : -1, 1e-14);
    assert_close(fold->u, 0, 1e-10);
    assert_close(fold->t_p, 0, 1e-10);
  }
  free(w);
}

static void a_walk_of_the_other_direction_sees_the_circle_backwards(void **state) {
  (void)state;
  const double u = 0.9;
  ric_curve_options options = defaults();
  options.direction = -2;
  walked *w = walk(&circle, &options, &u, 0.4, NULL);
  assert_true(w->points[0].t_p < 0 && w->points[1].p < 0.4);
  assert_int_equal(w->run.end, RIC_CURVE_CLOSED);
  assert_close(special(w, RIC_CURVE_FOLD, 0)->p, -1, 1e-14);
  free(w);
}

static void cubic_has_its_two_folds(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.p_low = -2;
  options.p_high = 2;
  const double u = -1.2;
  walked *w = walk(&cubic_curve, &options, &u, 0.6, NULL);
  double at = 1 / sqrt(3.0), p = at - at * at * at;
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  assert_int_equal(count_special(w, RIC_CURVE_FOLD), 0); /* to the right there is none */
  free(w);
  options.direction = -1;
  w = walk(&cubic_curve, &options, &u, 0.6, NULL);
  assert_int_equal(w->run.special, 2);
  assert_close(special(w, RIC_CURVE_FOLD, 0)->u, -at, 1e-10);
  assert_close(special(w, RIC_CURVE_FOLD, 0)->p, -p, 1e-14);
  assert_close(special(w, RIC_CURVE_FOLD, 1)->u, at, 1e-10);
  assert_close(special(w, RIC_CURVE_FOLD, 1)->p, p, 1e-14);
  assert_true(last(w)->p == -2);
  free(w);
}

static void bounds_are_landed_on_exactly(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.p_low = 0.1;
  options.p_high = 1.0 / 3;
  const double u = 0.97;
  for (int natural = 0; natural < 2; natural++)
    for (int direction = -1; direction < 2; direction += 2) {
      options.natural = natural;
      options.direction = direction;
      walked *w = walk(&circle, &options, &u, 0.2, NULL);
      double bound = direction > 0 ? options.p_high : options.p_low;
      assert_int_equal(w->run.end, RIC_CURVE_BOUND);
      assert_true(last(w)->p == bound);
      assert_close(last(w)->u, sqrt(1 - bound * bound), 1e-14);
      free(w);
    }
}

static void a_start_on_a_bound_ends_there_or_leaves_it(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.p_low = 0.5;
  const double u = 0.8;
  options.direction = -1;
  walked *w = walk(&circle, &options, &u, 0.5, NULL);
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  assert_true(w->count == 1 && w->run.points == 0);
  free(w);
  options.direction = 1;
  w = walk(&circle, &options, &u, 0.5, NULL); /* round the fold and back to the bound below */
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  assert_true(last(w)->p == 0.5);
  assert_close(last(w)->u, -sqrt(0.75), 1e-14);
  free(w);
}

static void natural_continuation_stops_at_a_fold_with_a_reason(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.natural = true;
  const double u = 0.9;
  walked *w = walk(&circle, &options, &u, 0.4, NULL);
  assert_int_equal(w->run.end, RIC_CURVE_NOT_CONVERGED);
  assert_true(strlen(w->run.reason) > 0);
  print_message("p = %.15g, %zu points: %s\n", last(w)->p, w->run.points, w->run.reason);
  assert_true(last(w)->p < 1);
  assert_close(last(w)->p, 1, 1e-6);
  free(w);
}

/* The largest p on the branch through symmetric solutions with the middle values m: the equations marched from the
 * middle outwards, their boundary value bisected for p, and p maximised over m by golden sections. */
static double boundary_value(size_t n, double m, double p) {
  double h2 = 1 / ((double)(n + 1) * (double)(n + 1)), inner = m, outer = m;
  for (size_t i = 0; i < n / 2; i++) {
    double next = 2 * outer - inner - h2 * p * exp(outer);
    inner = outer;
    outer = next;
  }
  return outer;
}

static double bratu_parameter(size_t n, double m) {
  double low = 0, high = 20;
  for (int k = 0; k < 100; k++) {
    double middle = (low + high) / 2;
    *(boundary_value(n, m, middle) > 0 ? &low : &high) = middle;
  }
  return low;
}

static double bratu_fold(size_t n) {
  const double part = (sqrt(5.0) - 1) / 2;
  double low = 0.5, high = 2.5;
  for (int k = 0; k < 60; k++) {
    double a = high - part * (high - low), b = low + part * (high - low);
    if (bratu_parameter(n, a) < bratu_parameter(n, b))
      low = a;
    else
      high = b;
  }
  return bratu_parameter(n, (low + high) / 2);
}

static void bratu_folds_where_its_largest_parameter_is(void **state) {
  (void)state;
  static const size_t sizes[] = {50, 200};
  for (size_t k = 0; k < 2; k++) {
    ric_curve_problem problem = bratu(sizes[k]);
    ric_curve_options options = defaults();
    options.p_low = 0.5; /* far up the other branch the discrete problem has folds of its own */
    options.p_high = 10;
    options.step_most = 0.5;
    walked *w = walk(&problem, &options, NULL, 0.5, NULL);
    assert_int_equal(w->run.special, 1);
    double p = special(w, RIC_CURVE_FOLD, 0)->p, expected = bratu_fold(sizes[k]);
    print_message(
        "n = %zu: fold at %.12f, %.12f expected (limit 3.513830719); %zu points, %llu iterations, end %s %s\n",
        sizes[k], p, expected, w->run.points, w->run.iterations, ric_curve_end_name(w->run.end), w->run.reason);
    assert_close(p, expected, 1e-11);
    assert_true(last(w)->p == 0.5 && last(w)->t_p < 0);
    free(w);
  }
}

static void newtons_method_converges_quadratically(void **state) {
  (void)state;
  ric_curve *curve = made(&cubic_curve, NULL);
  double u = -1.2, root = -1.3247179572447460; /* of u^3 - u + 1 */
  int iterations;
  assert_int_equal(ric_curve_solve(curve, &u, 1, &iterations, NULL), RIC_OK);
  assert_close(u, root, 1e-15);
  assert_in_range(iterations, 3, 5);
  ric_curve_destroy(&curve);
  ric_curve_options options = defaults();
  options.newton_tol = 0.5; /* the first correction is below 0.5 (1 + |x|), made, and not counted */
  curve = made(&cubic_curve, &options);
  u = -1.2;
  for (int k = 0; k < 4; k++) {
    double before = fabs(u - root);
    assert_int_equal(ric_curve_solve(curve, &u, 1, &iterations, NULL), RIC_OK);
    assert_int_equal(iterations, 0);
    assert_true(fabs(u - root) < 1.2 * before * before + 1e-15); /* |F_uu / (2 F_u)|: 0.93 at the root */
  }
  ric_curve_destroy(&curve);
}

static void steps_grow_on_a_straight_curve_and_shrink_where_it_turns(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.p_low = -50;
  options.step_most = 5;
  options.direction = -1;
  const double u = 2;
  walked *w = walk(&cubic_curve, &options, &u, -6, NULL);
  double longest = 0;
  assert_true(w->points[1].step == options.step);
  for (size_t k = 1; k < w->count; k++)
    longest = fmax(longest, w->points[k].step);
  assert_true(longest > 1);
  free(w);
  options = defaults();
  options.step_most = 5;
  options.p_high = 3;
  options.turn = 0.2;
  w = walk(&cubic_curve, &options, &u, -6, NULL);
  for (size_t k = 1; k < w->count; k++) {
    const shown_point *a = &w->points[k - 1], *b = &w->points[k];
    assert_true(fabs(asin(a->t_p * b->t_u - a->t_u * b->t_p)) <= 0.2 * (1 + 1e-9));
  }
  assert_int_equal(w->run.special, 2);
  free(w);
}

static void a_bound_just_ahead_of_the_start_is_landed_on(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  const double u = 0.9;
  for (double ahead = 1e-15; ahead < 0.1; ahead *= 10) {
    options.p_high = 0.4 + ahead;
    walked *w = walk(&circle, &options, &u, 0.4, NULL);
    assert_int_equal(w->run.end, RIC_CURVE_BOUND);
    assert_true(last(w)->p == options.p_high);
    free(w);
  }
}

static void a_fold_just_before_a_bound_is_gone_round(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  const double u = 0.9;
  for (double behind = 1e-12; behind < 0.1; behind *= 10) {
    options.p_high = 1 + behind;
    walked *w = walk(&circle, &options, &u, 0.4, NULL);
    assert_int_equal(w->run.end, RIC_CURVE_CLOSED);
    assert_int_equal(w->run.special, 2);
    free(w);
    options.p_high = 1 - behind;
    w = walk(&circle, &options, &u, 0.4, NULL);
    if (w->run.end != RIC_CURVE_BOUND) /* a step goes over the fold and comes back within the range */
      assert_int_equal(w->run.end, RIC_CURVE_CLOSED);
    free(w);
  }
}

/* Equations that have no value below p = 0: neither at the start nor at a bound does p move by a bit. */
static ric_status half_line(const double *u, double p, double *F, double *J, double *F_p, void *user,
                            ric_error *error) {
  (void)user;
  if (p < 0)
    return ric_fail(error, RIC_ENUMERIC, "p = %g, expected >= 0", p);
  F[0] = u[0] - 3 * p;
  F[1] = u[1] + u[0] / 7 - p;
  J[0] = 1, J[1] = 0, J[2] = 1.0 / 7, J[3] = 1;
  F_p[0] = -3;
  F_p[1] = -1;
  return RIC_OK;
}

static void parameters_that_are_held_stay_exactly(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.p_low = 0;
  options.p_high = 1.0 / 3;
  const ric_curve_problem problem = {.unknowns = 2, .residual = half_line};
  for (double guess = -1; guess < 1; guess += 0.1) {
    double u[2] = {guess, guess / 3};
    walked *w = walk(&problem, &options, u, 0, NULL);
    assert_true(w->points[0].p == 0);
    assert_int_equal(w->run.end, RIC_CURVE_BOUND);
    assert_true(last(w)->p == options.p_high);
    free(w);
  }
}

static void a_start_at_a_fold_needs_a_tangent(void **state) {
  (void)state;
  ric_curve *curve = made(&circle, NULL);
  ric_curve_run run;
  ric_error error;
  double u = 0, along[2] = {3, 0};
  assert_int_equal(ric_curve_follow(curve, &u, 1, NULL, NULL, NULL, &run, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "singular"));
  assert_int_equal(ric_curve_follow(curve, &u, 1, along, NULL, NULL, &run, &error), RIC_OK);
  assert_int_equal(run.end, RIC_CURVE_CLOSED);
  assert_int_equal(run.special, 2); /* the start is one, told when the walk comes back */
  ric_curve_destroy(&curve);
}

/* Two waves 0.05 apart: long steps would end on the other. */
static ric_status two_waves(const double *u, double p, double *F, double *J, double *F_p, void *user,
                            ric_error *error) {
  (void)user, (void)error;
  double a = *u - sin(p), b = a - 0.05, c = -cos(p);
  F[0] = a * b;
  J[0] = a + b;
  F_p[0] = c * (a + b);
  return RIC_OK;
}

static void walks_stay_on_their_curve_beside_another(void **state) {
  (void)state;
  const ric_curve_problem problem = {.unknowns = 1, .residual = two_waves};
  ric_curve_options options = defaults();
  options.p_high = 20;
  options.step_most = 1;
  const double u = 1e-3;
  walked *w = walk(&problem, &options, &u, 0, NULL);
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  for (size_t k = 0; k < w->count; k++)
    assert_close(w->points[k].u, sin(w->points[k].p), 1e-11);
  free(w);
}

static void names_are_those_of_the_lists(void **state) {
  (void)state;
  assert_string_equal(ric_curve_end_name(RIC_CURVE_NOT_CONVERGED), "not_converged");
  assert_string_equal(ric_curve_end_name(RIC_CURVE_ENDS), "unknown end");
  assert_string_equal(ric_curve_point_name(RIC_CURVE_BRANCH_POINT), "branch_point");
  assert_string_equal(ric_curve_point_name(RIC_CURVE_POINT_KINDS), "unknown kind");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(circle_is_closed_and_has_its_length),
      cmocka_unit_test(folds_of_a_circle_are_at_one),
      cmocka_unit_test(a_walk_of_the_other_direction_sees_the_circle_backwards),
      cmocka_unit_test(cubic_has_its_two_folds),
      cmocka_unit_test(bounds_are_landed_on_exactly),
      cmocka_unit_test(a_start_on_a_bound_ends_there_or_leaves_it),
      cmocka_unit_test(natural_continuation_stops_at_a_fold_with_a_reason),
      cmocka_unit_test(bratu_folds_where_its_largest_parameter_is),
      cmocka_unit_test(newtons_method_converges_quadratically),
      cmocka_unit_test(steps_grow_on_a_straight_curve_and_shrink_where_it_turns),
      cmocka_unit_test(a_bound_just_ahead_of_the_start_is_landed_on),
      cmocka_unit_test(a_fold_just_before_a_bound_is_gone_round),
      cmocka_unit_test(parameters_that_are_held_stay_exactly),
      cmocka_unit_test(a_start_at_a_fold_needs_a_tangent),
      cmocka_unit_test(walks_stay_on_their_curve_beside_another),
      cmocka_unit_test(names_are_those_of_the_lists),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

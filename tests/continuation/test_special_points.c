/* Special points of curves, and switching at them. */
#include "support.h"

#include "curves.h"

static ric_curve_problem with_user(ric_curve_problem problem, const void *user) {
  problem.user = (void *)(uintptr_t)user;
  return problem;
}

/* The walk along the branch a = 0 of the crossing, with a step of its own. */
static walked *walk_crossing(const bool *fork, double p, double step, bool natural) {
  const ric_curve_problem problem = with_user(crossing, fork);
  ric_curve_options options = ric_curve_options_default();
  double u[3];
  options.p_high = 1;
  options.step = step;
  options.natural = natural;
  crossing_point(p, 0.4 * sin(p), u);
  return walk(&problem, &options, u, p, NULL);
}

static void branch_points_are_found_from_wherever_the_walk_comes(void **state) {
  (void)state;
  double worst = 0, worst_t = 0;
  for (int fork = 0; fork < 2; fork++)
    for (int k = 0; k < 40; k++) {
      double expected[4];
      const bool is_fork = fork;
      walked *w = walk_crossing(&is_fork, -0.5 + 0.013 * k, 0.01 + 0.002 * k, k % 2);
      assert_int_equal(w->run.special, 1);
      const shown_point *at = special(w, RIC_CURVE_BRANCH_POINT, 0);
      crossing_tangent(0.3, 0.4 * sin(0.3), 0.4 * cos(0.3), expected);
      worst = fmax(worst, fmax(fabs(at->p - 0.3), fabs(at->u - 0.4 * sin(0.3))));
      for (int i = 0; i < 4; i++)
        worst_t = fmax(worst_t, fabs(at->t[i] - expected[i]));
      free(w);
    }
  print_message("branch points off by %.3g, tangents by %.3g\n", worst, worst_t);
  assert_true(worst < 1e-10);
  assert_true(worst_t < 1e-8);
}

static void branch_points_exactly_on_a_step_are_found_once(void **state) {
  (void)state;
  ric_curve_options options = ric_curve_options_default();
  options.p_high = 1;
  options.step = options.step_most = 0.125;
  walked *w = walk(&pitchfork, &options, NULL, -1, NULL); /* meets p = 0 exactly */
  assert_int_equal(w->run.special, 1);
  assert_close(special(w, RIC_CURVE_BRANCH_POINT, 0)->p, 0, 1e-12);
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  free(w);
}

static void a_transcritical_branch_point_gives_the_other_tangent(void **state) {
  (void)state;
  const bool fork = false;
  const ric_curve_problem problem = with_user(crossing, &fork);
  walked *w = walk_crossing(&fork, -0.2, 0.03, false);
  const shown_point *at = special(w, RIC_CURVE_BRANCH_POINT, 0);
  ric_curve *curve = made(&problem, NULL);
  double other[4], expected[4], back[4], p = 0.3;
  assert_int_equal(ric_curve_switch(curve, at->x, at->p, at->t, other, NULL), RIC_OK);
  crossing_tangent(p, 0.4 * sin(p), 0.4 * cos(p) + 1, expected);
  assert_int_equal(ric_curve_switch(curve, at->x, at->p, other, back, NULL), RIC_OK);
  for (int i = 0; i < 4; i++) {
    assert_close(other[i] * (other[3] > 0 ? 1 : -1), expected[i], 1e-8);
    assert_close(back[i] * (back[3] > 0 ? 1 : -1), at->t[i], 1e-8);
  }
  ric_curve_destroy(&curve);
  for (int sign = -1; sign < 2; sign += 2) { /* both halves of the other branch */
    ric_curve_options options = ric_curve_options_default();
    double along[4];
    options.p_low = -0.5;
    options.p_high = 1;
    for (int i = 0; i < 4; i++)
      along[i] = sign * expected[i];
    walked *half = walk(&problem, &options, at->x, at->p, along);
    assert_int_equal(half->run.end, RIC_CURVE_BOUND);
    assert_int_equal(half->run.special, 0);
    assert_true(last(half)->p == (sign > 0 ? 1 : -0.5));
    for (size_t k = 1; k < half->count; k++)
      assert_close(half->points[k].u, 0.4 * sin(half->points[k].p) + half->points[k].p - 0.3, 1e-10);
    free(half);
  }
  free(w);
}

static void a_pitchfork_branches_at_right_angles(void **state) {
  (void)state;
  ric_curve *curve = made(&pitchfork, NULL);
  const double u = 0, trivial[2] = {0, 1}, bent[2] = {1, 0};
  double other[2];
  assert_int_equal(ric_curve_switch(curve, &u, 0, trivial, other, NULL), RIC_OK);
  assert_close(fabs(other[0]), 1, 1e-15);
  assert_close(other[1], 0, 1e-15);
  assert_int_equal(ric_curve_switch(curve, &u, 0, bent, other, NULL), RIC_OK);
  assert_close(other[0], 0, 1e-10);
  assert_close(fabs(other[1]), 1, 1e-15);
  ric_curve_destroy(&curve);
  ric_curve_options options = ric_curve_options_default();
  options.p_high = 1;
  walked *w = walk(&pitchfork, &options, &u, 0, bent);
  assert_int_equal(w->run.special, 0);
  assert_close(last(w)->u, 1, 1e-14);
  free(w);
}

/* The tangent of another branch, scaled to its part in p, at a branch point seen by the walk. */
typedef struct seen_branch {
  ric_curve *curve;
  double rate; /* of u_0 */
} seen_branch;

static int switch_there(const ric_curve_point *point, void *user) {
  seen_branch *seen = user;
  double t[400], other[400];
  if (point->kind != RIC_CURVE_BRANCH_POINT)
    return 0;
  assert_close(point->p, 0.3, 1e-9);
  memcpy(t, point->t_u, 399 * sizeof *t);
  t[399] = point->t_p;
  assert_int_equal(ric_curve_switch(seen->curve, point->u, point->p, t, other, NULL), RIC_OK);
  seen->rate = other[0] / other[399];
  return 1;
}

static void branch_points_of_many_unknowns_are_found_and_left(void **state) {
  (void)state;
  const wide_user user = {.unknowns = 399};
  const ric_curve_problem problem = wide_crossing(&user);
  double u[399], expected = 0.4 * cos(0.3) + 1;
  seen_branch seen = {.curve = made(&problem, NULL)};
  ric_curve_run run;
  wide_point(&user, 0.15, 0.4 * sin(0.15), u);
  assert_int_equal(ric_curve_follow(seen.curve, u, 0.15, NULL, switch_there, &seen, &run, NULL), RIC_OK);
  assert_int_equal(run.end, RIC_CURVE_ENDED);
  assert_close(seen.rate, expected, 1e-6);
  ric_curve_destroy(&seen.curve);
}

/* Both factorisations, by QR and by LU, and sizes on both sides of where one is taken for the other. */
static void branch_points_are_found_whatever_the_size(void **state) {
  (void)state;
  static const size_t sizes[] = {2, 12, 30, 31, 45, 70};
  double worst = 0;
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
    for (int fork = 0; fork < 2; fork++)
      for (int start = 0; start < 6; start++) {
        const wide_user user = {.is_fork = fork, .unknowns = sizes[k]};
        const ric_curve_problem problem = wide_crossing(&user);
        ric_curve_options options = ric_curve_options_default();
        double u[70], p = -0.2 + 0.017 * start;
        options.p_high = 0.6;
        options.step = 0.01 + 0.01 * start;
        options.natural = start % 2;
        wide_point(&user, p, 0.4 * sin(p), u);
        walked *w = walk(&problem, &options, u, p, NULL);
        assert_int_equal(w->run.special, 1);
        assert_int_equal(w->run.missed, 0);
        assert_int_equal(w->run.end, RIC_CURVE_BOUND);
        const shown_point *at = special(w, RIC_CURVE_BRANCH_POINT, 0);
        worst = fmax(worst, fmax(fabs(at->p - 0.3), fabs(at->u - 0.4 * sin(0.3))));
        free(w);
      }
  print_message("branch points off by %.3g\n", worst);
  assert_true(worst < 2e-10);
}

/* Where a point of the walk is just before or behind the branch point, it ends the bracket from which that is located.
 */
static void tangents_at_branch_points_are_good_wherever_steps_end(void **state) {
  (void)state;
  double worst = 0, expected[4];
  crossing_tangent(0.3, 0.4 * sin(0.3), 0.4 * cos(0.3), expected);
  for (int k = 0; k < 400; k++) {
    const bool fork = false;
    walked *w = walk_crossing(&fork, -0.5 + 0.0013 * k, 0.01 + 0.0002 * k, false);
    for (int i = 0; i < 4; i++)
      worst = fmax(worst, fabs(special(w, RIC_CURVE_BRANCH_POINT, 0)->t[i] - expected[i]));
    free(w);
  }
  print_message("tangents off by %.3g\n", worst);
  assert_true(worst < 1e-10);
}

/* The bent branch passes a fold and a branch point at one place, where Newton's method has no hold. */
static void a_fold_and_a_branch_point_at_one_place_are_both_told(void **state) {
  (void)state;
  const bool fork = true;
  const ric_curve_problem problem = with_user(crossing, &fork);
  double worst = 0;
  for (int k = 0; k < 40; k++) {
    ric_curve_options options = ric_curve_options_default();
    double p = 0.7 + 0.011 * k, u[3];
    options.direction = -1;
    options.step = 0.02 + 0.002 * k;
    options.p_high = 1.5;
    crossing_point(p, 0.4 * sin(p) + sqrt(p - 0.3), u);
    walked *w = walk(&problem, &options, u, p, NULL);
    assert_int_equal(count_special(w, RIC_CURVE_FOLD), 1);
    assert_int_equal(count_special(w, RIC_CURVE_BRANCH_POINT), 1);
    assert_int_equal(w->run.missed, 0);
    assert_int_equal(w->run.end, RIC_CURVE_BOUND);
    for (int kind = RIC_CURVE_FOLD; kind <= RIC_CURVE_BRANCH_POINT; kind++) {
      const shown_point *at = special(w, (ric_curve_point_kind)kind, 0);
      worst = fmax(worst, fmax(fabs(at->p - 0.3), fabs(at->u - 0.4 * sin(0.3))));
    }
    assert_close(last(w)->u, 0.4 * sin(1.5) - sqrt(1.2), 1e-11);
    free(w);
  }
  print_message("fold and branch point off by %.3g\n", worst);
  assert_true(worst < 1e-9);
}

static void switching_elsewhere_is_refused(void **state) {
  (void)state;
  const bool fork = false;
  const ric_curve_problem problem = with_user(crossing, &fork);
  ric_curve *curve = made(&problem, NULL);
  ric_error error;
  double u[3], t[4], none[4] = {0}, other[4];
  crossing_point(0.6, 0.4 * sin(0.6), u);
  crossing_tangent(0.6, 0.4 * sin(0.6), 0.4 * cos(0.6), t);
  assert_int_equal(ric_curve_switch(curve, u, 0.6, t, other, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "no simple branch point"));
  assert_int_equal(ric_curve_switch(curve, u, 0.6, none, other, &error), RIC_EINVAL);
  ric_curve_destroy(&curve);
}

/* Where branches touch, u (u - p^2) = 0, no other tangent exists. */
static ric_status touching(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error) {
  (void)user, (void)error;
  F[0] = *u * (*u - p * p);
  J[0] = 2 * *u - p * p;
  F_p[0] = -2 * p * *u;
  return RIC_OK;
}

static void branches_that_touch_are_no_simple_branch_point(void **state) {
  (void)state;
  const ric_curve_problem problem = {.unknowns = 1, .residual = touching};
  ric_curve *curve = made(&problem, NULL);
  ric_error error;
  const double u = 0, t[2] = {0, 1};
  double other[2];
  assert_int_equal(ric_curve_switch(curve, &u, 0, t, other, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "tangent"));
  ric_curve_destroy(&curve);
}

typedef struct test_case {
  size_t count;
  double (*value[3])(double u, double p);
  ric_status trouble; /* returned for p > 0.5 */
  size_t calls;
} test_case;

static ric_status evaluate(const double *u, double p, const double *t_u, double t_p, double *values, void *user,
                           ric_error *error) {
  test_case *test = user;
  (void)error;
  assert_close(*t_u * *t_u + t_p * t_p, 1, 1e-12);
  test->calls++;
  for (size_t k = 0; k < test->count; k++)
    values[k] = test->value[k](*u, p);
  return p > 0.5 ? test->trouble : RIC_OK;
}

static walked *walk_tested(test_case *test, double step) {
  ric_curve_problem problem = circle;
  ric_curve_options options = ric_curve_options_default();
  problem.tests = test->count;
  problem.test = evaluate;
  problem.user = test;
  options.p_low = -0.9;
  options.step = step;
  const double u = 0.6;
  return walk(&problem, &options, &u, -0.8, NULL);
}

static double diagonal(double u, double p) {
  return 1e-6 * (u - p);
}

static double third_of_p(double u, double p) {
  (void)u;
  return p - 1.0 / 3;
}

static double cube(double u, double p) {
  return (u + p) * (u + p) * (u + p);
}

static void roots_of_tests_are_found_in_their_order(void **state) {
  (void)state;
  test_case test = {.count = 3, .value = {diagonal, third_of_p, cube}};
  static const size_t which[] = {2, 1, 0, 2, 1, 0};
  const double third = 1.0 / 3, half = sqrt(0.5), side = sqrt(8.0 / 9);
  const double places[][2] = {{half, -half}, {side, third},  {half, half},
                              {-half, half}, {-side, third}, {-half, -half}};
  walked *w = walk_tested(&test, 0.01);
  double before = -1;
  assert_int_equal(w->run.special, 7); /* and the fold */
  for (size_t k = 0; k < w->count; k++) {
    assert_true(w->points[k].arclength > before);
    before = w->points[k].arclength;
  }
  for (size_t k = 0; k < 6; k++) {
    const shown_point *at = special(w, RIC_CURVE_TEST, k);
    assert_int_equal(at->which, which[k]);
    double tol = which[k] == 2 ? 1e-4 : 1e-10; /* a triple root is flat */
    assert_close(at->u, places[k][0], tol);
    assert_close(at->p, places[k][1], tol);
    assert_close(hypot(at->u, at->p), 1, 1e-14); /* on the curve */
  }
  assert_close(special(w, RIC_CURVE_FOLD, 0)->p, 1, 1e-14);
  free(w);
}

static double right_of_a_third(double u, double p) {
  return p < 0.1 ? -1 : p < 0.2 ? NAN : u + 1;
}

static double step_function(double u, double p) {
  (void)u;
  return p < 0.1234 ? -1 : 1;
}

static double pole(double u, double p) {
  (void)u;
  return 1 / (p - 0.1234);
}

static void no_sign_change_is_seen_across_nan(void **state) {
  (void)state;
  test_case test = {.count = 1, .value = {right_of_a_third}};
  walked *w = walk_tested(&test, 0.01);
  assert_int_equal(count_special(w, RIC_CURVE_TEST), 0);
  assert_int_equal(w->run.missed, 0);
  free(w);
}

static void jumps_and_poles_are_missed_not_told(void **state) {
  (void)state;
  test_case test = {.count = 2, .value = {step_function, pole}};
  walked *w = walk_tested(&test, 0.01);
  assert_int_equal(count_special(w, RIC_CURVE_TEST), 0);
  assert_int_equal(w->run.missed, 4); /* each on the way to the fold and back */
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  free(w);
}

static void tests_without_value_shorten_steps_and_other_errors_end_the_walk(void **state) {
  (void)state;
  test_case test = {.count = 1, .value = {third_of_p}, .trouble = RIC_ENUMERIC};
  walked *w = walk_tested(&test, 0.01);
  assert_int_equal(w->run.end, RIC_CURVE_NOT_CONVERGED);
  assert_non_null(strstr(w->run.reason, "no test functions at p = 0.5"));
  assert_close(last(w)->p, 0.5, 1e-7);
  assert_int_equal(w->run.special, 1);
  free(w);
  test.trouble = RIC_ECALLBACK;
  ric_curve_problem problem = circle;
  problem.tests = 1;
  problem.test = evaluate;
  problem.user = &test;
  ric_curve *curve = made(&problem, NULL);
  ric_curve_run run;
  ric_error error;
  double u = 0.6;
  assert_int_equal(ric_curve_follow(curve, &u, -0.8, NULL, NULL, NULL, &run, &error), RIC_ECALLBACK);
  assert_non_null(strstr(error.message, "no test functions"));
  ric_curve_destroy(&curve);
}

/* Switches and solves from within the callback. */
typedef struct within {
  ric_curve *curve;
  int switched;
} within;

static int switch_within(const ric_curve_point *point, void *user) {
  within *w = user;
  double t[4] = {point->t_u[0], point->t_u[1], point->t_u[2], point->t_p}, other[4], u[3];
  crossing_point(0.9, 0.4 * sin(0.9), u);
  assert_int_equal(ric_curve_solve(w->curve, u, 0.91, NULL, NULL), RIC_OK);
  if (point->kind == RIC_CURVE_BRANCH_POINT)
    w->switched += ric_curve_switch(w->curve, point->u, point->p, t, other, NULL) == RIC_OK;
  return 0;
}

static void switching_within_the_callback_leaves_the_walk_alone(void **state) {
  (void)state;
  const bool fork = false;
  const ric_curve_problem problem = with_user(crossing, &fork);
  ric_curve_options options = ric_curve_options_default();
  options.p_high = 1;
  options.step = 0.03;
  within w = {.curve = made(&problem, &options)};
  ric_curve_run run;
  double u[3];
  walked *alone = walk_crossing(&fork, -0.2, 0.03, false);
  crossing_point(-0.2, 0.4 * sin(-0.2), u);
  assert_int_equal(ric_curve_follow(w.curve, u, -0.2, NULL, switch_within, &w, &run, NULL), RIC_OK);
  assert_int_equal(w.switched, 1);
  assert_int_equal(run.points, alone->run.points);
  assert_int_equal(run.end, RIC_CURVE_BOUND);
  ric_curve_destroy(&w.curve);
  free(alone);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(branch_points_are_found_from_wherever_the_walk_comes),
      cmocka_unit_test(branch_points_exactly_on_a_step_are_found_once),
      cmocka_unit_test(a_transcritical_branch_point_gives_the_other_tangent),
      cmocka_unit_test(a_pitchfork_branches_at_right_angles),
      cmocka_unit_test(branch_points_of_many_unknowns_are_found_and_left),
      cmocka_unit_test(branch_points_are_found_whatever_the_size),
      cmocka_unit_test(tangents_at_branch_points_are_good_wherever_steps_end),
      cmocka_unit_test(a_fold_and_a_branch_point_at_one_place_are_both_told),
      cmocka_unit_test(switching_elsewhere_is_refused),
      cmocka_unit_test(branches_that_touch_are_no_simple_branch_point),
      cmocka_unit_test(roots_of_tests_are_found_in_their_order),
      cmocka_unit_test(no_sign_change_is_seen_across_nan),
      cmocka_unit_test(jumps_and_poles_are_missed_not_told),
      cmocka_unit_test(tests_without_value_shorten_steps_and_other_errors_end_the_walk),
      cmocka_unit_test(switching_within_the_callback_leaves_the_walk_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

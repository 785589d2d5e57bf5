/* What walks cost: evaluations, corrections, points. */
#include "support.h"

#include "curves.h"
#include "scenario/smooth_curve.h"

static const double tolerances[] = {1e-12, 1e-10};

static void a_point_of_a_smooth_curve_takes_two_evaluations(void **state) {
  (void)state;
  for (int natural = 0; natural < 2; natural++)
    for (size_t k = 0; k < 2; k++) {
      size_t calls = 0;
      const ric_curve_problem problem = smooth_wave(&calls);
      ric_curve_options options = ric_curve_options_default();
      options.points = 200;
      options.natural = natural;
      options.newton_tol = tolerances[k];
      walked *w = walk(&problem, &options, NULL, 0, NULL);
      assert_int_equal(w->run.points, 200);
      assert_int_equal(w->run.jacobians, calls);
      print_message("natural %d, tol %g: %.3f evaluations, %.3f corrections per point\n", natural, tolerances[k],
                    (double)calls / 200, (double)w->run.iterations / 200);
      assert_true(calls <= 440);
      for (size_t i = 0; i < w->count; i++)
        assert_close(w->points[i].u, sin(w->points[i].p), 2 * tolerances[k]);
      free(w);
    }
}

/* With p = p_high as the last point; folds are counted out, about 20 evaluations each. */
static walked *walk_duffing(const duffing *d, double step_most, double tol) {
  ric_curve_problem problem = duffing_response;
  problem.user = (void *)(uintptr_t)d;
  ric_curve_options options = ric_curve_options_default();
  options.p_low = 0.2;
  options.p_high = 3;
  options.step_most = step_most;
  options.newton_tol = tol;
  walked *w = walk(&problem, &options, NULL, 0.2, NULL);
  assert_int_equal(w->run.end, RIC_CURVE_BOUND);
  assert_int_equal(w->run.special, 2);
  assert_int_equal(count_special(w, RIC_CURVE_FOLD), 2);
  for (size_t i = 0; i < w->count; i++)
    assert_close(duffing_force(d, w->points[i].x, w->points[i].p), d->force, 100 * tol);
  return w;
}

static void a_response_curve_takes_few_evaluations(void **state) {
  (void)state;
  const duffing d = {.damping = 0.02, .force = 0.3};
  for (size_t k = 0; k < 2; k++) {
    walked *w = walk_duffing(&d, 0.1, tolerances[k]);
    double each = ((double)w->run.jacobians - 40) / (double)w->run.points;
    print_message("tol %g: %zu points, %llu evaluations\n", tolerances[k], w->run.points, w->run.jacobians);
    assert_true(each < 2.5);
    free(w);
  }
}

static void long_steps_make_a_curve_cheaper(void **state) {
  (void)state;
  const duffing d = {.damping = 0.02, .force = 0.3};
  for (size_t k = 0; k < 2; k++) {
    walked *w = walk_duffing(&d, 1, tolerances[k]), *shorter = walk_duffing(&d, 0.05, tolerances[k]);
    print_message("tol %g: %zu points, %llu evaluations; short steps %zu, %llu\n", tolerances[k], w->run.points,
                  w->run.jacobians, shorter->run.points, shorter->run.jacobians);
    assert_true(w->run.points < 90);
    assert_true(w->run.jacobians < 240);
    assert_true(3 * w->run.jacobians < 2 * shorter->run.jacobians);
    free(w);
    free(shorter);
  }
}

static void corrections_that_only_confirm_are_not_counted(void **state) {
  (void)state;
  size_t calls = 0;
  const ric_curve_problem problem = smooth_wave(&calls);
  ric_curve *curve = made(&problem, NULL);
  double u[3] = {0};
  int iterations = -1;
  assert_int_equal(ric_curve_solve(curve, u, 0, &iterations, NULL), RIC_OK);
  assert_true(iterations == 0 && calls == 1);
  ric_curve_destroy(&curve);
}

/* u - 2 p = 0 */
static ric_status line(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error) {
  (void)user, (void)error;
  F[0] = u[0] - 2 * p;
  J[0] = 1;
  F_p[0] = -2;
  return RIC_OK;
}

static void a_linear_problem_takes_one_correction_and_a_straight_curve_none(void **state) {
  (void)state;
  const ric_curve_problem problem = {.unknowns = 1, .residual = line};
  ric_curve_options options = ric_curve_options_default();
  options.p_high = 7;
  ric_curve *curve = made(&problem, NULL);
  double u = 100;
  int iterations = -1;
  assert_int_equal(ric_curve_solve(curve, &u, 0.5, &iterations, NULL), RIC_OK);
  assert_int_equal(iterations, 1);
  assert_close(u, 1, 1e-13);
  ric_curve_destroy(&curve);
  walked *w = walk(&problem, &options, &u, 0, NULL);
  assert_int_equal(w->points[0].iterations, 1);
  assert_int_equal(w->run.iterations, 1);
  for (size_t i = 1; i < w->count; i++)
    assert_int_equal(w->points[i].iterations, 0);
  assert_true(w->run.jacobians <= w->run.points + 2);
  free(w);
}

/* The tangents of points that are accepted early. */
static void tangents_are_those_of_the_curve(void **state) {
  (void)state;
  ric_curve_options options = ric_curve_options_default();
  options.step_most = 1;
  const double u = 0.9;
  walked *w = walk(&circle, &options, &u, 0.4, NULL);
  for (size_t i = 0; i < w->count; i++) {
    assert_close(w->points[i].t_u, -w->points[i].p, 1e-9);
    assert_close(w->points[i].t_p, w->points[i].u, 1e-9);
  }
  free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_point_of_a_smooth_curve_takes_two_evaluations),
      cmocka_unit_test(a_response_curve_takes_few_evaluations),
      cmocka_unit_test(long_steps_make_a_curve_cheaper),
      cmocka_unit_test(corrections_that_only_confirm_are_not_counted),
      cmocka_unit_test(a_linear_problem_takes_one_correction_and_a_straight_curve_none),
      cmocka_unit_test(tangents_are_those_of_the_curve),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Callbacks that fail, stop or end a walk; starts, options and problems that cannot be. */
#include "support.h"

#include "curves.h"

static ric_curve_options defaults(void) {
  return ric_curve_options_default();
}

/* F = u - 2 p with troubles. */
typedef struct trouble {
  double from; /* in p */
  ric_status status;
  double F;
  const char *text;
  size_t calls;
} trouble;

static ric_status troubled(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error) {
  trouble *t = user;
  t->calls++;
  F[0] = p > t->from ? t->F : *u - 2 * p;
  J[0] = 1;
  F_p[0] = -2;
  if (p > t->from && t->status != RIC_OK)
    return t->text ? ric_fail(error, t->status, "%s", t->text) : t->status;
  return RIC_OK;
}

static void where_there_is_no_value_steps_shorten_and_the_walk_ends(void **state) {
  (void)state;
  static const trouble troubles[] = {{.from = 0.5, .status = RIC_ENUMERIC, .text = "too hot"},
                                     {.from = 0.5, .status = RIC_ENUMERIC},
                                     {.from = 0.5, .F = NAN},
                                     {.from = 0.5, .F = INFINITY}};
  static const char *reasons[] = {"too hot", "no residual at p = 0.5", "not finite", "not finite"};
  for (size_t k = 0; k < sizeof troubles / sizeof *troubles; k++) {
    trouble t = troubles[k];
    const ric_curve_problem problem = {.unknowns = 1, .residual = troubled, .user = &t};
    walked *w = walk(&problem, NULL, NULL, 0, NULL);
    assert_int_equal(w->run.end, RIC_CURVE_NOT_CONVERGED);
    assert_non_null(strstr(w->run.reason, reasons[k]));
    assert_true(last(w)->p <= 0.5);
    assert_close(last(w)->p, 0.5, 1e-7);
    assert_int_equal(w->run.jacobians, t.calls);
    free(w);
  }
}

static void nothing_is_asked_beyond_the_bounds_of_a_straight_curve(void **state) {
  (void)state;
  trouble t = {.from = 0.5, .status = RIC_ECALLBACK};
  const ric_curve_problem problem = {.unknowns = 1, .residual = troubled, .user = &t};
  ric_curve_options options = defaults();
  options.p_high = 0.5;
  for (int natural = 0; natural < 2; natural++) {
    options.natural = natural;
    walked *w = walk(&problem, &options, NULL, 0, NULL);
    assert_int_equal(w->run.end, RIC_CURVE_BOUND);
    assert_true(last(w)->p == 0.5);
    free(w);
  }
}

static void other_errors_of_callbacks_are_handed_on(void **state) {
  (void)state;
  static const ric_status statuses[] = {RIC_ECALLBACK, RIC_ENOMEM, RIC_EINVAL, RIC_ESTOPPED};
  for (size_t k = 0; k < 4; k++) {
    trouble t = {.from = 0.5, .status = statuses[k], .text = k % 2 ? "of mine" : NULL};
    const ric_curve_problem problem = {.unknowns = 1, .residual = troubled, .user = &t};
    ric_curve *curve = made(&problem, NULL);
    ric_curve_run run;
    ric_error error = {0};
    double u = 0;
    assert_int_equal(ric_curve_follow(curve, &u, 0, NULL, NULL, NULL, &run, &error), statuses[k]);
    assert_int_equal(error.status, statuses[k]);
    assert_non_null(strstr(error.message, t.text ? t.text : "no residual at p ="));
    assert_int_equal(ric_curve_follow(curve, &u, 0, NULL, NULL, NULL, &run, NULL), statuses[k]);
    assert_int_equal(ric_curve_solve(curve, &u, 1, NULL, &error), statuses[k]);
    ric_curve_destroy(&curve);
  }
}

static int countdown(void *user) {
  return --*(int *)user <= 0;
}

static void poll_stops_at_every_call_and_the_curve_can_be_followed_again(void **state) {
  (void)state;
  for (int calls = 1; calls < 60; calls++) {
    int left = calls;
    ric_curve_options options = defaults();
    options.poll = (ric_poll){countdown, &left};
    ric_curve *curve = made(&circle, &options);
    ric_curve_run run;
    ric_error error;
    double u = 0.9;
    assert_int_equal(ric_curve_follow(curve, &u, 0.4, NULL, NULL, NULL, &run, &error), RIC_ESTOPPED);
    assert_int_equal(left, 0);
    assert_non_null(strstr(error.message, "stopped"));
    left = 100000;
    u = 0.9;
    assert_int_equal(ric_curve_follow(curve, &u, 0.4, NULL, NULL, NULL, &run, &error), RIC_OK);
    assert_int_equal(run.end, RIC_CURVE_CLOSED);
    ric_curve_destroy(&curve);
  }
}

static int third(const ric_curve_point *point, void *user) {
  (void)point;
  return ++*(int *)user == 3;
}

static void walks_end_when_asked_and_after_their_points(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.points = 7;
  ric_curve *curve = made(&circle, &options);
  ric_curve_run run;
  double u = 0.9;
  int seen = 0;
  assert_int_equal(ric_curve_follow(curve, &u, 0.4, NULL, third, &seen, &run, NULL), RIC_OK);
  assert_int_equal(run.end, RIC_CURVE_ENDED);
  assert_int_equal(run.points, 2);
  assert_int_equal(seen, 3);
  assert_int_equal(ric_curve_follow(curve, &u, 0.4, NULL, NULL, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.end, RIC_CURVE_POINTS);
  assert_int_equal(run.points, 7);
  ric_curve_destroy(&curve);
}

static void starts_that_cannot_be_are_refused(void **state) {
  (void)state;
  ric_curve_options options = defaults();
  options.p_low = -5;
  ric_curve *curve = made(&circle, &options);
  ric_curve_run run;
  ric_error error;
  double u = 0.3, none[2] = {0, 0};
  assert_int_equal(ric_curve_follow(curve, &u, -6, NULL, NULL, NULL, &run, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "p = -6"));
  assert_int_equal(ric_curve_follow(curve, &u, NAN, NULL, NULL, NULL, &run, &error), RIC_EINVAL);
  assert_int_equal(ric_curve_follow(curve, &u, 0, none, NULL, NULL, &run, &error), RIC_EINVAL);
  assert_int_equal(ric_curve_follow(curve, &u, 2, NULL, NULL, NULL, &run, &error), RIC_ENUMERIC); /* off the circle */
  assert_non_null(strstr(error.message, "no convergence at p = 2: the last of 8 corrections is"));
  assert_true(u == 0.3);
  assert_int_equal(ric_curve_solve(curve, &u, 2, NULL, &error), RIC_ENUMERIC);
  assert_true(u == 0.3);
  ric_curve_destroy(&curve);
}

static void bad_options_are_named(void **state) {
  (void)state;
  static const struct {
    size_t offset;
    double value;
    const char *text;
  } bad[] = {
#define BAD(field, value, text) {offsetof(ric_curve_options, field), value, text}
      BAD(p_low, INFINITY, "p_low = inf"),
      BAD(p_low, NAN, "p_low = nan"),
      BAD(step, 0, "step = 0"),
      BAD(step, NAN, "step = nan"),
      BAD(step_least, 0, "step_least = 0"),
      BAD(step_most, 0.001, "step_most = 0.001"),
      BAD(step_most, INFINITY, "step_most = inf"),
      BAD(direction, 0, "direction = 0"),
      BAD(newton_tol, 0, "newton_tol = 0"),
      BAD(turn, 2, "turn = 2"),
      BAD(locate_tol, -1, "locate_tol = -1"),
#undef BAD
  };
  ric_curve *curve = NULL;
  ric_error error;
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    ric_curve_options options = defaults();
    memcpy((char *)&options + bad[k].offset, &bad[k].value, sizeof bad[k].value);
    assert_int_equal(ric_curve_create(&circle, &options, &curve, &error), RIC_EINVAL);
    if (!strstr(error.message, bad[k].text))
      fail_msg("%s", error.message);
    assert_null(curve);
  }
  ric_curve_options options = defaults();
  options.iterations = 0;
  assert_int_equal(ric_curve_create(&circle, &options, &curve, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "iterations = 0"));
  options = defaults();
  options.points = 0;
  assert_int_equal(ric_curve_create(&circle, &options, &curve, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "points = 0"));
  ric_curve_destroy(&curve);
}

static void bad_problems_are_named(void **state) {
  (void)state;
  ric_curve *curve = NULL;
  ric_error error;
  ric_curve_problem problem = circle;
  problem.unknowns = 0;
  assert_int_equal(ric_curve_create(&problem, NULL, &curve, &error), RIC_EINVAL);
  problem = circle;
  problem.residual = NULL;
  assert_int_equal(ric_curve_create(&problem, NULL, &curve, &error), RIC_EINVAL);
  problem = circle;
  problem.tests = 2;
  assert_int_equal(ric_curve_create(&problem, NULL, &curve, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "tests = 2"));
  problem = circle;
  problem.unknowns = SIZE_MAX / 2;
  assert_int_equal(ric_curve_create(&problem, NULL, &curve, &error), RIC_ENOMEM);
  assert_null(curve);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(where_there_is_no_value_steps_shorten_and_the_walk_ends),
      cmocka_unit_test(nothing_is_asked_beyond_the_bounds_of_a_straight_curve),
      cmocka_unit_test(other_errors_of_callbacks_are_handed_on),
      cmocka_unit_test(poll_stops_at_every_call_and_the_curve_can_be_followed_again),
      cmocka_unit_test(walks_end_when_asked_and_after_their_points),
      cmocka_unit_test(starts_that_cannot_be_are_refused),
      cmocka_unit_test(bad_options_are_named),
      cmocka_unit_test(bad_problems_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

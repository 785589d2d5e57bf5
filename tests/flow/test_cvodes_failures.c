/* The flow of CVODES where the motion ends: callbacks that fail, and states that blow up. */
#include "support.h"

#include <ricochet/ricochet.h>

static ric_flow *flow_of(const ric_system *s, double tolerance) {
  ric_flow_options options = ric_flow_options_default();
  ric_flow *flow = NULL;
  options.tolerance = tolerance;
  assert_int_equal(ric_flow_create(s, &options, &flow, NULL), RIC_OK);
  return flow;
}

static int square(double t, const double *x, double *rate, void *user) {
  (void)t, (void)user;
  rate[0] = x[0] * x[0];
  return 0;
}

/* Steps until one fails; what it says. */
static ric_error move_until_failure(ric_flow *flow, double end) {
  ric_error error = {0};
  while (ric_flow_time(flow) != end && ric_flow_step(flow, end, &error) == RIC_OK)
    ric_flow_accept(flow, 1);
  return error;
}

/* x' = x^2 along 1 / (1 - t), infinite at t = 1, from several times before. */
static void blow_up_ends_in_a_failure_at_its_time(void **state) {
  (void)state;
  const ric_first_order model = {.states = 1, .rate = square};
  ric_system *s = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &s, NULL), RIC_OK);
  for (double tolerance = 1e-4; tolerance > 1e-14; tolerance /= 100) {
    ric_flow *flow = flow_of(s, tolerance);
    for (double start = -4; start <= 0; start += 1) {
      const double x = 1 / (1 - start);
      assert_int_equal(ric_flow_start(flow, start, &x, NULL, NULL), RIC_OK);
      ric_error error = move_until_failure(flow, 3);
      assert_int_equal(error.status, RIC_ENUMERIC);
      assert_non_null(strstr(error.message, "blows up"));
      assert_close(ric_flow_time(flow), 1, 1e3 * tolerance);
      assert_true(isfinite(*ric_flow_q(flow)));
    }
    ric_flow_destroy(&flow);
  }
  ric_system_destroy(&s);
}

typedef struct limit {
  double time;
  int code;
} limit;

static int force_up_to(double t, const double *q, const double *u, double *f, void *user) {
  const limit *l = user;
  (void)u;
  f[0] = t > l->time && l->code == 0 ? NAN : -q[0];
  return t > l->time ? l->code : 0;
}

static void failing_callbacks_leave_time_and_state(void **state) {
  (void)state;
  limit l = {.time = 1};
  const ric_mechanical model = {.coordinates = 1, .speeds = 1, .force = force_up_to, .user = &l};
  const double q = 1, u = 0;
  ric_system *s = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &s, NULL), RIC_OK);
  ric_flow *flow = flow_of(s, 1e-10);
  for (l.code = 0; l.code < 2; l.code++) {
    l.time = 1;
    assert_int_equal(ric_flow_start(flow, 0, &q, &u, NULL), RIC_OK);
    ric_error error = move_until_failure(flow, 3);
    assert_int_equal(error.status, RIC_ECALLBACK);
    assert_non_null(strstr(error.message, l.code ? "the force callback failed" : "the force callback gave a value"));
    assert_in_range((int)(1e6 * ric_flow_time(flow)), 1, 1000000);
    assert_close(*ric_flow_q(flow), cos(ric_flow_time(flow)), 1e-8);
    l.time = INFINITY; /* whoever puts things right may go on */
    assert_int_equal(move_until_failure(flow, 3).status, RIC_OK);
    assert_close(*ric_flow_q(flow), cos(3), 1e-8);
  }
  ric_flow_destroy(&flow);
  ric_system_destroy(&s);
}

static void options_are_checked(void **state) {
  (void)state;
  const ric_first_order model = {.states = 1, .rate = square};
  ric_system *s = NULL;
  ric_flow *flow = NULL;
  ric_error error;
  assert_int_equal(ric_system_create_first_order(&model, &s, NULL), RIC_OK);
  ric_flow_options options = ric_flow_options_default();
  options.method = RIC_FLOW_TAYLOR;
  assert_int_equal(ric_flow_create(s, &options, &flow, &error), RIC_EINVAL);
  options.method = RIC_FLOW_CVODES;
  options.tolerance = 1e-15;
  assert_int_equal(ric_flow_create(s, &options, &flow, &error), RIC_EINVAL);
  options.tolerance = 1e-8;
  options.longest_step = 0.01;
  assert_int_equal(ric_flow_create(s, &options, &flow, &error), RIC_OK);
  const double x = 0.01;
  assert_int_equal(ric_flow_start(flow, 0, &x, NULL, NULL), RIC_OK);
  while (ric_flow_time(flow) < 1) {
    assert_int_equal(ric_flow_step(flow, 1, NULL), RIC_OK);
    assert_true(ric_flow_piece(flow, 0).length <= 0.01 * (1 + 1e-12));
    ric_flow_accept(flow, 1);
  }
  ric_flow_destroy(&flow);
  ric_system_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blow_up_ends_in_a_failure_at_its_time),
      cmocka_unit_test(failing_callbacks_leave_time_and_state),
      cmocka_unit_test(options_are_checked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

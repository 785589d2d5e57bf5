/* Order of convergence of the Taylor flow, and what its tolerance means. */
#include "support.h"

#include "witness/system_flow.h"
#include "witness/random_lattice.h"

enum { N = 5 };
static const double end = 4;

static void state_of(unsigned seed, double *q, double *v) {
  random_source source = {.state = seed};
  random_lattice_state(&source, N, q, v);
}

/* A lattice that has everything. */
static const ric_lattice *everything(void) {
  static random_lattice r;
  random_source source = {.state = 72};
  random_lattice_set(&r, &source, N, RIC_ENDS_PERIODIC, WITH_ALL);
  return &r.lattice;
}

/* Euclidean distance from a run with the default options. */
static double distance(unsigned seed, const ric_flow_options *options) {
  double q[N], v[N], squares = 0;
  system_flow exact = system_flow_of_lattice(everything(), NULL, 0, NULL),
              m = system_flow_of_lattice(everything(), NULL, 0, options);
  state_of(seed, q, v);
  system_flow_start(&exact, 0, q, v);
  system_flow_start(&m, 0, q, v);
  system_flow_run(&exact, end, 0);
  system_flow_run(&m, end, 0);
  for (size_t i = 0; i < N; i++) {
    double in_q = ric_flow_q(m.flow)[i] - ric_flow_q(exact.flow)[i];
    double in_v = ric_flow_u(m.flow)[i] - ric_flow_u(exact.flow)[i];
    squares += in_q * in_q + in_v * in_v;
  }
  system_flow_clear(&exact);
  system_flow_clear(&m);
  return sqrt(squares);
}

/* Over several motions, so that chance cancellation in one of them does not count. */
static double error_of(const ric_flow_options *options) {
  double squares = 0;
  for (unsigned seed = 73; seed < 89; seed++) {
    double d = distance(seed, options);
    squares += d * d;
  }
  return sqrt(squares / 16);
}

/* Speeds are derivatives of segments of degree K, whose error in a step is of order K: one less over a run. */
static void halving_the_step_divides_the_error_by_two_to_the_order(void **state) {
  (void)state;
  for (int order = 4; order <= 10; order++) {
    ric_flow_options options = ric_flow_options_default();
    options.order = order;
    options.step = order < 7 ? 0.02 : order < 9 ? 0.05 : 0.1;
    double coarse = error_of(&options);
    options.step /= 2;
    double ratio = log2(coarse / error_of(&options));
    assert_close(ratio, order - 1, 0.15);
  }
}

static void every_fixed_step_has_its_length_and_the_last_the_rest(void **state) {
  (void)state;
  double q[N], v[N];
  ric_flow_options options = ric_flow_options_default();
  options.step = 0.3;
  system_flow m = system_flow_of_lattice(everything(), NULL, 0, &options);
  state_of(73, q, v);
  system_flow_start(&m, 0, q, v);
  for (int k = 1; k <= 4; k++) {
    assert_int_equal(ric_flow_step(m.flow, 1, NULL), RIC_OK);
    assert_close(ric_flow_piece(m.flow, 0).length, k < 4 ? 0.3 : 0.1, 1e-15);
    ric_flow_accept(m.flow, 1);
  }
  assert_close(ric_flow_time(m.flow), 1, 0);
  system_flow_run(&m, 4, 0);
  assert_int_equal(ric_flow_counted(m.flow).steps, 14);
  system_flow_clear(&m);
}

/* The local error is relative to the state; a few dozen steps on a motion that is not chaotic multiply it by less than
 * a hundred. */
static void errors_follow_the_tolerance(void **state) {
  (void)state;
  for (int digits = 3; digits <= 13; digits++) {
    ric_flow_options options = ric_flow_options_default();
    options.tolerance = pow(10, -digits);
    double error = error_of(&options);
    assert_true(error < 100 * options.tolerance);
    if (digits <= 10)
      assert_true(error > 1e-5 * options.tolerance); /* and no work is wasted on digits not asked for */
  }
}

static void a_given_order_takes_shorter_steps_for_the_same_tolerance(void **state) {
  (void)state;
  for (int order = 8; order <= 30; order += 2) {
    ric_flow_options options = ric_flow_options_default();
    options.order = order;
    options.tolerance = 1e-10;
    assert_true(error_of(&options) < 1e-8);
  }
}

static void longest_step_is_a_bound(void **state) {
  (void)state;
  ric_flow_options options = ric_flow_options_default();
  options.longest_step = 0.01;
  double q[N], v[N];
  system_flow m = system_flow_of_lattice(everything(), NULL, 0, &options);
  state_of(73, q, v);
  system_flow_start(&m, 0, q, v);
  system_flow_run(&m, 1, 0);
  assert_in_range(ric_flow_counted(m.flow).steps, 100, 101);
  system_flow_clear(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(halving_the_step_divides_the_error_by_two_to_the_order),
      cmocka_unit_test(every_fixed_step_has_its_length_and_the_last_the_rest),
      cmocka_unit_test(errors_follow_the_tolerance),
      cmocka_unit_test(a_given_order_takes_shorter_steps_for_the_same_tolerance),
      cmocka_unit_test(longest_step_is_a_bound),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Order and step of Taylor flows: functions of tolerance and decay alone. */
#include "support.h"

#include <float.h>

#include "flow/taylor_step.h"

static void order_grows_with_accuracy_within_its_bounds(void **state) {
  (void)state;
  assert_int_equal(taylor_order(1e-16), 24);
  assert_int_equal(taylor_order(1e-2), 4);
  assert_int_equal(taylor_order(1e-40), 30);
  for (double tolerance = 1e-3; tolerance > 1e-17; tolerance /= 2)
    assert_true(taylor_order(tolerance / 2) >= taylor_order(tolerance));
}

/* c_j = 1 / rho^j: at the step found, one of the last two terms has come down to tolerance times size. */
static void last_terms_meet_the_tolerance(void **state) {
  (void)state;
  for (int order = 4; order <= 30; order++)
    for (double rho = 1e-3; rho < 2; rho *= 3) {
      double tolerance = 1e-10;
      taylor_decay d = {.position = 1,
                        .rate = 1 / rho,
                        .bend = pow(rho, -2),
                        .before_last = pow(rho, 1 - order),
                        .last = pow(rho, -order),
                        .fraction = 1};
      double theta = taylor_step_factor(&d, order, tolerance, 1e3);
      double size = fmax(theta / rho, fmin(theta, 1));
      assert_close(d.before_last * pow(theta, order - 1) / (tolerance * size), 1, 0.05);
      assert_true(d.last * pow(theta, order) <= tolerance * size);
    }
}

static void a_motion_without_last_terms_takes_the_longest_step(void **state) {
  (void)state;
  assert_close(taylor_step_factor(&(taylor_decay){.position = 1, .fraction = 1}, 24, 1e-16, 4), 4, 0);
  assert_close(taylor_step_factor(&(taylor_decay){0}, 24, 1e-16, 4), 4, 0);
}

/* From rest at zero under a force sin(t), where c_0 to c_2 vanish. */
static void forced_motion_can_begin_at_rest(void **state) {
  (void)state;
  taylor_decay d = {.before_last = 1.0 / 6, .last = 0, .forcing = 1, .fraction = 1};
  double theta = taylor_step_factor(&d, 4, 1e-4, 4);
  assert_true(theta > 1e-3 && theta < 1);
}

static void steps_land_on_the_stop_without_a_sliver(void **state) {
  (void)state;
  for (int sign = -1; sign <= 1; sign += 2)
    for (double longest = 0.03; longest < 2; longest *= 1.1) {
      double remaining = sign * 1.0, shortest = INFINITY;
      while (remaining != 0) {
        double length = taylor_step_length(remaining, longest, false);
        assert_true(fabs(length) <= longest && length * sign > 0);
        shortest = fmin(shortest, fabs(length));
        remaining = length == remaining ? 0 : remaining - length;
      }
      assert_true(shortest >= 0.499 * fmin(longest, 1));
    }
}

static void fixed_steps_keep_their_length(void **state) {
  (void)state;
  double time = 0;
  int steps = 0;
  while (time != 10) {
    double length = taylor_step_length(10 - time, 0.1, true);
    assert_close(length, 0.1, 1e-6);
    time = length == 10 - time ? 10 : time + length;
    steps++;
  }
  assert_int_equal(steps, 100);
  assert_close(taylor_step_length(0.25, 0.1, true), 0.1, 0);
  assert_close(taylor_step_length(-0.05, 0.1, true), -0.05, 0);
}

static void steps_below_the_resolution_of_time_vanish(void **state) {
  (void)state;
  assert_true(taylor_step_vanishes(1, DBL_EPSILON));
  assert_true(taylor_step_vanishes(1, NAN));
  assert_true(taylor_step_vanishes(0, 0));
  assert_false(taylor_step_vanishes(0, 1e-30));
  assert_false(taylor_step_vanishes(-1000, -1e-10));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_grows_with_accuracy_within_its_bounds),
      cmocka_unit_test(last_terms_meet_the_tolerance),
      cmocka_unit_test(a_motion_without_last_terms_takes_the_longest_step),
      cmocka_unit_test(forced_motion_can_begin_at_rest),
      cmocka_unit_test(steps_land_on_the_stop_without_a_sliver),
      cmocka_unit_test(fixed_steps_keep_their_length),
      cmocka_unit_test(steps_below_the_resolution_of_time_vanish),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

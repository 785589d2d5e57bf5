/* Order and step of Taylor flows: functions of tolerance and decay alone. */
#include "support.h"

#include <float.h>

#include "flow/taylor_step.h"

static void order_grows_with_accuracy_within_its_bounds(void **state) {
  (void)state;
  assert_int_equal(taylor_order(1e-16), 26);
  assert_int_equal(taylor_order(1e-2), 11);
  assert_int_equal(taylor_order(1e3), 4);
  assert_int_equal(taylor_order(1e-40), 30);
  for (double tolerance = 1e-3; tolerance > 1e-17; tolerance /= 2)
    assert_true(taylor_order(tolerance / 2) >= taylor_order(tolerance));
}

/* The first term left out is a hundredth of the tolerance; an order from the tolerance reaches 2.2. */
static void linear_motions_reach_as_far_as_the_first_term_left_out_allows(void **state) {
  (void)state;
  for (double tolerance = 1e-3; tolerance > 1e-17; tolerance /= 7) {
    assert_close(taylor_reach(tolerance, taylor_order(tolerance)), 2.2, 1e-12);
    for (int order = 4; order < taylor_order(tolerance); order++) {
      double reach = taylor_reach(tolerance, order);
      assert_true(reach < 2.2);
      assert_close(pow(reach, order + 1) / tgamma(order + 2) / (0.01 * tolerance), 1, 1e-12);
    }
  }
}

/* Roots of s^2 + c s + k, complex and real. */
static void rate_bound_is_met_without_damping_and_without_springs(void **state) {
  (void)state;
  assert_close(taylor_rate_bound(4, 0), 2, 1e-15);
  assert_close(taylor_rate_bound(0, 3), 3, 1e-15);
  for (double c = 0; c < 10; c += 0.3)
    assert_true(taylor_rate_bound(1, c) >= (c > 2 ? c / 2 + sqrt(c * c / 4 - 1) : 1));
}

/* Of passive modes whose k and c lie anywhere between the bounds. */
static void passive_rate_bound_holds_and_is_met(void **state) {
  (void)state;
  for (double softest = 0; softest < 2; softest += 0.37)
    for (double damping = 0; damping < 8; damping += 0.41) {
      double bound = taylor_passive_rate_bound(2, softest, damping), most = 0;
      for (int i = 0; i <= 20; i++)
        for (int j = 0; j <= 20; j++) {
          double k = softest + (2 - softest) * i / 20, c = damping * j / 20, root = c * c / 4 - k;
          most = fmax(most, root < 0 ? sqrt(k) : c / 2 + sqrt(root));
        }
      assert_true(bound <= taylor_rate_bound(2, damping) + 1e-14);
      assert_true(most <= bound + 1e-14);
      if (damping * damping / 4 > softest || damping * damping < 8)
        assert_close(most, bound, 1e-13);
    }
}

/* c_j = 1 / rho^j: at the step found, one of the last two terms has come down to a tenth of tolerance times change. */
static void last_terms_meet_the_tolerance(void **state) {
  (void)state;
  for (int order = 4; order <= 30; order++)
    for (double rho = 1e-2; rho < 2; rho *= 3) {
      double c[31], tolerance = 1e-10;
      for (int j = 0; j <= order; j++)
        c[j] = pow(rho, -j);
      taylor_decay d = taylor_decay_of(c, 1, 1, order);
      assert_close(d.change, fmax(c[1], c[3]), 0);
      double theta = taylor_step_factor(&d, order, tolerance), allowed = 0.1 * tolerance * d.change * theta;
      double terms = fmax(c[order - 1] * pow(theta, order - 1), c[order] * pow(theta, order));
      assert_close(terms / allowed, 1, 1e-12);
    }
}

static void a_motion_without_last_terms_grows_by_the_most(void **state) {
  (void)state;
  assert_close(taylor_step_factor(&(taylor_decay){.change = 1, .nearest_zero = INFINITY}, 24, 1e-16), 1000, 0);
  assert_close(taylor_step_factor(&(taylor_decay){.nearest_zero = INFINITY}, 24, 1e-16), 1000, 0);
}

static void steps_keep_away_from_branch_points(void **state) {
  (void)state;
  assert_close(taylor_step_factor(&(taylor_decay){.change = 1, .nearest_zero = 0.5}, 24, 1e-16), 0.45, 1e-15);
}

/* Forces that balance at the start and turn: the first coefficient that is not zero may be c_4. */
static void motion_can_begin_at_rest(void **state) {
  (void)state;
  for (int first = 2; first <= 4; first++) {
    double c[7] = {1};
    for (int j = first; j <= 6; j += 2)
      c[j] = 0.1;
    taylor_decay d = taylor_decay_of(c, 1, 1, 6);
    double theta = taylor_step_factor(&d, 6, 1e-4);
    assert_true(theta > 1e-2 && theta < 1);
  }
}

static void series_that_are_not_finite_are_no_use(void **state) {
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY, 1e305};
  const size_t places[] = {1, 2, 5, 6};
  for (size_t b = 0; b < 4; b++)
    for (size_t p = 0; p < 4; p++)
      for (size_t column = 0; column < 11; column++) {
        double c[7 * 11] = {0};
        c[places[p] * 11 + column] = bad[b];
        taylor_decay d = taylor_decay_of(c, 11, 11, 6), good = taylor_decay_of((double[7 * 11]){0}, 11, 11, 6);
        assert_true(isnan(d.change));
        assert_true(isnan(taylor_decay_join(d, good).change) && isnan(taylor_decay_join(good, d).change));
        assert_true(good.change == 0);
      }
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
  assert_true(taylor_step_vanishes(0, 1e-13));
  assert_false(taylor_step_vanishes(0, 1e-11));
  assert_false(taylor_step_vanishes(-1000, -1e-8));
  for (double time = -1e6; time < 2e6; time += 1e5)
    assert_false(taylor_step_vanishes(time, taylor_step_least(time)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_grows_with_accuracy_within_its_bounds),
      cmocka_unit_test(last_terms_meet_the_tolerance),
      cmocka_unit_test(linear_motions_reach_as_far_as_the_first_term_left_out_allows),
      cmocka_unit_test(rate_bound_is_met_without_damping_and_without_springs),
      cmocka_unit_test(passive_rate_bound_holds_and_is_met),
      cmocka_unit_test(a_motion_without_last_terms_grows_by_the_most),
      cmocka_unit_test(steps_keep_away_from_branch_points),
      cmocka_unit_test(motion_can_begin_at_rest),
      cmocka_unit_test(series_that_are_not_finite_are_no_use),
      cmocka_unit_test(steps_land_on_the_stop_without_a_sliver),
      cmocka_unit_test(fixed_steps_keep_their_length),
      cmocka_unit_test(steps_below_the_resolution_of_time_vanish),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The list of resonances against the condition omega_j T = 2 pi l and a scan that looks for it by brute force. */
#include "support.h"

#include <ricochet/ricochet.h>

enum { MOST = 4096 };

static const double pi = 3.14159265358979323846;

static ric_chain chain_of(size_t n, int ends, double gamma) {
  ric_chain chain = ric_chain_default(n, gamma);
  chain.ends = (ric_ends)ends;
  return chain;
}

static size_t list_all(const ric_chain *chain, ric_along along, double period, double low, double high,
                       ric_resonance *list) {
  size_t count;
  ric_error error;
  if (ric_chain_resonances(chain, along, period, low, high, list, MOST, &count, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_true(count <= MOST);
  return count;
}

/* Turns omega_j T / (2 pi) at a value of the parameter. */
static double turns(const ric_chain *chain, ric_along along, double period, double parameter, size_t mode) {
  ric_chain at = *chain;
  if (along == RIC_ALONG_GAMMA)
    at.gamma = parameter;
  return ric_chain_frequency(&at, mode) * (along == RIC_ALONG_GAMMA ? period : parameter) / (2 * pi);
}

static void check_listed(const ric_chain *chain, ric_along along, double period, double low, double high) {
  static ric_resonance list[MOST];
  size_t count = list_all(chain, along, period, low, high, list);
  for (size_t k = 0; k < count; k++) {
    double l = turns(chain, along, period, list[k].parameter, list[k].mode);
    assert_true(list[k].parameter >= low && list[k].parameter <= high);
    assert_true(list[k].harmonic >= 1 && list[k].mode < chain->particles);
    assert_close(l, list[k].harmonic, 1e-14 * list[k].harmonic);
    if (k > 0)
      assert_true(list[k].parameter > list[k - 1].parameter ||
                  (list[k].parameter == list[k - 1].parameter && list[k].mode > list[k - 1].mode));
  }
}

/* turns() grows with the parameter: in each cell of a grid a mode passes as many whole numbers as it resonates. */
static void check_complete(const ric_chain *chain, ric_along along, double period, double low, double high) {
  enum { CELLS = 200 };
  static ric_resonance list[MOST];
  size_t count = list_all(chain, along, period, low, high, list);
  for (size_t mode = 0; mode < chain->particles; mode++)
    for (int c = 0; c < CELLS; c++) {
      double left = low + (high - low) * c / CELLS, right = low + (high - low) * (c + 1) / CELLS;
      double before = turns(chain, along, period, left, mode), after = turns(chain, along, period, right, mode);
      double passed = floor(after) - floor(before), listed = 0;
      for (size_t k = 0; k < count; k++)
        listed += list[k].mode == mode && list[k].parameter > left && list[k].parameter <= right;
      assert_close(listed, passed, 0);
    }
}

typedef void (*property)(const ric_chain *chain, ric_along along, double period, double low, double high);

/* Ends of the ranges are no resonances, so that the scan need not decide about equality. */
static void for_all_chains(property holds) {
  const size_t sizes[] = {1, 2, 3, 4, 5, 8, 13};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
      ric_chain chain = chain_of(sizes[s], ends, 0.37);
      holds(&chain, RIC_ALONG_GAMMA, 4.7, 0.0123, 3.21);
      holds(&chain, RIC_ALONG_GAMMA, 9.1, 0.0123, 3.21);
      holds(&chain, RIC_ALONG_GAMMA, 30.3, 0.1, 1.17);
      holds(&chain, RIC_ALONG_PERIOD, 1, 0.77, 25.3);
    }
}

static void listed_resonances_have_whole_turns_and_are_ordered(void **state) {
  (void)state;
  for_all_chains(check_listed);
}

static void no_resonance_is_missing(void **state) {
  (void)state;
  for_all_chains(check_complete);
}

static void first_resonance_is_the_first_of_the_list(void **state) {
  (void)state;
  static ric_resonance list[MOST];
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t n = 1; n <= 14; n++)
      for (double period = 2.1; period < 6.2; period += 0.7) {
        ric_chain chain = chain_of(n, ends, 0);
        double first = ric_chain_first_resonance(&chain, period);
        if (n == 1 && ends != RIC_ENDS_FIXED) {
          assert_true(isnan(first));
          continue;
        }
        assert_true(list_all(&chain, RIC_ALONG_GAMMA, period, 0, first * 1.01, list) >= 1);
        assert_close(list[0].parameter, first, 1e-15 * first);
        assert_int_equal(list[0].harmonic, 1);
      }
}

static void first_resonance_of_even_rings_is_gamma_c(void **state) {
  (void)state;
  for (size_t n = 4; n <= 30; n += 2) {
    ric_chain ring = ric_chain_default(n, 0);
    assert_close(ric_chain_first_resonance(&ring, 1.5 * pi), ric_gamma_c(1.5 * pi), 1e-15);
    ring.particles++;
    assert_true(ric_chain_first_resonance(&ring, 1.5 * pi) > ric_gamma_c(1.5 * pi));
    ring.ends = RIC_ENDS_FIXED;
    assert_true(ric_chain_first_resonance(&ring, 1.5 * pi) > ric_gamma_c(1.5 * pi));
  }
}

static void beyond_two_pi_there_is_no_first_resonance(void **state) {
  (void)state;
  ric_chain ring = ric_chain_default(8, 0);
  assert_true(isnan(ric_chain_first_resonance(&ring, 2 * pi)));
  assert_true(isnan(ric_chain_first_resonance(&ring, 7)));
}

static void ends_of_the_range_belong_to_it(void **state) {
  (void)state;
  ric_chain ring = ric_chain_default(8, 0);
  ric_resonance at;
  size_t count;
  double first = ric_chain_first_resonance(&ring, 5);
  assert_int_equal(ric_chain_resonances(&ring, RIC_ALONG_GAMMA, 5, first, first, &at, 1, &count, NULL), RIC_OK);
  assert_int_equal(count, 1);
  assert_int_equal(at.mode, 4);
}

static void count_goes_on_beyond_the_capacity(void **state) {
  (void)state;
  ric_chain ring = ric_chain_default(30, 0);
  ric_resonance few[3];
  size_t count, all;
  assert_int_equal(ric_chain_resonances(&ring, RIC_ALONG_GAMMA, 5, 0, 2, NULL, 0, &all, NULL), RIC_OK);
  assert_true(all > 3);
  few[2].mode = 12345;
  assert_int_equal(ric_chain_resonances(&ring, RIC_ALONG_GAMMA, 5, 0, 2, few, 2, &count, NULL), RIC_OK);
  assert_int_equal(count, all);
  assert_int_equal(few[2].mode, 12345);
  assert_true(few[0].parameter <= few[1].parameter);
}

static void refuse(double period, double low, double high, ric_along along, const char *part) {
  ric_chain ring = ric_chain_default(5, 0.1);
  ric_error error = {0};
  size_t count;
  assert_int_equal(ric_chain_resonances(&ring, along, period, low, high, NULL, 0, &count, &error), RIC_EINVAL);
  if (!strstr(error.message, part))
    fail_msg("'%s' not in '%s'", part, error.message);
}

static void ranges_and_periods_out_of_bounds_are_refused(void **state) {
  (void)state;
  const double ranges[][2] = {{-1, 1}, {1, 0.5}, {0, INFINITY}, {NAN, 1}, {0, NAN}};
  for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++) {
    refuse(5, ranges[k][0], ranges[k][1], RIC_ALONG_GAMMA, "range");
    refuse(5, ranges[k][0], ranges[k][1], RIC_ALONG_PERIOD, "range");
  }
  refuse(0, 0, 1, RIC_ALONG_GAMMA, "period = 0");
  refuse(-2, 0, 1, RIC_ALONG_GAMMA, "period = -2");
  refuse(NAN, 0, 1, RIC_ALONG_GAMMA, "period");
}

/* The mode p = 0 has frequency 1 whatever gamma is. */
static void uniform_mode_resonates_along_the_period_only(void **state) {
  (void)state;
  static ric_resonance list[MOST];
  ric_chain ring = ric_chain_default(6, 0.2);
  size_t count = list_all(&ring, RIC_ALONG_GAMMA, 2 * pi, 0, 9, list);
  for (size_t k = 0; k < count; k++)
    assert_true(list[k].mode != 0);
  count = list_all(&ring, RIC_ALONG_PERIOD, 1, 6, 6.5, list);
  int seen = 0;
  for (size_t k = 0; k < count; k++)
    if (list[k].mode == 0) {
      assert_close(list[k].parameter, 2 * pi, 1e-15 * 7);
      seen++;
    }
  assert_int_equal(seen, 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(listed_resonances_have_whole_turns_and_are_ordered),
      cmocka_unit_test(no_resonance_is_missing),
      cmocka_unit_test(first_resonance_is_the_first_of_the_list),
      cmocka_unit_test(first_resonance_of_even_rings_is_gamma_c),
      cmocka_unit_test(beyond_two_pi_there_is_no_first_resonance),
      cmocka_unit_test(ends_of_the_range_belong_to_it),
      cmocka_unit_test(count_goes_on_beyond_the_capacity),
      cmocka_unit_test(ranges_and_periods_out_of_bounds_are_refused),
      cmocka_unit_test(uniform_mode_resonates_along_the_period_only),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Patterns that repeat in space are solved on their unit cell, with the result of the whole chain. */
#include "support.h"

#include "witness/solved_orbit.h"

static const double couplings[] = {0.02, 0.11, 0.4, 0.9};

static void compare_word(const char *word, size_t times, ric_ends ends, double gamma, double period) {
  solved_orbit cell = solve_orbit(RIC_METHOD_IMPULSE, scenario_word(word, times, ends, gamma, period));
  solved_orbit whole = solve_orbit(RIC_METHOD_DENSE, scenario_word(word, times, ends, gamma, period));
  assert_int_equal(cell.orbit.outcome, whole.orbit.outcome);
  if (solved_orbit_has_state(&whole)) {
    assert_true(state_difference(&cell.orbit, &whole.orbit) <= method_tolerance(&whole));
    assert_close(cell.orbit.energy, whole.orbit.energy, 2 * sqrt(whole.orbit.energy * 40) * method_tolerance(&whole));
    if (whole.orbit.clearance_particle >= 0)
      assert_close(cell.orbit.clearance, whole.orbit.clearance,
                   method_tolerance(&whole) + 2e-12 * solved_orbit_scale(&whole));
  }
  solved_orbit_clear(&cell);
  solved_orbit_clear(&whole);
}

static void compare_everywhere(const char *word, size_t times, ric_ends ends) {
  for (size_t g = 0; g < sizeof couplings / sizeof *couplings; g++)
    for (double period = 3.7; period < 6.3; period += 0.9)
      compare_word(word, times, ends, couplings[g], period);
}

static void periodic_patterns_on_rings_equal_the_dense_solution(void **state) {
  (void)state;
  const char *words[] = {"s", "sh", "s.", "s..", "sh.", "s.h.", "ssh.", "s..h..", "shh"};
  for (size_t w = 0; w < sizeof words / sizeof *words; w++)
    for (size_t times = 2; times <= 4; times++)
      compare_everywhere(words[w], times, RIC_ENDS_PERIODIC);
}

/* Palindromes repeat on a free chain with its mirror image; a word and a half does when the half mirrors. */
static void mirrored_patterns_on_free_chains_equal_the_dense_solution(void **state) {
  (void)state;
  const char *words[] = {"s", "h", ".s.", "s.s", "s..s", "shhs", ".sh.hs.", "s.hh.s", "s.hh.ss.h", ".ss..s"};
  for (size_t w = 0; w < sizeof words / sizeof *words; w++)
    for (size_t times = 1; times <= 3; times++)
      compare_everywhere(words[w], times, RIC_ENDS_FREE);
}

static void patterns_on_fixed_chains_equal_the_dense_solution(void **state) {
  (void)state;
  compare_everywhere("s..", 4, RIC_ENDS_FIXED);
  compare_everywhere("sh", 5, RIC_ENDS_FIXED);
}

/* In phase every particle moves at frequency 1. In zigzag the mean of two neighbours does, and their difference moves
 * at the upper edge of the band: with equal impulses half a period apart, p (g_mean + g_difference) = -1, where g =
 * (cos x + 1) / (4 omega sin x) for the mean, which sees two impulses of one sign, and (cos x - 1) / (4 omega sin x)
 * for the difference, x = omega T / 2. */
static void in_phase_and_zigzag_motions_are_one_and_two_oscillators(void **state) {
  (void)state;
  const double period = 5, gamma = 0.07, edge = sqrt(1 + 4 * gamma);
  double x = period / 2, y = edge * period / 2;
  double g = (cos(x) + 1) / (4 * sin(x)) + (cos(y) - 1) / (4 * edge * sin(y));
  solved_orbit in_phase = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s", 10, RIC_ENDS_PERIODIC, gamma, period));
  solved_orbit zigzag = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("sh", 5, RIC_ENDS_PERIODIC, gamma, period));
  for (size_t i = 0; i < 10; i++) {
    assert_close(in_phase.orbit.q_half[i], -1 / cos(x), 1e-13);
    assert_close(in_phase.orbit.impulse[i], -2 * tan(x), 1e-13);
    assert_close(zigzag.orbit.impulse[i], -1 / g, 1e-13);
  }
  solved_orbit_clear(&in_phase);
  solved_orbit_clear(&zigzag);
}

static double bytes_of(const char *word, size_t times, ric_ends ends) {
  scenario s = scenario_word(word, times, ends, 0.1, 5);
  double bytes = ric_orbit_bytes(&s.chain, s.pattern, RIC_METHOD_IMPULSE);
  scenario_clear(&s);
  return bytes;
}

/* The orbit itself takes four numbers per particle and one per impact, the pattern a byte. */
static void periodic_patterns_take_little_more_memory_than_their_orbit(void **state) {
  (void)state;
  enum { CELLS = 20000 };
  double cell = 100 * 1024;
  assert_true(bytes_of("s..", CELLS, RIC_ENDS_PERIODIC) < 3 * CELLS * 33.0 + CELLS * 8.0 + cell);
  assert_true(bytes_of(".s.", CELLS, RIC_ENDS_FREE) < 3 * CELLS * 33.0 + CELLS * 8.0 + cell);
  assert_true(bytes_of("s..", CELLS, RIC_ENDS_FIXED) > 1e8);
}

static void large_periodic_patterns_equal_small_ones(void **state) {
  (void)state;
  solved_orbit large = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s.h..", 2000, RIC_ENDS_PERIODIC, 0.05, 5));
  solved_orbit small = solve_orbit(RIC_METHOD_DENSE, scenario_word("s.h..", 3, RIC_ENDS_PERIODIC, 0.05, 5));
  for (size_t i = 0; i < large.orbit.particles; i++) {
    assert_close(large.orbit.q[i], small.orbit.q[i % 5], method_tolerance(&small));
    assert_close(large.orbit.v[i], small.orbit.v[i % 5], method_tolerance(&small));
  }
  assert_close(large.orbit.clearance, small.orbit.clearance, 1e-11);
  solved_orbit_clear(&large);
  solved_orbit_clear(&small);
}

/* Floors that do not repeat with the pattern forbid the reduction. */
static void floors_that_do_not_repeat_are_not_reduced(void **state) {
  (void)state;
  const double floors[] = {-1, -1, -1, -0.8, -1, -1, -1, -1, -1};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (double gamma = 0; gamma < 0.2; gamma += 0.1) {
      scenario s = scenario_word("s..", 3, (ric_ends)ends, gamma, 5),
               t = scenario_word("s..", 3, (ric_ends)ends, gamma, 5);
      s.chain.floors = t.chain.floors = floors;
      solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, s), dense = solve_orbit(RIC_METHOD_DENSE, t);
      assert_true(state_difference(&impulse.orbit, &dense.orbit) <= method_tolerance(&dense));
      assert_close(impulse.orbit.q[3], -0.8, 1e-13);
      assert_close(impulse.orbit.q[0], -1, 1e-13);
      solved_orbit_clear(&impulse);
      solved_orbit_clear(&dense);
    }
}

static void floors_that_repeat_are_reduced(void **state) {
  (void)state;
  const double floors[] = {-1, -0.7, -2, -1, -0.7, -2, -1, -0.7, -2};
  scenario s = scenario_word("sh.", 3, RIC_ENDS_PERIODIC, 0.1, 5),
           t = scenario_word("sh.", 3, RIC_ENDS_PERIODIC, 0.1, 5);
  s.chain.floors = t.chain.floors = floors;
  assert_true(ric_orbit_bytes(&s.chain, s.pattern, RIC_METHOD_IMPULSE) < bytes_of("sh...h...", 1, RIC_ENDS_PERIODIC));
  solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, s), dense = solve_orbit(RIC_METHOD_DENSE, t);
  assert_true(state_difference(&impulse.orbit, &dense.orbit) <= method_tolerance(&dense));
  assert_int_equal(impulse.orbit.outcome, dense.orbit.outcome);
  solved_orbit_clear(&impulse);
  solved_orbit_clear(&dense);
}

/* Every pattern of up to four particles: where a class of equal particles has one member, nothing is gained or lost. */
static void uncoupled_chains_of_any_size_equal_the_dense_solution(void **state) {
  (void)state;
  const char letters[] = ".sh";
  for (size_t n = 1, patterns = 3; n <= 4; n++, patterns *= 3)
    for (size_t code = 1; code < patterns; code++)
      for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
        char word[5] = "";
        for (size_t i = 0, rest = code; i < n; i++, rest /= 3)
          word[i] = letters[rest % 3];
        solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, scenario_word(word, 1, (ric_ends)ends, 0, 4.7));
        solved_orbit dense = solve_orbit(RIC_METHOD_DENSE, scenario_word(word, 1, (ric_ends)ends, 0, 4.7));
        assert_int_equal(impulse.orbit.outcome, RIC_ADMISSIBLE);
        assert_int_equal(dense.orbit.outcome, RIC_ADMISSIBLE);
        assert_true(state_difference(&impulse.orbit, &dense.orbit) <= method_tolerance(&dense));
        solved_orbit_clear(&impulse);
        solved_orbit_clear(&dense);
      }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uncoupled_chains_of_any_size_equal_the_dense_solution),
      cmocka_unit_test(periodic_patterns_on_rings_equal_the_dense_solution),
      cmocka_unit_test(mirrored_patterns_on_free_chains_equal_the_dense_solution),
      cmocka_unit_test(patterns_on_fixed_chains_equal_the_dense_solution),
      cmocka_unit_test(in_phase_and_zigzag_motions_are_one_and_two_oscillators),
      cmocka_unit_test(periodic_patterns_take_little_more_memory_than_their_orbit),
      cmocka_unit_test(large_periodic_patterns_equal_small_ones),
      cmocka_unit_test(floors_that_do_not_repeat_are_not_reduced),
      cmocka_unit_test(floors_that_repeat_are_reduced),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

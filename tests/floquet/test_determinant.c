/* The determinant method against the reduced one. */
#include "support.h"

#include "witness/multiplier_witness.h"
#include "scenario/example1.h"

enum { SMALL_CASES = 400, LARGE_CASES = 100, CIRCLE_CASES = 60, THRESHOLD_FAMILIES = 12 };

static scenario_ranges up_to(size_t particles) {
  return (scenario_ranges){
      .most_particles = particles, .highest_gamma = 0.5, .shortest_period = 3.3, .longest_period = 6.2};
}

static void report(const solved_orbit *x, const ric_multipliers *a, const ric_multipliers *b) {
  print_error("n = %zu, ends %d, m = %zu, gamma = %.17g, T = %.17g: %zu outside (%s) and %zu (%s)\n",
              x->orbit.particles, (int)x->scenario.chain.ends, x->orbit.impacts, x->scenario.chain.gamma,
              x->scenario.period, a->outside, a->reason, b->outside, b->reason);
}

/* Next to a collision on the circle the determinant method may not tell two multipliers from it. */
static bool compatible(ric_stability a, ric_stability b) {
  return a == b || a == RIC_UNDECIDED || b == RIC_UNDECIDED;
}

/* Both methods on one orbit. @returns the distance of what the determinant finds, of the largest multiplier */
static double compare(const solved_orbit *x, bool exactly) {
  ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_REDUCED, x, false);
  ric_multipliers b = multipliers_by(RIC_MULTIPLIERS_DETERMINANT, x, false);
  double distance = multipliers_distance(&b, b.outside, &a);
  if (!compatible(a.stable, b.stable) || a.outside != b.outside)
    report(x, &a, &b);
  assert_true(exactly ? a.stable == b.stable : compatible(a.stable, b.stable));
  assert_int_equal(a.outside, b.outside);
  ric_multipliers_clear(&a);
  ric_multipliers_clear(&b);
  return distance;
}

static double worst_of_cases(unsigned seed, int cases, size_t particles) {
  random_source source = {.state = seed};
  scenario_ranges ranges = up_to(particles);
  double worst = 0;
  for (int i = 0; i < cases; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 6));
    worst = fmax(worst, compare(&x, true));
    solved_orbit_clear(&x);
  }
  return worst;
}

/* The verdict and the number outside are the same; multipliers differ by the root of rounding where two of them nearly
 * meet. */
static void determinant_and_reduced_methods_agree_on_random_patterns(void **state) {
  (void)state;
  double worst = worst_of_cases(21, SMALL_CASES, 16);
  worst = fmax(worst, worst_of_cases(22, LARGE_CASES, 40));
  print_message("largest relative difference of a multiplier: %.3g\n", worst);
  assert_true(worst < 1e-6);
}

/* Both sides of a critical coupling, 1e-3 to 1e-8 away. */
static int compare_beside(const scenario *s, double critical, double sign) {
  int compared = 0;
  for (double distance = 1e-3; distance > 0.5e-8; distance /= 10) {
    scenario beside = {.chain = s->chain, .period = s->period};
    ric_symmetry none = {0};
    beside.chain.gamma = critical + sign * distance;
    assert_int_equal(ric_pattern_image(s->pattern, s->chain.ends, none, &beside.pattern, NULL), RIC_OK);
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, beside);
    compare(&x, false);
    compared++;
    solved_orbit_clear(&x);
  }
  return compared;
}

static void methods_agree_beside_critical_couplings(void **state) {
  (void)state;
  random_source source = {.state = 23};
  scenario_ranges ranges = up_to(16);
  int compared = 0;
  for (int i = 0; i < THRESHOLD_FAMILIES; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 3));
    ric_critical found[4];
    size_t count;
    assert_int_equal(ric_orbit_critical_points(x.solver, &x.scenario.chain, x.scenario.pattern, RIC_ALONG_GAMMA,
                                               x.scenario.period, 0.01, 0.3, 30, found, 4, &count, NULL),
                     RIC_OK);
    for (size_t k = 0; k < count && k < 4; k++)
      if (found[k].uncertainty < 1e-9) {
        compared += compare_beside(&x.scenario, found[k].parameter, -1);
        compared += compare_beside(&x.scenario, found[k].parameter, 1);
      }
    solved_orbit_clear(&x);
  }
  print_message("%d orbits beside critical couplings\n", compared);
  assert_true(compared >= 100);
}

/* So close to the critical coupling that rounding would decide. */
static void both_methods_are_undecided_at_a_critical_coupling(void **state) {
  (void)state;
  const double critical = 0.132081944878;
  for (int method = RIC_MULTIPLIERS_REDUCED; method <= RIC_MULTIPLIERS_DETERMINANT; method += 2)
    for (int k = -1; k <= 1; k++) {
      solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(critical + 1e-10 * k));
      ric_multipliers m = multipliers_by((ric_multiplier_method)method, &x, false);
      assert_int_equal(m.stable, RIC_UNDECIDED);
      assert_int_equal(m.outside, 0);
      assert_non_null(strstr(m.reason, "from 1"));
      ric_multipliers_clear(&m);
      solved_orbit_clear(&x);
    }
}

static void all_multipliers_on_the_circle_are_found(void **state) {
  (void)state;
  random_source source = {.state = 24};
  scenario_ranges ranges = up_to(24);
  int complete = 0;
  double worst = 0;
  for (int i = 0; i < CIRCLE_CASES; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 2));
    ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_REDUCED, &x, false);
    ric_multipliers b = multipliers_by(RIC_MULTIPLIERS_DETERMINANT, &x, true);
    assert_int_equal(a.stable, b.stable);
    if (b.count == b.dimension) {
      complete++;
      worst = fmax(worst, multipliers_distance(&a, a.count, &b));
      worst = fmax(worst, multipliers_distance(&b, b.count, &a));
    }
    ric_multipliers_clear(&a);
    ric_multipliers_clear(&b);
    solved_orbit_clear(&x);
  }
  print_message("all 2n found in %d of %d, largest difference %.3g\n", complete, CIRCLE_CASES, worst);
  assert_true(complete >= CIRCLE_CASES * 9 / 10);
  assert_true(worst < 1e-6);
}

static void all_multipliers_of_a_ring_of_500_are_found(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(500, RIC_ENDS_PERIODIC, 0.12, example1_period()));
  ric_multipliers m = multipliers_by(RIC_MULTIPLIERS_DETERMINANT, &x, true);
  assert_int_equal(m.stable, RIC_STABLE);
  assert_int_equal(m.count, 1000);
  assert_close(m.largest, 1, 1e-12);
  ric_multipliers_clear(&m);
  solved_orbit_clear(&x);
}

/* At n = 10 000 the orbit and its multipliers outside are those of a ring of 60. */
static void large_rings_have_the_multipliers_of_small_ones(void **state) {
  (void)state;
  const double couplings[] = {0.1, 0.15};
  for (int k = 0; k < 2; k++) {
    solved_orbit large =
        solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(10000, RIC_ENDS_PERIODIC, couplings[k], example1_period()));
    solved_orbit small =
        solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(60, RIC_ENDS_PERIODIC, couplings[k], example1_period()));
    ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_AUTO, &large, false);
    ric_multipliers b = multipliers_by(RIC_MULTIPLIERS_AUTO, &small, false);
    assert_int_equal(a.stable, k == 0 ? RIC_STABLE : RIC_UNSTABLE);
    assert_int_equal(a.outside, b.outside);
    assert_close(a.largest, b.largest, 1e-9);
    ric_multipliers_clear(&a);
    ric_multipliers_clear(&b);
    solved_orbit_clear(&large);
    solved_orbit_clear(&small);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(determinant_and_reduced_methods_agree_on_random_patterns),
      cmocka_unit_test(methods_agree_beside_critical_couplings),
      cmocka_unit_test(both_methods_are_undecided_at_a_critical_coupling),
      cmocka_unit_test(all_multipliers_on_the_circle_are_found),
      cmocka_unit_test(all_multipliers_of_a_ring_of_500_are_found),
      cmocka_unit_test(large_rings_have_the_multipliers_of_small_ones),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

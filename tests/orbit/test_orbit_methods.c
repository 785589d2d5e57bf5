/* Two solvers and a closed form: three witnesses of one orbit. */
#include "support.h"

#include "scenario/example1.h"
#include "witness/solved_orbit.h"

enum { PATTERNS = 3000 };

/* Solves a scenario by both methods; returns their difference over the bound, infinite when they disagree about the
 * outcome, -1 for a singular outcome of both. */
static double compare_methods(scenario s, scenario copy) {
  solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, s), dense = solve_orbit(RIC_METHOD_DENSE, copy);
  double ratio = state_difference(&impulse.orbit, &dense.orbit) / method_tolerance(&dense);
  if (dense.orbit.outcome != impulse.orbit.outcome)
    ratio = INFINITY;
  else if (dense.orbit.outcome == RIC_SINGULAR)
    ratio = -1;
  if (!(ratio <= 1))
    print_error("n = %zu, ends %d, gamma = %.17g, T = %.17g: %.3g of the bound, condition %.3g, %s and %s\n",
                s.chain.particles, (int)s.chain.ends, s.chain.gamma, s.period, ratio, dense.orbit.condition,
                ric_outcome_name(impulse.orbit.outcome), ric_outcome_name(dense.orbit.outcome));
  solved_orbit_clear(&impulse);
  solved_orbit_clear(&dense);
  return ratio;
}

static void assert_agreement(double ratio) {
  assert_true(ratio >= 0 && ratio <= 1);
}

static void impulse_and_dense_agree_on_random_patterns(void **state) {
  (void)state;
  random_source source = {.state = 1}, twin = {.state = 1};
  scenario_ranges ranges = {.most_particles = 24, .highest_gamma = 1.5, .shortest_period = 0.5, .longest_period = 7};
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < PATTERNS; i++) {
    double ratio = compare_methods(scenario_random(&source, &ranges), scenario_random(&twin, &ranges));
    worst = fmax(worst, ratio);
    compared += ratio >= 0;
  }
  print_message("largest difference: %.3g of the bound, %d orbits\n", worst, compared);
  assert_true(compared >= PATTERNS - 5);
  assert_true(worst <= 1);
}

static void impulse_and_dense_agree_along_the_table_of_example_1(void **state) {
  (void)state;
  for (size_t row = 0; row < EXAMPLE1_TABLE; row++) {
    double gamma = example1_gamma(row);
    assert_agreement(compare_methods(example1_at(gamma), example1_at(gamma)));
  }
}

/* Two modes at distances 0.047 and 0.095 from resonance, too far to be set apart, and a nearly singular contact matrix.
 */
static void impulse_form_keeps_its_digits_between_close_resonances(void **state) {
  (void)state;
  const double gamma = 1.3834562237177714, period = 6.377385452215937;
  assert_agreement(compare_methods(scenario_word("sh", 1, RIC_ENDS_FREE, gamma, period),
                                   scenario_word("sh", 1, RIC_ENDS_FREE, gamma, period)));
}

/* Whether an outcome is one of the three singular cases. */
static int is_special(ric_outcome outcome) {
  return outcome == RIC_GRAZING || outcome == RIC_RESONANT || outcome == RIC_SINGULAR;
}

/* The same pattern, to be solved by the other method. */
static scenario copy_of(const scenario *s) {
  scenario copy = *s;
  assert_int_equal(ric_pattern_image(s->pattern, s->chain.ends, (ric_symmetry){0}, &copy.pattern, NULL), RIC_OK);
  return copy;
}

/* Largest difference over the bound at relative distances 1e-2 ... 1e-13 from a resonance. */
static double compare_next_to(scenario *s, double resonance) {
  double worst = 0;
  for (int k = 2; k <= 13; k++) {
    s->chain.gamma = resonance * (1 + (k % 2 ? 1 : -1) * pow(10, -k));
    solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, copy_of(s)),
                 dense = solve_orbit(RIC_METHOD_DENSE, copy_of(s));
    if (!is_special(impulse.orbit.outcome) && !is_special(dense.orbit.outcome)) {
      double ratio = state_difference(&impulse.orbit, &dense.orbit) / method_tolerance(&dense);
      if (ratio > 1 && ratio > worst)
        print_error(
            "n = %zu, ends %d, gamma = %.17g, T = %.17g, 1e-%d from a resonance: %.3g of the bound, residual %.2g\n",
            s->chain.particles, (int)s->chain.ends, s->chain.gamma, s->period, k, ratio, impulse.orbit.residual);
      worst = fmax(worst, ratio);
    }
    solved_orbit_clear(&impulse);
    solved_orbit_clear(&dense);
  }
  return worst;
}

/* With two or more impacts a mode at resonance leaves impulses, and an orbit like any other. */
static void impulse_and_dense_agree_next_to_resonances(void **state) {
  (void)state;
  random_source source = {.state = 17};
  scenario_ranges ranges = {.most_particles = 12, .highest_gamma = 1, .shortest_period = 2, .longest_period = 7};
  double worst = 0;
  for (int i = 0; i < 200; i++) {
    scenario s = scenario_random(&source, &ranges);
    ric_resonance list[256];
    size_t count;
    assert_int_equal(ric_chain_resonances(&s.chain, RIC_ALONG_GAMMA, s.period, 0, 2, list, 256, &count, NULL), RIC_OK);
    if (count > 0)
      worst = fmax(worst, compare_next_to(&s, list[random_below(&source, count)].parameter));
    scenario_clear(&s);
  }
  print_message("largest difference next to resonances: %.3g of the bound\n", worst);
  assert_true(worst <= 1);
}

/* At gamma = 0 particles move alone: q = -cos(t - T/2) / cos(T/2) after an impact at t = 0, shifted by T/2 for one at
 * T/2, and 0 without impacts. */
static double closed_form(ric_role role, double period, double t, double *v) {
  if (role == RIC_ROLE_FREE)
    return *v = 0;
  double since = fmod(role == RIC_ROLE_START ? t : t + period / 2, period);
  *v = sin(since - period / 2) / cos(period / 2);
  return -cos(since - period / 2) / cos(period / 2);
}

/* The phase T/2 is known to rounding, which 1 / cos amplifies by its tangent. */
static double closed_form_rounding(double period) {
  return 1e-14 * (1 + period * fabs(tan(period / 2))) / fabs(cos(period / 2));
}

static void compare_with_closed_form(ric_orbit_method method, ric_ends ends, double period) {
  enum { N = 9, TIMES = 40 };
  solved_orbit x = solve_orbit(method, scenario_word("s.h.hs...", 1, ends, 0, period));
  double times[TIMES], q[TIMES * N], v[TIMES * N];
  for (int a = 0; a < TIMES; a++)
    times[a] = period * a / TIMES;
  assert_int_equal(ric_orbit_states(x.solver, &x.scenario.chain, &x.orbit, times, TIMES, q, v, NULL), RIC_OK);
  for (size_t a = 0; a < TIMES; a++)
    for (size_t i = 0; i < N; i++) {
      double speed, place = closed_form(ric_pattern_role(x.scenario.pattern, i), period, times[a], &speed);
      assert_close(q[a * N + i], place, closed_form_rounding(period));
      assert_close(v[a * N + i], speed, closed_form_rounding(period));
    }
  solved_orbit_clear(&x);
}

static void uncoupled_orbits_equal_the_closed_form(void **state) {
  (void)state;
  const double periods[] = {0.6, 2, 3, 3.3, 4.71238898038469, 5.5, 6.2, 6.6, 9};
  for (size_t k = 0; k < sizeof periods / sizeof *periods; k++)
    for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
      for (int method = RIC_METHOD_IMPULSE; method <= RIC_METHOD_DENSE; method++)
        compare_with_closed_form((ric_orbit_method)method, (ric_ends)ends, periods[k]);
}

static void uncoupled_orbits_are_admissible_from_pi_to_two_pi_only(void **state) {
  (void)state;
  const struct {
    double period;
    ric_outcome outcome;
  } cases[] = {{2, RIC_INADMISSIBLE}, {3.1, RIC_INADMISSIBLE}, {3.2, RIC_ADMISSIBLE},
               {5, RIC_ADMISSIBLE},   {6.28, RIC_ADMISSIBLE},  {6.29, RIC_INADMISSIBLE}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s..h.", 1, RIC_ENDS_PERIODIC, 0, cases[k].period));
    assert_int_equal(x.orbit.outcome, cases[k].outcome);
    solved_orbit_clear(&x);
  }
}

/* At gamma = 0 one particle of each role stands for all; a coupling too small to matter takes the general way. */
static void vanishing_coupling_is_the_limit_of_small_coupling(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    solved_orbit none = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s.h..s.", 1, (ric_ends)ends, 0, 5));
    solved_orbit tiny = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s.h..s.", 1, (ric_ends)ends, 1e-13, 5));
    assert_true(state_difference(&none.orbit, &tiny.orbit) <= 1e-11);
    assert_int_equal(none.orbit.outcome, tiny.orbit.outcome);
    solved_orbit_clear(&none);
    solved_orbit_clear(&tiny);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(impulse_and_dense_agree_on_random_patterns),
      cmocka_unit_test(impulse_and_dense_agree_along_the_table_of_example_1),
      cmocka_unit_test(impulse_and_dense_agree_next_to_resonances),
      cmocka_unit_test(impulse_form_keeps_its_digits_between_close_resonances),
      cmocka_unit_test(uncoupled_orbits_equal_the_closed_form),
      cmocka_unit_test(uncoupled_orbits_are_admissible_from_pi_to_two_pi_only),
      cmocka_unit_test(vanishing_coupling_is_the_limit_of_small_coupling),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

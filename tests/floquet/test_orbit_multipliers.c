/* Multipliers of the orbits of chains by the reduced method, against a dense matrix, event-driven runs and known
 * numbers. */
#include "support.h"

#include "witness/multiplier_witness.h"
#include "scenario/example1.h"

enum { DENSE_CASES = 100, PAIR_CASES = 200 };

static const scenario_ranges ranges = {
    .most_particles = 40, .highest_gamma = 0.5, .shortest_period = 3.3, .longest_period = 6.2};

/* The reduced form has rounding where the dense one has its square root: multipliers that meet there. */
static void reduced_and_dense_multipliers_agree(void **state) {
  (void)state;
  random_source source = {.state = 11};
  double worst = 0, worst_outside = 0;
  for (int i = 0; i < DENSE_CASES; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 6));
    ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_REDUCED, &x, false), b = multipliers_dense(&x);
    double scale = fmax(1, a.largest);
    worst = fmax(worst, multipliers_distance(&a, a.count, &b) / scale);
    for (size_t k = 0; k < a.count && hypot(a.mu[k].re, a.mu[k].im) > 1.001; k++)
      worst_outside = fmax(worst_outside, multipliers_distance(&a, k + 1, &b) / scale);
    if (a.stable != RIC_UNDECIDED && b.stable != RIC_UNDECIDED) {
      assert_int_equal(a.stable, b.stable);
      assert_int_equal(a.outside, b.outside);
    }
    ric_multipliers_clear(&a);
    ric_multipliers_clear(&b);
    solved_orbit_clear(&x);
  }
  print_message("reduced and dense: %.3g, outside %.3g of the largest\n", worst, worst_outside);
  assert_true(worst < 1e-5);
  assert_true(worst_outside < 1e-7);
}

/* The event-driven run knows the state only. */
static void monodromy_of_a_run_has_the_same_multipliers(void **state) {
  (void)state;
  random_source source = {.state = 13};
  size_t compared = 0, unstable = 0;
  for (int i = 0; i < 400 && compared < 40; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 4));
    ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_REDUCED, &x, false);
    ric_multipliers b = multipliers_by(RIC_MULTIPLIERS_MONODROMY, &x, false);
    if (x.orbit.outcome == RIC_ADMISSIBLE && a.largest < 1e4) { /* closure errors grow with it */
      assert_int_not_equal(b.stable, RIC_STABILITY_UNKNOWN);
      assert_true(multipliers_distance(&a, a.count, &b) < 1e-5 * fmax(1, a.largest));
      assert_close(b.log_determinant, 0, 1e-10 * fmax(1, a.largest * a.largest));
      if (a.stable != RIC_UNDECIDED && b.stable != RIC_UNDECIDED)
        assert_int_equal(a.stable, b.stable);
      unstable += a.stable == RIC_UNSTABLE;
      compared++;
    } else if (x.orbit.outcome == RIC_INADMISSIBLE)
      assert_true(b.stable == RIC_STABILITY_UNKNOWN && strstr(b.reason, "run") != NULL);
    ric_multipliers_clear(&a);
    ric_multipliers_clear(&b);
    solved_orbit_clear(&x);
  }
  print_message("%zu compared, %zu unstable\n", compared, unstable);
  assert_true(compared == 40 && unstable > 5);
}

static void multipliers_come_in_reciprocal_pairs_and_multiply_to_one(void **state) {
  (void)state;
  random_source source = {.state = 12};
  for (int i = 0; i < PAIR_CASES; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 6));
    ric_multipliers m = multipliers_by(RIC_MULTIPLIERS_AUTO, &x, false);
    for (size_t k = 0; k < m.count; k++) {
      double square = m.mu[k].re * m.mu[k].re + m.mu[k].im * m.mu[k].im;
      ric_complex inverse = {m.mu[k].re / square, -m.mu[k].im / square};
      ric_multipliers one = {.mu = &inverse, .count = 1};
      assert_true(multipliers_distance(&one, 1, &m) < 1e-13);
    }
    assert_close(m.log_determinant, 0, 1e-12);
    ric_multipliers_clear(&m);
    solved_orbit_clear(&x);
  }
}

static ric_multipliers example_multipliers(double gamma, double period, ric_multiplier_method method) {
  scenario s = example1_at(gamma);
  s.period = period;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, s);
  ric_multipliers m = multipliers_by(method, &x, false);
  solved_orbit_clear(&x);
  return m;
}

static void multipliers_meet_the_reference(void **state) {
  (void)state;
  const struct {
    double gamma, period, largest;
  } values[] = {{0.149153131912, 4.69756390941, 1.882696258}, {0.187, example1_period(), 8.236263884}};
  for (int method = RIC_MULTIPLIERS_REDUCED; method <= RIC_MULTIPLIERS_DETERMINANT; method++)
    for (int k = 0; k < 2; k++) {
      ric_multipliers m = example_multipliers(values[k].gamma, values[k].period, (ric_multiplier_method)method);
      assert_int_equal(m.stable, RIC_UNSTABLE);
      assert_int_equal(m.real_above, 1);
      assert_int_equal(m.outside, 1);
      assert_close(m.largest, values[k].largest, 1e-9);
      ric_multipliers_clear(&m);
    }
}

static void orbit_is_stable_up_to_the_critical_coupling(void **state) {
  (void)state;
  for (int method = RIC_MULTIPLIERS_REDUCED; method <= RIC_MULTIPLIERS_DETERMINANT; method++)
    for (size_t row = 0; row < EXAMPLE1_TABLE; row++) {
      double gamma = example1_gamma(row);
      ric_multipliers m = example_multipliers(gamma, example1_period(), (ric_multiplier_method)method);
      assert_int_equal(m.stable, gamma < 0.13208 ? RIC_STABLE : RIC_UNSTABLE);
      ric_multipliers_clear(&m);
    }
}

/* At gamma = 0 the impacting particle has the double 1 and the others turn by T. */
static void decoupled_particles_have_their_own_multipliers(void **state) {
  (void)state;
  ric_multipliers m = example_multipliers(0, example1_period(), RIC_MULTIPLIERS_REDUCED);
  for (size_t i = 0; i < m.count; i++) {
    double from_one = hypot(m.mu[i].re - 1, m.mu[i].im), from_turn = hypot(m.mu[i].re, fabs(m.mu[i].im) - 1);
    assert_true(from_one == 0 || from_turn < 1e-13);
  }
  ric_multipliers_clear(&m);
}

/* The orbit of a pattern that repeats is that of its cell; its multipliers are those of the cell and others, of motions
 * that do not repeat with it. */
static void multipliers_are_those_of_the_whole_chain(void **state) {
  (void)state;
  solved_orbit whole = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s...", 8, RIC_ENDS_PERIODIC, 0.2, 4.5));
  solved_orbit cell = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s...", 1, RIC_ENDS_PERIODIC, 0.2, 4.5));
  ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_AUTO, &whole, false);
  ric_multipliers b = multipliers_by(RIC_MULTIPLIERS_AUTO, &cell, false);
  assert_close(whole.orbit.impulse[0], cell.orbit.impulse[0], 1e-12);
  assert_true(multipliers_distance(&b, b.count, &a) < 1e-6);
  print_message("%zu outside, %zu of them in the cell\n", a.outside, b.outside);
  assert_true(a.outside > b.outside);
  ric_multipliers_clear(&a);
  ric_multipliers_clear(&b);
  solved_orbit_clear(&whole);
  solved_orbit_clear(&cell);
}

static void orbits_without_derivative_are_unknown(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(7.0 / 36)); /* grazing */
  ric_multipliers m = multipliers_by(RIC_MULTIPLIERS_AUTO, &x, false);
  assert_int_equal(m.stable, RIC_STABILITY_UNKNOWN);
  assert_non_null(strstr(m.reason, "grazing"));
  assert_true(isnan(m.largest) && isnan(m.margin) && m.count == 0);
  ric_multipliers_clear(&m);
  ric_orbit_fail(&x.orbit, "no memory");
  m = multipliers_by(RIC_MULTIPLIERS_AUTO, &x, false);
  assert_string_equal(m.reason, "failed orbit: no memory");
  ric_multipliers_clear(&m);
  solved_orbit_clear(&x);
}

static void state_of_another_orbit_is_unknown(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(0.1));
  x.scenario.chain.gamma = 0.11;
  ric_multipliers m = multipliers_by(RIC_MULTIPLIERS_REDUCED, &x, false);
  assert_int_equal(m.stable, RIC_STABILITY_UNKNOWN);
  assert_non_null(strstr(m.reason, "does not belong to an orbit"));
  ric_multipliers_clear(&m);
  solved_orbit_clear(&x);
}

static void bad_arguments_are_refused(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(0.1));
  ric_orbit_multiplier_options options = ric_orbit_multiplier_options_default();
  ric_multipliers m;
  ric_error error;
  ric_multipliers_init(&m, 30, NULL);
  assert_int_equal(ric_orbit_multipliers(x.solver, &x.scenario.chain, x.scenario.pattern, &x.orbit, NULL, &m, &error),
                   RIC_EINVAL);
  assert_string_equal(error.message, "room for 30 multipliers, expected 60");
  ric_multipliers_clear(&m);
  ric_multipliers_init(&m, 60, NULL);
  options.method = (ric_multiplier_method)7;
  assert_int_equal(
      ric_orbit_multipliers(x.solver, &x.scenario.chain, x.scenario.pattern, &x.orbit, &options, &m, &error),
      RIC_EINVAL);
  ric_multipliers_clear(&m);
  solved_orbit_clear(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reduced_and_dense_multipliers_agree),
      cmocka_unit_test(monodromy_of_a_run_has_the_same_multipliers),
      cmocka_unit_test(multipliers_come_in_reciprocal_pairs_and_multiply_to_one),
      cmocka_unit_test(multipliers_meet_the_reference),
      cmocka_unit_test(orbit_is_stable_up_to_the_critical_coupling),
      cmocka_unit_test(decoupled_particles_have_their_own_multipliers),
      cmocka_unit_test(multipliers_are_those_of_the_whole_chain),
      cmocka_unit_test(orbits_without_derivative_are_unknown),
      cmocka_unit_test(state_of_another_orbit_is_unknown),
      cmocka_unit_test(bad_arguments_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Critical parameters: where multipliers leave the circle. */
#include "support.h"

#include "witness/multiplier_witness.h"
#include "scenario/example1.h"

enum { ROOM = 64 };

/* Critical couplings of a scenario; returns their number. */
static size_t critical_of(scenario *s, ric_along along, double low, double high, size_t points, ric_critical *found) {
  ric_orbit_solver *solver;
  size_t count;
  ric_error error;
  assert_int_equal(ric_orbit_solver_create(NULL, &solver, NULL), RIC_OK);
  if (ric_orbit_critical_points(solver, &s->chain, s->pattern, along, s->period, low, high, points, found, ROOM, &count,
                                &error) != RIC_OK)
    fail_msg("%s", error.message);
  ric_orbit_solver_destroy(&solver);
  assert_true(count <= ROOM);
  return count;
}

static void example_1_loses_stability_at_plus_one(void **state) {
  (void)state;
  scenario s = example1_at(0);
  ric_critical found[ROOM];
  assert_int_equal(critical_of(&s, RIC_ALONG_GAMMA, 0, 0.19, 20, found), 1);
  assert_int_equal(found[0].kind, RIC_CRITICAL_PLUS_ONE);
  assert_true(found[0].outwards);
  assert_close(found[0].parameter, 0.1320819448778, 1e-10);
  assert_true(found[0].uncertainty <= 1e-10);
  scenario_clear(&s);
}

static void critical_point_is_the_same_from_any_grid(void **state) {
  (void)state;
  scenario s = example1_at(0);
  double parameter = 0;
  for (size_t points = 2; points <= 40; points += 19) {
    ric_critical found[ROOM];
    assert_int_equal(critical_of(&s, RIC_ALONG_GAMMA, 0.05, 0.18, points, found), 1);
    if (parameter > 0)
      assert_close(found[0].parameter, parameter, 1e-10);
    parameter = found[0].parameter;
  }
  scenario_clear(&s);
}

/* Along the period and along gamma the same boundary in the plane is met. */
static void both_directions_meet_on_one_boundary(void **state) {
  (void)state;
  scenario s = example1_at(0.1320819448778);
  ric_critical found[ROOM];
  size_t count = critical_of(&s, RIC_ALONG_PERIOD, 4.6, 4.8, 5, found);
  assert_int_equal(count, 1);
  assert_close(found[0].parameter, example1_period(), 1e-9);
  scenario_clear(&s);
}

/* On either side of every critical parameter the number of multipliers outside is different. */
static void number_outside_changes_across_every_critical_parameter(void **state) {
  (void)state;
  scenario s = scenario_middle(12, RIC_ENDS_FREE, 0, 4.4);
  ric_critical found[ROOM];
  size_t count = critical_of(&s, RIC_ALONG_GAMMA, 0.01, 0.5, 200, found), kinds[RIC_CRITICAL_KINDS] = {0};
  assert_true(count >= 3);
  for (size_t i = 0; i < count; i++) {
    double step = fmax(1e-7, 3 * found[i].uncertainty);
    size_t outside[2];
    for (int side = 0; side < 2; side++) {
      solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE,
                                   scenario_middle(12, RIC_ENDS_FREE, found[i].parameter + (2 * side - 1) * step, 4.4));
      ric_multipliers m = multipliers_by(RIC_MULTIPLIERS_REDUCED, &x, false);
      outside[side] = m.outside;
      ric_multipliers_clear(&m);
      solved_orbit_clear(&x);
    }
    assert_true(found[i].outwards ? outside[1] > outside[0] : outside[1] < outside[0]);
    assert_close(hypot(found[i].mu.re, found[i].mu.im), 1, 1e-12);
    kinds[found[i].kind]++;
  }
  print_message("%zu at +1, %zu at -1, %zu collisions\n", kinds[0], kinds[1], kinds[2]);
  scenario_clear(&s);
}

static void bad_ranges_are_refused(void **state) {
  (void)state;
  scenario s = example1_at(0);
  ric_orbit_solver *solver;
  ric_critical found[1];
  size_t count;
  ric_error error;
  assert_int_equal(ric_orbit_solver_create(NULL, &solver, NULL), RIC_OK);
  assert_int_equal(ric_orbit_critical_points(solver, &s.chain, s.pattern, RIC_ALONG_GAMMA, s.period, 0.2, 0.1, 5, found,
                                             1, &count, &error),
                   RIC_EINVAL);
  assert_int_equal(ric_orbit_critical_points(solver, &s.chain, s.pattern, RIC_ALONG_GAMMA, s.period, 0.1, 0.2, 1, found,
                                             1, &count, &error),
                   RIC_EINVAL);
  assert_string_equal(error.message, "points = 1, expected at least 2");
  ric_orbit_solver_destroy(&solver);
  scenario_clear(&s);
}

/* Two neighbours that hit together: the pair that meets at +1 moves them apart, and there the contact equations are
 * singular. */
static void pairs_that_break_a_symmetry_are_found_from_any_grid(void **state) {
  (void)state;
  scenario s = scenario_word("ss", 1, RIC_ENDS_FIXED, 0.4, 6.0921765756413766);
  for (size_t points = 2; points <= 40; points += 19) {
    ric_critical found[ROOM];
    size_t count = critical_of(&s, RIC_ALONG_GAMMA, 0.4, 0.5, points, found), hits = 0;
    for (size_t i = 0; i < count; i++)
      hits += fabs(found[i].parameter - 0.4644336073) < 1e-8 && found[i].kind == RIC_CRITICAL_PLUS_ONE;
    assert_int_equal(hits, 1);
  }
  scenario_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(example_1_loses_stability_at_plus_one),
      cmocka_unit_test(critical_point_is_the_same_from_any_grid),
      cmocka_unit_test(both_directions_meet_on_one_boundary),
      cmocka_unit_test(number_outside_changes_across_every_critical_parameter),
      cmocka_unit_test(bad_ranges_are_refused),
      cmocka_unit_test(pairs_that_break_a_symmetry_are_found_from_any_grid),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

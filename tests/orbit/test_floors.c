/* Floors of each particle: none, above the rest position, at it. */
#include "support.h"

#include "sampled_gaps.h"

static const double period = 4.4;

static scenario with_floors(const char *word, ric_ends ends, double gamma, const double *floors) {
  scenario s = scenario_word(word, 1, ends, gamma, period);
  s.chain.floors = floors;
  return s;
}

/* Impulse and dense form agree, contacts lie on their floors, and the clearance is that of sampling. */
static void check(const char *word, double gamma, const double *floors) {
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, with_floors(word, (ric_ends)ends, gamma, floors));
    solved_orbit y = solve_orbit(RIC_METHOD_DENSE, with_floors(word, (ric_ends)ends, gamma, floors));
    modal_motion motion = modal_motion_create(&x.scenario.chain);
    modal_motion_set(&motion, x.orbit.q, x.orbit.v);
    assert_int_equal(x.orbit.outcome, y.orbit.outcome);
    assert_true(state_difference(&x.orbit, &y.orbit) <= method_tolerance(&y));
    for (size_t i = 0; i < x.orbit.particles; i++)
      if (ric_pattern_role(x.scenario.pattern, i) != RIC_ROLE_FREE)
        assert_close(ric_pattern_role(x.scenario.pattern, i) == RIC_ROLE_START ? x.orbit.q[i] : x.orbit.q_half[i],
                     floors[i], 1e-12 * fmax(1, solved_orbit_scale(&x)));
    sampled_gap sampled = sampled_clearance(&x, &motion, 2000);
    sampled_gap refined = refined_gap(&x, &motion, sampled, period / 4000);
    assert_true(refined.gap < INFINITY);
    assert_close(x.orbit.clearance, refined.gap, 2e-12 * fmax(1, solved_orbit_scale(&x)));
    modal_motion_clear(&motion);
    solved_orbit_clear(&x);
    solved_orbit_clear(&y);
  }
}

static void floors_at_different_heights_are_met(void **state) {
  (void)state;
  const double floors[] = {-1.5, -0.6, -1, -2, -0.7, -1.1, -0.9};
  for (double gamma = 0; gamma < 0.5; gamma += 0.07) {
    check(".s..h..", gamma, floors);
    check("s.....s", gamma, floors);
  }
}

static void floors_above_the_rest_position_are_met(void **state) {
  (void)state;
  const double floors[] = {-1, 0.3, -1, -1, 0.5, -1};
  for (double gamma = 0; gamma < 0.5; gamma += 0.07)
    check(".s..h.", gamma, floors);
}

static void particles_without_a_floor_are_not_looked_at(void **state) {
  (void)state;
  const double none = -INFINITY, floors[] = {none, -1, none, none, -0.9, none, -1};
  for (double gamma = 0; gamma < 0.5; gamma += 0.07)
    check(".s..h..", gamma, floors);
}

static void without_free_particles_that_have_a_floor_there_is_no_clearance(void **state) {
  (void)state;
  const double none = -INFINITY, floors[] = {none, none, -1, none, none};
  solved_orbit some = solve_orbit(RIC_METHOD_IMPULSE, with_floors("..s..", RIC_ENDS_FREE, 0.1, floors));
  solved_orbit all = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("sh", 1, RIC_ENDS_FREE, 0.1, period));
  assert_true(isnan(some.orbit.clearance) && isnan(some.orbit.clearance_time));
  assert_int_equal(some.orbit.clearance_particle, -1);
  assert_int_equal(some.orbit.outcome, RIC_ADMISSIBLE);
  assert_true(isnan(all.orbit.clearance) && all.orbit.clearance_particle == -1);
  solved_orbit_clear(&some);
  solved_orbit_clear(&all);
}

/* A violation that only a removed floor would show. */
static void removing_a_floor_makes_an_orbit_admissible(void **state) {
  (void)state;
  double floors[] = {-1, -1, -1, -1, -1, -1, -1};
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, with_floors("...s...", RIC_ENDS_FREE, 0.1, floors));
  assert_int_equal(x.orbit.outcome, RIC_ADMISSIBLE);
  size_t lowest = (size_t)x.orbit.clearance_particle;
  floors[lowest] += x.orbit.clearance + 0.01;
  solved_orbit y = solve_orbit(RIC_METHOD_IMPULSE, with_floors("...s...", RIC_ENDS_FREE, 0.1, floors));
  assert_int_equal(y.orbit.outcome, RIC_INADMISSIBLE);
  assert_close(y.orbit.clearance, -0.01, 1e-11);
  floors[lowest] = -INFINITY;
  solved_orbit z = solve_orbit(RIC_METHOD_IMPULSE, with_floors("...s...", RIC_ENDS_FREE, 0.1, floors));
  assert_int_equal(z.orbit.outcome, RIC_ADMISSIBLE);
  solved_orbit_clear(&x);
  solved_orbit_clear(&y);
  solved_orbit_clear(&z);
}

static void gap_that_just_closes_grazes(void **state) {
  (void)state;
  double floors[] = {-1, -1, -1, -1, -1, -1, -1};
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, with_floors("...s...", RIC_ENDS_FREE, 0.1, floors));
  floors[x.orbit.clearance_particle] += x.orbit.clearance;
  solved_orbit y = solve_orbit(RIC_METHOD_IMPULSE, with_floors("...s...", RIC_ENDS_FREE, 0.1, floors));
  assert_int_equal(y.orbit.outcome, RIC_GRAZING);
  assert_int_equal(y.orbit.mode, -1);
  assert_non_null(strstr(y.orbit.reason, "touches its floor"));
  solved_orbit_clear(&x);
  solved_orbit_clear(&y);
}

/* With every floor at the rest position the equations have the rest state only, which touches. */
static void floors_at_the_rest_position_leave_the_rest_state(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (double gamma = 0; gamma < 0.3; gamma += 0.1) {
      scenario s = scenario_word("s.h..", 1, (ric_ends)ends, gamma, period);
      s.chain.floor = 0;
      solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, s);
      assert_int_equal(x.orbit.outcome, RIC_GRAZING);
      for (size_t i = 0; i < 5; i++)
        assert_true(x.orbit.q[i] == 0 && x.orbit.v[i] == 0);
      assert_close(x.orbit.clearance, 0, 0);
      solved_orbit_clear(&x);
    }
}

/* The equations are linear: floors twice as deep make the orbit twice as large. */
static void orbits_scale_with_the_floor(void **state) {
  (void)state;
  scenario deep = scenario_word("s..h.", 1, RIC_ENDS_FIXED, 0.2, period);
  deep.chain.floor = -4;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s..h.", 1, RIC_ENDS_FIXED, 0.2, period));
  solved_orbit y = solve_orbit(RIC_METHOD_IMPULSE, deep);
  assert_int_equal(x.orbit.outcome, y.orbit.outcome);
  for (size_t i = 0; i < 5; i++)
    assert_close(y.orbit.q[i], 4 * x.orbit.q[i], 1e-13 * solved_orbit_scale(&y));
  assert_close(y.orbit.energy, 16 * x.orbit.energy, 1e-13 * y.orbit.energy);
  assert_close(y.orbit.clearance, 4 * x.orbit.clearance, 2e-12 * solved_orbit_scale(&y));
  solved_orbit_clear(&x);
  solved_orbit_clear(&y);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(floors_at_different_heights_are_met),
      cmocka_unit_test(floors_above_the_rest_position_are_met),
      cmocka_unit_test(particles_without_a_floor_are_not_looked_at),
      cmocka_unit_test(without_free_particles_that_have_a_floor_there_is_no_clearance),
      cmocka_unit_test(removing_a_floor_makes_an_orbit_admissible),
      cmocka_unit_test(gap_that_just_closes_grazes),
      cmocka_unit_test(floors_at_the_rest_position_leave_the_rest_state),
      cmocka_unit_test(orbits_scale_with_the_floor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

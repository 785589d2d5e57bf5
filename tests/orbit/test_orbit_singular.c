/* Singular case (c): no orbit, and amplitudes that blow up nearby. */
#include "support.h"

#include "scenario/example1.h"
#include "witness/solved_orbit.h"

static void singular_gammas(double *points, size_t count) {
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(0.1));
  size_t found;
  assert_int_equal(ric_orbit_singular_points(x.solver, &x.scenario.chain, x.scenario.pattern, RIC_ALONG_GAMMA,
                                             example1_period(), 0.19, 0.2, points, count, &found, NULL),
                   RIC_OK);
  assert_int_equal(found, count);
  solved_orbit_clear(&x);
}

static void singular_points_of_example_1_are_those_known(void **state) {
  (void)state;
  double points[2];
  singular_gammas(points, 2);
  assert_close(points[0], 0.1949776, 5e-8);
  assert_close(points[1], 0.1993134, 5e-8);
}

static void assert_no_orbit(const solved_orbit *x) {
  const ric_orbit *o = &x->orbit;
  assert_int_equal(o->outcome, RIC_SINGULAR);
  assert_true(o->condition > ric_orbit_options_default().singular_condition);
  assert_true(strlen(o->reason) > 0);
  for (size_t i = 0; i < o->particles; i++)
    assert_true(isnan(o->q[i]) && isnan(o->v[i]) && isnan(o->q_half[i]) && isnan(o->v_half[i]));
  for (size_t r = 0; r < o->impacts; r++)
    assert_true(isnan(o->impulse[r]));
  assert_true(isnan(o->energy) && isnan(o->residual) && isnan(o->clearance) && isnan(o->clearance_time));
  assert_int_equal(o->clearance_particle, -1);
  assert_int_equal(o->mode, -1);
}

static void at_a_singular_point_there_is_no_orbit(void **state) {
  (void)state;
  double points[2];
  singular_gammas(points, 2);
  for (size_t k = 0; k < 2; k++) {
    solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, example1_at(points[k]));
    solved_orbit dense = solve_orbit(RIC_METHOD_DENSE, example1_at(points[k]));
    assert_no_orbit(&impulse);
    assert_no_orbit(&dense);
    solved_orbit_clear(&impulse);
    solved_orbit_clear(&dense);
  }
}

static void energy_grows_with_the_inverse_square_of_the_distance(void **state) {
  (void)state;
  double points[2];
  singular_gammas(points, 2);
  for (size_t k = 0; k < 2; k++)
    for (int side = -1; side <= 1; side += 2) {
      solved_orbit far = solve_orbit(RIC_METHOD_IMPULSE, example1_at(points[k] + side * 1e-7));
      solved_orbit near = solve_orbit(RIC_METHOD_IMPULSE, example1_at(points[k] + side * 1e-8));
      double order = log10(near.orbit.energy / far.orbit.energy);
      print_message("energy next to %.7f: distance to the power %.5f\n", points[k], -order);
      assert_close(order, 2, 1e-3); /* resonances are 5e-4 away: corrections of order 1e-7 / 5e-4 */
      solved_orbit_clear(&far);
      solved_orbit_clear(&near);
    }
}

static void states_of_a_singular_orbit_are_refused(void **state) {
  (void)state;
  double points[2], time = 1, q[EXAMPLE1_PARTICLES];
  ric_error error;
  singular_gammas(points, 2);
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(points[0]));
  assert_int_equal(ric_orbit_states(x.solver, &x.scenario.chain, &x.orbit, &time, 1, q, NULL, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "singular"));
  solved_orbit_clear(&x);
}

/* At gamma = 0 the response at the contact, cot(T/2), vanishes for T = pi, 3 pi, ... */
static void uncoupled_particles_have_no_orbit_at_odd_multiples_of_pi(void **state) {
  (void)state;
  for (int odd = 1; odd <= 5; odd += 2)
    for (int method = RIC_METHOD_IMPULSE; method <= RIC_METHOD_DENSE; method++) {
      double period = odd * 3.14159265358979323846;
      solved_orbit x = solve_orbit((ric_orbit_method)method, scenario_word("s.h", 1, RIC_ENDS_FIXED, 0, period));
      assert_no_orbit(&x);
      solved_orbit_clear(&x);
    }
}

/* Two neighbours in phase: every other zero of the determinant belongs to impulses of opposite sign, which the floors
 * do not drive. There the orbit goes on smoothly, and is not unique. */
static void zeros_that_the_floors_do_not_drive_leave_one_of_many_orbits(void **state) {
  (void)state;
  enum { MOST = 16 };
  double points[MOST];
  size_t count, driven = 0, free_impulses = 0;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("ss............................", 1, RIC_ENDS_PERIODIC,
                                                                 0.1, example1_period()));
  assert_int_equal(ric_orbit_singular_points(x.solver, &x.scenario.chain, x.scenario.pattern, RIC_ALONG_GAMMA,
                                             example1_period(), 0, 0.25, points, MOST, &count, NULL),
                   RIC_OK);
  for (size_t k = 0; k < count; k++)
    for (int method = RIC_METHOD_IMPULSE; method <= RIC_METHOD_DENSE; method++) {
      solved_orbit at =
          solve_orbit((ric_orbit_method)method, scenario_word("ss............................", 1, RIC_ENDS_PERIODIC,
                                                              points[k], example1_period()));
      solved_orbit near =
          solve_orbit((ric_orbit_method)method, scenario_word("ss............................", 1, RIC_ENDS_PERIODIC,
                                                              points[k] + 1e-7, example1_period()));
      if (at.orbit.outcome == RIC_SINGULAR) {
        driven++;
        assert_true(near.orbit.energy > 1e6);
      } else {
        free_impulses++;
        assert_int_equal(at.orbit.outcome, RIC_RESONANT);
        assert_int_equal(at.orbit.mode, -1);
        assert_true(at.orbit.condition > 1e9);
        assert_close(at.orbit.impulse[0], at.orbit.impulse[1], 1e-6);
        assert_close(at.orbit.energy, near.orbit.energy, 1e-4 * near.orbit.energy);
      }
      solved_orbit_clear(&at);
      solved_orbit_clear(&near);
    }
  assert_true(driven >= 4 && free_impulses >= 4);
  solved_orbit_clear(&x);
}

static void the_limit_of_the_condition_decides(void **state) {
  (void)state;
  double points[2];
  singular_gammas(points, 2);
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(points[0] + 1e-6));
  assert_true(x.orbit.outcome != RIC_SINGULAR);
  ric_orbit_options options = ric_orbit_options_default();
  options.singular_condition = x.orbit.condition / 2;
  ric_orbit_solver_destroy(&x.solver);
  assert_int_equal(ric_orbit_solver_create(&options, &x.solver, NULL), RIC_OK);
  ric_orbit_clear(&x.orbit);
  assert_int_equal(scenario_solve(&x.scenario, x.solver, &x.orbit, NULL), RIC_OK);
  assert_int_equal(x.orbit.outcome, RIC_SINGULAR);
  solved_orbit_clear(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(singular_points_of_example_1_are_those_known),
      cmocka_unit_test(at_a_singular_point_there_is_no_orbit),
      cmocka_unit_test(energy_grows_with_the_inverse_square_of_the_distance),
      cmocka_unit_test(states_of_a_singular_orbit_are_refused),
      cmocka_unit_test(uncoupled_particles_have_no_orbit_at_odd_multiples_of_pi),
      cmocka_unit_test(zeros_that_the_floors_do_not_drive_leave_one_of_many_orbits),
      cmocka_unit_test(the_limit_of_the_condition_decides),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Values to meet for Example 1 of [JAP], found by two independent programs (a dense matrix exponential and shooting
 * with a Taylor integrator), and large chains that must have them too. */
#include "support.h"

#include "scenario/example1.h"
#include "witness/solved_orbit.h"

static void speed_after_impact_meets_the_reference(void **state) {
  (void)state;
  const struct { double gamma, speed; } values[] = {{0.05, 0.823195058650}, {0.187, 0.178528674603}};
  for (int method = RIC_METHOD_IMPULSE; method <= RIC_METHOD_DENSE; method++)
    for (int k = 0; k < 2; k++) {
      solved_orbit x = solve_orbit((ric_orbit_method)method, example1_at(values[k].gamma));
      assert_close(x.orbit.v[EXAMPLE1_IMPACT], values[k].speed, 1e-12);
      assert_close(x.orbit.impulse[0], 2 * values[k].speed, 2e-12);
      solved_orbit_clear(&x);
    }
}

static void energy_meets_the_reference(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(0.149153131912));
  assert_close(x.orbit.energy, 1.067138152, 1e-9);
  solved_orbit_clear(&x);
}

static void all_orbits_of_the_table_are_admissible(void **state) {
  (void)state;
  for (size_t row = 0; row < EXAMPLE1_TABLE; row++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(example1_gamma(row)));
    assert_int_equal(x.orbit.outcome, RIC_ADMISSIBLE);
    assert_true(x.orbit.clearance > 0 && x.orbit.impulse[0] > 0);
    assert_true(x.orbit.condition >= 1 && x.orbit.condition < 100);
    solved_orbit_clear(&x);
  }
}

/* The infinite chain is reached long before: at gamma = 0.1 the rate is 1.7 per particle. */
static void check_large(size_t n, ric_ends ends) {
  solved_orbit large = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(n, ends, 0.1, example1_period()));
  solved_orbit small = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(61, ends, 0.1, example1_period()));
  assert_int_equal(large.orbit.outcome, RIC_ADMISSIBLE);
  assert_close(large.orbit.impulse[0], small.orbit.impulse[0], 1e-12);
  assert_close(large.orbit.energy, small.orbit.energy, 1e-12);
  assert_close(large.orbit.clearance, small.orbit.clearance, 2e-12);
  assert_true(large.orbit.residual <= 1e-12);
  for (size_t i = 0; i < 61; i++)
    assert_close(large.orbit.q[n / 2 - 30 + i], small.orbit.q[i], 1e-12);
  solved_orbit_clear(&large);
  solved_orbit_clear(&small);
}

static void chains_of_a_hundred_thousand_are_solved_and_certified(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    check_large(100000, (ric_ends)ends);
}

static void chains_of_a_prime_number_of_particles_are_solved_and_certified(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    check_large(100003, (ric_ends)ends);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(speed_after_impact_meets_the_reference),
      cmocka_unit_test(energy_meets_the_reference),
      cmocka_unit_test(all_orbits_of_the_table_are_admissible),
      cmocka_unit_test(chains_of_a_hundred_thousand_are_solved_and_certified),
      cmocka_unit_test(chains_of_a_prime_number_of_particles_are_solved_and_certified),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

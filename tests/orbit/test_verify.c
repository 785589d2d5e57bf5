/* The verifier: closed-form orbits pass; orbits that are not what they promise do not. */
#include "support.h"

#include "witness/recorded_run.h"
#include "witness/solved_orbit.h"

static ric_verification verify(const solved_orbit *x, const ric_verify_options *options) {
  ric_verification v;
  ric_error error = {0};
  if (ric_orbit_verify(x->solver, &x->scenario.chain, &x->orbit, options, &v, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return v;
}

/* Growth of a small difference over one period: the closure error is the error of a step times it. */
static double growth_over_a_period(const solved_orbit *x) {
  const ric_chain *chain = &x->scenario.chain;
  size_t n = chain->particles;
  double quarter = x->orbit.period / 4, *q = calloc(2 * n, sizeof *q), *v = q + n;
  ric_obstacle *floors = calloc(n, sizeof *floors);
  ric_lattice lattice = ric_lattice_of_chain(chain);
  for (size_t i = 0; i < n; i++)
    floors[i] = ric_obstacle_floor(i, ric_chain_floor(chain, i));
  ric_system *system = lattice_system(&lattice, floors, n);
  assert_int_equal(ric_orbit_states(x->solver, chain, &x->orbit, &quarter, 1, q, v, NULL), RIC_OK);
  double growth = growth_of(system, q, v, x->orbit.period);
  ric_system_destroy(&system);
  free(floors);
  free(q);
  return growth;
}

static void random_admissible_orbits_pass(void **state) {
  (void)state;
  random_source source = {.state = 2014};
  scenario_ranges ranges = {.most_particles = 24, .highest_gamma = 0.6, .shortest_period = 3.2, .longest_period = 6.2};
  size_t verified = 0, of_ends[3] = {0};
  double worst = 0;
  while (verified < 1000) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    double least = INFINITY;
    for (size_t k = 0; k < x.orbit.impacts; k++)
      least = fmin(least, x.orbit.impulse[k]);
    /* impacts at least of this strength, gaps at least of this width: else a grazing contact may go either way */
    if (x.orbit.outcome == RIC_ADMISSIBLE && least > 1e-3 && !(x.orbit.clearance < 1e-6) && x.orbit.condition < 1e4) {
      ric_verification v = verify(&x, NULL);
      double bound = 1e-13 * growth_over_a_period(&x) * (1 + solved_orbit_scale(&x)); /* rounding, grown for a period */
      if (v.result != RIC_VERIFIED)
        fail_msg("orbit %zu: %s: %s", verified, ric_verification_name(v.result), v.reason);
      assert_int_equal(v.impacts, x.orbit.impacts);
      worst = fmax(worst, v.closure_error / bound);
      if (!(v.closure_error <= bound))
        fail_msg("orbit %zu: closure error %g, bound %g, condition %g", verified, v.closure_error, bound,
                 x.orbit.condition);
      of_ends[x.scenario.chain.ends]++;
      verified++;
    }
    solved_orbit_clear(&x);
  }
  assert_true(of_ends[0] > 100 && of_ends[1] > 100 && of_ends[2] > 100);
  print_message("[ closure errors at most %.2g of the bound ]\n", worst);
}

static solved_orbit example(void) {
  return solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s...h...", 2, RIC_ENDS_PERIODIC, 0.1, 4.7));
}

static void disturbed_orbit_does_not_close(void **state) {
  (void)state;
  solved_orbit x = example();
  assert_int_equal(verify(&x, NULL).result, RIC_VERIFIED);
  for (size_t i = 0; i < x.orbit.particles; i++)
    x.orbit.q[i] *= i == 2 ? 1 + 1e-5 : 1;
  ric_verification v = verify(&x, NULL);
  assert_true(v.result == RIC_NOT_CLOSED || v.result == RIC_IMPACT_EXTRA || v.result == RIC_IMPACT_MISSING);
  assert_true(v.closure_error > 1e-8);
  assert_true(strlen(v.reason) > 0);
  solved_orbit_clear(&x);
}

static void inadmissible_orbits_are_not_run(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s....h..", 1, RIC_ENDS_PERIODIC, 0.9, 5));
  assert_int_equal(x.orbit.outcome, RIC_INADMISSIBLE);
  ric_verification v = verify(&x, NULL);
  assert_int_equal(v.result, RIC_NOT_RUN);
  assert_true(isnan(v.closure_error));
  solved_orbit_clear(&x);
}

/* A single mass bouncing on a floor at -0.5 from q = 1 on, against predicted impacts. */
static ric_verification of_impacts(const double *times, size_t count, double period) {
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -0.5);
  ric_system *system = lattice_system(&mass, &floor, 1);
  ric_orbit orbit;
  ric_verification v;
  assert_int_equal(ric_orbit_init_for(&orbit, system, count, NULL), RIC_OK);
  orbit.period = period;
  for (size_t k = 0; k < count; k++)
    orbit.impact_time[k] = times[k];
  assert_int_equal(ric_verify(system, &orbit, 0, (double[]){1}, (double[]){0}, NULL, &v, NULL), RIC_OK);
  ric_orbit_clear(&orbit);
  ric_system_destroy(&system);
  return v;
}

static void predicted_impacts_happen_or_are_missed_or_exceeded(void **state) {
  (void)state;
  const double hit = 2 * 3.14159265358979323846 / 3, period = 2 * hit; /* cos t = -0.5 */
  const double late = hit + 0.01, both[2] = {hit, hit + 0.5};
  assert_int_equal(of_impacts(&hit, 1, period).result, RIC_VERIFIED);
  assert_int_equal(of_impacts(NULL, 0, period).result, RIC_IMPACT_EXTRA);
  assert_int_equal(of_impacts(&late, 1, period).result, RIC_IMPACT_EXTRA);
  ric_verification v = of_impacts(both, 2, period);
  assert_int_equal(v.result, RIC_IMPACT_MISSING);
  assert_non_null(strstr(v.reason, "obstacle 0 is not hit at t = 2.594"));
  v = of_impacts(&hit, 1, period + 0.1);
  assert_int_equal(v.result, RIC_NOT_CLOSED);
}

/* What makes no sense is refused; what cannot begin is a finding. */
static void requests_that_make_no_sense_are_refused(void **state) {
  (void)state;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -0.5);
  ric_system *system = lattice_system(&mass, &floor, 1);
  ric_orbit orbit, large;
  ric_verification v;
  const double q[2] = {1, 1}, u[2] = {0, 0}, below = -0.6;
  assert_int_equal(ric_orbit_init_for(&orbit, system, 1, NULL), RIC_OK);
  assert_int_equal(ric_orbit_init(&large, 2, 1, NULL), RIC_OK);
  orbit.impact_time[0] = 1;
  assert_int_equal(ric_verify(system, &orbit, 0, q, u, NULL, &v, NULL), RIC_EINVAL); /* no period */
  orbit.period = large.period = 4;
  assert_int_equal(ric_verify(system, &large, 0, q, u, NULL, &v, NULL), RIC_EINVAL);
  assert_int_equal(ric_verify(system, &orbit, 1, q, u, NULL, &v, NULL), RIC_EINVAL);
  assert_int_equal(ric_verify(system, &orbit, 5, q, u, NULL, &v, NULL), RIC_EINVAL);
  assert_int_equal(ric_verify(system, &orbit, 0, &below, u, NULL, &v, NULL), RIC_OK);
  assert_int_equal(v.result, RIC_RUN_FAILED);
  assert_true(strlen(v.reason) > 0);
  orbit.impact_obstacle[0] = 1;
  assert_int_equal(ric_verify(system, &orbit, 0, q, u, NULL, &v, NULL), RIC_EINVAL);
  ric_orbit_clear(&orbit);
  ric_orbit_clear(&large);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_admissible_orbits_pass),
      cmocka_unit_test(disturbed_orbit_does_not_close),
      cmocka_unit_test(inadmissible_orbits_are_not_run),
      cmocka_unit_test(predicted_impacts_happen_or_are_missed_or_exceeded),
      cmocka_unit_test(requests_that_make_no_sense_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

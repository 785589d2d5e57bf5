/* Admissibility (9): located clearances against dense sampling. */
#include "support.h"

#include "sampled_gaps.h"

enum { PATTERNS = 1000, SAMPLES = 512 };

/* The witness, a sum over at most 24 modes, is itself rounded. */
static const double witness_rounding = 1e-13;

typedef void (*property)(solved_orbit *x, modal_motion *motion, double scale);

static void for_random_orbits(int count, property holds) {
  random_source source = {.state = 3};
  scenario_ranges ranges = {.most_particles = 24, .highest_gamma = 0.8, .shortest_period = 2, .longest_period = 6.5};
  for (int k = 0; k < count; k++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    modal_motion motion = modal_motion_create(&x.scenario.chain);
    if (solved_orbit_has_state(&x)) {
      modal_motion_set(&motion, x.orbit.q, x.orbit.v);
      holds(&x, &motion, solved_orbit_scale(&x));
    }
    modal_motion_clear(&motion);
    solved_orbit_clear(&x);
  }
}

static void check_clearance(solved_orbit *x, modal_motion *motion, double scale) {
  double tolerance = (ric_orbit_options_default().clearance_tol + witness_rounding) * scale;
  sampled_gap sampled = sampled_clearance(x, motion, SAMPLES);
  if (sampled.gap == INFINITY) {
    assert_true(isnan(x->orbit.clearance) && isnan(x->orbit.clearance_time) && x->orbit.clearance_particle == -1);
    return;
  }
  sampled_gap refined = refined_gap(x, motion, sampled, x->orbit.period / 2 / SAMPLES);
  assert_true(x->orbit.clearance <= sampled.gap + tolerance);
  assert_true(x->orbit.clearance <= refined.gap + tolerance);
}

static void clearance_is_never_above_the_sampled_one(void **state) {
  (void)state;
  for_random_orbits(PATTERNS, check_clearance);
}

static void check_attained(solved_orbit *x, modal_motion *motion, double scale) {
  if (x->orbit.clearance_particle < 0)
    return;
  size_t particle = (size_t)x->orbit.clearance_particle;
  double tolerance = (ric_orbit_options_default().clearance_tol + witness_rounding) * scale, q[24];
  assert_true(x->orbit.clearance_time >= 0 && x->orbit.clearance_time <= x->orbit.period / 2);
  assert_int_equal(ric_pattern_role(x->scenario.pattern, particle), RIC_ROLE_FREE);
  assert_close(modal_motion_particle(motion, particle, x->orbit.clearance_time, NULL) + 1, x->orbit.clearance,
               tolerance);
  ric_orbit_states(x->solver, &x->scenario.chain, &x->orbit, &x->orbit.clearance_time, 1, q, NULL, NULL);
  assert_close(q[particle] + 1, x->orbit.clearance, tolerance);
}

static void clearance_is_attained_where_and_when_it_is_reported(void **state) {
  (void)state;
  for_random_orbits(PATTERNS, check_attained);
}

static void check_admissible(solved_orbit *x, modal_motion *motion, double scale) {
  double zero = ric_orbit_options_default().grazing_tol * scale;
  if (x->orbit.outcome != RIC_ADMISSIBLE)
    return;
  for (size_t r = 0; r < x->orbit.impacts; r++)
    assert_true(x->orbit.impulse[r] > zero);
  assert_true(sampled_any(x, motion, 0, x->orbit.period / 2, SAMPLES).gap >= -witness_rounding * scale);
  assert_string_equal(x->orbit.reason, "");
}

static void admissible_orbits_have_positive_impulses_and_no_sampled_violation(void **state) {
  (void)state;
  for_random_orbits(PATTERNS, check_admissible);
}

static void check_inadmissible(solved_orbit *x, modal_motion *motion, double scale) {
  double least = INFINITY, zero = ric_orbit_options_default().grazing_tol * scale;
  if (x->orbit.outcome == RIC_INADMISSIBLE || x->orbit.outcome == RIC_GRAZING)
    return;
  for (size_t r = 0; r < x->orbit.impacts; r++)
    least = fmin(least, x->orbit.impulse[r]);
  assert_true(least > 0 && sampled_any(x, motion, 0, x->orbit.period / 2, SAMPLES).gap > -zero);
}

static void sampled_violations_are_never_called_admissible(void **state) {
  (void)state;
  for_random_orbits(PATTERNS, check_inadmissible);
}

static void check_coarse(solved_orbit *x, modal_motion *motion, double scale) {
  ric_orbit_options options = ric_orbit_options_default();
  solved_orbit coarse = {.scenario = x->scenario};
  (void)motion;
  options.clearance_tol = 1e-3;
  assert_int_equal(ric_orbit_solver_create(&options, &coarse.solver, NULL), RIC_OK);
  assert_int_equal(scenario_solve(&coarse.scenario, coarse.solver, &coarse.orbit, NULL), RIC_OK);
  if (x->orbit.clearance_particle >= 0)
    assert_close(coarse.orbit.clearance, x->orbit.clearance, (1e-3 + 1e-12) * scale);
  coarse.scenario.pattern = NULL; /* belongs to x */
  solved_orbit_clear(&coarse);
}

static void coarse_clearance_lies_within_its_tolerance(void **state) {
  (void)state;
  for_random_orbits(200, check_coarse);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(clearance_is_never_above_the_sampled_one),
      cmocka_unit_test(clearance_is_attained_where_and_when_it_is_reported),
      cmocka_unit_test(admissible_orbits_have_positive_impulses_and_no_sampled_violation),
      cmocka_unit_test(sampled_violations_are_never_called_admissible),
      cmocka_unit_test(coarse_clearance_lies_within_its_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

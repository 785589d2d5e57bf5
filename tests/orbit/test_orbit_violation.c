/* The reason of an inadmissible orbit: which condition fails first, and when, against dense sampling. */
#include "support.h"

#include "sampled_gaps.h"

enum { PATTERNS = 1000, SAMPLES = 512, MOST = 24 };

typedef void (*property)(solved_orbit *x, modal_motion *motion, double zero);

/* Random patterns of few impacts over floors that rise towards the free particles: impulses are positive more often
 * than not, gaps close at any time. `zero` is what counts as zero. */
static void for_random_orbits(property holds) {
  random_source source = {.state = 18};
  scenario_ranges ranges = {
      .most_particles = MOST, .highest_gamma = 0.3, .shortest_period = 3.3, .longest_period = 6.2};
  double floors[MOST];
  for (int k = 0; k < PATTERNS; k++) {
    scenario s = scenario_random(&source, &ranges);
    for (size_t i = 0; i < s.chain.particles; i++)
      floors[i] = ric_pattern_role(s.pattern, i) == RIC_ROLE_FREE ? random_uniform(&source, -1, -0.02) : -1;
    s.chain.floors = floors;
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, s);
    modal_motion motion = modal_motion_create(&x.scenario.chain);
    if (solved_orbit_has_state(&x)) {
      modal_motion_set(&motion, x.orbit.q, x.orbit.v);
      holds(&x, &motion, ric_orbit_options_default().grazing_tol * solved_orbit_scale(&x));
    }
    modal_motion_clear(&motion);
    solved_orbit_clear(&x);
  }
}

static double gap_at(const solved_orbit *x, const modal_motion *motion, size_t particle, double time, double *speed) {
  return modal_motion_particle(motion, particle, time, speed) - ric_chain_floor(&x->scenario.chain, particle);
}

/* Below its floor from the start: no gap closes before. */
static int begins_below(const solved_orbit *x, const modal_motion *motion) {
  size_t particle;
  int read = 0;
  sscanf(x->orbit.reason, "particle %zu is below its floor at t = 0%n", &particle, &read);
  if (read > 0)
    assert_true(gap_at(x, motion, particle, 0, NULL) < 0);
  return read > 0;
}

static int gaps_that_close;

/* The reason names the particle and the time, to six digits, of the first gap that closes. */
static void check_first_gap(solved_orbit *x, modal_motion *motion, double zero) {
  size_t particle;
  double time, half = x->orbit.period / 2;
  if (x->orbit.outcome != RIC_INADMISSIBLE || begins_below(x, motion) ||
      sscanf(x->orbit.reason, "particle %zu passes its floor at t = %lf", &particle, &time) != 2)
    return;
  double printed = 1e-5 * time, speed, gap = gap_at(x, motion, particle, time, &speed), lowest = INFINITY;
  double bound = modal_motion_bound(motion, 2) * printed;
  assert_close(gap, 0, fmax(fabs(speed), bound) * printed + 2 * zero);
  assert_true(sampled_any(x, motion, 0, time - printed, SAMPLES).gap > -2 * zero);
  for (int k = 1; k <= 400; k++)
    lowest = fmin(lowest, gap_at(x, motion, particle, time + (half - time) * pow(k / 400.0, 4), NULL));
  assert_true(lowest < 0);
  gaps_that_close++;
}

static void first_violation_is_where_sampling_finds_it(void **state) {
  (void)state;
  gaps_that_close = 0;
  for_random_orbits(check_first_gap);
  print_message("%d orbits with a gap that closes after the start\n", gaps_that_close);
  assert_true(gaps_that_close > PATTERNS / 20);
}

/* Every inadmissible orbit says what is wrong with it in one of three ways. */
static void check_reason(solved_orbit *x, modal_motion *motion, double zero) {
  (void)motion, (void)zero;
  if (x->orbit.outcome == RIC_INADMISSIBLE)
    assert_true(strstr(x->orbit.reason, "passes its floor") || strstr(x->orbit.reason, "is below its floor") ||
                strstr(x->orbit.reason, "must be positive"));
}

static void inadmissible_orbits_say_why(void **state) {
  (void)state;
  for_random_orbits(check_reason);
}

/* An impulse at t = 0 with the wrong sign comes before any gap. */
static void check_first_impulse(solved_orbit *x, modal_motion *motion, double zero) {
  (void)motion;
  int wrong = 0, read = 0;
  size_t particle;
  for (size_t r = 0; r < x->orbit.impacts; r++)
    if (ric_pattern_role(x->scenario.pattern, ric_pattern_impact(x->scenario.pattern, r)) == RIC_ROLE_START)
      wrong = wrong || x->orbit.impulse[r] < -zero;
  sscanf(x->orbit.reason, "impulse of particle %zu at t = 0 is%n", &particle, &read);
  if (read > 0)
    assert_true(impulse_of(x, particle) < -zero);
  if (x->orbit.outcome == RIC_INADMISSIBLE)
    assert_int_equal(read > 0, wrong);
}

static void wrong_impulses_at_the_start_are_named_first(void **state) {
  (void)state;
  for_random_orbits(check_first_impulse);
}

static int smallest_gaps;

/* The smallest gap in the reason is that of the particle then, and none of the free particles is smaller. */
static void check_smallest_gap(solved_orbit *x, modal_motion *motion, double zero) {
  const char *part = strstr(x->orbit.reason, "smallest gap ");
  double gap, time;
  size_t particle;
  if (!part)
    return;
  assert_int_equal(sscanf(part, "smallest gap %lf, particle %zu at t = %lf", &gap, &particle, &time), 3);
  double printed = 1e-5 * x->orbit.period, speed, there = gap_at(x, motion, particle, time, &speed);
  assert_close(gap, there, 1e-5 * fabs(gap) + (fabs(speed) + modal_motion_bound(motion, 2) * printed) * printed + zero);
  assert_true(isnan(x->orbit.clearance) || gap <= x->orbit.clearance + 1e-5 * fabs(gap));
  smallest_gaps++;
}

static void smallest_gap_in_the_reason_is_that_of_the_motion(void **state) {
  (void)state;
  smallest_gaps = 0;
  for_random_orbits(check_smallest_gap);
  assert_true(smallest_gaps > PATTERNS / 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_violation_is_where_sampling_finds_it),
      cmocka_unit_test(inadmissible_orbits_say_why),
      cmocka_unit_test(wrong_impulses_at_the_start_are_named_first),
      cmocka_unit_test(smallest_gap_in_the_reason_is_that_of_the_motion),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

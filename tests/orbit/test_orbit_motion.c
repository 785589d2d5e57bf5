/* Every orbit with a state solves the equations: its motion, its contacts, its symmetry. */
#include "support.h"

#include "witness/modal_motion.h"
#include "witness/solved_orbit.h"

enum { MOST = 24, ORBITS = 200 };

/* States come from a few Taylor steps and modal sums of at most MOST terms: rounding stays below this share of the
 * amplitude. */
static const double rounding = 1e-12;

typedef void (*property)(solved_orbit *x, modal_motion *motion, double amplitude);

/* Holds a property against random orbits. `motion` starts from the orbit's state at t = 0+. */
static void for_random_orbits(property holds) {
  random_source source = {.state = 2};
  scenario_ranges ranges = {.most_particles = MOST, .highest_gamma = 1.5, .shortest_period = 0.5, .longest_period = 7};
  for (int k = 0; k < ORBITS; k++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    modal_motion motion = modal_motion_create(&x.scenario.chain);
    if (solved_orbit_has_state(&x)) {
      modal_motion_set(&motion, x.orbit.q, x.orbit.v);
      holds(&x, &motion, modal_motion_bound(&motion, 1));
    }
    modal_motion_clear(&motion);
    solved_orbit_clear(&x);
  }
}

static void states_at(solved_orbit *x, const double *times, size_t count, double *q, double *v) {
  ric_error error;
  if (ric_orbit_states(x->solver, &x->scenario.chain, &x->orbit, times, count, q, v, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

static void check_contacts(solved_orbit *x, modal_motion *motion, double amplitude) {
  (void)motion;
  for (size_t i = 0; i < x->orbit.particles; i++) {
    ric_role role = ric_pattern_role(x->scenario.pattern, i);
    if (role == RIC_ROLE_START)
      assert_close(x->orbit.q[i], -1, rounding * amplitude);
    else
      assert_close(x->orbit.v[i], 0, 0);
    if (role == RIC_ROLE_HALF)
      assert_close(x->orbit.q_half[i], -1, rounding * amplitude);
    else
      assert_close(x->orbit.v_half[i], 0, 0);
  }
}

static void contact_and_rest_conditions_hold_at_both_ends(void **state) {
  (void)state;
  for_random_orbits(check_contacts);
}

static void reverse(const solved_orbit *x, ric_role role, double *v) {
  for (size_t i = 0; i < x->orbit.particles; i++)
    if (ric_pattern_role(x->scenario.pattern, i) == role)
      v[i] = -v[i];
}

static void assert_states_close(const double *a, const double *b, size_t n, double tolerance) {
  for (size_t i = 0; i < n; i++)
    assert_close(a[i], b[i], tolerance);
}

static void check_closing(solved_orbit *x, modal_motion *motion, double amplitude) {
  size_t n = x->orbit.particles;
  double q[MOST], v[MOST];
  modal_motion_state(motion, x->orbit.period / 2, q, v);
  assert_states_close(q, x->orbit.q_half, n, rounding * amplitude);
  assert_states_close(v, x->orbit.v_half, n, rounding * amplitude);
  reverse(x, RIC_ROLE_HALF, v);
  modal_motion_set(motion, q, v);
  modal_motion_state(motion, x->orbit.period / 2, q, v);
  reverse(x, RIC_ROLE_START, v);
  assert_states_close(q, x->orbit.q, n, rounding * amplitude);
  assert_states_close(v, x->orbit.v, n, rounding * amplitude);
}

static void orbit_closes_after_free_motion_and_reversals(void **state) {
  (void)state;
  for_random_orbits(check_closing);
}

static void check_states(solved_orbit *x, modal_motion *motion, double amplitude) {
  enum { TIMES = 33 };
  size_t n = x->orbit.particles;
  double times[TIMES], q[TIMES * MOST], v[TIMES * MOST], exact_q[MOST], exact_v[MOST], half = x->orbit.period / 2;
  for (int a = 0; a < TIMES; a++)
    times[a] = x->orbit.period * ((a * 7) % TIMES + 0.5) / TIMES; /* out of order */
  states_at(x, times, TIMES, q, v);
  modal_motion later = modal_motion_create(&x->scenario.chain);
  modal_motion_state(motion, half, exact_q, exact_v);
  reverse(x, RIC_ROLE_HALF, exact_v);
  modal_motion_set(&later, exact_q, exact_v);
  for (size_t a = 0; a < TIMES; a++) {
    int second = times[a] >= half;
    modal_motion_state(second ? &later : motion, second ? times[a] - half : times[a], exact_q, exact_v);
    assert_states_close(q + a * n, exact_q, n, rounding * amplitude);
    assert_states_close(v + a * n, exact_v, n, rounding * amplitude);
  }
  modal_motion_clear(&later);
}

static void states_follow_the_modes_over_the_whole_period(void **state) {
  (void)state;
  for_random_orbits(check_states);
}

/* Fourth-order differences with step h: the truncation error is h^4 / 90 of the sixth derivative and h^4 / 30 of the
 * fifth, rounding is 64 / 12 units of the amplitude over h^2. */
static void check_equation_of_motion(solved_orbit *x, modal_motion *motion, double amplitude) {
  enum { POINTS = 5 };
  const double h = 0.004;
  size_t n = x->orbit.particles;
  double times[POINTS], q[POINTS * MOST], v[POINTS * MOST], a[MOST];
  double error = pow(h, 4) / 30 * modal_motion_bound(motion, 6) + 1e-15 * amplitude * 6 / (h * h);
  for (int side = 0; side < 2; side++) {
    double centre = x->orbit.period * (0.19 + side * 0.6);
    for (int k = 0; k < POINTS; k++)
      times[k] = centre + (k - 2) * h;
    states_at(x, times, POINTS, q, v);
    ric_chain_acceleration(&x->scenario.chain, q + 2 * n, a);
    for (size_t i = 0; i < n; i++) {
      const double *p = q + i;
      double curvature = (-p[0] + 16 * p[n] - 30 * p[2 * n] + 16 * p[3 * n] - p[4 * n]) / (12 * h * h);
      double slope = (p[0] - 8 * p[n] + 8 * p[3 * n] - p[4 * n]) / (12 * h);
      assert_close(curvature, a[i], error);
      assert_close(slope, v[2 * n + i], error);
    }
  }
}

static void differences_of_states_satisfy_the_equation_of_motion(void **state) {
  (void)state;
  for_random_orbits(check_equation_of_motion);
}

static void check_energy(solved_orbit *x, modal_motion *motion, double amplitude) {
  (void)motion, (void)amplitude;
  enum { TIMES = 16 };
  size_t n = x->orbit.particles;
  double times[TIMES], q[TIMES * MOST], v[TIMES * MOST];
  for (int a = 0; a < TIMES; a++)
    times[a] = x->orbit.period * a / TIMES;
  states_at(x, times, TIMES, q, v);
  for (size_t a = 0; a < TIMES; a++)
    assert_close(ric_chain_energy(&x->scenario.chain, q + a * n, v + a * n), x->orbit.energy,
                 rounding * x->orbit.energy);
}

static void energy_is_constant_along_the_orbit(void **state) {
  (void)state;
  for_random_orbits(check_energy);
}

/* Velocities of an impacting particle just before and at its impact. */
static void check_jump(solved_orbit *x, modal_motion *motion, double amplitude) {
  (void)motion;
  size_t n = x->orbit.particles;
  double at[2] = {0, x->orbit.period / 2}, before[2] = {nextafter(x->orbit.period, 0), nextafter(at[1], 0)};
  double q[2 * MOST], v[2 * MOST], q_before[2 * MOST], v_before[2 * MOST];
  states_at(x, at, 2, q, v);
  states_at(x, before, 2, q_before, v_before);
  for (size_t side = 0; side < 2; side++)
    for (size_t i = 0; i < n; i++) {
      ric_role role = ric_pattern_role(x->scenario.pattern, i);
      int hits = role == (side == 0 ? RIC_ROLE_START : RIC_ROLE_HALF);
      size_t e = side * n + i;
      assert_close(q[e], q_before[e], rounding * amplitude);
      assert_close(v[e] - v_before[e], hits ? impulse_of(x, i) : 0, rounding * amplitude);
      if (hits)
        assert_close(v[e], -v_before[e], rounding * amplitude);
    }
}

static void velocities_are_reversed_and_jump_by_the_impulses(void **state) {
  (void)state;
  for_random_orbits(check_jump);
}

static void check_periodicity(solved_orbit *x, modal_motion *motion, double amplitude) {
  (void)amplitude;
  size_t n = x->orbit.particles;
  double T = x->orbit.period, t = 0.3 * T, q[5 * MOST], v[5 * MOST];
  double times[5] = {t, t - T, t + T, t - 37 * T, t + 1000 * T};
  states_at(x, times, 5, q, v);
  double tolerance = rounding * modal_motion_bound(motion, 2) * 100; /* the time itself is rounded, to 1000 T eps */
  for (size_t a = 1; a < 5; a++) {
    assert_states_close(q + a * n, q, n, tolerance);
    assert_states_close(v + a * n, v, n, tolerance);
  }
}

static void states_repeat_with_the_period_at_any_time(void **state) {
  (void)state;
  for_random_orbits(check_periodicity);
}

static void check_evenness(solved_orbit *x, modal_motion *motion, double amplitude) {
  (void)motion;
  size_t n = x->orbit.particles;
  double T = x->orbit.period, q[4 * MOST], v[4 * MOST];
  double times[4] = {0.2 * T, -0.2 * T, 0.7 * T, 0.3 * T};
  states_at(x, times, 4, q, v);
  for (size_t i = 0; i < n; i++) {
    assert_close(q[i], q[n + i], rounding * amplitude);
    assert_close(v[i], -v[n + i], rounding * amplitude);
    assert_close(q[2 * n + i], q[3 * n + i], rounding * amplitude);
    assert_close(v[2 * n + i], -v[3 * n + i], rounding * amplitude);
  }
}

static void orbits_are_even_about_both_impact_times(void **state) {
  (void)state;
  for_random_orbits(check_evenness);
}

static void check_residual(solved_orbit *x, modal_motion *motion, double amplitude) {
  (void)motion;
  assert_true(x->orbit.residual >= 0 && x->orbit.residual <= rounding * amplitude);
}

static void residual_is_rounding(void **state) {
  (void)state;
  for_random_orbits(check_residual);
}

static void velocities_may_be_left_out(void **state) {
  (void)state;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(7, RIC_ENDS_FREE, 0.1, 5));
  double times[2] = {0.4, 4}, q[14], only[14], v[14];
  states_at(&x, times, 2, q, v);
  states_at(&x, times, 2, only, NULL);
  assert_memory_equal(q, only, sizeof q);
  solved_orbit_clear(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contact_and_rest_conditions_hold_at_both_ends),
      cmocka_unit_test(orbit_closes_after_free_motion_and_reversals),
      cmocka_unit_test(states_follow_the_modes_over_the_whole_period),
      cmocka_unit_test(differences_of_states_satisfy_the_equation_of_motion),
      cmocka_unit_test(energy_is_constant_along_the_orbit),
      cmocka_unit_test(velocities_are_reversed_and_jump_by_the_impulses),
      cmocka_unit_test(states_repeat_with_the_period_at_any_time),
      cmocka_unit_test(orbits_are_even_about_both_impact_times),
      cmocka_unit_test(residual_is_rounding),
      cmocka_unit_test(velocities_may_be_left_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Singular case (b): a mode at resonance that vanishes at every contact. */
#include "support.h"

#include "witness/modal_motion.h"
#include "witness/solved_orbit.h"

enum { MOST = 13, HARMONICS = 3 };

static const double pi = 3.14159265358979323846;

/* Periods at which the modes of frequency above 1 can have one, two and three oscillations. */
static const double periods[HARMONICS] = {5, 9, 9};

/* A free chain with an odd number of particles: its antisymmetric modes, odd j, vanish in the middle. */
typedef struct hidden {
  size_t n, mode;
  unsigned harmonic;
} hidden;

static double resonant_gamma(hidden h) {
  double frequency = 2 * pi * h.harmonic / periods[h.harmonic - 1], s = sin(pi * (double)h.mode / (double)h.n / 2);
  return (frequency * frequency - 1) / (4 * s * s);
}

static solved_orbit with_hidden_mode(ric_orbit_method method, hidden h, double distance) {
  return solve_orbit(method,
                     scenario_middle(h.n, RIC_ENDS_FREE, resonant_gamma(h) + distance, periods[h.harmonic - 1]));
}

static void for_all_hidden_modes(void (*holds)(hidden h, solved_orbit *x)) {
  for (size_t n = 3; n <= MOST; n += 2)
    for (size_t mode = 1; mode < n; mode += 2)
      for (unsigned harmonic = 1; harmonic <= HARMONICS; harmonic++) {
        hidden h = {.n = n, .mode = mode, .harmonic = harmonic};
        solved_orbit x = with_hidden_mode(RIC_METHOD_IMPULSE, h, 0);
        holds(h, &x);
        solved_orbit_clear(&x);
      }
}

static void check_report(hidden h, solved_orbit *x) {
  solved_orbit dense = with_hidden_mode(RIC_METHOD_DENSE, h, 0);
  const ric_orbit *orbits[] = {&x->orbit, &dense.orbit};
  for (int k = 0; k < 2; k++) {
    assert_int_equal(orbits[k]->outcome, RIC_RESONANT);
    assert_int_equal(orbits[k]->mode, h.mode);
    assert_int_equal(orbits[k]->harmonic, h.harmonic);
    assert_true(strlen(orbits[k]->reason) > 0);
  }
  solved_orbit_clear(&dense);
}

static void hidden_mode_at_resonance_is_reported_by_both_methods(void **state) {
  (void)state;
  for_all_hidden_modes(check_report);
}

static void reverse(const solved_orbit *x, ric_role role, double *v) {
  for (size_t i = 0; i < x->orbit.particles; i++)
    if (ric_pattern_role(x->scenario.pattern, i) == role)
      v[i] = -v[i];
}

/* Whether a state at t = 0+ returns after free motion and the reversals of the pattern, with its contacts. */
static void assert_periodic(const solved_orbit *x, const double *q, const double *v) {
  size_t n = x->orbit.particles, middle = n / 2;
  double q_end[MOST], v_end[MOST];
  modal_motion motion = modal_motion_create(&x->scenario.chain);
  modal_motion_set(&motion, q, v);
  double tolerance = 1e-12 * modal_motion_bound(&motion, 1);
  modal_motion_state(&motion, x->orbit.period, q_end, v_end);
  reverse(x, RIC_ROLE_START, v_end);
  assert_close(q[middle], -1, tolerance);
  for (size_t i = 0; i < n; i++) {
    assert_close(q_end[i], q[i], tolerance);
    assert_close(v_end[i], v[i], tolerance);
  }
  modal_motion_clear(&motion);
}

static void check_any_amplitude(hidden h, solved_orbit *x) {
  for (int amplitude = -2; amplitude <= 2; amplitude++) {
    double q[MOST];
    for (size_t i = 0; i < h.n; i++)
      q[i] = x->orbit.q[i] + amplitude * ric_chain_mode_shape(&x->scenario.chain, h.mode, i);
    assert_periodic(x, q, x->orbit.v);
  }
}

static void any_amplitude_of_the_hidden_mode_solves_the_equations(void **state) {
  (void)state;
  for_all_hidden_modes(check_any_amplitude);
}

static void check_no_amplitude(hidden h, solved_orbit *x) {
  double amplitude = 0;
  for (size_t i = 0; i < h.n; i++)
    amplitude += x->orbit.q[i] * ric_chain_mode_shape(&x->scenario.chain, h.mode, i);
  assert_close(amplitude, 0, 1e-12 * fmax(1, solved_orbit_scale(x)) * (double)h.n);
}

static void the_orbit_given_has_none_of_the_hidden_mode(void **state) {
  (void)state;
  for_all_hidden_modes(check_no_amplitude);
}

/* Nothing happens to the orbit itself as its coupling passes the resonance of a mode that it does not contain. */
static void the_orbit_is_continuous_across_the_resonance(void **state) {
  (void)state;
  const hidden h = {.n = 7, .mode = 5, .harmonic = 1};
  solved_orbit at = with_hidden_mode(RIC_METHOD_IMPULSE, h, 0);
  solved_orbit left = with_hidden_mode(RIC_METHOD_IMPULSE, h, -1e-7);
  solved_orbit right = with_hidden_mode(RIC_METHOD_IMPULSE, h, 1e-7);
  double across = state_difference(&left.orbit, &right.orbit);
  assert_true(left.orbit.outcome != RIC_RESONANT && right.orbit.outcome != RIC_RESONANT);
  for (size_t i = 0; i < h.n; i++)
    assert_close(at.orbit.q[i], (left.orbit.q[i] + right.orbit.q[i]) / 2,
                 across * 1e-3 + 1e-12 * solved_orbit_scale(&at));
  solved_orbit_clear(&at);
  solved_orbit_clear(&left);
  solved_orbit_clear(&right);
}

/* On a ring of 12 with an impact of every third particle, modes that do not repeat with the pattern are at resonance
 * without vanishing at the contacts: the orbit is unique and no different from the orbit of a ring of 3. */
static void resonances_that_the_contacts_see_leave_a_periodic_pattern_alone(void **state) {
  (void)state;
  const double period = 5;
  ric_chain ring = ric_chain_default(12, 0);
  ric_resonance list[64];
  size_t count;
  int seen = 0;
  assert_int_equal(ric_chain_resonances(&ring, RIC_ALONG_GAMMA, period, 0, 5, list, 64, &count, NULL), RIC_OK);
  for (size_t k = 0; k < count; k++) {
    if (list[k].mode % 2 == 0) /* in the small ring, or hidden */
      continue;
    solved_orbit full =
        solve_orbit(RIC_METHOD_DENSE, scenario_word("s..", 4, RIC_ENDS_PERIODIC, list[k].parameter, period));
    solved_orbit cell =
        solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s..", 4, RIC_ENDS_PERIODIC, list[k].parameter, period));
    assert_true(cell.orbit.outcome != RIC_RESONANT && cell.orbit.outcome != RIC_GRAZING);
    assert_int_equal(full.orbit.outcome, cell.orbit.outcome);
    assert_true(state_difference(&full.orbit, &cell.orbit) <= method_tolerance(&full));
    seen++;
    solved_orbit_clear(&full);
    solved_orbit_clear(&cell);
  }
  assert_true(seen > 0);
}

/* The sine of the pair about the impact is free, the cosine is excited: the vanishing impulses name the outcome. */
static void one_mode_of_a_pair_hides_from_a_single_impact_on_a_ring(void **state) {
  (void)state;
  const double period = 5;
  ric_chain ring = ric_chain_default(9, 0);
  ric_resonance list[64];
  size_t count;
  assert_int_equal(ric_chain_resonances(&ring, RIC_ALONG_GAMMA, period, 0, 2, list, 64, &count, NULL), RIC_OK);
  assert_true(count > 0);
  for (size_t k = 0; k < count; k++) {
    solved_orbit x =
        solve_orbit(RIC_METHOD_IMPULSE, scenario_single(9, RIC_ENDS_PERIODIC, list[k].parameter, period, 4));
    assert_int_equal(x.orbit.outcome, RIC_GRAZING);
    assert_periodic(&x, x.orbit.q, x.orbit.v);
    solved_orbit_clear(&x);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(hidden_mode_at_resonance_is_reported_by_both_methods),
      cmocka_unit_test(any_amplitude_of_the_hidden_mode_solves_the_equations),
      cmocka_unit_test(the_orbit_given_has_none_of_the_hidden_mode),
      cmocka_unit_test(the_orbit_is_continuous_across_the_resonance),
      cmocka_unit_test(resonances_that_the_contacts_see_leave_a_periodic_pattern_alone),
      cmocka_unit_test(one_mode_of_a_pair_hides_from_a_single_impact_on_a_ring),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

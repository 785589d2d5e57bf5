/* Singular case (a): a mode that the pattern excites is at resonance. */
#include "support.h"

#include "witness/modal_motion.h"
#include "scenario/example1.h"
#include "witness/solved_orbit.h"

static double alternating(size_t i) {
  return i % 2 == EXAMPLE1_IMPACT % 2 ? -1 : 1;
}

static void at_gamma_c_the_orbit_is_the_out_of_phase_mode_touching_the_floor(void **state) {
  (void)state;
  ric_orbit_options options = ric_orbit_options_default();
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(7.0 / 36));
  assert_int_equal(x.orbit.outcome, RIC_GRAZING);
  assert_int_equal(x.orbit.mode, 15);
  assert_int_equal(x.orbit.harmonic, 1);
  assert_true(strlen(x.orbit.reason) > 0);
  assert_close(x.orbit.impulse[0], 0, options.grazing_tol);
  assert_close(x.orbit.clearance, 0, options.grazing_tol);
  for (size_t i = 0; i < EXAMPLE1_PARTICLES; i++) {
    assert_close(x.orbit.q[i], alternating(i), options.grazing_tol);
    assert_close(x.orbit.q_half[i], -alternating(i), options.grazing_tol);
    assert_close(x.orbit.v[i], 0, options.grazing_tol);
    assert_close(x.orbit.v_half[i], 0, options.grazing_tol);
  }
  double energy = 0.5 * EXAMPLE1_PARTICLES * pow(4.0 / 3, 2); /* n omega^2 / 2 with omega = 2 pi / T = 4/3 */
  assert_close(x.orbit.energy, energy, 1e-9);
  solved_orbit_clear(&x);
}

static double impulse_at(double gamma) {
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(gamma));
  double impulse = x.orbit.impulse[0];
  solved_orbit_clear(&x);
  return impulse;
}

/* On the left the impulse is positive; the next singular point, 5e-4 to the right, bends the line on the scale of that
 * distance. */
static void impulses_vanish_linearly_towards_gamma_c(void **state) {
  (void)state;
  double previous = impulse_at(7.0 / 36 - 1e-5);
  for (int k = 6; k <= 9; k++) {
    double distance = pow(10, -k), impulse = impulse_at(7.0 / 36 - distance);
    double order = log10(previous / impulse);
    print_message("distance 1e-%d: impulse %.6g, order %.6f\n", k, impulse, order);
    assert_true(impulse > 0);
    assert_close(order, 1, 10 * distance / 5e-4 + 1e-6);
    previous = impulse;
  }
}

static void orbits_tend_to_the_linear_mode_from_both_sides(void **state) {
  (void)state;
  solved_orbit limit = solve_orbit(RIC_METHOD_IMPULSE, example1_at(7.0 / 36));
  for (int side = -1; side <= 1; side += 2) {
    double previous = 0;
    for (int k = 6; k <= 8; k++) {
      solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(7.0 / 36 + side * pow(10, -k)));
      double distance = state_difference(&x.orbit, &limit.orbit);
      if (previous > 0)
        assert_close(log10(previous / distance), 1, 0.01);
      previous = distance;
      solved_orbit_clear(&x);
    }
  }
  solved_orbit_clear(&limit);
}

static void method_of_reference_reaches_the_limit_too(void **state) {
  (void)state;
  solved_orbit impulse = solve_orbit(RIC_METHOD_IMPULSE, example1_at(7.0 / 36));
  solved_orbit dense = solve_orbit(RIC_METHOD_DENSE, example1_at(7.0 / 36));
  assert_int_equal(dense.orbit.outcome, RIC_GRAZING);
  assert_int_equal(dense.orbit.mode, 15);
  assert_true(state_difference(&impulse.orbit, &dense.orbit) <= method_tolerance(&dense));
  solved_orbit_clear(&impulse);
  solved_orbit_clear(&dense);
}

static void later_resonances_of_the_ring_graze_too(void **state) {
  (void)state;
  ric_chain chain = ric_chain_default(EXAMPLE1_PARTICLES, 0);
  ric_resonance list[64];
  size_t count;
  assert_int_equal(ric_chain_resonances(&chain, RIC_ALONG_GAMMA, example1_period(), 0.19, 0.5, list, 64, &count, NULL),
                   RIC_OK);
  assert_true(count > 10 && count <= 64);
  assert_close(list[1].parameter, 0.196592, 5e-7);
  for (size_t k = 0; k < count; k++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, example1_at(list[k].parameter));
    size_t partner = (EXAMPLE1_PARTICLES - list[k].mode) % EXAMPLE1_PARTICLES;
    assert_int_equal(x.orbit.outcome, RIC_GRAZING);
    assert_true((size_t)x.orbit.mode == list[k].mode || (size_t)x.orbit.mode == partner);
    assert_int_equal(x.orbit.harmonic, list[k].harmonic);
    assert_close(impulse_of(&x, EXAMPLE1_IMPACT), 0, ric_orbit_options_default().grazing_tol * solved_orbit_scale(&x));
    assert_close(x.orbit.q[EXAMPLE1_IMPACT], -1, 1e-12);
    solved_orbit_clear(&x);
  }
}

/* At a resonance of any chain: the motion without impulses, checked by the modes, must close after T/2 and touch. */
static void check_mode_orbit(size_t n, ric_ends ends, size_t particle, size_t mode, double period) {
  ric_chain chain = ric_chain_default(n, 0);
  ric_resonance list[64];
  size_t count;
  chain.ends = ends;
  assert_int_equal(ric_chain_resonances(&chain, RIC_ALONG_GAMMA, period, 0, 3, list, 64, &count, NULL), RIC_OK);
  for (size_t k = 0; k < count; k++) {
    chain.gamma = list[k].parameter;
    if (list[k].mode != mode || fabs(ric_chain_mode_shape(&chain, mode, particle)) < 1e-3)
      continue;
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_single(n, ends, chain.gamma, period, particle));
    double amplitude = -1 / ric_chain_mode_shape(&chain, mode, particle);
    double sign = list[k].harmonic % 2 == 1 ? -1 : 1, tolerance = 1e-10 * solved_orbit_scale(&x);
    assert_int_equal(x.orbit.outcome == RIC_GRAZING || x.orbit.outcome == RIC_INADMISSIBLE, 1);
    for (size_t i = 0; i < n; i++) {
      double q = amplitude * ric_chain_mode_shape(&chain, mode, i);
      assert_close(x.orbit.q[i], q, tolerance);
      assert_close(x.orbit.q_half[i], sign * q, tolerance);
      assert_close(x.orbit.v[i], 0, tolerance);
    }
    solved_orbit_clear(&x);
  }
}

static void simple_resonances_of_chains_with_ends_give_their_mode(void **state) {
  (void)state;
  for (size_t mode = 0; mode < 8; mode++)
    for (size_t particle = 0; particle < 8; particle++) {
      check_mode_orbit(8, RIC_ENDS_FIXED, particle, mode, 4.3);
      check_mode_orbit(8, RIC_ENDS_FREE, particle, mode, 4.3);
    }
}

static void uncoupled_particles_at_their_own_period_graze(void **state) {
  (void)state;
  const double period = 6.28318530717958647692;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t n = 1; n <= 5; n++) {
      solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(n, (ric_ends)ends, 0, period));
      assert_int_equal(x.orbit.outcome, RIC_GRAZING);
      assert_int_equal(x.orbit.harmonic, 1);
      assert_close(x.orbit.impulse[0], 0, 1e-10);
      assert_close(x.orbit.q[n / 2], -1, 1e-10);
      assert_close(x.orbit.q_half[n / 2], 1, 1e-10);
      for (size_t i = 0; i < n; i++)
        if (i != n / 2)
          assert_close(x.orbit.q[i], 0, 1e-10);
      solved_orbit_clear(&x);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(at_gamma_c_the_orbit_is_the_out_of_phase_mode_touching_the_floor),
      cmocka_unit_test(impulses_vanish_linearly_towards_gamma_c),
      cmocka_unit_test(orbits_tend_to_the_linear_mode_from_both_sides),
      cmocka_unit_test(method_of_reference_reaches_the_limit_too),
      cmocka_unit_test(later_resonances_of_the_ring_graze_too),
      cmocka_unit_test(simple_resonances_of_chains_with_ends_give_their_mode),
      cmocka_unit_test(uncoupled_particles_at_their_own_period_graze),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The determinant behind the large chains, and what it takes. */
#include "support.h"

#include "floquet/determinant.h"
#include "floquet/orbit_multipliers.h"
#include "scenario/scenario.h"
#include "numeric/complex_number.h"

/* An orbit with its determinant and its reduced matrix. */
typedef struct prepared {
  scenario s;
  ric_orbit_solver *solver;
  orbit_spectrum *spectrum;
  ric_orbit orbit;
} prepared;

static prepared prepare(scenario s) {
  prepared p = {.s = s};
  size_t grazing;
  assert_int_equal(ric_orbit_solver_create(NULL, &p.solver, NULL), RIC_OK);
  assert_int_equal(scenario_solve(&p.s, p.solver, &p.orbit, NULL), RIC_OK);
  assert_int_equal(orbit_spectrum_of(p.solver, &p.spectrum, NULL), RIC_OK);
  assert_int_equal(orbit_impacts_find(&p.spectrum->impacts, &s.chain, s.pattern, &p.orbit, 1e-10, &grazing, NULL),
                   RIC_OK);
  assert_int_equal(secular_prepare(&p.spectrum->secular, &s.chain, &p.spectrum->impacts, s.period, NULL), RIC_OK);
  return p;
}

static void discard(prepared *p) {
  ric_orbit_clear(&p->orbit);
  ric_orbit_solver_destroy(&p->solver);
  scenario_clear(&p->s);
}

static const scenario_ranges ranges = {
    .most_particles = 30, .highest_gamma = 0.5, .shortest_period = 3.3, .longest_period = 6.2};

/* log of prod (alpha - alpha_i) / prod (alpha - cos w_j T), without the trivial alpha. */
static double complex log_product(const prepared *p, double complex alpha) {
  size_t n = p->s.chain.particles;
  double complex sum = 0;
  for (size_t i = 0; i + 1 < n; i++)
    sum += clog(alpha - CMPLX(p->spectrum->reduced.spectrum.alpha[i].re, p->spectrum->reduced.spectrum.alpha[i].im));
  for (size_t j = 0; j < n; j++)
    sum -= clog(alpha - cos(p->spectrum->secular.poles[j].angle));
  return sum;
}

static void determinant_is_the_product_over_multipliers_and_modes(void **state) {
  (void)state;
  random_source source = {.state = 31};
  double worst = 0;
  for (int i = 0; i < 100; i++) {
    prepared p = prepare(scenario_few(&source, &ranges, 6));
    assert_int_equal(reduced_compute(&p.spectrum->reduced, &p.s.chain, &p.spectrum->impacts, &p.orbit, NULL), RIC_OK);
    for (int k = 0; k < 5; k++) {
      double complex zeta = CMPLX(random_uniform(&source, 0.05, 1), random_uniform(&source, 0, 3.1));
      double complex ratio = cexp(secular_log(&p.spectrum->secular, zeta) - log_product(&p, ccosh(zeta)));
      worst = fmax(worst, cabs(ratio - 1));
    }
    discard(&p);
  }
  print_message("determinant: relative difference %.3g\n", worst);
  assert_true(worst < 1e-9);
}

/* Alpha from both counts on arcs and contours, against the eigenvalues. */
static void counts_on_the_circle_and_outside_are_those_of_the_eigenvalues(void **state) {
  (void)state;
  random_source source = {.state = 32};
  for (int i = 0; i < 60; i++) {
    prepared p = prepare(scenario_few(&source, &ranges, 3));
    size_t n = p.s.chain.particles, beyond = 0, outside;
    const double radius = 0.01;
    assert_int_equal(reduced_compute(&p.spectrum->reduced, &p.s.chain, &p.spectrum->impacts, &p.orbit, NULL), RIC_OK);
    for (size_t k = 0; k + 1 < n; k++) {
      double complex root =
          cacosh(CMPLX(p.spectrum->reduced.spectrum.alpha[k].re, p.spectrum->reduced.spectrum.alpha[k].im));
      beyond += fabs(creal(root)) > radius;
    }
    assert_true(winding_outside(&p.spectrum->secular, radius, &outside));
    assert_int_equal(outside, beyond);
    assert_true(unit_circle_count(&p.spectrum->secular, 1e-4, 40) + outside <= n);
    discard(&p);
  }
}

static void memory_is_below_a_kilobyte_per_particle_and_impact(void **state) {
  (void)state;
  const char *words[] = {"s", "s.h.s..h"};
  for (int k = 0; k < 2; k++) {
    scenario s = k == 0 ? scenario_middle(1000, RIC_ENDS_PERIODIC, 0.1, 4.7)
                        : scenario_word(words[k], 10, RIC_ENDS_FREE, 0.1, 4.7);
    prepared p = prepare(s);
    double each = (double)(s.chain.particles * ric_pattern_impacts(s.pattern));
    print_message("%zu particles, %zu impacts: %.0f bytes each\n", s.chain.particles, ric_pattern_impacts(s.pattern),
                  secular_bytes(&p.spectrum->secular) / each);
    assert_true(secular_bytes(&p.spectrum->secular) <= 1024 * each);
    discard(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(determinant_is_the_product_over_multipliers_and_modes),
      cmocka_unit_test(counts_on_the_circle_and_outside_are_those_of_the_eigenvalues),
      cmocka_unit_test(memory_is_below_a_kilobyte_per_particle_and_impact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

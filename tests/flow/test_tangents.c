/* Tangent vectors between impacts: Taylor series, CVODES, and differences of the flow itself. */
#include "support.h"

#include "witness/derivative.h"
#include "witness/random_lattice.h"
#include "witness/recorded_run.h"

enum { MOST = 24, SIZE = 4 * MOST * MOST };

static ric_trajectory_options with_method(ric_flow_method method, double tolerance) {
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow.method = method;
  options.flow.tolerance = tolerance;
  return options;
}

/* Largest error over some random lattices. */
static double worst(unsigned with, ric_flow_method method, double tolerance) {
  static random_lattice r;
  static double D[SIZE], differences[SIZE];
  ric_trajectory_options options = with_method(method, tolerance), taylor = with_method(RIC_FLOW_TAYLOR, 0);
  double most = 0;
  for (uint64_t seed = 1; seed <= 5; seed++) {
    random_source source = {.state = seed};
    size_t n = 1 + random_below(&source, seed % 2 ? 8 : MOST);
    double x[2 * MOST];
    random_lattice_set(&r, &source, n, (ric_ends)(seed % 3), with);
    random_lattice_state(&source, n, x, x + n);
    ric_system *system = lattice_system(&r.lattice, NULL, 0);
    assert_int_equal(derivative_by_tangents(system, &options, 0.3, x, 4, D), RIC_RUN_COMPLETED);
    derivative_by_differences(system, &taylor, 0.3, x, 4, 1e-3, 4, differences);
    most = fmax(most, derivative_error(D, differences, 2 * n));
    ric_system_destroy(&system);
  }
  return most;
}

static void tangents_are_derivatives_of_the_flow(void **state) {
  (void)state;
  for (unsigned with = 0; with <= WITH_ALL; with++) {
    double most = worst(with, RIC_FLOW_TAYLOR, 0);
    if (most > 1e-9)
      fail_msg("with %u: off by %g", with, most);
  }
}

static void tangents_of_cvodes_are_derivatives_of_the_flow(void **state) {
  (void)state;
  for (unsigned with = 0; with <= WITH_ALL; with += WITH_ALL) {
    double most = worst(with, RIC_FLOW_CVODES, 1e-12);
    if (most > 1e-8)
      fail_msg("with %u: off by %g", with, most);
  }
}

/* Two oscillators, of which the fast one stays at rest, and the other one too at first: the motion gives its steps no
 * reason to be short. Tangent vectors of springs without extension are those of linear ones. */
static void tangents_that_the_motion_leaves_at_rest_are_right(void **state) {
  (void)state;
  static const double x[4] = {0}, amplitude[4] = {1e-9}, w[2] = {1, 100}, end = 20;
  const ric_spring springs[2] = {{.linear = 1, .cubic = 0.1}, {.linear = 1e4, .cubic = 0.1}};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  lattice.on_sites = springs;
  lattice.link = (ric_spring){0};
  ric_system *system = lattice_system(&lattice, NULL, 0);
  ric_trajectory_options options = with_method(RIC_FLOW_TAYLOR, 0);
  double D[16], exact[16] = {0};
  for (size_t i = 0; i < 2; i++) {
    exact[i * 4 + i] = exact[(i + 2) * 4 + i + 2] = cos(w[i] * end);
    exact[i * 4 + i + 2] = sin(w[i] * end) / w[i];
    exact[(i + 2) * 4 + i] = -w[i] * sin(w[i] * end);
  }
  assert_int_equal(derivative_by_tangents(system, &options, 0, x, end, D), RIC_RUN_COMPLETED);
  assert_true(derivative_error(D, exact, 4) < 1e-10);
  assert_int_equal(derivative_by_tangents(system, &options, 0, amplitude, end, D), RIC_RUN_COMPLETED);
  assert_true(derivative_error(D, exact, 4) < 1e-10);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangents_are_derivatives_of_the_flow),
      cmocka_unit_test(tangents_that_the_motion_leaves_at_rest_are_right),
      cmocka_unit_test(tangents_of_cvodes_are_derivatives_of_the_flow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#include "solved_orbit.h"

#include "support.h"

solved_orbit solve_orbit(ric_orbit_method method, scenario s) {
  solved_orbit x = {.scenario = s};
  ric_orbit_options options = ric_orbit_options_default();
  ric_error error = {0};
  options.method = method;
  assert_non_null(s.pattern);
  assert_int_equal(ric_orbit_solver_create(&options, &x.solver, &error), RIC_OK);
  if (scenario_solve(&x.scenario, x.solver, &x.orbit, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return x;
}

void solved_orbit_clear(solved_orbit *x) {
  ric_orbit_clear(&x->orbit);
  ric_orbit_solver_destroy(&x->solver);
  scenario_clear(&x->scenario);
}

int solved_orbit_has_state(const solved_orbit *x) {
  return x->orbit.outcome != RIC_SINGULAR && x->orbit.outcome != RIC_FAILED;
}

double solved_orbit_scale(const solved_orbit *x) {
  double largest = 0;
  for (size_t i = 0; i < x->orbit.particles; i++)
    largest = fmax(largest, fmax(fabs(x->orbit.q[i]), fabs(x->orbit.q_half[i])));
  return largest;
}

double method_tolerance(const solved_orbit *dense) {
  double largest = fmax(1, solved_orbit_scale(dense));
  for (size_t i = 0; i < dense->orbit.particles; i++)
    largest = fmax(largest, fmax(fabs(dense->orbit.v[i]), fabs(dense->orbit.v_half[i])));
  return 1e-12 * fmax(1, dense->orbit.condition / 100) * largest;
}

static double difference(const double *a, const double *b, size_t count) {
  double largest = 0;
  for (size_t i = 0; i < count; i++) {
    double d = fabs(a[i] - b[i]);
    largest = d <= largest ? largest : d < INFINITY ? d : INFINITY;
  }
  return largest;
}

double state_difference(const ric_orbit *a, const ric_orbit *b) {
  size_t n = a->particles;
  double at_start = fmax(difference(a->q, b->q, n), difference(a->v, b->v, n));
  double at_half = fmax(difference(a->q_half, b->q_half, n), difference(a->v_half, b->v_half, n));
  return fmax(fmax(at_start, at_half), difference(a->impulse, b->impulse, a->impacts));
}

double impulse_of(const solved_orbit *x, size_t particle) {
  for (size_t r = 0; r < x->orbit.impacts; r++)
    if (ric_pattern_impact(x->scenario.pattern, r) == particle)
      return x->orbit.impulse[r];
  return 0;
}

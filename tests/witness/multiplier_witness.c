#include "multiplier_witness.h"

#include "dense_monodromy.h"
#include "support.h"

ric_multipliers multipliers_by(ric_multiplier_method method, const solved_orbit *x, bool on_circle) {
  ric_orbit_multiplier_options options = ric_orbit_multiplier_options_default();
  ric_multipliers m;
  ric_error error = {0};
  options.method = method;
  options.on_circle = on_circle;
  assert_int_equal(ric_multipliers_init(&m, 2 * x->orbit.particles, &error), RIC_OK);
  if (ric_orbit_multipliers(x->solver, &x->scenario.chain, x->scenario.pattern, &x->orbit, &options, &m, &error) !=
      RIC_OK)
    fail_msg("%s", error.message);
  return m;
}

ric_multipliers multipliers_dense(const solved_orbit *x) {
  ric_multipliers m;
  double *M = dense_monodromy(&x->scenario.chain, x->scenario.pattern, &x->orbit);
  assert_int_equal(ric_multipliers_init(&m, 2 * x->orbit.particles, NULL), RIC_OK);
  assert_int_equal(ric_multipliers_of_matrix(M, m.dimension, 2, NULL, &m, NULL), RIC_OK);
  free(M);
  return m;
}

double multipliers_distance(const ric_multipliers *a, size_t count, const ric_multipliers *b) {
  double worst = 0;
  for (size_t i = 0; i < count; i++) {
    double nearest = INFINITY, size = fmax(1, hypot(a->mu[i].re, a->mu[i].im));
    for (size_t j = 0; j < b->count; j++)
      nearest = fmin(nearest, hypot(a->mu[i].re - b->mu[j].re, a->mu[i].im - b->mu[j].im));
    worst = fmax(worst, nearest / size);
  }
  return worst;
}

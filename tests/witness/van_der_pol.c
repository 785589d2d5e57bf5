#include "van_der_pol.h"

#include "support.h"

static int rate(double t, const double *x, double *out, void *user) {
  (void)t, (void)user;
  out[0] = x[1];
  out[1] = 0.5 * (1 - x[0] * x[0]) * x[1] - x[0];
  return 0;
}

static int gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = *(const double *)user - x[0];
  return 0;
}

static int bounce(double t, const double *x, size_t obstacle, double *after, void *user) {
  (void)t, (void)obstacle, (void)user;
  after[0] = x[0];
  after[1] = -0.8 * x[1];
  return 0;
}

ric_system *van_der_pol_system(double *wall) {
  const ric_first_order model = {.states = 2, .obstacles = 1, .rate = rate, .gap = gap, .impact = bounce, .user = wall};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
  return system;
}

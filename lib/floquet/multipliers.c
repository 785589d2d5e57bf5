#include "ricochet/multipliers.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "multiplier_verdict.h"
#include "multiplier_work.h"

const char *ric_stability_name(ric_stability stability) {
  switch (stability) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_STABILITY_LIST(X)
#undef X
  case RIC_STABILITIES:
    break;
  }
  return "unknown stability";
}

ric_status ric_multipliers_init(ric_multipliers *m, size_t dimension, ric_error *error) {
  *m = (ric_multipliers){.dimension = dimension};
  if (dimension < 1)
    return ric_fail(error, RIC_EINVAL, "multipliers of dimension 0, expected at least 1");
  m->mu = dimension < SIZE_MAX / 32 ? calloc(dimension, sizeof *m->mu) : NULL;
  if (!m->mu)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu multipliers", dimension);
  ric_multipliers_fail(m, "not computed");
  return RIC_OK;
}

void ric_multipliers_clear(ric_multipliers *m) {
  free(m->mu);
  *m = (ric_multipliers){0};
}

void ric_multipliers_fail(ric_multipliers *m, const char *reason) {
  m->stable = RIC_STABILITY_UNKNOWN;
  snprintf(m->reason, sizeof m->reason, "%s", reason);
  m->count = m->outside = m->real_above = m->real_below = m->complex_outside = 0;
  m->largest = m->margin = m->log_determinant = NAN;
}

ric_multiplier_options ric_multiplier_options_default(void) {
  return (ric_multiplier_options){.multiplier_tol = 1e-9, .band = 1e-6, .band_at_one = 1e-4};
}

ric_status ric_multipliers_of_matrix(const double *M, size_t dimension, size_t trivial,
                                     const ric_multiplier_options *options, ric_multipliers *m, ric_error *error) {
  multiplier_work work = {0};
  ric_multiplier_options o = options ? *options : ric_multiplier_options_default();
  RIC_TRY(multiplier_options_check(&o, error));
  RIC_TRY(multiplier_matrix_check(M, dimension, trivial, m, error));
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = multiplier_work_init(&work, dimension, error);
  if (status == RIC_OK)
    status = multiplier_work_find(&work, M, trivial, &o, m, error);
  multiplier_work_clear(&work);
  gsl_set_error_handler(handler);
  return status;
}

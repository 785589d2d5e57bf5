#include "ricochet/multipliers.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>

#include "multiplier_verdict.h"

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

static ric_status check_matrix(const double *M, size_t dimension, size_t trivial, const ric_multipliers *m,
                               ric_error *error) {
  if (trivial > 2 || trivial > dimension)
    return ric_fail(error, RIC_EINVAL, "trivial = %zu, expected 0, 1 or 2, and at most the dimension %zu", trivial,
                    dimension);
  if (m->dimension != dimension)
    return ric_fail(error, RIC_EINVAL, "room for %zu multipliers, expected %zu", m->dimension, dimension);
  for (size_t i = 0; i < dimension * dimension; i++)
    if (!isfinite(M[i]))
      return ric_fail(error, RIC_EINVAL, "entry [%zu][%zu] = %g, expected a finite number", i / dimension,
                      i % dimension, M[i]);
  return RIC_OK;
}

/* Eigenvalues of a copy, balanced first: displacements and speeds have different units. */
static ric_status eigenvalues(const double *M, size_t n, ric_complex *mu, ric_error *error) {
  gsl_matrix *copy = gsl_matrix_alloc(n, n);
  gsl_vector_complex *values = gsl_vector_complex_alloc(n);
  gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(n);
  ric_status status = RIC_ENOMEM;
  if (copy && values && work) {
    memcpy(copy->data, M, n * n * sizeof *M);
    gsl_eigen_nonsymm_params(0, 1, work);
    status = gsl_eigen_nonsymm(copy, values, work) == GSL_SUCCESS ? RIC_OK : RIC_ENUMERIC;
    for (size_t i = 0; i < n && status == RIC_OK; i++)
      mu[i] = (ric_complex){values->data[2 * i], values->data[2 * i + 1]};
  }
  if (copy)
    gsl_matrix_free(copy);
  if (values)
    gsl_vector_complex_free(values);
  gsl_eigen_nonsymm_free(work);
  return status == RIC_OK ? RIC_OK
                          : ric_fail(error, status, "eigenvalues of a matrix of size %zu: %s", n,
                                     status == RIC_ENOMEM ? "no memory" : "they do not converge");
}

ric_status ric_multipliers_of_matrix(const double *M, size_t dimension, size_t trivial,
                                     const ric_multiplier_options *options, ric_multipliers *m, ric_error *error) {
  ric_multiplier_options o = options ? *options : ric_multiplier_options_default();
  RIC_TRY(multiplier_options_check(&o, error));
  RIC_TRY(check_matrix(M, dimension, trivial, m, error));
  ric_multipliers_fail(m, "not computed");
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = eigenvalues(M, dimension, m->mu, error);
  gsl_set_error_handler(handler);
  RIC_TRY(status);
  m->count = dimension;
  multipliers_judge(m, trivial, &o);
  return RIC_OK;
}

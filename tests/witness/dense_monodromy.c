#include "dense_monodromy.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>

/* exp(A t), A = [[0, 1], [-K, 0]]. */
static gsl_matrix *flow(const ric_chain *chain, double time) {
  size_t n = chain->particles;
  gsl_matrix *a = gsl_matrix_calloc(2 * n, 2 * n), *result = gsl_matrix_calloc(2 * n, 2 * n);
  double *unit = calloc(2 * n, sizeof *unit), *acceleration = unit + n;
  for (size_t j = 0; j < n; j++) {
    unit[j] = 1;
    ric_chain_acceleration(chain, unit, acceleration);
    for (size_t i = 0; i < n; i++)
      gsl_matrix_set(a, n + i, j, time * acceleration[i]);
    gsl_matrix_set(a, j, n + j, time);
    unit[j] = 0;
  }
  gsl_linalg_exponential_ss(a, result, GSL_PREC_DOUBLE);
  gsl_matrix_free(a);
  free(unit);
  return result;
}

/* M becomes S M, S = [[-1, 0], [2 a / v-, -1]] on the particles that hit at this half. */
static void impacts(gsl_matrix *M, const ric_chain *chain, const ric_pattern *pattern, const ric_orbit *orbit,
                    ric_role role) {
  size_t n = chain->particles;
  double *acceleration = calloc(n, sizeof *acceleration);
  ric_chain_acceleration(chain, role == RIC_ROLE_START ? orbit->q : orbit->q_half, acceleration);
  for (size_t k = 0; k < n; k++) {
    if (ric_pattern_role(pattern, k) != role)
      continue;
    double before = role == RIC_ROLE_START ? -orbit->v[k] : orbit->v_half[k];
    for (size_t j = 0; j < 2 * n; j++) {
      double q = gsl_matrix_get(M, k, j), v = gsl_matrix_get(M, n + k, j);
      gsl_matrix_set(M, k, j, -q);
      gsl_matrix_set(M, n + k, j, 2 * acceleration[k] / before * q - v);
    }
  }
  free(acceleration);
}

double *dense_monodromy(const ric_chain *chain, const ric_pattern *pattern, const ric_orbit *orbit) {
  size_t size = 2 * chain->particles;
  gsl_matrix *half = flow(chain, orbit->period / 2), *M = gsl_matrix_calloc(size, size);
  double *copy = calloc(size * size, sizeof *copy);
  gsl_matrix_view result = gsl_matrix_view_array(copy, size, size);
  gsl_matrix_set_identity(&result.matrix);
  impacts(&result.matrix, chain, pattern, orbit, RIC_ROLE_START);
  gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, half, &result.matrix, 0, M);
  impacts(M, chain, pattern, orbit, RIC_ROLE_HALF);
  gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, half, M, 0, &result.matrix);
  gsl_matrix_free(half);
  gsl_matrix_free(M);
  return copy;
}

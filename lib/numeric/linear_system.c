#include "linear_system.h"

#include <math.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>

static double upper_norm1(const double *r, size_t size) {
  double largest = 0;
  for (size_t j = 0; j < size; j++) {
    double sum = 0;
    for (size_t i = 0; i <= j; i++)
      sum += fabs(r[i * size + j]);
    largest = fmax(largest, sum);
  }
  return largest;
}

static ric_status fail(ric_error *error, size_t size, int code) {
  return ric_fail(error, code == GSL_ENOMEM ? RIC_ENOMEM : RIC_ENUMERIC, "linear system of size %zu: %s", size,
                  gsl_strerror(code));
}

ric_status linear_solve(double *matrix, size_t size, double *rhs, double *x, const linear_work *w,
                        linear_factor *factor, ric_error *error) {
  gsl_matrix_view a = gsl_matrix_view_array(matrix, size, size);
  gsl_vector_view tau = gsl_vector_view_array(w->tau, size), scratch = gsl_vector_view_array(w->norm, size);
  gsl_vector_view solution = gsl_vector_view_array(x, size), b = gsl_vector_view_array(rhs, size);
  gsl_vector_view work = gsl_vector_view_array(w->work, 3 * size);
  gsl_permutation p = {.size = size, .data = w->permutation};
  int sign, code = gsl_linalg_QRPT_decomp(&a.matrix, &tau.vector, &p, &sign, &scratch.vector);
  double rcond = 0;
  factor->norm = upper_norm1(matrix, size);
  factor->last = fabs(matrix[size * size - 1]);
  if (!code && factor->last > 0)
    code = gsl_linalg_QRPT_rcond(&a.matrix, &rcond, &work.vector);
  factor->inverse_norm = rcond > 0 ? 1 / (rcond * factor->norm) : INFINITY;
  if (!code && rcond > 0)
    code = gsl_linalg_QRPT_solve(&a.matrix, &tau.vector, &p, &b.vector, &solution.vector);
  return code ? fail(error, size, code) : RIC_OK;
}

ric_status linear_least_norm(double *matrix, size_t size, double *rhs, double *x, double zero, double last,
                             double *residual, ric_error *error) {
  gsl_matrix_view a = gsl_matrix_view_array(matrix, size, size);
  gsl_vector_view b = gsl_vector_view_array(rhs, size), solution = gsl_vector_view_array(x, size);
  gsl_vector *tau_q = gsl_vector_alloc(size), *tau_z = gsl_vector_alloc(size), *work = gsl_vector_alloc(size);
  gsl_permutation *p = gsl_permutation_alloc(size);
  size_t rank = 0;
  int code = tau_q && tau_z && work && p ? GSL_SUCCESS : GSL_ENOMEM;
  if (!code)
    code = gsl_linalg_COD_decomp_e(&a.matrix, tau_q, tau_z, p, fmax(zero, last * (1 + 1e-9)), &rank, work);
  if (!code)
    code = gsl_linalg_COD_lssolve(&a.matrix, tau_q, tau_z, p, rank, &b.vector, &solution.vector, work);
  *residual = code ? INFINITY : gsl_blas_dnrm2(work) / gsl_blas_dnrm2(&b.vector);
  gsl_vector_free(tau_q);
  gsl_vector_free(tau_z);
  gsl_vector_free(work);
  gsl_permutation_free(p);
  return code ? fail(error, size, code) : RIC_OK;
}

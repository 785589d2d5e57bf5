/* Linear equations with dense matrices: Cholesky's factorisation, QR with column pivoting, orthonormal vectors. */
#include "linear.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>

#include "gsl_quiet.h"

/* A pivot below this fraction of its diagonal entry is rounding. */
static const double dependent = 1e-12;

void cholesky_solve_lower(const double *factor, size_t stride, size_t n, double *x) {
  for (size_t i = 0; i < n; i++) {
    const double *row = factor + i * stride;
    for (size_t k = 0; k < i; k++)
      x[i] -= row[k] * x[k];
    x[i] /= row[i];
  }
}

void cholesky_solve_upper(const double *factor, size_t stride, size_t n, double *x) {
  for (size_t i = n; i-- > 0;) {
    const double *row = factor + i * stride;
    x[i] /= row[i];
    for (size_t k = 0; k < i; k++)
      x[k] -= row[k] * x[i];
  }
}

void cholesky_solve(const double *factor, size_t n, double *x) {
  cholesky_solve_lower(factor, n, n, x);
  cholesky_solve_upper(factor, n, n, x);
}

double cholesky_row(double *a, size_t stride, size_t i) {
  double *row = a + i * stride, pivot = row[i];
  cholesky_solve_lower(a, stride, i, row);
  for (size_t k = 0; k < i; k++)
    pivot -= row[k] * row[k];
  return pivot;
}

bool cholesky_factor(double *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double pivot = cholesky_row(a, n, i);
    if (!(pivot > 0 && pivot < INFINITY))
      return false;
    a[i * n + i] = sqrt(pivot);
  }
  return true;
}

void cholesky_factor_semidefinite(double *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double size = a[i * n + i], pivot = cholesky_row(a, n, i);
    a[i * n + i] = pivot > dependent * size ? sqrt(pivot) : INFINITY;
  }
}

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
  return ric_fail(error, gsl_status(code), "linear system of size %zu: %s", size, gsl_text(code));
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

static const double dependence_share = 1e-13; /* remainder of a vector, relative to it, that counts as rounding */

ric_status orthonormal_init(orthonormal_work *w, size_t size, size_t count, ric_error *error) {
  keep_gsl_quiet();
  w->factors = gsl_matrix_alloc(size, count);
  w->tau = gsl_vector_alloc(count);
  w->column = gsl_vector_alloc(size);
  return w->factors && w->tau && w->column ? RIC_OK
                                           : ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors", count);
}

void orthonormal_clear(orthonormal_work *w) {
  if (w->factors)
    gsl_matrix_free(w->factors);
  if (w->tau)
    gsl_vector_free(w->tau);
  if (w->column)
    gsl_vector_free(w->column);
  *w = (orthonormal_work){0};
}

/* Column k of Q; zero if the vector depends on the others. */
static void copy_column(const orthonormal_work *w, size_t k, bool gone, gsl_matrix *x) {
  gsl_vector_set_basis(w->column, k);
  if (gone)
    gsl_vector_set_zero(w->column);
  else
    gsl_linalg_QR_Qvec(w->factors, w->tau, w->column);
  gsl_matrix_set_col(x, k, w->column);
}

void orthonormal_make(orthonormal_work *w, double *x, double *growth) {
  size_t size = w->factors->size1, count = w->factors->size2;
  gsl_matrix_view vectors = gsl_matrix_view_array(x, size, count);
  for (size_t k = 0; k < count; k++) {
    gsl_vector_view column = gsl_matrix_column(&vectors.matrix, k);
    growth[k] = gsl_blas_dnrm2(&column.vector);
  }
  gsl_matrix_memcpy(w->factors, &vectors.matrix);
  gsl_linalg_QR_decomp(w->factors, w->tau);
  for (size_t k = 0; k < count; k++) {
    double left = fabs(gsl_matrix_get(w->factors, k, k));
    bool gone = !(left > dependence_share * growth[k]);
    growth[k] = gone ? -INFINITY : log(left);
    copy_column(w, k, gone, &vectors.matrix);
  }
}

void orthonormal_scatter(orthonormal_work *w, double *x, double *growth) {
  uint64_t state = 1; /* of a linear congruential generator */
  for (size_t i = 0; i < w->factors->size1 * w->factors->size2; i++) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    x[i] = (double)(state >> 11) / 0x1p52 - 1;
  }
  orthonormal_make(w, x, growth);
}

/* Linear equations with dense matrices: Cholesky's factorisation, QR with column pivoting, orthonormal vectors. */
#include "linear.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sort_vector.h>

#include "ricochet/elementary.h"

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

/* Whether a long loop is to stop, asked for each of `size` columns. */
static bool column_stops(size_t size, ric_poll poll) {
  enum { SMALL = 100 };
  return size > SMALL && ric_poll_stops(poll);
}

static ric_status refuse_stopped(ric_error *error, size_t size) {
  return ric_fail(error, RIC_ESTOPPED, "stopped by the poll callback in a linear system of size %zu", size);
}

static void swap_columns(gsl_matrix *a, gsl_permutation *p, gsl_vector *norms, size_t i, size_t j) {
  gsl_matrix_swap_columns(a, i, j);
  gsl_permutation_swap(p, i, j);
  gsl_vector_swap_elements(norms, i, j);
}

/* The norms of the columns behind column i without row i, and of those which that cancels anew. */
static void reduce_norms(gsl_matrix *a, gsl_vector *norms, size_t i) {
  for (size_t j = i + 1; j < a->size2; j++) {
    const double x = gsl_vector_get(norms, j), share = x > 0 ? gsl_matrix_get(a, i, j) / x : 0;
    double y = fabs(share) >= 1 ? 0 : x * sqrt(1 - share * share);
    if (!(x > 0))
      continue;
    if (fabs(y / x) < sqrt(20.0) * GSL_SQRT_DBL_EPSILON) {
      gsl_vector_view rest = gsl_matrix_subcolumn(a, j, i + 1, a->size1 - (i + 1));
      y = gsl_blas_dnrm2(&rest.vector);
    }
    gsl_vector_set(norms, j, y);
  }
}

/* gsl_linalg_QRPT_decomp of a square matrix, bit for bit, but it can be stopped: with thousands of columns it takes
 * minutes. @returns false if it was */
static bool decompose(gsl_matrix *a, gsl_vector *tau, gsl_permutation *p, gsl_vector *norms, ric_poll poll) {
  const size_t n = a->size1;
  gsl_permutation_init(p);
  for (size_t i = 0; i < n; i++) {
    gsl_vector_view column = gsl_matrix_column(a, i);
    gsl_vector_set(norms, i, gsl_blas_dnrm2(&column.vector));
  }
  for (size_t i = 0; i < n; i++) {
    size_t largest = i;
    for (size_t j = i + 1; j < n; j++)
      if (gsl_vector_get(norms, j) > gsl_vector_get(norms, largest))
        largest = j;
    if (largest != i)
      swap_columns(a, p, norms, i, largest);
    gsl_vector_view column = gsl_matrix_subcolumn(a, i, i, n - i);
    const double factor = gsl_linalg_householder_transform(&column.vector);
    gsl_vector_set(tau, i, factor);
    if (i + 1 == n)
      break;
    gsl_matrix_view rest = gsl_matrix_submatrix(a, i, i + 1, n - i, n - (i + 1));
    gsl_linalg_householder_hm(factor, &column.vector, &rest.matrix);
    reduce_norms(a, norms, i);
    if (column_stops(n, poll))
      return false;
  }
  return true;
}

ric_status linear_solve(double *matrix, size_t size, double *rhs, double *x, const linear_work *w,
                        linear_factor *factor, ric_error *error) {
  gsl_matrix_view a = gsl_matrix_view_array(matrix, size, size);
  gsl_vector_view tau = gsl_vector_view_array(w->tau, size), scratch = gsl_vector_view_array(w->norm, size);
  gsl_vector_view solution = gsl_vector_view_array(x, size), b = gsl_vector_view_array(rhs, size);
  gsl_vector_view work = gsl_vector_view_array(w->work, 3 * size);
  gsl_permutation p = {.size = size, .data = w->permutation};
  int code = 0;
  double rcond = 0;
  if (!decompose(&a.matrix, &tau.vector, &p, &scratch.vector, w->poll))
    return refuse_stopped(error, size);
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

/* One step of the reduction to a tridiagonal matrix: column i below the diagonal becomes a multiple of a unit vector.
 * @param x  [size - i - 1] scratch */
static void reduce_column(gsl_matrix *a, size_t i, gsl_vector *x) {
  const size_t left = a->size1 - i - 1;
  gsl_vector_view column = gsl_matrix_subcolumn(a, i, i + 1, left);
  gsl_matrix_view rest = gsl_matrix_submatrix(a, i + 1, i + 1, left, left);
  const double factor = gsl_linalg_householder_transform(&column.vector), first = gsl_vector_get(&column.vector, 0);
  if (factor != 0) {
    double product;
    gsl_vector_set(&column.vector, 0, 1);
    gsl_blas_dsymv(CblasLower, factor, &rest.matrix, &column.vector, 0, x);
    gsl_blas_ddot(x, &column.vector, &product);
    gsl_blas_daxpy(-0.5 * factor * product, &column.vector, x);
    gsl_blas_dsyr2(CblasLower, -1, &column.vector, x, &rest.matrix);
  }
  gsl_vector_set_zero(&column.vector);
  gsl_vector_set(&column.vector, 0, first);
}

/* gsl_linalg_symmtd_decomp, bit for bit, of the lower triangle, but it can be stopped. GSL takes no time for the
 * eigenvalues of what is left. @returns false if it was stopped */
static bool make_tridiagonal(gsl_matrix *a, gsl_vector *scratch, ric_poll poll) {
  for (size_t i = 0; i + 2 < a->size1; i++) {
    gsl_vector_view x = gsl_vector_subvector(scratch, 0, a->size1 - i - 1);
    reduce_column(a, i, &x.vector);
    if (column_stops(a->size1, poll))
      return false;
  }
  return true;
}

ric_status linear_eigenvalues(double *matrix, size_t size, double *eigenvalues, ric_poll poll, ric_error *error) {
  gsl_eigen_symm_workspace *w = gsl_eigen_symm_alloc(size);
  gsl_matrix_view a = gsl_matrix_view_array(matrix, size, size);
  gsl_vector_view e = gsl_vector_view_array(eigenvalues, size);
  int code = w ? GSL_SUCCESS : GSL_ENOMEM;
  const bool done = code || make_tridiagonal(&a.matrix, &e.vector, poll);
  if (!code && done)
    code = gsl_eigen_symm(&a.matrix, &e.vector, w);
  gsl_eigen_symm_free(w);
  if (!done)
    return refuse_stopped(error, size);
  gsl_sort_vector(&e.vector);
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
    growth[k] = gone ? -INFINITY : ric_log(left);
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

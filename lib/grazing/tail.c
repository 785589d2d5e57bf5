#include "tail.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>

#include "numeric/cholesky.h"
#include "numeric/number_block.h"

/* B^N with N = 2 to this is the last power looked at: multipliers whose moduli differ by less than 1e-9 are not told.
 */
enum { most_doublings = 32 };

static double length(const double *x, size_t n) {
  gsl_vector_const_view view = gsl_vector_const_view_array(x, n);
  return gsl_blas_dnrm2(&view.vector);
}

/* C = A^T B or A B, plus C where it is added. */
static void multiply(CBLAS_TRANSPOSE_t transposed, const double *a, const double *b, bool add, double *c, size_t n) {
  gsl_matrix_const_view A = gsl_matrix_const_view_array(a, n, n), B = gsl_matrix_const_view_array(b, n, n);
  gsl_matrix_view C = gsl_matrix_view_array(c, n, n);
  gsl_blas_dgemm(transposed, CblasNoTrans, 1, &A.matrix, &B.matrix, add ? 1 : 0, &C.matrix);
}

/* x becomes B x or x B. */
static void apply(const tail_proof *t, CBLAS_TRANSPOSE_t transposed, double *x) {
  gsl_matrix_const_view B = gsl_matrix_const_view_array(t->B, t->n, t->n);
  gsl_vector_const_view from = gsl_vector_const_view_array(x, t->n);
  gsl_vector_view to = gsl_vector_view_array(t->work, t->n);
  gsl_blas_dgemv(transposed, 1, &B.matrix, &from.vector, 0, &to.vector);
  memcpy(x, t->work, t->n * sizeof *x);
}

/* --- B, e and w --------------------------------------------------------------------------------------------------- */

/* x less its part along `along`, as `dual` measures it; dual . along = 1. */
static void project(double *x, size_t stride, const double *dual, const double *along, size_t n) {
  double part = 0;
  for (size_t k = 0; k < n; k++)
    part += dual[k] * x[k * stride];
  for (size_t k = 0; k < n; k++)
    x[k * stride] -= part * along[k];
}

static void build_rest(tail_proof *t, const balanced_map *map, const dominant_multiplier *d) {
  size_t n = t->n;
  for (size_t k = 0; k < n * n; k++)
    t->B[k] = map->L[k] / d->value.re;
  for (size_t k = 0; k < n; k++)
    project(t->B + k, n, d->left, d->right, n);
  for (size_t k = 0; k < n; k++)
    project(t->B + k * n, 1, d->right, d->left, n);
  memcpy(t->row, map->eta, n * sizeof *t->row);
  memcpy(t->w, map->xi, n * sizeof *t->w);
  project(t->row, 1, d->right, d->left, n);
  project(t->w, 1, d->left, d->right, n);
}

/* --- coordinates in which B contracts ----------------------------------------------------------------------------- */

/* What their search works on, [n][n] each. */
typedef struct contraction {
  double *X, *A, *scratch;
} contraction;

/* X of 2N powers from X of N: X + A^T X A with A = (B / s)^N, which is squared then. */
static void double_powers(const contraction *c, size_t n) {
  multiply(CblasNoTrans, c->X, c->A, false, c->scratch, n);
  multiply(CblasTrans, c->A, c->scratch, true, c->X, n);
  multiply(CblasNoTrans, c->A, c->A, false, c->scratch, n);
  memcpy(c->A, c->scratch, n * n * sizeof *c->A);
}

static void sum_powers(const tail_proof *t, double rate, const contraction *c) {
  size_t n = t->n;
  memset(c->X, 0, n * n * sizeof *c->X);
  for (size_t k = 0; k < n; k++)
    c->X[k * n + k] = 1;
  for (size_t k = 0; k < n * n; k++)
    c->A[k] = t->B[k] / rate;
  for (int k = 0; k < most_doublings && length(c->A, n * n) > 0.5 && isfinite(length(c->X, n * n)); k++)
    double_powers(c, n);
}

/* B becomes C^T B C^-T, row and w what they are there. */
static void change_coordinates(tail_proof *t, const double *C) {
  size_t n = t->n;
  gsl_matrix_view B = gsl_matrix_view_array(t->B, n, n);
  gsl_matrix_const_view factor = gsl_matrix_const_view_array(C, n, n);
  gsl_vector_view w = gsl_vector_view_array(t->w, n);
  gsl_blas_dtrmm(CblasLeft, CblasLower, CblasTrans, CblasNonUnit, 1, &factor.matrix, &B.matrix);
  gsl_blas_dtrsm(CblasRight, CblasLower, CblasTrans, CblasNonUnit, 1, &factor.matrix, &B.matrix);
  gsl_blas_dtrmv(CblasLower, CblasTrans, CblasNonUnit, &factor.matrix, &w.vector);
  cholesky_solve_lower(C, n, n, t->row);
}

/* I - B^T B is positive definite by more than `margin`. NaN fails. */
static bool contracts(const tail_proof *t, double margin, double *rest) {
  size_t n = t->n;
  multiply(CblasTrans, t->B, t->B, false, rest, n);
  for (size_t k = 0; k < n * n; k++)
    rest[k] = (k % (n + 1) == 0 ? 1 - margin : 0) - rest[k];
  return isfinite(length(rest, n * n)) && cholesky_factor(rest, n);
}

/* As X >= I, errors of B grow by no more than |C| in the new coordinates. That of the projector need not be added: the
 * rest of the exact L is similar to one that close to B by a matrix that differs from I by dominant->accuracy. */
static void contract(tail_proof *t, const dominant_multiplier *d, const contraction *c) {
  size_t n = t->n;
  double ratio = d->second / d->modulus, unit = 10 * (double)n * DBL_EPSILON;
  double error = unit * length(t->B, n * n) + d->rounding;
  sum_powers(t, sqrt(fmax(ratio, 0.25)), c);
  if (!isfinite(length(c->X, n * n)) || !cholesky_factor(c->X, n))
    return;
  for (size_t k = 0; k < n; k++)
    memset(c->X + k * n + k + 1, 0, (n - k - 1) * sizeof *c->X);
  change_coordinates(t, c->X);
  t->contracting = contracts(t, unit + 2 * error * length(c->X, n * n), c->scratch);
}

ric_status tail_proof_init(tail_proof *t, const balanced_map *map, const dominant_multiplier *d, ric_error *error) {
  size_t n = map->n, used = 0;
  double *block = balanced_map_room(n, 1, 3), *work = balanced_map_room(n, 3, 1);
  *t = (tail_proof){.n = n};
  if (!block || !work) {
    free(block);
    free(work);
    return ric_fail(error, RIC_ENOMEM, "no memory for the proof of a map of size %zu", n);
  }
  t->B = number_block_take(block, &used, n * n);
  t->row = number_block_take(block, &used, n);
  t->w = number_block_take(block, &used, n);
  t->work = number_block_take(block, &used, n);
  build_rest(t, map, d);
  contract(t, d, &(contraction){work, work + n * n, work + 2 * n * n});
  free(work);
  return RIC_OK;
}

void tail_proof_clear(tail_proof *t) {
  free(t->B);
  *t = (tail_proof){0};
}

/* --- the bound ---------------------------------------------------------------------------------------------------- */

double tail_proof_bound(const tail_proof *t) {
  return t->contracting ? length(t->row, t->n) * length(t->w, t->n) : INFINITY;
}

void tail_proof_advance(tail_proof *t) {
  apply(t, CblasTrans, t->row);
  apply(t, CblasNoTrans, t->w);
}

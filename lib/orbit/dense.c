#include "dense.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>

#include "pattern_roles.h"

/* Matrices of size 2n and vectors, all freed together. */
typedef struct dense {
  size_t n;
  gsl_matrix *a, *flow, *system; /* A T/2, its exponential, M + N exp(A T/2) */
  gsl_vector *rhs, *x, *x_half, *tau, *norm, *work, *residual;
  gsl_permutation *permutation;
} dense;

static void dense_free(dense *d) {
  gsl_matrix *matrices[] = {d->a, d->flow, d->system};
  gsl_vector *vectors[] = {d->rhs, d->x, d->x_half, d->tau, d->norm, d->work, d->residual};
  for (size_t i = 0; i < sizeof matrices / sizeof *matrices; i++)
    if (matrices[i])
      gsl_matrix_free(matrices[i]);
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    if (vectors[i])
      gsl_vector_free(vectors[i]);
  if (d->permutation)
    gsl_permutation_free(d->permutation);
}

static ric_status dense_alloc(dense *d, size_t n, ric_error *error) {
  size_t size = 2 * n;
  *d = (dense){.n = n};
  d->a = gsl_matrix_calloc(size, size);
  d->flow = gsl_matrix_calloc(size, size);
  d->system = gsl_matrix_calloc(size, size);
  d->rhs = gsl_vector_calloc(size);
  d->x = gsl_vector_calloc(size);
  d->x_half = gsl_vector_calloc(size);
  d->tau = gsl_vector_calloc(size);
  d->norm = gsl_vector_calloc(size);
  d->residual = gsl_vector_calloc(size);
  d->work = gsl_vector_calloc(3 * size);
  d->permutation = gsl_permutation_calloc(size);
  if (d->a && d->flow && d->system && d->rhs && d->x && d->x_half && d->tau && d->norm && d->residual && d->work &&
      d->permutation)
    return RIC_OK;
  dense_free(d);
  return ric_fail(error, RIC_ENOMEM, "no memory for matrices of size %zu", size);
}

/* exp(A T/2) with A = (0, I; -K, 0); columns of -K are accelerations at unit displacements. */
static int exponentiate(dense *d, const ric_chain *chain, double half_period) {
  size_t n = d->n;
  double *unit = d->x->data, *acceleration = d->x_half->data;
  for (size_t j = 0; j < n; j++) {
    for (size_t i = 0; i < n; i++)
      unit[i] = i == j;
    ric_chain_acceleration(chain, unit, acceleration);
    for (size_t i = 0; i < n; i++)
      gsl_matrix_set(d->a, n + i, j, half_period * acceleration[i]);
    gsl_matrix_set(d->a, j, n + j, half_period);
  }
  return gsl_linalg_exponential_ss(d->a, d->flow, GSL_PREC_DOUBLE);
}

/* Row `row` of the system := row `source` of the flow, or of the identity. */
static void set_row(dense *d, size_t row, size_t source, int from_flow) {
  for (size_t j = 0; j < 2 * d->n; j++)
    gsl_matrix_set(d->system, row, j, from_flow ? gsl_matrix_get(d->flow, source, j) : j == source);
}

/* The boundary conditions (8): free and half-period particles start at rest, start particles end at rest, and so on. */
static void impose(dense *d, const ric_chain *chain, const ric_pattern *pattern) {
  size_t n = d->n;
  for (size_t i = 0; i < n; i++) {
    ric_role role = ric_pattern_role(pattern, i);
    if (role == RIC_ROLE_START)
      set_row(d, i, i, 0); /* q(0) = b */
    else
      set_row(d, i, n + i, 0); /* v(0) = 0 */
    if (role == RIC_ROLE_HALF)
      set_row(d, n + i, i, 1); /* q(T/2) = b */
    else
      set_row(d, n + i, n + i, 1); /* v(T/2) = 0 */
    gsl_vector_set(d->rhs, i, role == RIC_ROLE_START ? ric_chain_floor(chain, i) : 0);
    gsl_vector_set(d->rhs, n + i, role == RIC_ROLE_HALF ? ric_chain_floor(chain, i) : 0);
  }
}

/* Numerical rank of the pivoted R at a condition number. */
static size_t rank_at(const gsl_matrix *r, double condition) {
  size_t rank = 0;
  while (rank < r->size1 && fabs(gsl_matrix_get(r, rank, rank)) * condition > fabs(gsl_matrix_get(r, 0, 0)))
    rank++;
  return rank;
}

static int solve(dense *d, double singular_condition, double *condition) {
  int sign, code = gsl_linalg_QRPT_decomp(d->system, d->tau, d->permutation, &sign, d->norm);
  double rcond = 0;
  size_t size = 2 * d->n;
  if (!code && gsl_matrix_get(d->system, size - 1, size - 1) != 0)
    code = gsl_linalg_QRPT_rcond(d->system, &rcond, d->work);
  if (code)
    return code;
  *condition = rcond > 0 ? 1 / rcond : INFINITY;
  if (*condition < singular_condition)
    return gsl_linalg_QRPT_solve(d->system, d->tau, d->permutation, d->rhs, d->x);
  return gsl_linalg_QRPT_lssolve2(d->system, d->tau, d->permutation, d->rhs, rank_at(d->system, singular_condition),
                                  d->x, d->residual);
}

ric_status dense_solve(const ric_chain *chain, const ric_pattern *pattern, double period, double singular_condition,
                       const boundary_state *state, double *condition, ric_error *error) {
  dense d;
  size_t n = chain->particles;
  RIC_TRY(dense_alloc(&d, n, error));
  int code = exponentiate(&d, chain, period / 2);
  if (!code) {
    impose(&d, chain, pattern);
    code = solve(&d, singular_condition, condition);
  }
  if (!code)
    code = gsl_blas_dgemv(CblasNoTrans, 1, d.flow, d.x, 0, d.x_half);
  for (size_t i = 0; i < n && !code; i++) {
    state->q[i] = gsl_vector_get(d.x, i);
    state->v[i] = gsl_vector_get(d.x, n + i);
    state->q_half[i] = gsl_vector_get(d.x_half, i);
    state->v_half[i] = gsl_vector_get(d.x_half, n + i);
  }
  dense_free(&d);
  return code ? ric_fail(error, RIC_ENUMERIC, "boundary-value problem of size %zu: %s", 2 * n, gsl_strerror(code))
              : RIC_OK;
}

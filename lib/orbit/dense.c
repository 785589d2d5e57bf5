#include "dense.h"

#include <math.h>

#include <stdlib.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_permutation.h>

#include "pattern_roles.h"

/* Matrices and vectors of size 2n, all freed together. */
typedef struct dense_equations {
  size_t n;
  gsl_matrix *a, *modes;     /* [n][n]: K, work; eigenvectors of K */
  gsl_matrix *flow, *system; /* [2n][2n]: exp(A T/2), M + N exp(A T/2) */
  gsl_vector *rhs, *x, *x_half, *tau, *norm, *work;
  gsl_permutation *permutation;
} dense_equations;

static void dense_free(dense_equations *d) {
  gsl_matrix *matrices[] = {d->a, d->modes, d->flow, d->system};
  gsl_vector *vectors[] = {d->rhs, d->x, d->x_half, d->tau, d->norm, d->work};
  for (size_t i = 0; i < sizeof matrices / sizeof *matrices; i++)
    if (matrices[i])
      gsl_matrix_free(matrices[i]);
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    if (vectors[i])
      gsl_vector_free(vectors[i]);
  if (d->permutation)
    gsl_permutation_free(d->permutation);
}

static ric_status dense_alloc(dense_equations *d, size_t n, ric_error *error) {
  size_t size = 2 * n;
  *d = (dense_equations){.n = n};
  d->a = gsl_matrix_calloc(n, n);
  d->modes = gsl_matrix_calloc(n, n);
  d->flow = gsl_matrix_calloc(size, size);
  d->system = gsl_matrix_calloc(size, size);
  d->rhs = gsl_vector_calloc(size);
  d->x = gsl_vector_calloc(size);
  d->x_half = gsl_vector_calloc(size);
  d->tau = gsl_vector_calloc(size);
  d->norm = gsl_vector_calloc(size);
  d->work = gsl_vector_calloc(3 * size);
  d->permutation = gsl_permutation_calloc(size);
  if (d->a && d->modes && d->flow && d->system && d->rhs && d->x && d->x_half && d->tau && d->norm && d->work &&
      d->permutation)
    return RIC_OK;
  dense_free(d);
  return ric_fail(error, RIC_ENOMEM, "no memory for matrices of size %zu", size);
}

/* -K from accelerations at unit displacements, symmetric. */
static void stiffness(dense_equations *d, const ric_chain *chain) {
  size_t n = d->n;
  double *unit = d->x->data, *acceleration = d->x_half->data;
  for (size_t j = 0; j < n; j++) {
    for (size_t i = 0; i < n; i++)
      unit[i] = i == j;
    ric_chain_acceleration(chain, unit, acceleration);
    for (size_t i = 0; i < n; i++)
      gsl_matrix_set(d->a, i, j, -acceleration[i]);
  }
}

/* exp(A t) with A = (0, I; -K, 0), block by block from the numerical eigenvectors of K: cos(wt), sin(wt)/w, -w sin(wt).
 * A Taylor series with squaring loses a digit for every doubling of the time. */
static int exponentiate(dense_equations *d, const ric_chain *chain, double t) {
  size_t n = d->n;
  stiffness(d, chain);
  gsl_eigen_symmv_workspace *w = gsl_eigen_symmv_alloc(n);
  gsl_vector_view values = gsl_vector_subvector(d->rhs, 0, n);
  int code = w ? gsl_eigen_symmv(d->a, &values.vector, d->modes, w) : GSL_ENOMEM;
  gsl_eigen_symmv_free(w);
  for (int block = 0; block < 3 && !code; block++) {
    for (size_t j = 0; j < n; j++) { /* a := modes times the function of the frequencies */
      double omega = sqrt(gsl_vector_get(&values.vector, j));
      double f = block == 0 ? cos(omega * t) : block == 1 ? sin(omega * t) / omega : -omega * sin(omega * t);
      for (size_t i = 0; i < n; i++)
        gsl_matrix_set(d->a, i, j, f * gsl_matrix_get(d->modes, i, j));
    }
    gsl_matrix_view to = gsl_matrix_submatrix(d->flow, block == 2 ? n : 0, block == 1 ? n : 0, n, n);
    code = gsl_blas_dgemm(CblasNoTrans, CblasTrans, 1, d->a, d->modes, 0, &to.matrix);
  }
  gsl_matrix_view upper = gsl_matrix_submatrix(d->flow, 0, 0, n, n), lower = gsl_matrix_submatrix(d->flow, n, n, n, n);
  return code ? code : gsl_matrix_memcpy(&lower.matrix, &upper.matrix);
}

/* Row `row` of the system := row `source` of the flow, or of the identity. */
static void set_row(dense_equations *d, size_t row, size_t source, int from_flow) {
  for (size_t j = 0; j < 2 * d->n; j++)
    gsl_matrix_set(d->system, row, j, from_flow ? gsl_matrix_get(d->flow, source, j) : j == source);
}

/* The boundary conditions (8): free and half-period particles start at rest, start particles end at rest, and so on. */
static void impose(dense_equations *d, const ric_chain *chain, const ric_pattern *pattern) {
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

static ric_status solve(dense_equations *d, const ric_chain *chain, const ric_pattern *pattern,
                        const ric_orbit_options *options, linear_outcome *solution, ric_error *error) {
  linear_work work = {
      .tau = d->tau->data, .norm = d->norm->data, .work = d->work->data, .permutation = d->permutation->data};
  linear_factor factor;
  double residual;
  size_t size = 2 * d->n;
  impose(d, chain, pattern);
  RIC_TRY(linear_solve(d->system->data, size, d->rhs->data, d->x->data, &work, &factor, error));
  *solution = (linear_outcome){.condition = factor.norm * factor.inverse_norm};
  solution->singular = !(solution->condition < options->singular_condition);
  if (!solution->singular)
    return RIC_OK;
  impose(d, chain, pattern); /* the factorisation has overwritten it */
  RIC_TRY(linear_least_norm(d->system->data, size, d->rhs->data, d->x->data, factor.norm / options->singular_condition,
                            factor.last, &residual, error));
  solution->solvable = residual <= options->residual_tol;
  return RIC_OK;
}

ric_status dense_solve(const ric_chain *chain, const ric_pattern *pattern, double period,
                       const ric_orbit_options *options, const boundary_state *state, linear_outcome *solution,
                       ric_error *error) {
  dense_equations d;
  size_t n = chain->particles;
  RIC_TRY(dense_alloc(&d, n, error));
  int code = exponentiate(&d, chain, period / 2);
  ric_status status =
      code ? ric_fail(error, RIC_ENUMERIC, "matrix exponential of size %zu: %s", 2 * n, gsl_strerror(code))
           : solve(&d, chain, pattern, options, solution, error);
  if (status == RIC_OK)
    gsl_blas_dgemv(CblasNoTrans, 1, d.flow, d.x, 0, d.x_half);
  for (size_t i = 0; i < n && status == RIC_OK; i++) {
    state->q[i] = gsl_vector_get(d.x, i);
    state->v[i] = gsl_vector_get(d.x, n + i);
    state->q_half[i] = gsl_vector_get(d.x_half, i);
    state->v_half[i] = gsl_vector_get(d.x_half, n + i);
  }
  dense_free(&d);
  return status;
}

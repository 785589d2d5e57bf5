/* Newton's method in a hyperplane, with the bordered Jacobian, and the tangent. */
#include "corrector.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "curve.h"
#include "ricochet/elementary.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* From this size on LU with row pivoting: 9 times as quick as QR at 1000, twice at 30, since GSL does it in blocks. It
 * allocates its pivots in every call, a cost that small problems avoid. */
static const size_t lu_size = 32;

static bool by_lu(const bordered *b) {
  return b->size >= lu_size;
}

size_t bordered_numbers(size_t unknowns) {
  size_t size = unknowns + 1;
  return size * size + unknowns * size + 3 * size;
}

double *bordered_place(bordered *b, size_t unknowns, double *block) {
  size_t n = unknowns, size = n + 1;
  b->size = size;
  b->matrix = block;
  b->J = b->matrix + size * size;
  b->F_p = b->J + n * n;
  b->residual = b->F_p + n;
  b->tau = b->residual + size;
  b->scratch = b->tau + size;
  return b->scratch + size;
}

/* A problem that fails without a message gets one. */
static ric_status evaluate_bordered(bordered *b, const double *x, ric_error *error) {
  const ric_curve_problem *problem = b->problem;
  double p = x[b->size - 1];
  if (ric_poll_stops(b->poll))
    return ric_fail(error, RIC_ESTOPPED, "stopped by the poll callback at p = %.9g", p);
  b->jacobians++;
  if (error)
    error->message[0] = '\0';
  ric_status status = problem->residual(x, p, b->residual, b->J, b->F_p, problem->user, error);
  if (status != RIC_OK && error && error->message[0] == '\0')
    return ric_fail(error, status, "no residual at p = %.9g: %s", p, ric_status_text(status));
  return status;
}

static void assemble(bordered *b, const double *row) {
  size_t n = b->size - 1;
  for (size_t i = 0; i < n; i++) {
    memcpy(b->matrix + i * b->size, b->J + i * n, n * sizeof *b->J);
    b->matrix[i * b->size + n] = b->F_p[i];
  }
  memcpy(b->matrix + n * b->size, row, b->size * sizeof *row);
}

static void factor(bordered *b) {
  gsl_matrix_view a = gsl_matrix_view_array(b->matrix, b->size, b->size);
  gsl_vector_view tau = gsl_vector_view_array(b->tau, b->size), scratch = gsl_vector_view_array(b->scratch, b->size);
  gsl_permutation p = {.size = b->size, .data = b->permutation};
  if (by_lu(b))
    gsl_linalg_LU_decomp(&a.matrix, &p, &b->signum);
  else
    gsl_linalg_QRPT_decomp(&a.matrix, &tau.vector, &p, &b->signum, &scratch.vector);
}

/* The smallest modulus on the diagonal of the triangular factor. */
static double least_pivot(const bordered *b) {
  double least = INFINITY;
  for (size_t i = 0; i < b->size; i++)
    least = fmin(least, fabs(b->matrix[i * b->size + i]));
  return least;
}

ric_status bordered_factor(bordered *b, const double *x, const double *row, ric_error *error) {
  b->singular = false;
  RIC_TRY(evaluate_bordered(b, x, error));
  assemble(b, row);
  factor(b);
  b->singular = least_pivot(b) == 0;
  if (b->singular)
    return ric_fail(error, RIC_ENUMERIC, "the bordered Jacobian is singular at p = %.9g", x[b->size - 1]);
  return RIC_OK;
}

static void solve_bordered(bordered *b, double *z) {
  gsl_matrix_view a = gsl_matrix_view_array(b->matrix, b->size, b->size);
  gsl_vector_view tau = gsl_vector_view_array(b->tau, b->size), solution = gsl_vector_view_array(z, b->size);
  gsl_vector_view rhs = gsl_vector_view_array(b->residual, b->size);
  gsl_permutation p = {.size = b->size, .data = b->permutation};
  if (by_lu(b))
    gsl_linalg_LU_solve(&a.matrix, &p, &rhs.vector, &solution.vector);
  else
    gsl_linalg_QRPT_solve(&a.matrix, &tau.vector, &p, &rhs.vector, &solution.vector);
}

/* Newton's correction z [n + 1] within the hyperplane of the row. */
static void bordered_correction(bordered *b, double *z) {
  b->residual[b->size - 1] = 0;
  solve_bordered(b, z);
  for (size_t i = 0; i < b->size; i++)
    z[i] = -z[i];
}

/* The null vector z [n + 1] of (J, F_p) with <row, z> = 1. */
static void bordered_null_vector(bordered *b, double *z) {
  memset(b->residual, 0, b->size * sizeof *b->residual);
  b->residual[b->size - 1] = 1;
  solve_bordered(b, z);
}

/* Each Householder reflection of Q has the determinant -1; one with tau = 0 is the identity. That of L is 1. */
bordered_determinant bordered_det(const bordered *b) {
  bordered_determinant det = {.sign = b->signum, .least = least_pivot(b)};
  for (size_t i = 0; i < b->size; i++) {
    double r = b->matrix[i * b->size + i];
    if (!(fabs(r) > 0 && fabs(r) < INFINITY))
      return (bordered_determinant){0};
    det.sign *= (r > 0 ? 1 : -1) * (!by_lu(b) && b->tau[i] != 0 ? -1 : 1);
    det.log += ric_log(fabs(r));
  }
  return det;
}

/* Corrections below this multiple of the tolerance that no longer shrink are rounding of the residual. */
static const double rounding = 1000;

/* Rows of natural steps and of bounds fix the parameter exactly, since problems may be undefined next to it. */
static bool holds_parameter(const ric_curve *c, const double *row) {
  for (size_t i = 0; i < c->problem.unknowns; i++)
    if (row[i] != 0)
      return false;
  return true;
}

/* One correction. @param size  set to its length over 1 + |x| */
static ric_status correct(ric_curve *c, const double *row, double *x, double *size, ric_error *error) {
  RIC_TRY(bordered_factor(&c->linear, x, row, error));
  bordered_correction(&c->linear, c->z);
  if (holds_parameter(c, row))
    c->z[c->problem.unknowns] = 0;
  for (size_t i = 0; i < c->linear.size; i++)
    x[i] += c->z[i];
  *size = curve_norm(c, c->z) / (1 + curve_norm(c, x));
  if (isfinite(*size))
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "a correction is not finite near p = %.9g", x[c->problem.unknowns]);
}

/* A correction that only confirms the point before it. */
static bool confirms(const ric_curve_options *o, double size, double before) {
  return size <= o->newton_tol || (size <= rounding * o->newton_tol && size > before / 2);
}

/* A correction that the next one would only confirm, since convergence is superlinear. Its factors must be accurate
 * enough for tangents. */
static bool suffices(const ric_curve_options *o, double size, double before) {
  return before < INFINITY && size <= o->locate_tol && size * size <= o->newton_tol * before;
}

ric_status corrector_run(ric_curve *c, const double *row, double *x, bool near, int *iterations, ric_error *error) {
  double size = INFINITY;
  for (int k = *iterations = 0; k < c->options.iterations; k++) {
    double before = size;
    RIC_TRY(correct(c, row, x, &size, error));
    if (confirms(&c->options, size, before))
      return RIC_OK;
    ++*iterations;
    c->iterations++;
    if (suffices(&c->options, size, before))
      return RIC_OK;
    if (near && size > before)
      return ric_fail(error, RIC_ENUMERIC, "Newton's corrections grow from %.3g to %.3g at p = %.9g", before, size,
                      x[c->problem.unknowns]);
  }
  return ric_fail(error, RIC_ENUMERIC, "no convergence at p = %.9g: the last of %d corrections is %.3g",
                  x[c->problem.unknowns], c->options.iterations, size);
}

ric_status corrector_tangent(ric_curve *c, double *t, bordered_determinant *det, ric_error *error) {
  bordered_null_vector(&c->linear, t);
  double length = curve_norm(c, t);
  if (!(length > 0 && length < INFINITY))
    return ric_fail(error, RIC_ENUMERIC, "no tangent: the bordered Jacobian is singular");
  for (size_t i = 0; i < c->linear.size; i++)
    t[i] /= length;
  *det = bordered_det(&c->linear);
  det->log += ric_log(length); /* converts to the tangent as the row: <row, t> = 1 / length */
  return RIC_OK;
}

ric_status ric_curve_solve(ric_curve *curve, double *u, double p, int *iterations, ric_error *error) {
  REQUIRE(error, {"curve", curve}, {"u", u});
  size_t n = curve->problem.unknowns;
  double *x = curve->trial.x;
  int count = 0;
  memcpy(x, u, n * sizeof *u);
  x[n] = p;
  curve_parameter_row(curve, 1, curve->bound_row);
  keep_gsl_quiet();
  ric_status status = corrector_run(curve, curve->bound_row, x, false, &count, error);
  if (iterations)
    *iterations = count;
  if (status == RIC_OK)
    memcpy(u, x, n * sizeof *u);
  return status;
}

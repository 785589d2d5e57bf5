#include "corrector.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>

/* Corrections within this of the tolerance that no longer shrink are rounding of the residual. */
static const double rounding = 1000;

/* Rows of natural steps and of bounds hold the parameter: exactly, since problems may be undefined just beside it. */
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

/* A correction that the next would only confirm, since they shrink faster and faster. Its factors are to be good for
 * tangents as well. */
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
  det->log += log(length); /* as if the tangent were the row: <row, t> = 1 / length */
  return RIC_OK;
}

ric_status ric_curve_solve(ric_curve *curve, double *u, double p, int *iterations, ric_error *error) {
  size_t n = curve->problem.unknowns;
  double *x = curve->trial.x;
  int count = 0;
  memcpy(x, u, n * sizeof *u);
  x[n] = p;
  curve_parameter_row(curve, 1, curve->bound_row);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = corrector_run(curve, curve->bound_row, x, false, &count, error);
  gsl_set_error_handler(handler);
  if (iterations)
    *iterations = count;
  if (status == RIC_OK)
    memcpy(u, x, n * sizeof *u);
  return status;
}

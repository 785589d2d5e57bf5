#include "cycle_curve.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "numeric/largest.h"

enum { MOST_CORRECTIONS = 20 };

/* A correction below it, relative to the scales, is the last: what is left of it is about its square. */
static const double nearly_done = 1e-9;

/* Corrections that do not shrink any more below it are rounding. */
static const double rounding = 1e-5;

/* Scales are not below these parts of the largest: of an unknown that passes 0 on the way, and one whose size does
 * not matter to the equations. */
static const double least_part = 1e-3, least_column = 1e-12;

ric_status cycle_curve_init(cycle_curve *c, cycle_equations *equations, double p, double step, ric_error *error) {
  size_t size = equations->unknowns + 1;
  *c = (cycle_curve){.equations = equations, .size = size, .low = -INFINITY, .high = INFINITY};
  c->least_scale = p != 0 ? least_part * fabs(p) : 1;
  c->difference = 1e-4 * fmin(step, 1e-3);
  c->scale = calloc(3 * size, sizeof *c->scale);
  c->matrix = gsl_matrix_alloc(size, size);
  c->reflectors = gsl_vector_alloc(size);
  c->right = gsl_vector_alloc(size);
  if (!(c->scale && c->matrix && c->reflectors && c->right))
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu unknowns", size);
  c->columns = c->scale + size;
  c->beside = c->scale + 2 * size;
  return RIC_OK;
}

void cycle_curve_clear(cycle_curve *c) {
  free(c->scale);
  gsl_matrix_free(c->matrix);
  gsl_vector_free(c->reflectors);
  gsl_vector_free(c->right);
  *c = (cycle_curve){0};
}

/* --- lengths ------------------------------------------------------------------------------------------------------ */

static void set_scales(const double *x, size_t count, double least, double *scale) {
  for (size_t i = 0; i < count; i++)
    scale[i] = least > 0 ? fmax(fabs(x[i]), least) : 1;
}

/* States that matter to the border are of the size of d or y^2, over eta. States of one piece have one scale, since
 * coordinates may pass 0. */
void cycle_curve_measure(cycle_curve *c, const double *x) {
  const cycle_equations *e = c->equations;
  size_t m = e->map.size, states = e->pieces * m;
  double y = largest(x + states, e->impacts);
  if (c->least_y == 0)
    c->least_y = least_part * y;
  y = fmax(y, c->least_y);
  double unit = fmax(fabs(e->d), y * y) / largest(e->map.eta, m);
  for (size_t k = 0; k < e->pieces; k++) {
    double size = fmax(largest(x + k * m, m), least_part * unit);
    set_scales(x + k * m, m, size, c->scale + k * m);
    set_scales(x + k * m, m, least_column * size, c->columns + k * m);
  }
  set_scales(x + states, e->impacts, fmax(least_part * y, c->least_y), c->scale + states);
  memcpy(c->columns + states, c->scale + states, e->impacts * sizeof *c->scale);
  c->scale[e->unknowns] = c->columns[e->unknowns] = fmax(fabs(x[e->unknowns]), c->least_scale);
}

void cycle_curve_row(const cycle_curve *c, const double *direction, double *row) {
  size_t n = c->equations->unknowns;
  for (size_t i = 0; i < n; i++)
    row[i] = direction[i] / (c->scale[i] * c->scale[i]) / (double)n;
  row[n] = direction[n] / (c->scale[n] * c->scale[n]);
}

double cycle_curve_product(const cycle_curve *c, const double *a, const double *b) {
  size_t n = c->equations->unknowns;
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += (a[i] / c->scale[i]) * (b[i] / c->scale[i]);
  return sum / (double)n + (a[n] / c->scale[n]) * (b[n] / c->scale[n]);
}

/* --- linear equations --------------------------------------------------------------------------------------------- */

/* The residual's derivative by the parameter, by a difference towards the inside of its range. It directs Newton's
 * method only. */
static ric_status slope_in_parameter(cycle_curve *c, const double *x, const double *F, ric_error *error) {
  cycle_equations *e = c->equations;
  double p = x[e->unknowns], h = c->difference * c->scale[e->unknowns];
  if (p + h > c->high)
    h = -h;
  RIC_TRY(cycle_equations_set(e, p + h, error));
  cycle_equations_at(e, x, c->beside, NULL, 0, NULL);
  for (size_t i = 0; i < e->unknowns; i++)
    gsl_matrix_set(c->matrix, i, e->unknowns, (c->beside[i] - F[i]) / h);
  return cycle_equations_set(e, p, error);
}

/* The matrix with its last row, the right side -F and 0. @param moves  whether the parameter does */
static ric_status assemble(cycle_curve *c, const double *x, const double *row, bool moves, ric_error *error) {
  cycle_equations *e = c->equations;
  size_t n = e->unknowns;
  RIC_TRY(cycle_equations_set(e, x[n], error));
  cycle_equations_at(e, x, c->right->data, c->matrix->data, c->size, NULL);
  for (size_t i = 0; i < n; i++)
    gsl_matrix_set(c->matrix, i, n, 0);
  if (moves)
    RIC_TRY(slope_in_parameter(c, x, c->right->data, error));
  gsl_vector_scale(c->right, -1);
  gsl_vector_set(c->right, n, 0);
  for (size_t j = 0; j <= n; j++)
    gsl_matrix_set(c->matrix, n, j, row ? row[j] : j == n);
  return RIC_OK;
}

/* Solves for the right side, in its place. Columns and rows are scaled, so that what is small counts as much. */
static ric_status solve(cycle_curve *c, ric_error *error) {
  for (size_t i = 0; i < c->size; i++) {
    double largest = 0, *row = gsl_matrix_ptr(c->matrix, i, 0);
    for (size_t j = 0; j < c->size; j++)
      largest = fmax(largest, fabs(row[j] *= c->columns[j]));
    for (size_t j = 0; j < c->size; j++)
      row[j] /= largest;
    c->right->data[i] /= largest;
  }
  /* Not LU: GSL's takes memory, and does not look whether there is any. */
  gsl_linalg_QR_decomp(c->matrix, c->reflectors);
  bool solved = gsl_linalg_QR_svx(c->matrix, c->reflectors, c->right) == 0;
  for (size_t j = 0; j < c->size; j++) {
    c->right->data[j] *= c->columns[j];
    solved = solved && isfinite(c->right->data[j]);
  }
  return solved ? RIC_OK : ric_fail(error, RIC_ENUMERIC, "the equations of the cycle are singular");
}

/* --- points and tangents ------------------------------------------------------------------------------------------ */

/* Largest of a correction over the scales. */
static double relative(const cycle_curve *c, const double *by) {
  double largest = 0;
  for (size_t i = 0; i < c->size; i++)
    if (!(fabs(by[i]) <= largest * c->scale[i]))
      largest = fabs(by[i]) / c->scale[i];
  return largest;
}

ric_status cycle_curve_correct(cycle_curve *c, double *x, const double *row, double *moved, ric_error *error) {
  double before = INFINITY, way = 0;
  for (int k = 0; k < MOST_CORRECTIONS; k++) {
    RIC_TRY(assemble(c, x, row, row != NULL, error));
    RIC_TRY(solve(c, error));
    const double *by = c->right->data, size = relative(c, by);
    for (size_t i = 0; i < c->size; i++)
      x[i] += by[i];
    way += sqrt(cycle_curve_product(c, by, by));
    if (size <= nearly_done || (size >= before / 2 && size <= rounding)) {
      if (moved)
        *moved = way;
      return cycle_equations_set(c->equations, x[c->size - 1], error);
    }
    before = size;
  }
  return ric_fail(error, RIC_ENUMERIC, "Newton's method has not converged at p = %.17g: its last correction is %.3g",
                  x[c->size - 1], before);
}

ric_status cycle_curve_tangent(cycle_curve *c, const double *x, const double *row, double *tangent, ric_error *error) {
  RIC_TRY(assemble(c, x, row, true, error));
  gsl_vector_set_zero(c->right);
  gsl_vector_set(c->right, c->size - 1, 1);
  RIC_TRY(solve(c, error));
  double length = sqrt(cycle_curve_product(c, c->right->data, c->right->data));
  for (size_t i = 0; i < c->size; i++)
    tangent[i] = c->right->data[i] / length;
  return RIC_OK;
}

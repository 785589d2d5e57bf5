/* Cycles with a fixed itinerary: their equations, and the curve of cycles along the parameter. */
#include "cycle_equations.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "numeric/required.h"
#include "numeric/vector.h"

enum { MOST_PERIOD = 10000, MOST_UNKNOWNS = 500 };

/* Pieces end where the powers of L exceed it: the growth of errors within one of them. */
static const double most_growth = 100;

/* Two states are equal when they differ by less, over the largest number of the cycle. */
static const double same = 1e-9;

static void swap(double **a, double **b) {
  double *kept = *a;
  *a = *b;
  *b = kept;
}

/* next = L x for x [size][columns] */
static void apply(const ric_grazing_map *map, const double *x, size_t columns, double *next) {
  size_t m = map->size;
  for (size_t i = 0; i < m; i++)
    for (size_t c = 0; c < columns; c++) {
      double sum = 0;
      for (size_t j = 0; j < m; j++)
        sum += map->L[i * m + j] * x[j * columns + c];
      next[i * columns + c] = sum;
    }
}

/* --- life --------------------------------------------------------------------------------------------------------- */

static ric_status check_cycle(const ric_map_line *line, double p, size_t period, const double *z, ric_error *error) {
  REQUIRE(error, {"at", called(line->at != NULL)});
  if (period < 1 || period > MOST_PERIOD)
    return ric_fail(error, RIC_EINVAL, "period = %zu, expected 1 to %d", period, MOST_PERIOD);
  if (!isfinite(p))
    return ric_fail(error, RIC_EINVAL, "p = %g, expected a finite number", p);
  for (size_t i = 0; i < line->size; i++)
    if (!isfinite(z[i]))
      return ric_fail(error, RIC_EINVAL, "z[%zu] = %g, expected a finite number", i, z[i]);
  return RIC_OK;
}

static void set_itinerary(cycle_equations *e, const double *z) {
  size_t m = e->map.size;
  memcpy(e->z, z, m * sizeof *z);
  for (size_t k = 0; k < e->period; k++) {
    e->hits[k] = ric_grazing_map_hits(&e->map, e->d, e->z);
    e->impacts += e->hits[k];
    ric_grazing_map_step(&e->map, e->d, e->z, e->next);
    swap(&e->z, &e->next);
  }
}

static double largest_of(const double *x, size_t count) {
  double largest = 0;
  for (size_t i = 0; i < count; i++)
    if (!(fabs(x[i]) <= largest))
      largest = fabs(x[i]);
  return largest;
}

static void set_identity(double *x, size_t m) {
  memset(x, 0, m * m * sizeof *x);
  for (size_t i = 0; i < m; i++)
    x[i * m + i] = 1;
}

static void cut(cycle_equations *e) {
  size_t m = e->map.size;
  double *power = e->slopes, *next = e->next_slopes;
  e->pieces = 0;
  e->starts[e->pieces++] = 0;
  set_identity(power, m);
  for (size_t k = 1; k < e->period; k++) {
    apply(&e->map, power, m, next);
    swap(&power, &next);
    if (!(largest_of(power, m * m) <= most_growth)) {
      e->starts[e->pieces++] = k;
      set_identity(power, m);
    }
  }
  e->starts[e->pieces] = e->period;
}

static ric_status fail_without_memory(const cycle_equations *e, ric_error *error) {
  return ric_fail(error, RIC_ENOMEM, "no memory for a cycle of period %zu", e->period);
}

static ric_status allocate_cycle(cycle_equations *e, ric_error *error) {
  size_t m = e->map.size;
  e->hits = calloc(e->period, sizeof *e->hits);
  e->starts = calloc(e->period + 1, sizeof *e->starts);
  e->z = calloc(m, sizeof *e->z);
  e->next = calloc(m, sizeof *e->next);
  e->slopes = calloc(m * m, sizeof *e->slopes);
  e->next_slopes = calloc(m * m, sizeof *e->next_slopes);
  if (!(e->hits && e->starts && e->z && e->next && e->slopes && e->next_slopes))
    return fail_without_memory(e, error);
  return ric_multipliers_init(&e->multipliers, m, error);
}

/* Allocates derivatives by all unknowns; there are at least as many unknowns as numbers of a state. */
static ric_status reserve_cycle(cycle_equations *e, ric_error *error) {
  size_t m = e->map.size;
  e->unknowns = e->pieces * m + e->impacts;
  if (e->unknowns > MOST_UNKNOWNS)
    return ric_fail(error, RIC_ELIMIT, "%zu unknowns: %zu impacts, %zu pieces; expected at most %d", e->unknowns,
                    e->impacts, e->pieces, MOST_UNKNOWNS);
  free(e->slopes);
  free(e->next_slopes);
  e->slopes = calloc(m * e->unknowns, sizeof *e->slopes);
  e->next_slopes = calloc(m * e->unknowns, sizeof *e->next_slopes);
  return e->slopes && e->next_slopes ? RIC_OK : fail_without_memory(e, error);
}

ric_status cycle_equations_set(cycle_equations *e, double p, ric_error *error) {
  RIC_TRY(e->line->at(p, &e->map, &e->d, e->line->user, error));
  RIC_TRY(ric_grazing_map_check(&e->map, error));
  if (!isfinite(e->d))
    return ric_fail(error, RIC_EINVAL, "d = %g at p = %g, expected a finite number", e->d, p);
  e->parameter = p;
  return RIC_OK;
}

ric_status cycle_equations_init(cycle_equations *e, const ric_map_line *line, double p, size_t period, const double *z,
                                ric_error *error) {
  *e = (cycle_equations){.line = line, .period = period};
  RIC_TRY(check_cycle(line, p, period, z, error));
  RIC_TRY(ric_grazing_map_init(&e->map, line->size, error));
  RIC_TRY(allocate_cycle(e, error));
  RIC_TRY(cycle_equations_set(e, p, error));
  set_itinerary(e, z);
  cut(e);
  return reserve_cycle(e, error);
}

void cycle_equations_clear(cycle_equations *e) {
  ric_grazing_map_clear(&e->map);
  ric_multipliers_clear(&e->multipliers);
  free(e->hits);
  free(e->starts);
  free(e->z);
  free(e->next);
  free(e->slopes);
  free(e->next_slopes);
  *e = (cycle_equations){0};
}

/* --- iterates ----------------------------------------------------------------------------------------------------- */

void cycle_equations_guess(cycle_equations *e, const double *z, double *x) {
  size_t m = e->map.size;
  double *y = x + e->pieces * m;
  memcpy(e->z, z, m * sizeof *z);
  for (size_t k = 0, piece = 0; k < e->period; k++) {
    if (k == e->starts[piece])
      memcpy(x + piece++ * m, e->z, m * sizeof *x);
    if (e->hits[k])
      *y++ = sqrt(fmax(0, e->d - dot(e->map.eta, e->z, m)));
    ric_grazing_map_step(&e->map, e->d, e->z, e->next);
    swap(&e->z, &e->next);
  }
}

static void begin_piece(cycle_equations *e, size_t piece, const double *x) {
  size_t m = e->map.size;
  memcpy(e->z, x + piece * m, m * sizeof *x);
  memset(e->slopes, 0, m * e->unknowns * sizeof *e->slopes);
  for (size_t i = 0; i < m; i++)
    e->slopes[i * e->unknowns + piece * m + i] = 1;
}

/* y^2 + eta z - d = 0 */
static void impact_row(const cycle_equations *e, double y, size_t which, double *F, double *J, size_t stride) {
  size_t m = e->map.size, row = e->pieces * m + which;
  F[row] = y * y + dot(e->map.eta, e->z, m) - e->d;
  if (!J)
    return;
  for (size_t c = 0; c < e->unknowns; c++) {
    double sum = 0;
    for (size_t i = 0; i < m; i++)
      sum += e->map.eta[i] * e->slopes[i * e->unknowns + c];
    J[row * stride + c] = sum;
  }
  J[row * stride + row] += 2 * y;
}

static void advance_iterates(cycle_equations *e, bool with_slopes) {
  apply(&e->map, e->z, 1, e->next);
  swap(&e->z, &e->next);
  if (!with_slopes)
    return;
  apply(&e->map, e->slopes, e->unknowns, e->next_slopes);
  swap(&e->slopes, &e->next_slopes);
}

/* The contribution of the impact to an iterate. */
static void add_impact(cycle_equations *e, double y, size_t which) {
  size_t m = e->map.size, column = e->pieces * m + which;
  double s = e->map.stretch;
  for (size_t i = 0; i < m; i++) {
    e->z[i] += y * s * e->map.xi[i] + y * y * e->map.kappa[i];
    e->slopes[i * e->unknowns + column] += s * e->map.xi[i] + 2 * y * e->map.kappa[i];
  }
}

/* The end of a piece is the beginning of the next, or of the first. */
static void closing_rows(const cycle_equations *e, size_t piece, const double *x, double *F, double *J, size_t stride) {
  size_t m = e->map.size, next = piece + 1 == e->pieces ? 0 : (piece + 1) * m;
  for (size_t i = 0; i < m; i++) {
    size_t row = piece * m + i;
    F[row] = e->z[i] - x[next + i];
    if (!J)
      continue;
    memcpy(J + row * stride, e->slopes + i * e->unknowns, e->unknowns * sizeof *J);
    J[row * stride + next + i] -= 1;
  }
}

void cycle_equations_at(cycle_equations *e, const double *x, double *F, double *J, size_t stride, double *clearance) {
  const double *y = x + e->pieces * e->map.size;
  for (size_t piece = 0, which = 0; piece < e->pieces; piece++) {
    begin_piece(e, piece, x);
    for (size_t k = e->starts[piece]; k < e->starts[piece + 1]; k++) {
      if (clearance)
        clearance[k] = e->hits[k] ? y[which] : dot(e->map.eta, e->z, e->map.size) - e->d;
      if (e->hits[k])
        impact_row(e, y[which], which, F, J, stride);
      advance_iterates(e, J != NULL);
      if (e->hits[k]) {
        add_impact(e, y[which], which);
        which++;
      }
    }
    closing_rows(e, piece, x, F, J, stride);
  }
}

ric_status cycle_equations_spectrum(cycle_equations *e, const double *x, ric_error *error) {
  const ric_grazing_map *map = &e->map;
  size_t m = map->size;
  const double *y = x + e->pieces * m;
  set_identity(e->slopes, m);
  for (size_t k = 0; k < e->period; k++) {
    apply(map, e->slopes, m, e->next_slopes);
    for (size_t c = 0; c < m && e->hits[k]; c++) {
      double fall = 0;
      for (size_t i = 0; i < m; i++)
        fall += map->eta[i] * e->slopes[i * m + c];
      for (size_t i = 0; i < m; i++) /* [FN97] (5.11), no infinity times 0 at the border */
        e->next_slopes[i * m + c] -=
            (map->kappa[i] + (map->xi[i] != 0 ? map->stretch / (2 * *y) * map->xi[i] : 0)) * fall;
    }
    y += e->hits[k];
    swap(&e->slopes, &e->next_slopes);
  }
  for (size_t i = 0; i < m * m; i++)
    if (!isfinite(e->slopes[i]))
      return ric_fail(error, RIC_ENUMERIC, "the derivative of iterate %zu overflows at p = %.17g", e->period,
                      e->parameter);
  return ric_multipliers_of_matrix(e->slopes, m, 0, NULL, &e->multipliers, error);
}

/* Whether the cycle repeats after so many iterates: the itinerary is that of the beginning, and the y and first
 * states are equal. Iterates without impacts do not reduce differences. */
static bool repeats_after(const cycle_equations *e, size_t part, const double *y, double largest) {
  size_t first = 0, second = 0;
  for (size_t k = 0; k < part; k++)
    second += e->hits[k];
  for (size_t k = 0; k + part < e->period; k++) {
    if (e->hits[k] != e->hits[k + part])
      return false;
    if (e->hits[k] && !(fabs(y[first++] - y[second++]) <= same * largest))
      return false;
  }
  return true;
}

size_t cycle_equations_least_period(cycle_equations *e, const double *x) {
  const double *y = x + e->pieces * e->map.size;
  double largest = largest_of(y, e->impacts);
  for (size_t part = 1; part < e->period; part++)
    if (e->period % part == 0 && repeats_after(e, part, y, largest))
      return part;
  return e->period;
}

enum { MOST_CORRECTIONS = 20 };

/* A correction below it, relative to the scales, is the last one: the remaining error is about its square. */
static const double nearly_done = 1e-9;

/* Below it, corrections that do not decrease any more are rounding. */
static const double rounding = 1e-5;

/* Lower bounds of scales over the largest: of an unknown that passes zero, and of one whose size does not affect the
 * equations. */
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

/* States that determine the border have the size of d or y^2, over eta. All states of a piece have one scale, since
 * single coordinates may pass 0. */
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

/* The residual's derivative by the parameter, by a difference towards the inside of its range. Its error affects the
 * convergence of Newton's method only. */
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

/* The matrix with its last row, the right side -F and 0. @param moves  whether the parameter is variable */
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

/* Solves for the right side in place. Columns and rows are scaled, so that small unknowns and equations count
 * equally. */
static ric_status solve_corrections(cycle_curve *c, ric_error *error) {
  for (size_t i = 0; i < c->size; i++) {
    double largest = 0, *row = gsl_matrix_ptr(c->matrix, i, 0);
    for (size_t j = 0; j < c->size; j++)
      largest = fmax(largest, fabs(row[j] *= c->columns[j]));
    for (size_t j = 0; j < c->size; j++)
      row[j] /= largest;
    c->right->data[i] /= largest;
  }
  /* Not LU: GSL's allocates memory and does not check whether that succeeds. */
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
    RIC_TRY(solve_corrections(c, error));
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
  RIC_TRY(solve_corrections(c, error));
  double length = sqrt(cycle_curve_product(c, c->right->data, c->right->data));
  for (size_t i = 0; i < c->size; i++)
    tangent[i] = c->right->data[i] / length;
  return RIC_OK;
}

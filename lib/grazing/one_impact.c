/* One-impact orbits of the return map near grazing, in closed form. */
#include "one_impact.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_poly.h>

#include "ricochet/grazing_map.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Largest period of the closed forms: rounding errors accumulate, and d decreases by lambda^2 with each period. */
enum { MOST_PERIOD = 10000 };

static ric_status allocate_one_impact(one_impact *o, ric_error *error) {
  size_t m = o->map->size, n = o->period;
  o->first = calloc(n, sizeof *o->first);
  o->second = calloc(n, sizeof *o->second);
  o->xi = gsl_vector_alloc(m);
  o->kappa = gsl_vector_alloc(m);
  o->vector = gsl_vector_alloc(m);
  o->reflectors = gsl_vector_alloc(m);
  o->norms = gsl_vector_alloc(m);
  o->power = gsl_matrix_alloc(m, m);
  o->factors = gsl_matrix_alloc(m, m);
  o->derivative = gsl_matrix_alloc(m, m);
  o->order = gsl_permutation_alloc(m);
  bool has_vectors = o->first && o->second && o->xi && o->kappa && o->vector && o->reflectors && o->norms;
  if (!(has_vectors && o->power && o->factors && o->derivative && o->order))
    return ric_fail(error, RIC_ENOMEM, "no memory for orbits of period %zu of a map of size %zu", n, m);
  return ric_multipliers_init(&o->multipliers, m, error);
}

/* L^n by squaring, in the memory of the matrices of the solves and the derivative. */
static void raise_power(one_impact *o) {
  gsl_matrix *square = o->factors, *product = o->derivative;
  size_t m = o->map->size;
  memcpy(square->data, o->map->L, m * m * sizeof *square->data);
  gsl_matrix_set_identity(o->power);
  for (size_t rest = o->period; rest > 0; rest /= 2) {
    if (rest % 2 == 1) {
      gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, o->power, square, 0, product);
      gsl_matrix_memcpy(o->power, product);
    }
    if (rest > 1) { /* the next square may overflow where L^n does not */
      gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, square, square, 0, product);
      gsl_matrix_memcpy(square, product);
    }
  }
}

/* Computes scale e L^(j-1) x, j = 1 ... n, and sets x to L^(n-1) x. */
static void project(one_impact *o, const gsl_vector *e, double scale, gsl_vector *x, double *values) {
  size_t m = o->map->size;
  gsl_matrix_const_view L = gsl_matrix_const_view_array(o->map->L, m, m);
  gsl_vector_view next = gsl_matrix_row(o->derivative, 0);
  for (size_t j = 0; j < o->period; j++) {
    if (j > 0) {
      gsl_blas_dgemv(CblasNoTrans, 1, &L.matrix, x, 0, &next.vector);
      gsl_vector_memcpy(x, &next.vector);
    }
    gsl_blas_ddot(e, x, &values[j]);
    values[j] *= scale;
  }
}

/* Whether the last and smallest pivot is rounding relative to the largest entry of the matrix. */
static bool is_singular(const gsl_matrix *factors, double largest) {
  size_t m = factors->size1;
  return !(fabs(gsl_matrix_get(factors, m - 1, m - 1)) > (double)m * DBL_EPSILON * largest);
}

ric_status one_impact_solve(one_impact *o, int sign, bool transposed, gsl_vector *b, ric_error *error) {
  size_t m = o->map->size;
  double largest = 1; /* I and L^n may cancel: the difference is compared with them */
  int parity;
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < m; j++) {
      double entry = transposed ? gsl_matrix_get(o->power, j, i) : gsl_matrix_get(o->power, i, j);
      if (!isfinite(entry))
        return ric_fail(error, RIC_ENUMERIC, "period = %zu: L^n overflows", o->period);
      largest = fmax(largest, fabs(entry));
      gsl_matrix_set(o->factors, i, j, (i == j) + sign * entry);
    }
  /* Not LU: that of GSL allocates without checking. */
  gsl_linalg_QRPT_decomp(o->factors, o->reflectors, o->order, &parity, o->norms);
  if (is_singular(o->factors, largest) || gsl_linalg_QRPT_svx(o->factors, o->reflectors, o->order, b) != 0)
    return ric_fail(error, RIC_ENUMERIC, "period = %zu: I %c L^n is singular", o->period, sign < 0 ? '-' : '+');
  return RIC_OK;
}

ric_status one_impact_init(one_impact *o, const ric_grazing_map *map, size_t period, ric_error *error) {
  *o = (one_impact){.map = map, .period = period};
  if (period < 1 || period > MOST_PERIOD)
    return ric_fail(error, RIC_EINVAL, "period = %zu, expected 1 to %d", period, MOST_PERIOD);
  RIC_TRY(ric_grazing_map_check(map, error));
  RIC_TRY(allocate_one_impact(o, error));
  size_t bytes = map->size * sizeof *map->xi;
  raise_power(o);
  memcpy(o->vector->data, map->eta, bytes);
  RIC_TRY(one_impact_solve(o, -1, true, o->vector, error));
  memcpy(o->xi->data, map->xi, bytes);
  memcpy(o->kappa->data, map->kappa, bytes);
  project(o, o->vector, map->stretch, o->xi, o->first);
  project(o, o->vector, 1, o->kappa, o->second);
  return RIC_OK;
}

void one_impact_clear(one_impact *o) {
  free(o->first);
  free(o->second);
  gsl_vector_free(o->xi);
  gsl_vector_free(o->kappa);
  gsl_vector_free(o->vector);
  gsl_vector_free(o->reflectors);
  gsl_vector_free(o->norms);
  gsl_matrix_free(o->power);
  gsl_matrix_free(o->factors);
  gsl_matrix_free(o->derivative);
  gsl_permutation_free(o->order);
  ric_multipliers_clear(&o->multipliers);
  *o = (one_impact){0};
}

double one_impact_d(const one_impact *o, double y) {
  double first = o->first[o->period - 1], second = 1 + o->second[o->period - 1];
  if (y == INFINITY && second == 0) /* not 0 times infinity */
    return first == 0 ? 0 : y * first;
  return y == INFINITY ? y * second : y * (first + y * second);
}

void one_impact_clearance(const one_impact *o, size_t j, double *steady, double *slope) {
  *steady = o->first[j - 1] - o->first[o->period - 1];
  *slope = o->second[j - 1] - o->second[o->period - 1] - 1;
}

ric_status one_impact_multipliers(one_impact *o, double y, ric_error *error) {
  size_t m = o->map->size;
  gsl_vector_const_view eta = gsl_vector_const_view_array(o->map->eta, m);
  gsl_matrix_memcpy(o->derivative, o->power);
  gsl_blas_dger(-o->map->stretch / (2 * y), o->xi, &eta.vector, o->derivative);
  gsl_blas_dger(-1, o->kappa, &eta.vector, o->derivative);
  for (size_t i = 0; i < m * m; i++)
    if (!isfinite(o->derivative->data[i]))
      return ric_fail(error, RIC_ENUMERIC, "y = %g: the derivative of iterate %zu overflows", y, o->period);
  return ric_multipliers_of_matrix(o->derivative->data, m, 0, NULL, &o->multipliers, error);
}

/* Finds the other iterate nearest to the border. */
static void find_nearest(const one_impact *o, double y, ric_grazing_cycle *cycle) {
  cycle->nearest = 0;
  cycle->clearance = INFINITY;
  for (size_t j = 1; j < o->period; j++) {
    double steady, slope;
    one_impact_clearance(o, j, &steady, &slope);
    double clearance = y * (steady + y * slope);
    if (!(clearance >= cycle->clearance)) {
      cycle->nearest = j;
      cycle->clearance = clearance;
    }
  }
  cycle->admissible = cycle->clearance > 0;
}

static ric_status describe(one_impact *o, double y, ric_grazing_cycle *cycle, ric_error *error) {
  ric_grazing_cycle found = {.period = o->period, .y = y, .d = one_impact_d(o, y)};
  if (!isfinite(found.d))
    return ric_fail(error, RIC_ENUMERIC, "y = %g: d overflows", y);
  find_nearest(o, y, &found);
  RIC_TRY(one_impact_multipliers(o, y, error));
  found.largest = o->multipliers.mu[0];
  found.stable = o->multipliers.largest < 1;
  *cycle = found;
  return RIC_OK;
}

/* The state at the impact: z = (I - L^n)^-1 L^(n-1) (y s xi + y^2 kappa). */
static ric_status find_state(one_impact *o, double y, double *z, ric_error *error) {
  gsl_vector_set_zero(o->vector);
  gsl_blas_daxpy(y * o->map->stretch, o->xi, o->vector);
  gsl_blas_daxpy(y * y, o->kappa, o->vector);
  RIC_TRY(one_impact_solve(o, -1, false, o->vector, error));
  memcpy(z, o->vector->data, o->map->size * sizeof *z);
  return RIC_OK;
}

ric_status ric_grazing_cycle_at(const ric_grazing_map *map, size_t period, double y, ric_grazing_cycle *cycle,
                                double *z, ric_error *error) {
  REQUIRE(error, {"map", map}, {"cycle", cycle});
  one_impact orbits;
  if (!(y > 0 && isfinite(y)))
    return ric_fail(error, RIC_EINVAL, "y = %g, expected a finite number > 0", y);
  keep_gsl_quiet();
  ric_status status = one_impact_init(&orbits, map, period, error);
  if (status == RIC_OK)
    status = describe(&orbits, y, cycle, error);
  if (status == RIC_OK && z)
    status = find_state(&orbits, y, z, error);
  one_impact_clear(&orbits);
  return status;
}

/* Solutions y > 0 at a d, smallest first. @param y  [2] @returns how many */
static size_t solve_for_y(const one_impact *o, double d, double *y) {
  double first = o->first[o->period - 1], second = 1 + o->second[o->period - 1], roots[2];
  double unit = d == 0 ? 1 : sqrt(fabs(d)); /* unit of y, so that no square of a small d underflows */
  int found = gsl_poly_solve_quadratic(second, first / unit, d == 0 ? 0 : d < 0 ? 1 : -1, &roots[0], &roots[1]);
  size_t count = 0;
  for (int i = 0; i < found; i++) {
    bool again = i > 0 && roots[i] == roots[i - 1]; /* GSL gives a double root, the fold, twice */
    if (roots[i] * unit > 0 && !again)
      y[count++] = roots[i] * unit;
  }
  return count;
}

ric_status ric_grazing_cycles(const ric_grazing_map *map, size_t period, double d, ric_grazing_cycle *cycles,
                              size_t *count, ric_error *error) {
  REQUIRE(error, {"map", map}, {"cycles", cycles}, {"count", count});
  one_impact orbits;
  ric_grazing_cycle list[2];
  double y[2];
  size_t found = 0;
  if (!isfinite(d))
    return ric_fail(error, RIC_EINVAL, "d = %g, expected a finite number", d);
  keep_gsl_quiet();
  ric_status status = one_impact_init(&orbits, map, period, error);
  if (status == RIC_OK)
    found = solve_for_y(&orbits, d, y);
  for (size_t i = 0; i < found && status == RIC_OK; i++) {
    status = describe(&orbits, y[i], &list[i], error);
    list[i].d = d; /* not that of the rounded y */
  }
  one_impact_clear(&orbits);
  if (status == RIC_OK) {
    memcpy(cycles, list, found * sizeof *list);
    *count = found;
  }
  return status;
}

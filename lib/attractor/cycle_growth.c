#include "cycle_growth.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include <gsl/gsl_blas.h>

#include "numeric/vector.h"
#include "ricochet/elementary.h"

/* Multipliers below this fraction of the largest entry of the derivative are rounding. */
static const double resolved = 1e-10;

void cycle_growth_clear(cycle_growth *g) {
  multiplier_work_clear(&g->work);
  ric_multipliers_clear(&g->multipliers);
  orthonormal_clear(&g->tangents);
  free(g->product);
  *g = (cycle_growth){0};
}

ric_status cycle_growth_init(cycle_growth *g, size_t size, ric_error *error) {
  *g = (cycle_growth){.product = calloc(3 * size * size + 2 * size, sizeof *g->product)};
  ric_status status =
      g->product ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for derivatives of a map of size %zu", size);
  if (status == RIC_OK)
    status = multiplier_work_init(&g->work, size, error);
  if (status == RIC_OK)
    status = ric_multipliers_init(&g->multipliers, size, error);
  if (status == RIC_OK)
    status = orthonormal_init(&g->tangents, size, size, error);
  if (status != RIC_OK) {
    cycle_growth_clear(g);
    return status;
  }
  g->size = size;
  g->next = g->product + size * size;
  g->derivative = g->next + size * size;
  g->once = g->derivative + size * size;
  g->rate = g->once + size;
  return RIC_OK;
}

size_t cycle_growth_resolve(cycle_growth *g, size_t period, double *exponents, size_t count) {
  const ric_multiplier_options options = ric_multiplier_options_default();
  const double size = largest(g->product, g->size * g->size);
  size_t known = 0;
  if (!isfinite(size) || multiplier_work_find(&g->work, g->product, 0, &options, &g->multipliers, NULL) != RIC_OK)
    return 0;
  for (; known < count; known++) {
    const double modulus = ric_hypot(g->multipliers.mu[known].re, g->multipliers.mu[known].im);
    if (!(modulus > resolved * size))
      break;
    exponents[known] = ric_log(modulus) / (double)period;
  }
  return known;
}

double cycle_impacts(const ric_grazing_map *map, double d, const double *states, size_t period) {
  size_t impacts = 0;
  for (size_t k = 0; k < period; k++)
    impacts += ric_grazing_map_hits(map, d, states + k * map->size);
  return (double)impacts / (double)period;
}

/* The columns of `product` through one period; with `tangents` made orthonormal after each iterate, their growth in
 * `rate`. @returns RIC_ESTOPPED */
static ric_status pass_period(cycle_growth *g, const ric_grazing_map *map, double d, const double *states,
                              size_t period, bool tangents, ric_poll poll, ric_error *error) {
  const size_t n = g->size;
  gsl_matrix_view next = gsl_matrix_view_array(g->next, n, n), so_far = gsl_matrix_view_array(g->product, n, n);
  gsl_matrix_view here = gsl_matrix_view_array(g->derivative, n, n);
  for (size_t i = 0; i < n; i++)
    g->rate[i] = 0;
  for (size_t k = 0; k < period; k++) {
    if (n > 50 && ric_poll_stops(poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped by the poll callback");
    ric_grazing_map_derivative(map, d, states + k * n, g->derivative);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &here.matrix, &so_far.matrix, 0, &next.matrix);
    gsl_matrix_memcpy(&so_far.matrix, &next.matrix);
    if (tangents)
      orthonormal_make(&g->tangents, g->product, g->once);
    for (size_t i = 0; tangents && i < n; i++)
      g->rate[i] += g->once[i];
  }
  return RIC_OK;
}

/* The first passes turn the vectors. */
static ric_status measure_tangents(cycle_growth *g, const ric_grazing_map *map, double d, const double *states,
                                   size_t period, ric_poll poll, ric_error *error) {
  enum { PASSES = 3 };
  orthonormal_scatter(&g->tangents, g->product, g->once);
  for (int i = 0; i < PASSES; i++)
    RIC_TRY(pass_period(g, map, d, states, period, true, poll, error));
  return RIC_OK;
}

ric_status cycle_exponents(cycle_growth *g, const ric_grazing_map *map, double d, const double *states, size_t period,
                           ric_poll poll, double *exponents, size_t count, ric_error *error) {
  const size_t n = g->size;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      g->product[i * n + j] = i == j;
  RIC_TRY(pass_period(g, map, d, states, period, false, poll, error));
  size_t known = cycle_growth_resolve(g, period, exponents, count);
  if (known == 0)
    return RIC_OK; /* a state on the border */
  if (known < count)
    RIC_TRY(measure_tangents(g, map, d, states, period, poll, error));
  for (; known < count; known++)
    exponents[known] = g->rate[known] / (double)period;
  return RIC_OK;
}

#include "ricochet/grazing_map.h"
#include "numeric/required.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/elementary.h"

/* --- storage ------------------------------------------------------------------------------------------------------ */

ric_status ric_grazing_map_init(ric_grazing_map *map, size_t size, ric_error *error) {
  REQUIRE(error, {"map", map});
  *map = (ric_grazing_map){0};
  if (size < 1)
    return ric_fail(error, RIC_EINVAL, "size = 0, expected at least 1");
  double *block = size < (size_t)1 << sizeof(size_t) * 3 ? calloc(size * (size + 3), sizeof *block) : NULL;
  if (!block)
    return ric_fail(error, RIC_ENOMEM, "no memory for a map of size %zu", size);
  double *after = block + size * size;
  *map = (ric_grazing_map){
      .size = size, .L = block, .eta = after, .xi = after + size, .kappa = after + 2 * size, .stretch = 1};
  return RIC_OK;
}

void ric_grazing_map_clear(ric_grazing_map *map) {
  if (!map)
    return;
  free(map->L); /* the block that holds them all */
  *map = (ric_grazing_map){0};
}

/* Rejects entries that are not finite, and a vector of zeros if that is not allowed. */
static ric_status check_vector(const char *name, const double *x, size_t size, bool may_vanish, ric_error *error) {
  bool vanishes = true;
  for (size_t i = 0; i < size; i++) {
    if (!isfinite(x[i]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected a finite number", name, i, x[i]);
    vanishes = vanishes && x[i] == 0;
  }
  if (vanishes && !may_vanish)
    return ric_fail(error, RIC_EINVAL, "%s = 0, expected a vector other than 0", name);
  return RIC_OK;
}

ric_status ric_grazing_map_check(const ric_grazing_map *map, ric_error *error) {
  REQUIRE(error, {"map", map});
  size_t n = map->size;
  if (n < 1)
    return ric_fail(error, RIC_EINVAL, "size = 0, expected at least 1");
  for (size_t i = 0; i < n * n; i++)
    if (!isfinite(map->L[i]))
      return ric_fail(error, RIC_EINVAL, "L[%zu][%zu] = %g, expected a finite number", i / n, i % n, map->L[i]);
  RIC_TRY(check_vector("eta", map->eta, n, false, error));
  RIC_TRY(check_vector("xi", map->xi, n, false, error));
  RIC_TRY(check_vector("kappa", map->kappa, n, true, error));
  if (!(map->stretch > 0 && isfinite(map->stretch)))
    return ric_fail(error, RIC_EINVAL, "stretch = %g, expected a finite number > 0", map->stretch);
  return RIC_OK;
}

ric_status ric_grazing_map_example(ric_grazing_map *map, double lambda, double omega, ric_error *error) {
  REQUIRE(error, {"map", map});
  *map = (ric_grazing_map){0};
  if (!isfinite(lambda))
    return ric_fail(error, RIC_EINVAL, "lambda = %g, expected a finite number", lambda);
  if (!isfinite(omega))
    return ric_fail(error, RIC_EINVAL, "omega = %g, expected a finite number", omega);
  RIC_TRY(ric_grazing_map_init(map, 3, error));
  const double L[] = {lambda, 0, 0, 0, 0, -omega, 0, omega, 0}; /* [FN97] (6.3) */
  memcpy(map->L, L, sizeof L);
  map->eta[0] = 1; /* [FN97] (6.2) */
  for (size_t i = 0; i < 3; i++)
    map->xi[i] = 1; /* [FN97] (6.5) */
  map->kappa[0] = lambda + 3;
  map->kappa[1] = -5;
  map->kappa[2] = 7;
  return RIC_OK;
}

/* --- iterates ----------------------------------------------------------------------------------------------------- */

/* How far z lies beyond the border: d - eta z. */
static double depth_of(const ric_grazing_map *map, double d, const double *z) {
  double sum = 0;
  for (size_t i = 0; i < map->size; i++)
    sum += map->eta[i] * z[i];
  return d - sum;
}

bool ric_grazing_map_hits(const ric_grazing_map *map, double d, const double *z) {
  return depth_of(map, d, z) >= 0;
}

void ric_grazing_map_step(const ric_grazing_map *map, double d, const double *z, double *next) {
  size_t n = map->size;
  double depth = depth_of(map, d, z);
  for (size_t i = 0; i < n; i++) {
    next[i] = 0;
    for (size_t j = 0; j < n; j++)
      next[i] += map->L[i * n + j] * z[j];
  }
  if (depth < 0)
    return;
  double root = map->stretch * sqrt(depth); /* NaN of d or z propagates to next */
  for (size_t i = 0; i < n; i++)
    next[i] += root * map->xi[i] + depth * map->kappa[i]; /* [FN97] (5.11) */
}

void ric_grazing_map_derivative(const ric_grazing_map *map, double d, const double *z, double *derivative) {
  size_t n = map->size;
  double depth = depth_of(map, d, z);
  memcpy(derivative, map->L, n * n * sizeof *derivative);
  if (depth < 0)
    return;
  double slope = map->stretch / (2 * sqrt(depth));
  for (size_t i = 0; i < n; i++) {
    /* No infinity times 0 at the border. */
    double fall = map->kappa[i] + (map->xi[i] != 0 ? slope * map->xi[i] : 0);
    for (size_t j = 0; j < n; j++)
      if (map->eta[j] != 0)
        derivative[i * n + j] -= fall * map->eta[j];
  }
}

ric_status ric_grazing_map_return(const ric_grazing_map *map, double d, double *z, size_t most, double *work,
                                  size_t *count, ric_error *error) {
  REQUIRE(error, {"map", map}, {"z", z}, {"work", work}, {"count", count});
  double depth = depth_of(map, d, z);
  *count = 0;
  if (!(depth >= 0))
    return ric_fail(error, RIC_EINVAL, "eta z - d = %g, expected an impact: at most 0", -depth);
  for (size_t i = 0; i < most; i++) {
    ric_grazing_map_step(map, d, z, work);
    memcpy(z, work, map->size * sizeof *z);
    if (ric_grazing_map_hits(map, d, z))
      return RIC_OK;
    ++*count;
  }
  return ric_fail(error, RIC_ENUMERIC, "no impact follows within %zu iterates", most);
}

double ric_grazing_limit_map(double rho, double lambda, double delta, size_t *count) {
  double first = rho * sqrt(1 - delta), N = 0;
  if (count)
    *count = 0;
  if (!(rho > 0 && lambda > 0 && lambda < 1 && delta <= 1 && isfinite(first)))
    return NAN;
  if (first > 1) {
    N = ceil(ric_log(first) / -ric_log(lambda));
    if (first * ric_pow(lambda, N) > 1) /* the logarithms are rounded: N may be one off */
      N++;
    else if (N > 1 && first * ric_pow(lambda, N - 1) <= 1)
      N--;
  }
  if (count)
    *count = (size_t)N;
  return first * ric_pow(lambda, N); /* [FN97] (5.14) */
}

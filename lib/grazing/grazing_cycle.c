#include "ricochet/grazing_map.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_poly.h>

#include "one_impact.h"

/* Which of the other iterates is nearest to the border. */
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
  one_impact orbits;
  if (!(y > 0 && isfinite(y)))
    return ric_fail(error, RIC_EINVAL, "y = %g, expected a finite number > 0", y);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = one_impact_init(&orbits, map, period, error);
  if (status == RIC_OK)
    status = describe(&orbits, y, cycle, error);
  if (status == RIC_OK && z)
    status = find_state(&orbits, y, z, error);
  one_impact_clear(&orbits);
  gsl_set_error_handler(handler);
  return status;
}

/* Which y > 0 exist at a d, smallest first. @param y  [2] @returns how many */
static size_t solve_for_y(const one_impact *o, double d, double *y) {
  double first = o->first[o->period - 1], second = 1 + o->second[o->period - 1], roots[2];
  double unit = d == 0 ? 1 : sqrt(fabs(d)); /* of y, so that no square of a small d underflows */
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
  one_impact orbits;
  ric_grazing_cycle list[2];
  double y[2];
  size_t found = 0;
  if (!isfinite(d))
    return ric_fail(error, RIC_EINVAL, "d = %g, expected a finite number", d);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = one_impact_init(&orbits, map, period, error);
  if (status == RIC_OK)
    found = solve_for_y(&orbits, d, y);
  for (size_t i = 0; i < found && status == RIC_OK; i++) {
    status = describe(&orbits, y[i], &list[i], error);
    list[i].d = d; /* not that of the rounded y */
  }
  one_impact_clear(&orbits);
  gsl_set_error_handler(handler);
  if (status == RIC_OK) {
    memcpy(cycles, list, found * sizeof *list);
    *count = found;
  }
  return status;
}

#include "comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- sets of numbers ---------------------------------------------------------------------------------------------- */

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* How far that of sorted a is which is farthest from all of sorted b. */
static double one_way(const double *a, const double *b, size_t count) {
  double most = 0;
  for (size_t i = 0, k = 0; i < count; i++) {
    while (k + 1 < count && b[k + 1] <= a[i])
      k++;
    const double next = k + 1 < count ? fabs(b[k + 1] - a[i]) : INFINITY;
    most = fmax(most, fmin(fabs(b[k] - a[i]), next));
  }
  return most;
}

double comparison_distance(double *a, double *b, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(a[i]) || !isfinite(b[i]))
      return NAN;
  qsort(a, count, sizeof *a, by_size);
  qsort(b, count, sizeof *b, by_size);
  return fmax(one_way(a, b, count), one_way(b, a, count)) / (b[count - 1] - b[0]);
}

/* --- the row ------------------------------------------------------------------------------------------------------ */

/* Numbers that are not known. */
static void put_nothing(const iterated *it, diagram_row *row) {
  row->parameter = row->d = row->map_impacts = row->map_lyapunov = row->distance = NAN;
  for (size_t i = 0; row->map_values && i < it->options.keep; i++)
    row->map_values[i] = NAN;
}

/* Both sets are copied: the row keeps the order in which the iterates came. */
static ric_status put_distance(diagram_row *row, size_t keep, ric_error *error) {
  double *both = calloc(2 * keep + 1, sizeof *both);
  if (!both)
    return ric_fail(error, RIC_ENOMEM, "no memory for a comparison");
  memcpy(both, row->values, keep * sizeof *both);
  memcpy(both + keep, row->map_values, keep * sizeof *both);
  row->distance = comparison_distance(both, both + keep, keep);
  free(both);
  return RIC_OK;
}

static void put_map(const iterated *it, diagram_row *row, const ric_attractor *a, double origin) {
  row->parameter = beyond_parameter(it->beyond, it->values);
  row->d = beyond_d(it->beyond, it->values);
  row->map_period = (long long)a->period;
  row->map_impacts = a->impacts;
  row->map_lyapunov = a->exponents[0];
  for (size_t i = 0; a->values && i < it->options.keep; i++)
    a->values[i] += origin;
}

static ric_status run(iterated *it, diagram_row *row, double *z, double *x, double *exponents, ric_error *error) {
  ric_attractor a = {.z = z, .exponents = exponents, .values = row->map_values};
  RIC_TRY(beyond_find(it->beyond, it->values, error));
  RIC_TRY(beyond_motion(it->beyond, it->values, beyond_parameter(it->beyond, it->values), x, error));
  RIC_TRY(beyond_run(it->beyond, it->values, &it->options, &a, error));
  put_map(it, row, &a, x[it->options.observe]);
  return it->options.keep > 0 ? put_distance(row, it->options.keep, error) : RIC_OK;
}

ric_status comparison_put(iterated *it, diagram_row *row, ric_error *error) {
  double *z = calloc(2 * it->size + it->options.exponents + 1, sizeof *z);
  ric_status status = z ? run(it, row, z, z + it->size, z + 2 * it->size, error)
                        : ric_fail(error, RIC_ENOMEM, "no memory for a comparison");
  free(z);
  if (status == RIC_ESTOPPED)
    return status;
  if (status != RIC_OK) {
    put_nothing(it, row);
    if (!row->reason[0]) /* the motion's own comes first */
      row->reason = error->message;
  }
  return RIC_OK;
}

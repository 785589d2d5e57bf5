/* Going over to the family of twice the period. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "family_parts.h"

/* The motion twice, and when its impacts are. */
typedef struct doubling {
  const ric_family *from;
  const ric_family_point *point;
  ric_family_problem problem;
  size_t *sequence;
  double *times, period;
} doubling;

static ric_status repeat(doubling *d, ric_error *error) {
  ric_shooting_problem *m = &d->problem.motion;
  const arc_plan *plan = &d->from->shooting->arcs;
  size_t count = m->count;
  d->sequence = calloc(2 * count + 1, sizeof *d->sequence);
  d->times = calloc(2 * count + 1, sizeof *d->times);
  if (!d->sequence || !d->times)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", 2 * count);
  for (size_t k = 0; k < 2 * count; k++) {
    d->sequence[k] = m->sequence[k % count];
    d->times[k] = arcs_time(plan->impacts[k % count], d->point->z, d->period) + (k < count ? 0 : d->period);
  }
  m->sequence = d->sequence;
  m->count = 2 * count;
  d->problem.periods = 2 * (d->problem.periods ? d->problem.periods : 1);
  return RIC_OK;
}

/* Of the two null vectors the one along which the parameter stands still; the other is the motion run through twice. */
static void combine(const double *vectors, size_t size, double *tangent) {
  const double *a = vectors, *b = vectors + size;
  for (size_t i = 0; i < size; i++)
    tangent[i] = b[size - 1] * a[i] - a[size - 1] * b[i];
  tangent[size - 1] = 0;
}

static ric_status find_tangent(ric_family_junction *j, ric_error *error) {
  size_t size = j->family->unknowns + 1;
  double *vectors = malloc(2 * size * sizeof *vectors);
  if (!vectors)
    return ric_fail(error, RIC_ENOMEM, "no memory for vectors of %zu numbers", size);
  ric_status status = family_null_vectors(j->family, j->z, 2, vectors, error);
  if (status == RIC_OK)
    combine(vectors, size, j->tangent);
  free(vectors);
  return status;
}

ric_status ric_family_double(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                             ric_error *error) {
  doubling d = {.from = family,
                .point = point,
                .problem = family->problem,
                .period = arcs_period(&family->shooting->arcs, point->z, point->given)};
  *junction = (ric_family_junction){0};
  if (point->kind != RIC_FAMILY_PERIOD_DOUBLING || family->problem.motion.kind == RIC_MOTION_EVEN)
    return ric_fail(error, RIC_EINVAL, "point = %s of %s motion, expected period_doubling of one that is not even",
                    ric_family_kind_name(point->kind),
                    family->problem.motion.kind == RIC_MOTION_EVEN ? "an even" : "a");
  if (!family->problem.set && family->problem.motion.kind != RIC_MOTION_AUTONOMOUS)
    return ric_fail(error, RIC_EINVAL, "a family along its period, expected one along a number of the system");
  family_forget(family);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = family_set(family, point->parameter, family->problem.second, error);
  if (status == RIC_OK)
    status = repeat(&d, error);
  if (status == RIC_OK)
    status = family_branch(&d.problem, family, point, point->z, d.times, 2 * d.period, junction, error);
  if (status == RIC_OK)
    status = find_tangent(junction, error);
  gsl_set_error_handler(handler);
  family_forget(family);
  if (status != RIC_OK)
    ric_family_junction_clear(junction);
  free(d.sequence);
  free(d.times);
  return status;
}

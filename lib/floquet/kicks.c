#include "kicks.h"

#include <math.h>
#include <stdlib.h>

#include "model/image_ring.h"

void kicks_clear(kick_list *list) {
  free(list->kicks);
  *list = (kick_list){0};
}

static ric_status make_room(kick_list *list, size_t count, ric_error *error) {
  if (count > list->capacity) {
    kick *more = realloc(list->kicks, count * sizeof *more);
    if (!more)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", count);
    list->kicks = more;
    list->capacity = count;
  }
  list->count = count;
  return RIC_OK;
}

/* As ric_chain_acceleration, for one particle. */
static double acceleration(const ric_chain *chain, const double *q, size_t particle) {
  ptrdiff_t i = (ptrdiff_t)particle;
  double bend = image_ring_value(chain, q, i - 1) - 2 * q[i] + image_ring_value(chain, q, i + 1);
  return -q[i] + image_ring_gamma(chain) * bend;
}

static double largest_displacement(const ric_orbit *orbit) {
  double largest = 0;
  for (size_t i = 0; i < orbit->particles; i++)
    largest = fmax(largest, fmax(fabs(orbit->q[i]), fabs(orbit->q_half[i])));
  return largest;
}

ric_status kicks_of_orbit(kick_list *list, const ric_chain *chain, const ric_pattern *pattern, const ric_orbit *orbit,
                          double grazing_tol, size_t *grazing, ric_error *error) {
  double tiny = grazing_tol * largest_displacement(orbit);
  RIC_TRY(make_room(list, orbit->impacts, error));
  *grazing = list->count;
  for (size_t r = 0; r < list->count; r++) {
    kick *k = &list->kicks[r];
    k->particle = ric_pattern_impact(pattern, r);
    k->at_half = ric_pattern_role(pattern, k->particle) == RIC_ROLE_HALF;
    k->impulse = orbit->impulse[r];
    if (!(fabs(k->impulse) > tiny) && *grazing == list->count)
      *grazing = r;
    k->slope = -4 * acceleration(chain, k->at_half ? orbit->q_half : orbit->q, k->particle) / k->impulse;
  }
  return RIC_OK;
}

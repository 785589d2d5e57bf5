#include "ricochet/obstacle.h"

static ric_status check(const ric_obstacle *o, size_t j, size_t coordinates, ric_error *error) {
  if (o->coordinate >= coordinates)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: coordinate = %zu, expected less than %zu", j, o->coordinate,
                    coordinates);
  if (o->side != 1 && o->side != -1)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: side = %d, expected +1 (floor) or -1 (wall)", j, o->side);
  if (!isfinite(o->position))
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: position = %g, expected a finite number", j, o->position);
  if (!(o->stiffness > 0))
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: stiffness = %g, expected > 0 (infinity: rigid)", j, o->stiffness);
  if (!(o->restitution >= 0 && o->restitution <= 1))
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: restitution = %g, expected 0 <= e <= 1", j, o->restitution);
  return RIC_OK;
}

ric_status ric_obstacles_check(const ric_obstacle *obstacles, size_t count, size_t coordinates, ric_error *error) {
  for (size_t j = 0; j < count; j++)
    RIC_TRY(check(&obstacles[j], j, coordinates, error));
  return RIC_OK;
}

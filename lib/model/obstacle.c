/* Obstacles, and those at coordinates as part of a system. */
#include <stdlib.h>
#include <string.h>

#include "ricochet/obstacle.h"
#include "system_model.h"
#include "numeric/required.h"

static ric_status check_obstacle(const ric_obstacle *o, size_t j, size_t coordinates, ric_error *error) {
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
  REQUIRE(error, {"obstacles", unless_empty(count, obstacles)});
  for (size_t j = 0; j < count; j++)
    RIC_TRY(check_obstacle(&obstacles[j], j, coordinates, error));
  return RIC_OK;
}

/* Obstacles at coordinates: their part of the model table, shared by lattices and M-C-K systems. */

/* Merges halves, unless they are in order already: obstacles are usually given so. */
static void sort_by_coordinate(const ric_obstacle *obstacles, size_t *order, size_t *spare, size_t count) {
  if (count < 2)
    return;
  size_t half = count / 2;
  sort_by_coordinate(obstacles, order, spare, half);
  sort_by_coordinate(obstacles, order + half, spare, count - half);
  if (obstacles[order[half - 1]].coordinate <= obstacles[order[half]].coordinate)
    return;
  memcpy(spare, order, count * sizeof *order);
  for (size_t i = 0, left = 0, right = half; i < count; i++) {
    int from_left =
        right == count || (left < half && obstacles[spare[left]].coordinate <= obstacles[spare[right]].coordinate);
    order[i] = from_left ? spare[left++] : spare[right++];
  }
}

/* In this order the rigid obstacles of a coordinate are adjacent. */
ric_status system_check_room(const ric_system *s, ric_error *error) {
  double low = -INFINITY, high = INFINITY;
  for (size_t k = 0; s->obstacles && k < s->obstacle_count; k++) {
    const ric_obstacle *o = &s->obstacles[s->by_coordinate[k]];
    if (k == 0 || o->coordinate != s->obstacles[s->by_coordinate[k - 1]].coordinate) {
      low = -INFINITY;
      high = INFINITY;
    }
    if (o->stiffness == INFINITY && o->side > 0)
      low = fmax(low, o->position);
    if (o->stiffness == INFINITY && o->side < 0)
      high = fmin(high, o->position);
    if (!(low < high))
      return ric_fail(error, RIC_EINVAL,
                      "coordinate %zu has a floor at %g and a wall at %g, expected room between them", o->coordinate,
                      low, high);
  }
  return RIC_OK;
}

ric_status system_take_obstacles(ric_system *s, const ric_obstacle *obstacles, size_t count, ric_error *error) {
  RIC_TRY(ric_obstacles_check(obstacles, count, s->coordinates, error));
  size_t *spare = malloc((count ? count : 1) * sizeof *spare);
  s->obstacles = malloc((count ? count : 1) * sizeof *s->obstacles);
  s->by_coordinate = malloc((count ? count : 1) * sizeof *s->by_coordinate);
  if (!s->obstacles || !s->by_coordinate || !spare) {
    free(spare);
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu obstacles", count);
  }
  s->obstacle_count = count;
  for (size_t j = 0; j < count; j++) {
    s->obstacles[j] = obstacles[j];
    s->by_coordinate[j] = j;
  }
  sort_by_coordinate(s->obstacles, s->by_coordinate, spare, count);
  free(spare);
  return RIC_OK;
}

/* Properties on which memory and lists of contacts depend. */
static ric_status check_same_place(const ric_obstacle *o, const ric_obstacle *now, size_t j, ric_error *error) {
  bool rigid = o->stiffness == INFINITY;
  if (o->coordinate != now->coordinate)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: coordinate = %zu, expected %zu as at the creation of the system",
                    j, o->coordinate, now->coordinate);
  if (o->side != now->side)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: side = %d, expected %d as at the creation of the system", j,
                    o->side, now->side);
  if (rigid != (now->stiffness == INFINITY))
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: stiffness = %g, expected %s as at the creation of the system", j,
                    o->stiffness, rigid ? "a finite one" : "infinity");
  return RIC_OK;
}

ric_status ric_system_set_obstacles(ric_system *s, const ric_obstacle *obstacles, size_t count, ric_error *error) {
  REQUIRE(error, {"system", s}, {"obstacles", unless_empty(count, obstacles)});
  if (!s->obstacles)
    return ric_fail(error, RIC_EINVAL, "obstacles for a user's system, expected a lattice or an M-C-K system");
  if (count != s->obstacle_count)
    return ric_fail(error, RIC_EINVAL, "%zu obstacles, expected %zu as at the creation of the system", count,
                    s->obstacle_count);
  RIC_TRY(ric_obstacles_check(obstacles, count, s->coordinates, error));
  for (size_t j = 0; j < count; j++)
    RIC_TRY(check_same_place(&obstacles[j], &s->obstacles[j], j, error));
  for (size_t j = 0; j < count; j++)
    s->obstacles[j] = obstacles[j];
  s->revision++;
  return RIC_OK;
}

const char *obstacle_gap(const ric_system *s, size_t obstacle, double t, const double *q, double *gap) {
  (void)t;
  const ric_obstacle *o = &s->obstacles[obstacle];
  *gap = ric_obstacle_gap(o, q[o->coordinate]);
  return NULL;
}

const char *obstacle_gap_derivative(const ric_system *s, size_t obstacle, double t, const double *q, const tangents *d,
                                    double *derivative) {
  (void)t;
  (void)q;
  const ric_obstacle *o = &s->obstacles[obstacle];
  for (size_t k = 0; k < d->columns; k++)
    derivative[k] = o->side * d->q[o->coordinate * d->columns + k];
  return NULL;
}

const char *obstacle_gap_rate(const ric_system *s, size_t obstacle, double t, const double *q, const double *u,
                              double *rate) {
  (void)t;
  (void)q;
  *rate = s->obstacles[obstacle].side * u[s->obstacles[obstacle].coordinate];
  return NULL;
}

const char *obstacle_gap_acceleration(const ric_system *s, size_t obstacle, double t, const double *q, const double *u,
                                      const double *q_rate, const double *u_rate, double *acceleration) {
  (void)t;
  (void)q;
  (void)u;
  (void)q_rate;
  *acceleration = s->obstacles[obstacle].side * u_rate[s->obstacles[obstacle].coordinate];
  return NULL;
}

double obstacle_restitution(const ric_system *s, size_t obstacle) {
  return s->obstacles[obstacle].restitution;
}

size_t system_compliant_obstacles(const ric_system *s) {
  size_t count = 0;
  for (size_t j = 0; s->obstacles && j < s->obstacle_count; j++)
    count += isfinite(s->obstacles[j].stiffness) != 0;
  return count;
}

size_t system_first_obstacle(const ric_system *s, size_t coordinate) {
  size_t low = 0, high = s->obstacle_count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (s->obstacles[s->by_coordinate[middle]].coordinate < coordinate)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

double hertz_force(double stiffness, double gap) {
  return gap < 0 ? stiffness * -gap * sqrt(-gap) : 0; /* [JAP] Hertz */
}

double hertz_stiffness(double stiffness, double gap) {
  return gap < 0 ? 1.5 * stiffness * sqrt(-gap) : 0;
}

double hertz_energy(double stiffness, double gap) {
  return gap < 0 ? 0.4 * stiffness * gap * gap * sqrt(-gap) : 0;
}

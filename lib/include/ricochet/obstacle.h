/* Obstacles: bounds for coordinates of lattices and M-C-K systems.
 *
 * Obstacle j stands at coordinate i(j) at `position` b and has a side: a floor (side +1) keeps q_i >= b, a wall
 * (side -1) keeps q_i <= b. Its gap is h = side (q_i - b), its gap rate h' = side q'_i. A coordinate may have several.
 *
 * Rigid (stiffness infinite): an impact, h = 0 and h' < 0, gives h'+ = -e h'- with the restitution 0 <= e <= 1. A
 * contact that sticks (persists) carries a force lambda >= 0 that holds the coordinate at b. Compliant (stiffness k
 * finite): no jump, but the Hertz force k max(0, -h)^{3/2} pushes the coordinate out [JAP]. */
#ifndef RICOCHET_OBSTACLE_H
#define RICOCHET_OBSTACLE_H

#include <math.h>
#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_obstacle {
  size_t coordinate;
  int side;           /* +1: floor, -1: wall */
  double position;    /* b, finite */
  double restitution; /* e in [0, 1]; unused for a compliant obstacle */
  double stiffness;   /* INFINITY: rigid; k > 0: Hertz's law */
} ric_obstacle;

/** A rigid floor with restitution 1. */
static inline ric_obstacle ric_obstacle_floor(size_t coordinate, double position) {
  const ric_obstacle floor = {coordinate, +1, position, 1, INFINITY};
  return floor;
}

/** A rigid wall with restitution 1. */
static inline ric_obstacle ric_obstacle_wall(size_t coordinate, double position) {
  const ric_obstacle wall = {coordinate, -1, position, 1, INFINITY};
  return wall;
}

/** Gap h of a coordinate's value q over the obstacle. */
static inline double ric_obstacle_gap(const ric_obstacle *obstacle, double q) {
  return obstacle->side * (q - obstacle->position);
}

/** @param coordinates  number of coordinates of the system
 *  @returns RIC_EINVAL naming the first obstacle and field that is out of range. */
RIC_API ric_status ric_obstacles_check(const ric_obstacle *obstacles, size_t count, size_t coordinates,
                                       ric_error *error);

RIC_END_DECLARATIONS

#endif

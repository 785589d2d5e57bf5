/* What the impacts of an orbit do to the motions beside it: internal to the room.
 *
 * The saltation matrix of an impact of particle k with restitution 1 acts on (q_k, v_k) alone (the chain has no
 * damping), as [[-1, 0], [s, -1]] with s = 2 a_k / v_k-, a_k the acceleration at the impact. With the velocity jump
 * p_k = -2 v_k- this is s = -4 a_k / p_k. */
#ifndef RICOCHET_KICKS_H
#define RICOCHET_KICKS_H

#include <stdbool.h>

#include "ricochet/orbit.h"

/** One impact. */
typedef struct kick {
  size_t particle;
  bool at_half;
  double impulse; /* p */
  double slope;   /* s */
} kick;

/** In the order of the pattern: those at t = 0 first. Zeroed once, keeps its memory. */
typedef struct kick_list {
  kick *kicks;
  size_t count, capacity;
} kick_list;

void kicks_clear(kick_list *list);

/** Reads the impacts of an orbit with a state.
 *  @param grazing_tol  relative to the largest displacement: impulses up to it have no saltation matrix
 *  @param grazing  set to the first impact with such an impulse, or to the number of impacts */
ric_status kicks_of_orbit(kick_list *list, const ric_chain *chain, const ric_pattern *pattern, const ric_orbit *orbit,
                          double grazing_tol, size_t *grazing, ric_error *error);

#endif

/* The workspace behind ric_orbit_solver. Internal to the room. */
#ifndef RICOCHET_SOLVER_H
#define RICOCHET_SOLVER_H

#include "impulse.h"
#include "motion.h"
#include "ricochet/orbit.h"

struct ric_orbit_solver {
  ric_orbit_options options;
  unit_cell cell;
  impulse impulse;
  motion motion;
  double *store; /* [4][capacity] state of a cell smaller than the chain */
  size_t capacity;
  void *multipliers; /* workspace of floquet/, created there when it is first needed; NULL until then */
  void (*destroy_multipliers)(void *workspace);
};

#endif

/* The workspace behind ric_orbit_solver. Internal to the room. */
#ifndef RICOCHET_SOLVER_H
#define RICOCHET_SOLVER_H

#include "impulse.h"
#include "kicks.h"
#include "motion.h"
#include "reduced.h"
#include "ricochet/orbit.h"
#include "secular.h"

struct ric_orbit_solver {
  ric_orbit_options options;
  unit_cell cell;
  impulse impulse;
  motion motion;
  double *store; /* [4][capacity] state of a cell smaller than the chain */
  size_t capacity;
  kick_list kicks; /* for multipliers, as what follows */
  reduced reduced;
  secular secular;
};

#endif

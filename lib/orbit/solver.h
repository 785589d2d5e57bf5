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

/** Outcome and reason of the orbit of a chain whose state, impulses and condition are set and whose outcome is not
 *  `singular`; also sets its residual and clearance.
 *  @param state  on the cell
 *  @param one_of_many  the equations were singular, and this is the smallest of their solutions */
ric_status chain_verdict(ric_orbit_solver *s, const ric_chain *chain, const ric_pattern *pattern,
                         const boundary_state *state, bool one_of_many, ric_orbit *orbit, ric_error *error);

#endif

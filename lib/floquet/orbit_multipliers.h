/* The workspace for multipliers of chain orbits, kept by the orbit solver from call to call: internal to the room. */
#ifndef RICOCHET_INTERNAL_ORBIT_MULTIPLIERS_H
#define RICOCHET_INTERNAL_ORBIT_MULTIPLIERS_H

#include "orbit/solver.h"
#include "reduced.h"
#include "secular.h"

typedef struct orbit_spectrum {
  orbit_impacts impacts;
  reduced reduced;
  secular secular;
} orbit_spectrum;

/** The workspace of a solver, which destroys it; created by the first call.
 *  @returns RIC_ENOMEM */
ric_status orbit_spectrum_of(ric_orbit_solver *solver, orbit_spectrum **spectrum, ric_error *error);

#endif

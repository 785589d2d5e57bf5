/* The outcome of a solved orbit and its reason in words: internal to the library. */
#ifndef RICOCHET_VERDICT_H
#define RICOCHET_VERDICT_H

#include "admissibility.h"
#include "ricochet/orbit.h"

/** Judges an orbit whose state, impulses and condition are set and whose outcome is not `singular`: finds the gaps, the
 *  residual, and the outcome with its reason.
 *  @param state  on the cell
 *  @param one_of_many  the equations were singular, and this is the smallest of their solutions */
ric_status verdict_find(motion *m, const unit_cell *cell, const ric_chain *chain, const ric_pattern *pattern,
                        const boundary_state *state, bool one_of_many, const ric_orbit_options *options,
                        ric_orbit *orbit, ric_error *error);

/** Makes an orbit without a state: NaN everywhere, with this outcome. The reason is the caller's. */
void verdict_without_state(ric_orbit *orbit, ric_outcome outcome);

#endif

/* What becomes of an orbit: its smallest gaps, modes at resonance, the outcome and its reason. Internal to the library.
 */
#ifndef RICOCHET_VERDICT_H
#define RICOCHET_VERDICT_H

#include "motion.h"
#include "ricochet/orbit.h"
#include "unit_cell.h"

/* Admissibility of an orbit, (9) of [JAP], certified on its segments.
 *
 * Every gap is a polynomial on a segment and its minimum is located by bounds (polynomial.h), so no violation is
 * missed. At a contact the gap starts at zero: there the polynomial divided by its known root is looked at. */

/** A value with the place where it was found. */
typedef struct located {
  double value, time;
  size_t site; /* SIZE_MAX: nowhere */
} located;

typedef struct gaps {
  located free; /* smallest gap of the free sites with a floor */
  located
      impact; /* smallest gap of the impacting sites away from their contact (divided by it near it), if it is small */
} gaps;

/* The outcome of a solved orbit and its reason in words. */

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

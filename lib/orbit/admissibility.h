/* Admissibility of an orbit, (9) of [JAP], certified on its segments: internal to the library.
 *
 * Every gap is a polynomial on a segment and its minimum is located by bounds (polynomial.h), so no violation is
 * missed. At a contact the gap starts at zero: there the polynomial divided by its known root is looked at. */
#ifndef RICOCHET_ADMISSIBILITY_H
#define RICOCHET_ADMISSIBILITY_H

#include "motion.h"
#include "unit_cell.h"

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

/** Finds the smallest gaps.
 *  @param tolerance  absolute, on the smallest free gap
 *  @param small  gaps of impacting sites above it are of no interest
 *  @param mismatch  as motion_run */
ric_status gaps_find(motion *m, const unit_cell *cell, double period, const boundary_state *state, double tolerance,
                     double small, gaps *found, double *mismatch, ric_poll poll, ric_error *error);

/** First time in [0, T/2] at which any gap falls below -tolerance; site SIZE_MAX if none does. */
ric_status gaps_first_violation(motion *m, const unit_cell *cell, double period, const boundary_state *state,
                                double tolerance, located *first, ric_poll poll, ric_error *error);

#endif

/* What multipliers say about stability: the one place where it is decided. Internal to the room. */
#ifndef RICOCHET_MULTIPLIER_VERDICT_H
#define RICOCHET_MULTIPLIER_VERDICT_H

#include <stdbool.h>

#include "ricochet/multipliers.h"

/** Sorts mu [count] and sets everything that follows from it, with all multipliers known (count = dimension).
 *  @param trivial  the nearest so many to 1 are 1 for any motion */
void multipliers_judge(ric_multipliers *multipliers, size_t trivial, const ric_multiplier_options *options);

/** The same when mu [count] holds only those outside the circle, and none that is 1 for any motion.
 *  @param untold  how many of the others are not known to lie on the circle or in it
 *  @param near_one  how many of the others lie within band_at_one of 1 */
void multipliers_judge_outside(ric_multipliers *multipliers, size_t untold, size_t near_one,
                               const ric_multiplier_options *options);

/** Sorts mu [count] as the public header says. */
void multipliers_sort(ric_multipliers *multipliers);

/** @returns RIC_EINVAL for tolerances that are not 0 <= multiplier_tol <= band < 1, 0 <= band_at_one < 1. */
ric_status multiplier_options_check(const ric_multiplier_options *options, ric_error *error);

#endif

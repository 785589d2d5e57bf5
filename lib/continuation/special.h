/* Special points of a step: where test functions change sign. Internal to the room. */
#ifndef RICOCHET_SPECIAL_H
#define RICOCHET_SPECIAL_H

#include "curve.h"

/** Locates the special points between the nodes `from` and `to` of the curve, a step over c->row, in order.
 *  @param count  set to their number; they are in c->found, their arclength from the start of the step
 *  @param missed  counts up sign changes at which no zero was found
 *  @returns what the problem returns, but RIC_ENUMERIC: that is a sign change missed */
ric_status locate_special(ric_curve *c, size_t *count, size_t *missed, ric_error *error);

#endif

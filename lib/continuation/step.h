/* One step along the curve: internal to the room. */
#ifndef RICOCHET_STEP_H
#define RICOCHET_STEP_H

#include "curve.h"

/** Sets c->row for steps that begin at `from`. */
void step_set_row(ric_curve *c);

/** A step of the length h from `from` to `to`, corrected, with tangent and tests; to the end of the range of p where it
 *  would leave that.
 *  @param landed  set to whether `to` lies on the end of the range
 *  @returns RIC_ENUMERIC with the reason when the step has to be shorter */
ric_status step_try(ric_curve *c, double h, bool *landed, ric_error *error);

/** Moves `to` back to the start of the curve if the step passes it in the same direction.
 *  @param closed  set to whether it did */
ric_status step_close(ric_curve *c, bool *closed, ric_error *error);

/** Angle by which the tangent has turned from `from` to `to`. */
double step_turn(const ric_curve *c);

#endif

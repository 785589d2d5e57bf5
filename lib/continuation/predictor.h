/* Where a curve goes on, from the last points of the walk: internal to the room. */
#ifndef RICOCHET_PREDICTOR_H
#define RICOCHET_PREDICTOR_H

#include "curve.h"

/** The point ahead of `from` by h, in arclength or, for natural steps, in p: on the tangent, or on the polynomial
 * through `from` and points before it along their tangents, of the highest degree that changes the prediction by less
 * than half of what the one before did.
 *  @param x  [n + 1] set
 *  @returns its progress over c->row, which is > 0 */
double predictor_point(ric_curve *c, double h, double *x);

/** Makes `to` the point that the next step is from. @param keep  whether predictions may use the tangent of `from` */
void predictor_advance(ric_curve *c, bool keep);

#endif

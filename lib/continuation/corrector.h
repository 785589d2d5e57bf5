/* Newton's method in a hyperplane, and the tangent: internal to the room. */
#ifndef RICOCHET_CORRECTOR_H
#define RICOCHET_CORRECTOR_H

#include "curve.h"

/** Corrects x [n + 1] within the hyperplane through it that the row is normal to.
 *  @param near  whether x is a prediction: the correction then fails as soon as corrections grow
 *  @param iterations  set to the number of corrections
 *  @returns RIC_ENUMERIC if it does not converge */
ric_status corrector_run(ric_curve *c, const double *row, double *x, bool near, int *iterations, ric_error *error);

/** Tangent and determinant at a point where the corrector has just converged, from its last factors, which belong to a
 *  point within the tolerance.
 *  @param t  [n + 1] set, along the row that the factors have
 *  @returns RIC_ENUMERIC if the factors are unusable */
ric_status corrector_tangent(ric_curve *c, double *t, bordered_determinant *det, ric_error *error);

#endif

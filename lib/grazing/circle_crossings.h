/* Where pairs of complex multipliers of one-impact orbits lie on the unit circle: internal to the room.
 *
 * exp(i theta) is a multiplier of the orbit of y where, with t = s / (2 y), mu = exp(i theta) and r = L^(n-1),
 *
 *   1 + t A + B = 0,     A = eta (mu I - L^n)^-1 r xi,     B = eta (mu I - L^n)^-1 r kappa.
 *
 * t is real where Im((1 + B) conj A) = 0. Times |det(mu I - L^n)|^2 / sin theta that is a polynomial in cos theta of
 * degree m - 1: its sign on a grid finer than its waves, and the dips between, find all its zeros. */
#ifndef RICOCHET_CIRCLE_CROSSINGS_H
#define RICOCHET_CIRCLE_CROSSINGS_H

#include "one_impact.h"

/** @param y  [size of the map] in no order, all > 0  @param count  set  @returns RIC_ENOMEM */
ric_status circle_crossings_find(const one_impact *orbits, double *y, size_t *count, ric_error *error);

#endif

/* Multipliers on the unit circle, counted by signature: internal to the room.
 *
 * On mu = exp(i t), 0 < t < pi, the multipliers are the zeros of the determinant of the real symmetric matrix H
 * (secular.h). Let N(t) be the number of its negative eigenvalues. Going down in t it grows by one at a multiplier
 * whose eigenvalue falls and drops by one at a multiplier whose eigenvalue rises; at the pole of a mode, by minus the
 * sign of sin wT. So on an arc (a, b) without a pole at its ends
 *
 *   N(a) - N(b) + (sum of the signs of the poles in it) = (falling) - (rising) multipliers in it.
 *
 * The modulus of that number of the arc is a lower bound of the number of multipliers on it. Where modes of one sign
 * lie on an arc, or arcs are short enough, it is the number itself. When the bounds of all arcs and what lies outside
 * the circle add up to n, nothing is left that could be anywhere else. (The signs are Krein's: multipliers of one sign
 * cannot leave the circle when they meet.) */
#ifndef RICOCHET_CIRCLE_H
#define RICOCHET_CIRCLE_H

#include "ricochet/status.h"
#include "secular.h"

/** A lower bound of the number of pairs on the circle at angles above `from`, without the one at 1.
 *  @param from  0, or beyond multipliers that are too close to 1 to be told from rounding
 *  @param depth  how often arcs may be divided to tell modes of different signs apart */
size_t circle_count(secular *s, double from, int depth);

/** The same for the angles 0 < t < band. */
size_t circle_near_one(secular *s, double band);

/** The angles of the pairs on the circle above `from`, to rounding, without the one at 1.
 *  @param angles  [n], or NULL to count; @param count  set to their number
 *  @param wanted  no need to look for more
 *  @returns RIC_ESTOPPED */
ric_status circle_find(secular *s, double from, size_t wanted, double *angles, size_t *count, ric_error *error);

#endif

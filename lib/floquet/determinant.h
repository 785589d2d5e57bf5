/* Multipliers by the determinant: those on the unit circle are counted and located by signature; the verdict. Internal
 * to the library. */
#ifndef RICOCHET_DETERMINANT_H
#define RICOCHET_DETERMINANT_H

#include "ricochet/orbit_multipliers.h"
#include "ricochet/status.h"
#include "secular.h"

/* Multipliers on the unit circle, counted by signature.
 *
 * On mu = exp(i t), 0 < t < pi, the multipliers are the zeros of the determinant of the real symmetric matrix H
 * (secular.h). Let N(t) be the number of its negative eigenvalues. As t decreases it increases by one at a multiplier
 * whose eigenvalue falls, and decreases by one at a multiplier whose eigenvalue rises; at the pole of a mode it changes
 * by minus the sign of sin wT. So on an arc (a, b) without a pole at its ends
 *
 *   N(a) - N(b) + (sum of the signs of the poles in it) = (falling) - (rising) multipliers in it.
 *
 * The modulus of that number is a lower bound of the number of multipliers on the arc. If the modes on an arc have one
 * sign, or the arc is short enough, it is the number itself. If the bounds of all arcs and the number outside the unit
 * circle add up to n, all multipliers are located. (The signs are Krein signatures: multipliers of one sign cannot
 * leave the circle when they collide.) */

/** A lower bound of the number of pairs on the circle at angles above `from`, without the one at 1.
 *  @param from  0, or beyond multipliers too close to 1 to be separated from rounding
 *  @param depth  how often arcs may be divided to separate modes of different signs */
size_t unit_circle_count(secular *s, double from, int depth);

/* The multipliers of an orbit by its determinant.
 *
 * Two counts decide: a lower bound of the pairs on the circle by signature, and the number outside of
 * |mu| = 1 + d by winding (winding.h), with d = 0.1, 1e-3 and the band. If they add up to n, every multiplier is
 * accounted for: `stable` is then certified. If they do not, even at the band and after a search of the circle, and
 * nothing is outside, the remaining multipliers lie within the band or on the circle: `undecided`. */

/** Fills the multipliers, with a verdict. @param s  prepared for the orbit */
ric_status determinant_multipliers(secular *s, const ric_orbit_multiplier_options *options, ric_multipliers *m,
                                   ric_error *error);

#endif

/* Multipliers by the determinant: those on the circle counted and found by signature, and the verdict. Internal to the
 * library. */
#ifndef RICOCHET_DETERMINANT_H
#define RICOCHET_DETERMINANT_H

#include "ricochet/orbit_multipliers.h"
#include "ricochet/status.h"
#include "secular.h"

/* Multipliers on the unit circle, counted by signature.
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

/** A lower bound of the number of pairs on the circle at angles above `from`, without the one at 1.
 *  @param from  0, or beyond multipliers that are too close to 1 to be told from rounding
 *  @param depth  how often arcs may be divided to tell modes of different signs apart */
size_t unit_circle_count(secular *s, double from, int depth);

/* The multipliers of an orbit by its determinant.
 *
 * Two counts decide: a lower bound of the pairs on the circle by signature, and the number outside of
 * |mu| = 1 + d by winding (winding.h), with d = 0.1, 1e-3 and the band. When they add up to n, every multiplier has
 * been told: `stable` is then a certificate. When they do not, even at the band and after a search of the circle, and
 * nothing is outside, the multipliers that are left lie within the band or on the circle: `undecided`. */

/** Fills the multipliers, with a verdict. @param s  prepared for the orbit */
ric_status determinant_multipliers(secular *s, const ric_orbit_multiplier_options *options, ric_multipliers *m,
                                   ric_error *error);

#endif

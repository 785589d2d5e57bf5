/* Multipliers by the determinant: those on the unit circle are counted and located by signature; the verdict. Internal
 * to the library. */
#ifndef RICOCHET_DETERMINANT_H
#define RICOCHET_DETERMINANT_H

#include "ricochet/multipliers.h"
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

/* Multipliers outside the circle, counted by the argument principle.
 *
 * f has its poles on the circle and tends to 1 far away, so the winding number of f along |mu| = exp(r), r > 0, is
 * minus the number of multipliers outside; that of g = f / (alpha - 1) is less by one. In zeta = log mu the contour is
 * a straight line, and conjugate symmetry leaves 0 <= Im zeta <= pi.
 *
 * Steps are bisected until a step is shorter than 0.7 times its distance from the nearest pole (a pole and a zero on
 * both sides of the contour would cancel at a distance), and until log g changes by less than a quarter turn in either
 * half of it, nearly equally in both. The modulus is used, too: zeros close to the contour between two points may turn
 * the phase by whole turns, but they change the modulus at the next point. */

/** Number of multipliers with modulus above exp(radius), radius > 0.
 *  @returns false if a multiplier lies on the contour */
bool winding_outside(secular *s, double radius, size_t *outside);

/** Number of zeros of g in a rectangle of zeta to the right of the circle. @returns as winding_outside */
bool winding_box(secular *s, double complex low, double complex high, size_t *zeros);

/* The multipliers outside the unit circle, one by one.
 *
 * Rectangles of zeta = log mu are divided until they hold one zero of g each, which the secant method then finds, or
 * until they are too small to divide: multipliers that coincide by symmetry. */

/** Finds the multipliers with modulus above exp(low) and below exp(high), which may be infinite.
 *  @param expected  their number; other divisions are tried if some are missing
 *  @param mu  [room]; both of a conjugate pair are stored
 *  @param count  set to the number found, at most `room` */
void multipliers_outside_find(secular *s, double low, double high, size_t expected, ric_complex *mu, size_t room,
                              size_t *count);

/* The multipliers of an orbit by its determinant.
 *
 * Two counts decide: a lower bound of the pairs on the circle by signature, and the number outside of
 * |mu| = 1 + d by winding (winding.c), with d = 0.1, 1e-3 and the band. If they add up to n, every multiplier is
 * accounted for: `stable` is then certified. If they do not, even at the band and after a search of the circle, and
 * nothing is outside, the remaining multipliers lie within the band or on the circle: `undecided`. */

/** Fills the multipliers, with a verdict. @param s  prepared for the orbit */
ric_status determinant_multipliers(secular *s, const ric_orbit_multiplier_options *options, ric_multipliers *m,
                                   ric_error *error);

#endif

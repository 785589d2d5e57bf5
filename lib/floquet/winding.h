/* Multipliers outside the unit circle: counted by winding numbers, and located. Internal to the library. */
#ifndef RICOCHET_WINDING_H
#define RICOCHET_WINDING_H

#include "ricochet/multipliers.h"
#include "secular.h"

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

#endif

/* The multipliers outside the circle, one by one: internal to the room.
 *
 * Rectangles of zeta = log mu are divided until they hold one zero of g each, which the secant method then finds, or
 * until they are too small to divide: multipliers that coincide by symmetry. */
#ifndef RICOCHET_OUTSIDE_H
#define RICOCHET_OUTSIDE_H

#include "ricochet/multipliers.h"
#include "secular.h"

/** Finds the multipliers with modulus above exp(low) and below exp(high), which may be infinite.
 *  @param expected  how many there are; other divisions are tried when some were missed
 *  @param mu  [room]; both of a conjugate pair are put there
 *  @param count  set to the number found, at most `room` */
void outside_find(secular *s, double low, double high, size_t expected, ric_complex *mu, size_t room, size_t *count);

#endif

/* Polynomials on [0, 1]: Chebyshev interpolation, certified minima and first roots, and cheap tests that mostly
 * suffice. Internal to the library. */
#ifndef RICOCHET_INTERNAL_POLYNOMIAL_H
#define RICOCHET_INTERNAL_POLYNOMIAL_H

#include <stdbool.h>

/* Cheap certified tests (`looks`) of polynomials on [0, 1], sufficient for most segments of a motion.
 *
 * The low powers have a Bernstein form of fixed size, which is halved a few times. The high powers, small in segments,
 * are replaced by bounds of their sum, slope and second derivative. On a convex piece a tangent near its minimum is a
 * sharp bound. The functions of ricochet/polynomial.h decide the remaining cases. */

typedef enum poly_look {
  POLY_ABOVE,    /* above the value on all of [0, 1] */
  POLY_FALLS,    /* not above: see the function */
  POLY_UNDECIDED /* no answer */
} poly_look;

/** @returns POLY_FALLS if it is at most the value somewhere */
poly_look poly_look_above(const double *c, int degree, double value);

/** @param value  >= 0
 *  @param at  for POLY_FALLS: its first zero. It stays above the value until it falls through the value and zero,
 *             without a minimum before */
poly_look poly_look_fall(const double *c, int degree, double value, double *at);

/** Whether a polynomial that is zero to rounding at 0, and increases there, is positive for all x > 0, without a
 *  minimum of at most `value`. False: undecided. */
bool poly_look_leaves(const double *c, int degree, double value);

/* Interpolation at Chebyshev points of [0, 1]. */

/** Point k of degree + 1, in increasing order: (1 - cos(pi k / degree)) / 2, the ends included. degree >= 1 */
double chebyshev_point(int k, int degree);

/** Coefficients a [degree + 1] of the interpolant sum_j a_j T_j(2 x - 1) from its values at the points. */
void chebyshev_coefficients(const double *values, int degree, double *a);

/** The same polynomial in powers of x, c [degree + 1]. */
void chebyshev_to_powers(const double *a, int degree, double *c);

#endif

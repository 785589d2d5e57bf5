/* Polynomials on [0, 1]: Chebyshev interpolation, certain minima and first roots, and cheap looks that mostly suffice.
 * Internal to the library. */
#ifndef RICOCHET_INTERNAL_POLYNOMIAL_H
#define RICOCHET_INTERNAL_POLYNOMIAL_H

#include <stdbool.h>

/* Cheap looks at polynomials on [0, 1] with certain answers, for most of what is asked of the segments of a motion.
 *
 * The low powers have a Bernstein form of fixed size, halved a few times; the high powers, which are small in segments,
 * are bounds of their sum, slope and bend. Where a piece is convex a tangent in its valley bounds it sharply. What
 * these looks leave open is for ricochet/polynomial.h to say. */

typedef enum poly_look {
  POLY_ABOVE,    /* above the value on all of [0, 1] */
  POLY_FALLS,    /* not so: see the function */
  POLY_UNDECIDED /* no answer */
} poly_look;

/** @returns POLY_FALLS when it is at most the value somewhere */
poly_look poly_look_above(const double *c, int degree, double value);

/** @param value  >= 0
 *  @param at  of POLY_FALLS: it stays above the value until it falls through it and through zero, which it meets here
 *             for the first time, without a minimum before */
poly_look poly_look_fall(const double *c, int degree, double value, double *at);

/** Whether a polynomial that is zero to rounding at 0, and rises there, is positive from there on, without a minimum of
 *  at most `value`. False is no answer. */
bool poly_look_leaves(const double *c, int degree, double value);

/* Interpolation at Chebyshev points of [0, 1]. */

/** Point k of degree + 1, in increasing order: (1 - cos(pi k / degree)) / 2, the ends included. degree >= 1 */
double chebyshev_point(int k, int degree);

/** Coefficients a [degree + 1] of the interpolant sum_j a_j T_j(2 x - 1) from its values at the points. */
void chebyshev_coefficients(const double *values, int degree, double *a);

/** The same polynomial in powers of x, c [degree + 1]. */
void chebyshev_to_powers(const double *a, int degree, double *c);

#endif

/* Cheap looks at polynomials on [0, 1] with certain answers, for most of what is asked of the segments of a motion:
 * internal to the library.
 *
 * The low powers have a Bernstein form of fixed size, halved a few times; the high powers, which are small in segments,
 * are bounds of their sum, slope and bend. Where a piece is convex a tangent in its valley bounds it sharply. What
 * these looks leave open is for polynomial.h to say. */
#ifndef RICOCHET_POLY_LOOK_H
#define RICOCHET_POLY_LOOK_H

#include <stdbool.h>

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

/** The only root of the polynomial (order 0, falling) or of its derivative (order 1, rising) in [low, high], from a
 *  first guess inside. */
double poly_bracketed_root(const double *c, int degree, int order, double low, double high, double guess);

#endif

/* Interpolation at Chebyshev points of [0, 1]: internal to the library. */
#ifndef RICOCHET_CHEBYSHEV_H
#define RICOCHET_CHEBYSHEV_H

enum {
  CHEBYSHEV_DEGREE = 14 /* largest: conversion to powers loses about as many digits as the last terms are small */
};

/** Point k of degree + 1, in increasing order: (1 - cos(pi k / degree)) / 2, the ends included. degree >= 1 */
double chebyshev_point(int k, int degree);

/** Coefficients a [degree + 1] of the interpolant sum_j a_j T_j(2 x - 1) from its values at the points. */
void chebyshev_coefficients(const double *values, int degree, double *a);

/** The same polynomial in powers of x, c [degree + 1]. */
void chebyshev_to_powers(const double *a, int degree, double *c);

#endif

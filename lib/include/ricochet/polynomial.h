/* Polynomials on the unit interval, p(x) = sum_j c_j x^j for 0 <= x <= 1, with certified minima and roots.
 *
 * Bounds come from the signs of the coefficients (cheap) and from the Bernstein form: on an interval a polynomial
 * lies between its smallest and its largest Bernstein coefficient, and it has at most as many roots as these have
 * sign changes. Subdivision makes both sharp. So a minimum or a first root is proved, not inferred from samples; the
 * only tolerance is that of rounding. Coefficients are [degree + 1], degree <= RIC_POLY_DEGREE. */
#ifndef RICOCHET_POLYNOMIAL_H
#define RICOCHET_POLYNOMIAL_H

#include "export.h"

RIC_BEGIN_DECLARATIONS

enum { RIC_POLY_DEGREE = 40 };

/** Value at x; `slope`, when not NULL, is set to the derivative. */
RIC_API double ric_poly_value(const double *c, int degree, double x, double *slope);

/** Lower bound on [0, 1] from the coefficients: c_0 plus the negative ones. */
RIC_API double ric_poly_lower_bound(const double *c, int degree);

/** Bernstein coefficients [degree + 1] on [0, 1]; the first and last are the values at the ends. */
RIC_API void ric_poly_bernstein(const double *c, int degree, double *b);

/** Smallest value on [0, 1].
 *  @param cutoff  larger values are ignored: if the whole polynomial lies above it, 0 is returned and nothing is set;
 *                 INFINITY: find the minimum in any case
 *  @param tolerance  absolute, on the value: `value` lies within it of the true minimum
 *  @param at, value  position and value of the minimum
 *  @returns 1 if a value <= cutoff was found. */
RIC_API int ric_poly_minimum(const double *c, int degree, double cutoff, double tolerance, double *at, double *value);

/** First local minimum inside (0, 1) whose value is at most `cutoff`.
 *  @returns 1 and sets `at` and `value`, or 0 if there is none. Minima caused by rounding are not distinguished from
 *           others: two of them lie within rounding of each other in value. */
RIC_API int ric_poly_first_minimum(const double *c, int degree, double cutoff, double *at, double *value);

/** Coefficients r [degree + 1] of the reflected polynomial, r(x) = p(1 - x). */
RIC_API void ric_poly_reflect(const double *c, int degree, double *r);

/** First x in [0, 1] at which the polynomial is <= 0.
 *  @returns 1 and sets `at`, or 0 if it is positive on the whole interval. */
RIC_API int ric_poly_first_root(const double *c, int degree, double *at);

/** Whether the polynomial is positive on the whole of [0, 1]: ric_poly_first_root without the root. */
RIC_API int ric_poly_is_positive(const double *c, int degree);

RIC_END_DECLARATIONS

#endif

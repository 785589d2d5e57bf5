/* Ritz-Galerkin approximations of motions with one impact per period, with the functions of [VID] (2).
 *
 * In a lattice without damping and forcing, coordinate k hits its obstacle at b at t = 0 mod T. The trial functions
 * are
 *
 *   q_k ~ sum_i a_i cos(i w (T/2 - t)),   the others q_j ~ sum_i b_ji cos(2 pi i t / T),   0 <= t <= T, i = 1 ... N,
 *
 * and i = 0 with `constants` (not in the source). All are even about T/2; the unknown w makes the velocity of q_k
 * jump. The equations of motion are projected on cos(2 pi i t / T) alone. These are n N' equations, and q_k(0) = b is
 * one more, for n N' coefficients and w, with N' = N or N + 1. Integrals are computed by Gauss quadrature over half a
 * period, exact to rounding.
 *
 * Without constants a motion whose mean is not zero cannot be represented: the error stalls. With them the error is
 * O(N^-3) in displacements and O(N^-2) in velocities, and the residual of the equations of motion O(N^-1), since an
 * impact makes the third derivatives of the neighbours jump. A single oscillator converges faster than any power.
 *
 * Choice of w: q_k can be expanded in the functions for every w below 2 pi / T, so there are several solutions. The
 * intended one is the frequency of the motion when the impact is ignored [VID]: the root that exists for N = 1 and
 * changes little with N. It is the nearest to 2 pi / T and the best conditioned: with g = w T / (2 pi) the condition
 * number of J grows about as exp(5 (1 - g) N). Roots with smaller w are lost in rounding from N = 8 or 16 on.
 * ric_ritz_refine increases N in this way. Where J is singular to rounding, w is arbitrary and a solution may not be
 * found. */
#ifndef RICOCHET_RITZ_H
#define RICOCHET_RITZ_H

#include <stdbool.h>
#include <stddef.h>

#include "shooting.h"

RIC_BEGIN_DECLARATIONS

enum { RIC_RITZ_MOST = 300 /* largest number of functions: larger ones have no quadrature rule with enough points */ };

typedef struct ric_ritz_options {
  size_t functions; /* N, largest number used: 1 to RIC_RITZ_MOST; default 16 */
  bool constants;   /* default true */
  size_t points;    /* of the quadrature, 2 N to 1024 at least; 0, the default: exact to rounding for cubic springs */
} ric_ritz_options;

RIC_API ric_ritz_options ric_ritz_options_default(void);

typedef struct ric_ritz ric_ritz;

/** @param system  a lattice; borrowed, must outlive it; its numbers may change between calls
 *  @param obstacle  that is hit, rigid, with restitution 1; other rigid obstacles are ignored
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for other systems, damping, forcing, compliant obstacles, options out of range; RIC_ENOMEM.
 *           Conditions that depend on the system's numbers are checked again, with the same errors, when they have
 *           changed. */
RIC_API ric_status ric_ritz_create(const ric_system *system, size_t obstacle, const ric_ritz_options *options,
                                   ric_ritz **ritz, ric_error *error);
RIC_API void ric_ritz_destroy(ric_ritz **ritz);

/** N in use, initially that of the options. */
RIC_API size_t ric_ritz_functions(const ric_ritz *ritz);
/** n N' + 1: coefficients [n][N'] by coordinate, the constants first, then w. */
RIC_API size_t ric_ritz_unknowns(const ric_ritz *ritz);
/** Points of the quadrature. */
RIC_API size_t ric_ritz_points(const ric_ritz *ritz);

/** Sets the number of functions, 1 to that of the options.
 *  @param c  [larger number of unknowns], rearranged: new coefficients are zero, superfluous ones dropped; may be NULL
 */
RIC_API ric_status ric_ritz_use(ric_ritz *ritz, size_t functions, double *c, ric_error *error);

/** F [unknowns] at c, its Jacobian J [unknowns][unknowns] row-major, and its derivative by T, in the form needed for
 *  continuation along the period (continuation.h). F contains, for every coordinate, the means over a period of (q'' -
 *  acceleration) cos(2 pi i t / T), then q_k(0) - b. Allocates nothing.
 *  @param J, F_period  may be NULL, both
 *  @returns RIC_ENUMERIC for c that is not finite, or a period that is not positive. */
RIC_API ric_status ric_ritz_residual(ric_ritz *ritz, const double *c, double period, double *F, double *J,
                                     double *F_period, ric_error *error);

/** Least-squares fit of the coefficients to a motion over its period: a first guess.
 *  @param shooting, z, period  even motions of this system with given period and one impact, on this obstacle, at t = 0
 *  @param frequency  w, between 0 and 2 pi / T; 0: the best of 50 values between pi / T and 2 pi / T, with the smallest
 *                    |F| (equations of motion divided by (2 pi / T)^2); for few functions only, see above
 *  @param c  [unknowns], set
 *  @returns RIC_EINVAL for another kind of motion or w; what ric_shooting_residual returns; RIC_ENOMEM. */
RIC_API ric_status ric_ritz_fit(ric_ritz *ritz, ric_shooting *shooting, const double *z, double period,
                                double frequency, double *c, ric_error *error);

/** Solves F = 0 at a given period by Newton's method with line search (SUNDIALS KINSOL).
 *  @param c  [unknowns] guess; set to the solution
 *  @param iterations  may be NULL
 *  @returns RIC_ENUMERIC if it does not converge, with the remaining residual (divided by the size of the motion and by
 *           (2 pi / T)^2), or converges to a w outside (0, 2 pi / T); c is then the last iterate. */
RIC_API ric_status ric_ritz_solve(ric_ritz *ritz, double *c, double period, int *iterations, ric_error *error);

/** Solves with N = 1, 2, 3, 4, 6, 8, 12, 16 ... up to that of the options, each from the previous solution, until the
 *  measured error is within the tolerance. Values of N without a nearby solution are skipped.
 *  @param shooting, z, period  as of ric_ritz_fit
 *  @param tolerance  of displacements; 0: the largest N that can be solved
 *  @param c  [unknowns of the largest N], set; ric_ritz_functions gives N
 *  @param error_q  set to the measured error; may be NULL
 *  @returns RIC_EINVAL as ric_ritz_fit, and for a negative tolerance; RIC_ENUMERIC if the tolerance is not reached, or
 *  nothing converges; c and N are then the best found, if any. */
RIC_API ric_status ric_ritz_refine(ric_ritz *ritz, ric_shooting *shooting, const double *z, double period,
                                   double tolerance, double *c, double *error_q, ric_error *error);

/** Displacements and velocities [n] at 0 <= t <= T; v at 0 is the velocity after the impact, at T the one before it.
 *  Either may be NULL. */
RIC_API void ric_ritz_state(const ric_ritz *ritz, const double *c, double period, double t, double *q, double *v);

/** Largest residual of the equations of motion, as an acceleration, divided by the largest acceleration; densely
 *  sampled. 0 for the state of rest.
 *  @returns NaN if c or the period is not finite. */
RIC_API double ric_ritz_defect(ric_ritz *ritz, const double *c, double period);

/** Measured error: the largest difference from a motion found by shooting, over all coordinates and times, densely
 *  sampled.
 *  @param shooting, z, period  as of ric_ritz_fit
 *  @param error_q, error_v  of displacements and velocities; either may be NULL
 *  @returns as ric_ritz_fit. */
RIC_API ric_status ric_ritz_error(ric_ritz *ritz, const double *c, double period, ric_shooting *shooting,
                                  const double *z, double *error_q, double *error_v, ric_error *error);

RIC_END_DECLARATIONS

#endif

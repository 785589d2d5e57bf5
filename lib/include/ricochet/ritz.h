/* Ritz-Galerkin approximations of motions with one impact per period, with the functions of [VID] (2).
 *
 * Of a lattice without damping and forcing, coordinate k hits its obstacle at b at t = 0 mod T. Trial functions:
 *
 *   q_k ~ sum_i a_i cos(i w (T/2 - t)),   the others q_j ~ sum_i b_ji cos(2 pi i t / T),   0 <= t <= T, i = 1 ... N,
 *
 * and i = 0 with `constants` (ours). All are even about T/2; w, an unknown, makes the velocity of q_k jump. The
 * equations of motion are projected on cos(2 pi i t / T) alone: n N' equations, q_k(0) = b is one more, for n N'
 * coefficients and w, N' = N or N + 1. Integrals are by Gauss's rule over half a period, exact to rounding.
 *
 * Without constants no motion whose mean is not zero can be represented: the error stalls. With them the error is
 * O(N^-3) in displacements, O(N^-2) in velocities, and the residual of the equations of motion O(N^-1): an impact
 * makes the third derivatives of the neighbours jump. A single oscillator converges faster than any power.
 *
 * Which w: any below 2 pi / T gives functions in which q_k can be expanded, so solutions are several. The one meant
 * is the motion's frequency when the impact is ignored [VID]: the root that is there for N = 1 and stays in place. It
 * is nearest to 2 pi / T, and the best conditioned: with g = w T / (2 pi) the condition number of J grows about as
 * exp(5 (1 - g) N). Roots with smaller w are lost in rounding from N = 8 or 16 on. ric_ritz_refine takes this way.
 * Where J is singular to rounding, w is arbitrary, and a solution may not be found. */
#ifndef RICOCHET_RITZ_H
#define RICOCHET_RITZ_H

#include <stdbool.h>
#include <stddef.h>

#include "shooting.h"

RIC_BEGIN_DECLARATIONS

enum { RIC_RITZ_MOST = 300 /* functions: beyond it there is no rule with enough points */ };

typedef struct ric_ritz_options {
  size_t functions; /* N, most that are used: 1 to RIC_RITZ_MOST; default 16 */
  bool constants;   /* default true */
  size_t points;    /* of the quadrature, 2 N to 1024 at least; 0, the default: exact to rounding for cubic springs */
} ric_ritz_options;

RIC_API ric_ritz_options ric_ritz_options_default(void);

typedef struct ric_ritz ric_ritz;

/** @param system  a lattice; borrowed, must outlive it; its numbers may change between calls
 *  @param obstacle  that is hit, rigid, with restitution 1; other rigid obstacles are ignored
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for other systems, damping, forcing, compliant obstacles, options out of range; RIC_ENOMEM.
 *           What depends on the system's numbers is checked again, and refused so, when they have changed. */
RIC_API ric_status ric_ritz_create(const ric_system *system, size_t obstacle, const ric_ritz_options *options,
                                   ric_ritz **ritz, ric_error *error);
RIC_API void ric_ritz_destroy(ric_ritz **ritz);

/** N in use, at first that of the options. */
RIC_API size_t ric_ritz_functions(const ric_ritz *ritz);
/** n N' + 1: coefficients [n][N'] by coordinate, those of constants first, then w. */
RIC_API size_t ric_ritz_unknowns(const ric_ritz *ritz);
/** Points of the quadrature. */
RIC_API size_t ric_ritz_points(const ric_ritz *ritz);

/** Uses another number of functions, 1 to that of the options.
 *  @param c  [unknowns, the more of both], re-arranged: new coefficients are zero, old ones dropped; may be NULL */
RIC_API ric_status ric_ritz_use(ric_ritz *ritz, size_t functions, double *c, ric_error *error);

/** F [unknowns] at c, its Jacobian J [unknowns][unknowns] row-major, and its derivative by T: made for continuation
 *  along the period (continuation.h). F: for every coordinate the means over a period of its part of
 *  (q'' - acceleration) cos(2 pi i t / T), then q_k(0) - b. Allocates nothing.
 *  @param J, F_period  may be NULL, both
 *  @returns RIC_ENUMERIC for c that are no numbers, or a period that is not positive. */
RIC_API ric_status ric_ritz_residual(ric_ritz *ritz, const double *c, double period, double *F, double *J,
                                     double *F_period, ric_error *error);

/** Coefficients that fit a motion best, by least squares over the period: a first guess.
 *  @param shooting, z, period  even motions of this system, period given, with one impact, of this obstacle, at t = 0
 *  @param frequency  w, between 0 and 2 pi / T; 0: of 50 between half of 2 pi / T and all of it the one whose fit
 *                    leaves the smallest |F|, equations of motion over (2 pi / T)^2: for few functions only (as said
 *                    above)
 *  @param c  [unknowns], set
 *  @returns RIC_EINVAL for another kind of motion or w; what ric_shooting_residual returns; RIC_ENOMEM. */
RIC_API ric_status ric_ritz_fit(ric_ritz *ritz, ric_shooting *shooting, const double *z, double period,
                                double frequency, double *c, ric_error *error);

/** Solves F = 0 at a period, by Newton's method with line search (SUNDIALS KINSOL).
 *  @param c  [unknowns] guess; set to the solution
 *  @param iterations  may be NULL
 *  @returns RIC_ENUMERIC when it does not converge, with the residual left (over the size of the motion, and over
 *           (2 pi / T)^2), or converges to a w that is not between 0 and 2 pi / T; c is then where it got. */
RIC_API ric_status ric_ritz_solve(ric_ritz *ritz, double *c, double period, int *iterations, ric_error *error);

/** Solves with N = 1, 2, 3, 4, 6, 8, 12, 16 ... up to that of the options, each from the solution before, until the
 *  measured error is within the tolerance. Numbers of functions for which there is no solution near are passed over.
 *  @param shooting, z, period  as of ric_ritz_fit
 *  @param tolerance  of displacements; 0: as many functions as can be solved for
 *  @param c  [unknowns of all functions], set; ric_ritz_functions tells N
 *  @param error_q  set to the measured error; may be NULL
 *  @returns RIC_EINVAL as ric_ritz_fit, and for a negative tolerance; RIC_ENUMERIC when the tolerance is not reached,
 * or when nothing converges; c and N are then the best there is, if any. */
RIC_API ric_status ric_ritz_refine(ric_ritz *ritz, ric_shooting *shooting, const double *z, double period,
                                   double tolerance, double *c, double *error_q, ric_error *error);

/** Displacements and velocities [n] at 0 <= t <= T; v at 0 is that after the impact, at T that before it. Either may
 *  be NULL. */
RIC_API void ric_ritz_state(const ric_ritz *ritz, const double *c, double period, double t, double *q, double *v);

/** Largest residual of the equations of motion, as an acceleration, over the largest acceleration; sampled closely.
 *  0 at rest.
 *  @returns NaN for c or a period that are no numbers. */
RIC_API double ric_ritz_defect(ric_ritz *ritz, const double *c, double period);

/** Measured error: the largest difference from a motion found by shooting, of any coordinate at any time, sampled
 *  closely.
 *  @param shooting, z, period  as of ric_ritz_fit
 *  @param error_q, error_v  of displacements and velocities; either may be NULL
 *  @returns as ric_ritz_fit. */
RIC_API ric_status ric_ritz_error(ric_ritz *ritz, const double *c, double period, ric_shooting *shooting,
                                  const double *z, double *error_q, double *error_v, ric_error *error);

RIC_END_DECLARATIONS

#endif

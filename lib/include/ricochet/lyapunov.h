/* Lyapunov exponents of a motion with impacts.
 *
 * Tangent vectors, solutions of the variational equation with saltation at impacts, are propagated with the motion
 * (trajectory.h) and orthonormalised repeatedly by a QR factorisation. The logarithms of the diagonal of R, summed
 * and divided by the time, tend to the exponents, largest first. For a periodic motion the exponents are the
 * logarithms of the moduli of the Floquet multipliers over the period. The error decreases like 1 / t if the
 * multipliers are simple, and like ln(t) / t if two of a conservative motion coincide. The sum of all exponents is
 * the mean divergence plus the mean rate of ln e^2 at the impacts.
 *
 * A contact that begins to stick, and an impact with restitution 0, reduce the dimension of the tangent space: the
 * exponent of the lost direction is -INFINITY. The same applies to a vector that shrinks by a factor 1e-13 at once. */
#ifndef RICOCHET_LYAPUNOV_H
#define RICOCHET_LYAPUNOV_H

#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_lyapunov_options {
  size_t count;     /* exponents wanted; 0 (default): all n + m */
  double interval;  /* time between two reports of the exponents, > 1e-12 (1 + |end|); default 1. The vectors are
                       orthonormalised at least that often, and before their growth ratios exceed about e^7 */
  double transient; /* time >= 0 before the sums begin; default 0 */
  /** Receives the exponents after every interval, NULL for none; non-zero ends the run with the outcome `ended`.
   *  @param time  since the sums began
   *  @param exponents  [count] so far */
  int (*history)(double time, const double *exponents, size_t count, void *user);
  const ric_observer *observer; /* receives the motion, NULL for none */
  void *user;                   /* for history */
} ric_lyapunov_options;

RIC_API ric_lyapunov_options ric_lyapunov_options_default(void);

typedef struct ric_lyapunov {
  ric_run run; /* outcome, time reached and counts of the whole run */
  double time; /* over which the exponents were averaged; 0: none are known */
} ric_lyapunov;

/** Runs a trajectory from its current state to `end`.
 *  @param trajectory  started; its tangent vectors are replaced
 *  @param options  NULL for the defaults
 *  @param exponents  [count] per unit time, usually largest first; NaN if unknown. A run that ends early, with an
 *         outcome that says why, gives those of the time until then
 *  @returns RIC_EINVAL for options out of range, and as ric_trajectory_run; RIC_ENOMEM, RIC_ESTOPPED. */
RIC_API ric_status ric_lyapunov_run(ric_trajectory *trajectory, double end, const ric_lyapunov_options *options,
                                    double *exponents, ric_lyapunov *lyapunov, ric_error *error);

RIC_END_DECLARATIONS

#endif

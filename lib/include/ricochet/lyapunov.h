/* Lyapunov exponents of a motion with impacts.
 *
 * Tangent vectors are carried along (trajectory.h) and made orthonormal again and again by a QR factorisation; the
 * logarithms of R's diagonal, added up and divided by the time, tend to the exponents, largest first. For a periodic
 * motion they are the logarithms of the multipliers' moduli over the period: approached like 1 / t where the
 * multipliers are simple, and like ln(t) / t where two of a conservative motion meet. Their sum is the mean divergence
 * plus the mean rate of ln e^2 at the impacts.
 *
 * Contacts that come to rest, and impacts with restitution 0, put a direction out: its exponent is -INFINITY. So does
 * what squeezes a vector to 1e-13 of itself at once. */
#ifndef RICOCHET_LYAPUNOV_H
#define RICOCHET_LYAPUNOV_H

#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_lyapunov_options {
  size_t count;    /* exponents wanted; 0 (default): all n + m */
  double interval; /* time from one report of the exponents to the next, > 1e-12 (1 + |end|); default 1. The vectors are
                      made orthonormal at least that often, and before they part by more than about e^7 */
  double transient; /* time, >= 0, after which the sums begin; default 0 */
  /** Sees the exponents after every interval, NULL for none; non-zero ends the run with the outcome `ended`.
   *  @param time  since the sums began
   *  @param exponents  [count] so far */
  int (*history)(double time, const double *exponents, size_t count, void *user);
  const ric_observer *observer; /* sees the motion, NULL for none */
  void *user;                   /* for history */
} ric_lyapunov_options;

RIC_API ric_lyapunov_options ric_lyapunov_options_default(void);

typedef struct ric_lyapunov {
  ric_run run; /* outcome, time reached and counts of all that was run */
  double time; /* over which the exponents were taken; 0: none are known */
} ric_lyapunov;

/** Runs a trajectory from where it stands to `end`.
 *  @param trajectory  started; tangent vectors that it carried are replaced
 *  @param options  NULL for the defaults
 *  @param exponents  [count] per unit time, largest first as a rule; NaN when none are known. A run that ends early,
 * with the outcome that says why, leaves those of the time until then
 *  @returns RIC_EINVAL for options out of range, and as ric_trajectory_run; RIC_ENOMEM, RIC_ESTOPPED. */
RIC_API ric_status ric_lyapunov_run(ric_trajectory *trajectory, double end, const ric_lyapunov_options *options,
                                    double *exponents, ric_lyapunov *lyapunov, ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Order and step of Taylor flows: internal to the room.
 *
 * Pure rules for every Taylor flow. A linear motion e^{s t} with |s| h <= r has coefficients r^j / j! and sums of
 * moduli below exp(r): a bound of |s| gives its step. Other motions are expanded over a trial step; c_j of a step theta
 * times as long is theta^j c_j, so that the last coefficients tell what the step may be. */
#ifndef RICOCHET_TAYLOR_STEP_H
#define RICOCHET_TAYLOR_STEP_H

#include <stdbool.h>
#include <stddef.h>

/** Order at which linear motions take the longest step: 26 at 1e-16, between 4 and 30. */
int taylor_order(double tolerance);

/** Longest step times |s| for linear motions, at most 2.2, which a given order may not reach. */
double taylor_reach(double tolerance, int order);

/** Longest step times |s| with which tangent vectors of linear motions go, whatever the motion itself takes: 3.3 at
 *  order 26. A motion that leaves what is fast at rest says nothing about tangent vectors that do not. */
double taylor_carried_reach(double tolerance, int order);

/** Bound of |s| over the roots e^{s t} of q'' + C q' + K q = 0, from norms of K and C. */
double taylor_rate_bound(double stiffness, double damping);

/** The same where K and C, over the masses, are symmetric and no spring and no damper is negative: what a mode comes to
 *  is a k of at most `stiffness` and at least `softest`, and a c of at most `damping`; |s| is sqrt(k) where it
 *  oscillates, c / 2 + sqrt(c^2 / 4 - k) at most where it does not. */
double taylor_passive_rate_bound(double stiffness, double softest, double damping);

/** Largest absolute value of x [count]; not finite when one of them is not. */
double taylor_largest(const double *x, size_t count);

/** How the coefficients of a step fall off. */
typedef struct taylor_decay {
  double change;  /* largest |c_1|, |c_2|, |c_3|, or |c_4| where these vanish: zero when the motion is at rest for good;
                     NaN when the series is no use */
  double tail[2]; /* largest |c_{order - 1}|, |c_order| */
  double nearest_zero; /* lower bound of the x at which a branch point lies; INFINITY without */
} taylor_decay;

/** Decay of coefficients [order + 1][stride], of which `count` columns are looked at. */
taylor_decay taylor_decay_of(const double *coef, size_t stride, size_t count, int order);

/** That of two sets of coordinates together. */
taylor_decay taylor_decay_join(taylor_decay a, taylor_decay b);

/** Factor, at most 1000, by which the trial step becomes the longest one whose last two coefficients, in coordinates
 *  and in speeds, lie below a tenth of the tolerance times what changes in the step. */
double taylor_step_factor(const taylor_decay *decay, int order, double tolerance);

/** Signed length of the next step.
 *  @param remaining  time to the stop, signed, not 0
 *  @param longest  > 0, what accuracy allows
 *  @param fixed  the length is prescribed: it is kept until the stop lies within it. Otherwise the last two steps share
 *                what remains, so that no sliver is left
 *  @returns `remaining` itself when the step reaches the stop. */
double taylor_step_length(double remaining, double longest, bool fixed);

/** Whether a step is lost in the rounding of the time, shorter than 1e-12 (1 + |time|). */
bool taylor_step_vanishes(double time, double length);

/** A step that is just not lost. */
double taylor_step_least(double time);

#endif

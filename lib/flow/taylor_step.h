/* Steps of Taylor flows: how order and length are chosen, and how a step is made. Internal to the library. */
#ifndef RICOCHET_TAYLOR_STEP_H
#define RICOCHET_TAYLOR_STEP_H

#include <stdbool.h>
#include <stddef.h>

#include "flow_method.h"

/* Order and step of Taylor flows.
 *
 * Rules common to all Taylor flows. A linear motion e^{s t} with |s| h <= r has coefficients r^j / j! and sums of
 * moduli below exp(r): a bound of |s| gives its step. Other motions are expanded over a trial step; c_j of a step theta
 * times as long is theta^j c_j, so that the last coefficients determine the admissible step. */

/** Order with the longest step for linear motions: 26 at 1e-16, between 4 and 30. */
int taylor_order(double tolerance);

/** Longest step times |s| for linear motions at a given order, at most 2.2. */
double taylor_reach(double tolerance, int order);

/** Bound of |s| over the roots e^{s t} of q'' + C q' + K q = 0, from norms of K and C. */
double taylor_rate_bound(double stiffness, double damping);

/** The same if K and C, divided by the masses, are symmetric and no spring and no damper is negative: a mode has a
 *  stiffness k between `softest` and `stiffness` and a damping c of at most `damping`; |s| is sqrt(k) if it oscillates,
 *  at most c / 2 + sqrt(c^2 / 4 - k) if not. */
double taylor_passive_rate_bound(double stiffness, double softest, double damping);

/** Largest absolute value of x [count]; not finite if an entry is not. */
double taylor_largest(const double *x, size_t count);

/** Decay of the coefficients of a step. */
typedef struct taylor_decay {
  double change;  /* largest |c_1|, |c_2|, |c_3|, or |c_4| where these vanish: zero if the motion stays at rest; NaN if
                     the series is unusable */
  double tail[2]; /* largest |c_{order - 1}|, |c_order| */
  double nearest_zero; /* lower bound of the x of a branch point; INFINITY: none */
} taylor_decay;

/** Decay of coefficients [order + 1][stride] in `count` columns. */
taylor_decay taylor_decay_of(const double *coef, size_t stride, size_t count, int order);

/** That of two sets of coordinates together. */
taylor_decay taylor_decay_join(taylor_decay a, taylor_decay b);

/** Factor, at most 1000, by which the trial step becomes the longest one whose last two coefficients, in coordinates
 *  and in speeds, lie below a tenth of the tolerance times the change of the state in the step. */
double taylor_step_factor(const taylor_decay *decay, int order, double tolerance);

/** Signed length of the next step.
 *  @param remaining  time to the stop, signed, not 0
 *  @param longest  > 0, what accuracy allows
 *  @param fixed  the length is prescribed: it is kept until the stop lies within it. Otherwise the last two steps share
 *                the remaining time equally, to avoid a very short one
 *  @returns `remaining` itself if the step reaches the stop. */
double taylor_step_length(double remaining, double longest, bool fixed);

/** Whether a step is lost in the rounding of the time, shorter than 1e-12 (1 + |time|). */
bool taylor_step_vanishes(double time, double length);

/** The shortest step that is not lost in rounding. */
double taylor_step_least(double time);

/* Choice of the step length of Taylor flows.
 *
 * The length follows from a bound of the rates if the flow has one, otherwise from the decay of the coefficients;
 * options, forcing and Hertz contacts shorten it, and the stop is reached without a very short step. */

typedef struct taylor_stepper {
  ric_flow *flow; /* whose length and end are set */
  /** Computes the series of a step of that signed length. */
  taylor_decay (*expand)(ric_flow *flow, double length);
  /** Converts the last series into that of a shorter step. */
  void (*shorten)(ric_flow *flow, double length);
  bool by_bound; /* steps without Hertz contacts have the length `longest` */
  int order;
  double longest;         /* step of the fastest linear motion; INFINITY without stiffness and damping */
  double longest_carried; /* step allowed by tangent vectors, with the rates of the linear springs */
  double longest_forced;  /* step allowed by the frequency of the forcing; INFINITY without */
  double trial;           /* length of the next series if its decay determines the step */
} taylor_stepper;

/** Sets order, lengths and trial from the options of the flow.
 *  @param rate  bound of |s| of the linear motions e^{s t}
 *  @param frequency  of the forcing; 0 without */
void taylor_stepper_plan(taylor_stepper *stepper, double rate, double frequency);

/** Length of the first series if the linear motions give no bound: problems are dimensionless. */
double taylor_stepper_natural(const taylor_stepper *stepper);

/** Chooses a step towards `stop`, with its series, and sets length and end of the flow.
 *  @param limit  longest step on which omitted forces are negligible
 *  @param pressed  Hertz contacts act: steps follow from the decay, a prescribed length is the longest one
 *  @returns RIC_ENUMERIC if the motion blows up; the flow is unchanged. */
ric_status taylor_stepper_choose(taylor_stepper *stepper, double stop, double limit, bool pressed, ric_error *error);

#endif

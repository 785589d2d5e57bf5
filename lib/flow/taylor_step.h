/* Order and step of Taylor flows from the tolerance: internal to the room.
 *
 * A flow expands the motion over a trial step, sees how its coefficients decay, and rescales them to the step that the
 * tolerance allows: c_j of a step theta times as long is theta^j c_j. Pure functions, for every Taylor flow. */
#ifndef RICOCHET_TAYLOR_STEP_H
#define RICOCHET_TAYLOR_STEP_H

#include <stdbool.h>

/** Order at which steps are about the natural time of the motion: 24 at 1e-16, between 4 and 30. */
int taylor_order(double tolerance);

/** Largest absolute values, over all coordinates, of coefficients of a trial step. */
typedef struct taylor_decay {
  double position, rate, bend; /* of c_0, c_1 and c_2 */
  double before_last, last;    /* of c_{order - 1} and c_order */
  double forcing;  /* size that forces give a motion in its natural time: it may begin at rest at zero; 0 without */
  double fraction; /* trial step over the natural time, of the fastest linear motion; 0 if that is infinite */
} taylor_decay;

/** Factor by which the trial step becomes the longest one whose last two coefficients lie below tolerance times the
 *  size of the state, max(|q|, |h u|, |h^2 u'| / 2); at most `most`. Where a step is shorter than the natural time, as
 *  close to the beginning and end of a Hertz contact, |q| counts by its fraction only: the error of the speeds is that
 *  of the coordinates over the step, and would not be bounded otherwise. */
double taylor_step_factor(const taylor_decay *decay, int order, double tolerance, double most);

/** Signed length of the next step.
 *  @param remaining  time to the stop, signed, not 0
 *  @param longest  > 0, what accuracy allows
 *  @param fixed  the length is prescribed: it is kept until the stop lies within it. Otherwise the last two steps share
 *                what remains, so that no sliver is left
 *  @returns `remaining` itself when the step reaches the stop. */
double taylor_step_length(double remaining, double longest, bool fixed);

/** Whether a step is lost in the rounding of the time. */
bool taylor_step_vanishes(double time, double length);

#endif

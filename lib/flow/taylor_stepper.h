/* Steps of Taylor flows: what a step's length follows from, and how it is chosen. Internal to the room.
 *
 * A length comes from a bound of the rates where the flow trusts one, else from the decay of the coefficients; options,
 * forcing and Hertz contacts shorten it, and the stop is met without a sliver. */
#ifndef RICOCHET_TAYLOR_STEPPER_H
#define RICOCHET_TAYLOR_STEPPER_H

#include "flow_method.h"
#include "taylor_step.h"

typedef struct taylor_stepper {
  ric_flow *flow; /* whose length and end are set */
  /** Makes the series of a step of that signed length. */
  taylor_decay (*expand)(ric_flow *flow, double length);
  /** Turns the series that was made last into that of a shorter step. */
  void (*shorten)(ric_flow *flow, double length);
  bool by_bound; /* steps without Hertz contacts have the length `longest` */
  int order;
  double longest;         /* step of the fastest linear motion; INFINITY when nothing pulls */
  double longest_carried; /* step that tangent vectors allow, whose rates are those of the linear springs */
  double longest_forced;  /* step that the frequency of the forcing allows; INFINITY without */
  double trial;           /* length at which the next series is made when its decay decides */
} taylor_stepper;

/** Sets order, lengths and trial from the options of the flow.
 *  @param rate  bound of |s| of the linear motions e^{s t}
 *  @param frequency  of the forcing; 0 without */
void taylor_stepper_plan(taylor_stepper *stepper, double rate, double frequency);

/** Length of the first series where the linear motions say nothing: problems are dimensionless. */
double taylor_stepper_natural(const taylor_stepper *stepper);

/** Chooses a step towards `stop`, with its series, and sets length and end of the flow.
 *  @param limit  longest step for which forces that are left out do not matter
 *  @param pressed  Hertz contacts act: steps follow from the decay, a prescribed length is the longest one
 *  @returns RIC_ENUMERIC when the motion blows up; the flow is as it was. */
ric_status taylor_stepper_choose(taylor_stepper *stepper, double stop, double limit, bool pressed, ric_error *error);

#endif

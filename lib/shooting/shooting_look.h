/* What one run along a motion tells, with its equations: internal to the room. */
#ifndef RICOCHET_SHOOTING_LOOK_H
#define RICOCHET_SHOOTING_LOOK_H

#include "shooting_parts.h"

/** What is looked at: numbers of the orbit and its gaps; the matrix of its multipliers. */
typedef enum look_at { LOOK_ORBIT = 1, LOOK_SPECTRUM = 2 } look_at;

/** Evaluates the equations and looks at the motion by the same run.
 *  @param what  of look_at, added up
 *  @param F, J, F_given  as ric_shooting_residual; F may be NULL
 *  @param orbit  with LOOK_ORBIT: impacts, state at T/2 and residual are set; s->gaps has the gaps
 *  @returns as ric_shooting_residual, RIC_ENOMEM. */
ric_status shooting_look(ric_shooting *s, const double *z, double given, int what, double *F, double *J,
                         double *F_given, ric_orbit *orbit, ric_error *error);

/** First state, period, energy and verdict of the orbit that shooting_look has seen last.
 *  @param z  of the orbit, or what it was corrected to since: by less than what is seen of it is exact to */
ric_status shooting_judge(ric_shooting *s, const double *z, double given, ric_orbit *orbit, ric_error *error);

#endif

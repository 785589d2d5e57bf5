/* Whether a system can have motions of the kind that was asked for: internal to the room.
 *
 * The equations of shooting take symmetries for granted: even motions those of a system that runs backwards as it runs
 * forwards, forced ones that time repeats after the period, the others that it does not matter. Where that is wrong
 * they have solutions that are no motions. */
#ifndef RICOCHET_SHOOTING_FIT_H
#define RICOCHET_SHOOTING_FIT_H

#include "shooting_parts.h"

/** Tries a state beside the first one.
 *  @param z  a solution
 *  @param why  set to what does not fit, NULL when all does
 *  @returns RIC_ECALLBACK */
ric_status shooting_fit(ric_shooting *shooting, const double *z, double period, double tolerance, const char **why,
                        ric_error *error);

#endif

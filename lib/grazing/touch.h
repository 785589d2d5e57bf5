/* Where the gap of a motion has a minimum: internal to the room. */
#ifndef RICOCHET_TOUCH_H
#define RICOCHET_TOUCH_H

#include "ricochet/family.h"

/** A minimum of a gap along a solution of shooting. */
typedef struct touch {
  size_t obstacle;
  double time; /* in [0, T) */
  double gap, rate, acceleration;
  double *x;     /* [n + m] state there; of the caller */
  double *rates; /* [n + m] of the free motion */
} touch;

/** Moves a touch to the minimum of its gap that is nearest to its time, and sets the rest.
 *  @returns RIC_ENUMERIC where there is none within a period; as ric_shooting_transfer */
ric_status touch_find(ric_shooting *shooting, const double *z, double given, double period, touch *touch,
                      ric_error *error);

#endif

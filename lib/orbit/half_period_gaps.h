/* The smallest gaps of a periodic response over its half period: internal to the room.
 *
 * The motion is even about 0 and T/2. Gaps are Taylor polynomials of the closed form on segments, each made from the
 * cosines and sines at its start, and their minima certified (polynomial.h). The gap of the obstacle that is hit is
 * zero at 0: it is divided by x on the first segment, where x goes from 0 to 1, so that it is positive there as long as
 * the obstacle is left, and meets the gap itself at the end. */
#ifndef RICOCHET_HALF_PERIOD_GAPS_H
#define RICOCHET_HALF_PERIOD_GAPS_H

#include "periodic_response.h"

/** A gap, where and when. */
typedef struct least_gap {
  double value; /* INFINITY: none */
  double time;
  size_t obstacle;
} least_gap;

/** The smallest gap of the obstacles that are not hit, and that of the one that is, divided as said above.
 *  @param tolerance  absolute, on the values */
void half_period_smallest(ric_impact_modes *modes, const periodic_response *response, double tolerance, least_gap *free,
                          least_gap *own);

/** The first gap below -zero. @returns whether there is one. */
bool half_period_violation(ric_impact_modes *modes, const periodic_response *response, double zero, least_gap *first);

#endif

/* Whether the response of a period is an orbit: internal to the room. */
#ifndef RICOCHET_IMPACT_VERDICT_H
#define RICOCHET_IMPACT_VERDICT_H

#include "half_period_gaps.h"

typedef struct impact_verdict {
  ric_outcome outcome;
  char reason[RIC_REASON_BYTES]; /* "" when admissible */
  double scale;                  /* largest displacement */
  least_gap free, own;           /* half_period_gaps.h */
} impact_verdict;

/** The smaller of both gaps over the scale: positive where the orbit is admissible, zero where it grazes. Resonances
 *  and large amplitudes are not told from others. `verdict` has its gaps and its scale only. */
double impact_verdict_margin(ric_impact_modes *modes, double period, periodic_response *response,
                             impact_verdict *verdict);

/** The outcome with its reason. modes->q and modes->v are the state at 0 then, unless it is singular. */
void impact_verdict_find(ric_impact_modes *modes, double period, periodic_response *response, impact_verdict *verdict);

/** Says which obstacle is touched, and when. */
void impact_verdict_touch(const impact_verdict *verdict, char *text, size_t bytes);

#endif

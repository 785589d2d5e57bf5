/* Where the gap of the free motion is smallest, and where it opens, forwards and backwards in time: internal to the
 * room.
 *
 * The gap is followed by its rate: on the steps of a short motion the gap itself may vary by less than its rounding
 * where the rate still varies by many times its own. Rates are polynomials on the segments of the flow; their
 * integrals are searched with certainty (polynomial.h). */
#ifndef RICOCHET_GAP_SEARCH_H
#define RICOCHET_GAP_SEARCH_H

#include "impact/gap.h"

typedef struct gap_search {
  ric_flow *flow; /* borrowed */
  size_t obstacle;
  gap_reader reader;
} gap_search;

ric_status gap_search_init(gap_search *search, ric_flow *flow, size_t obstacle, ric_error *error);
void gap_search_clear(gap_search *search);

/** First local minimum of the gap on the way from a state.
 *  @param span  signed length of the way in time, not 0
 *  @param rate  gap rate at the state
 *  @param time  set; NaN when there is none, or when the motion ends before
 *  @returns RIC_ECALLBACK, RIC_EINVAL as ric_flow_start. */
ric_status gap_search_minimum(gap_search *search, double t, const double *x, double span, double rate, double *time,
                              ric_error *error);

/** First time at which the gap, `depth` <= 0 at the state, is zero again; parameters as above. */
ric_status gap_search_opening(gap_search *search, double t, const double *x, double span, double depth, double *time,
                              ric_error *error);

#endif

/* What shooting needs to know of a forced motion on its attractor: internal to the room. */
#ifndef RICOCHET_MOTION_RECORD_H
#define RICOCHET_MOTION_RECORD_H

#include "ricochet/family.h"

/** A motion over its period. */
typedef struct motion_record {
  size_t count;     /* impacts */
  size_t *sequence; /* [count] their obstacles */
  double *times;    /* [count] increasing, the first one in [0, period) */
  double *q, *u;    /* [n], [m] after the first impact; without impacts at t = 0 */
} motion_record;

/** Runs it from (t, q, u) over a period.
 *  @param motion  options of the flow and the poll of its runs
 *  @returns RIC_ENUMERIC for a run that does not get there, for impacts that accumulate and contacts that last; as
 *           ric_trajectory_create, _start, _run; RIC_ENOMEM; always to be cleared */
ric_status motion_record_take(motion_record *record, const ric_system *system, const ric_shooting_problem *motion,
                              double period, double t, const double *q, const double *u, ric_error *error);
void motion_record_clear(motion_record *record);

#endif

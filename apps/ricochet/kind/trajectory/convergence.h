/* Lyapunov exponents of a trajectory: how a run finds them, and the records of how they converged. */
#ifndef RICOCHET_APP_CONVERGENCE_H
#define RICOCHET_APP_CONVERGENCE_H

#include <ricochet/ricochet.h>
#include <stdbool.h>

#include "base/records.h"
#include "base/table.h"

/** A record: the exponents by a time. */
typedef struct lyapunov_record {
  double time;
  const double *history;
} lyapunov_record;

/** The records of one task, of which those are kept that are a twentieth later than the one before, and the last. */
typedef struct convergence {
  const table *layout; /* with the columns lyapunov_time and lyapunov_history */
  records *to;
  double kept; /* time of the last one; 0 before the first */
  int no_memory;
} convergence;

/** Bytes that tangent vectors take for `exponents` exponents of as many numbers of state, as a number that cannot
 *  overflow, and the records of one task. */
double convergence_bytes(double exponents, bool by_cvodes);

/** Runs a trajectory from where it stands to `end`, as ric_trajectory_run, with all its exponents.
 *  @param interval  from one factorisation to the next
 *  @param exponents  [those of layout] NaN where the run gives none
 *  @returns as ric_lyapunov_run; whatever the outcome, without memory for a record `no_memory` is set and the run has
 *           ended */
ric_status convergence_run(convergence *c, ric_trajectory *trajectory, double end, double interval,
                           const ric_observer *observer, double *exponents, ric_run *did, ric_error *error);

#endif

/* The walk of a task along its branch, and along the branches that it meets. */
#ifndef RICOCHET_APP_BRANCH_WALK_H
#define RICOCHET_APP_BRANCH_WALK_H

#include "branch.h"
#include "kind/family/family_task.h"

/** How the first segment ended, and what all of them took. */
typedef struct branch_result {
  int outcome; /* ric_curve_end and beyond */
  char reason[CURVE_REASON_BYTES];
  size_t points, segments;
  unsigned long long iterations, jacobians;
} branch_result;

/** Follows the family of a task from its start, and further segments where the study asks for them.
 *  @param tails  [plan->tail_count], behind the records of earlier tasks
 *  @returns RIC_OK, also for a branch that does not begin; RIC_ESTOPPED; RIC_ENOMEM when records do not fit */
ric_status branch_walk(family_task *t, const kind_plan *plan, records *tails, branch_result *result);

/** The row's segment of a branch that never began. @returns RIC_OK or RIC_ENOMEM */
ric_status branch_put_unborn(const kind_plan *plan, records *tails, int outcome, const char *reason);

#endif

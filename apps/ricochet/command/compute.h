/* The loop of one rank: takes chunks of missing tasks, evaluates them, appends them to the checkpoint. */
#ifndef RICOCHET_APP_COMPUTE_H
#define RICOCHET_APP_COMPUTE_H

#include "../run/checkpoint.h"
#include "../run/progress.h"
#include "../run/stop.h"
#include "../kind/kind.h"
#include "options.h"

typedef struct compute_result {
  stop_reason stopped; /* on any rank; STOP_NONE when every missing task was done */
  double seconds;      /* from the first chunk taken to the last finished, over all ranks */
  uint64_t computed;   /* tasks finished by all ranks in this run */
} compute_result;

/** Collective. Computes every task that the checkpoint misses, on all ranks. */
int compute(const study *s, const kind *k, const kind_plan *plan, checkpoint *c, const run_options *o,
            compute_result *result, message *why);

#endif

/* A periodic motion out of a result of kind `branch`, to start another branch with. */
#ifndef RICOCHET_APP_MOTION_H
#define RICOCHET_APP_MOTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../base/message.h"

typedef struct result_impact {
  double time;
  long long particle;
  bool wall; /* or its floor */
} result_impact;

/** A number that varies in the result, by its key. */
typedef struct result_number {
  char name[96];
  double value;
} result_number;

enum { RESULT_MOST_NUMBERS = 9 /* one that is followed, and those swept */ };

typedef struct result_motion {
  size_t particles;
  double *q, *v; /* [particles] first state */
  double period, energy;
  result_impact *impacts; /* [impact_count] as ric_orbit lists them */
  size_t impact_count;
  result_number numbers[RESULT_MOST_NUMBERS]; /* the one that is followed first */
  size_t number_count;
} result_motion;

/** Where it stands. */
typedef struct result_where {
  const char *path;
  uint64_t task, index;
  bool special; /* a special point of the task, or a point */
} result_where;

/** Reads a motion, on this process alone, without MPI_Init.
 *  @param m  cleared by the caller, also after a failure
 *  @returns 0; EXIT_FILES when the file is damaged, not ours, or of another kind; EXIT_USAGE for a task or a point that
 *           it has not, or points without states; EXIT_RUN */
int result_read_motion(const result_where *where, result_motion *m, message *why);
void result_motion_clear(result_motion *m);

#endif

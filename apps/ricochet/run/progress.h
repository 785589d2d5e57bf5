/* Progress on standard error: a bar on a terminal, a line every 30 s otherwise, nothing on request. Rank 0 only. */
#ifndef RICOCHET_APP_PROGRESS_H
#define RICOCHET_APP_PROGRESS_H

#include <stdint.h>

typedef enum progress_mode {
  PROGRESS_AUTO,   /* the bar if standard error, or that of mpirun, is a terminal, lines otherwise */
  PROGRESS_ALWAYS, /* the bar also when standard error is no terminal */
  PROGRESS_NEVER
} progress_mode;

typedef struct progress {
  int active, terminal;
  uint64_t total, resumed; /* tasks of the study; those found in the checkpoint */
  double began, shown;     /* clock_seconds of the start and of the last output */
} progress;

/** Starts the clock that rates refer to; prints nothing yet. */
void progress_begin(progress *p, progress_mode mode, uint64_t total, uint64_t resumed);
/** Cheap when called often: prints at most 5 times a second on a terminal, every 30 s otherwise.
 *  Shows tasks done, rate and time left.
 *  @param done  tasks finished so far, the resumed ones included; these do not count in the rate */
void progress_show(progress *p, uint64_t done);
/** Last output: the bar at its final state and a line break. */
void progress_end(progress *p, uint64_t done);

#endif

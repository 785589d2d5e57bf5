/* Reasons to stop a run early: signals and the time limit.
 *
 * SIGUSR1 and --max-time ask for a checkpoint and exit code 75: whatever may take long asks stop_asked, or the poll
 * that the library is given. SIGTERM and SIGINT end the process at once: what it has written stays. While tasks are
 * computed they are held: the tasks that are finished are written first. */
#ifndef RICOCHET_APP_STOP_H
#define RICOCHET_APP_STOP_H

#include <stdbool.h>
#include <stdint.h>

typedef enum stop_reason {
  STOP_NONE,
  STOP_ASKED, /* SIGUSR1 */
  STOP_TIME,  /* the time limit has passed */
  STOP_SIGNAL /* SIGTERM or SIGINT, held; precedes the others, because the process has about a second left */
} stop_reason;

/** Installs the handlers (SIGUSR1; SIGXFSZ and SIGPIPE ignored), clears earlier signals and starts the clock. Without
 * it nothing stops.
 *  @param max_seconds  time limit, INFINITY for none; NaN stops at once */
void stop_watch(double max_seconds);

/** Reason so far; reads the flags and the clock, 50 ns. */
stop_reason stop_asked(void);

/** As the poll of the library. */
int stop_poll(void *user);

/** Whether to stop, for work that is measured in bytes: asked after each 16 MB of it, so that small things are never
 * left half done. @param since  bytes since it was asked, 0 at first */
bool stop_asked_after(uint64_t bytes, uint64_t *since);

/** SIGTERM and SIGINT are noted from here on and stop_asked reports them, until stop_release_signals. */
void stop_hold_signals(void);

/** SIGTERM and SIGINT end the process at once again; does not return if one of them was held. Not collective: mpirun
 *  ends the other ranks. */
void stop_release_signals(void);

/** Seconds on the monotonic clock. */
double clock_seconds(void);

#endif

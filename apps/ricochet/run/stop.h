/* Reasons to stop a run early: signals and the time limit.
 *
 * SIGUSR1 and --max-time ask for a checkpoint and exit code 75. SIGTERM and SIGINT stop the process:
 * what it has written stays, and it exits with the code of the signal. A handler only sets a flag, which the poll of
 * the computation reads. */
#ifndef RICOCHET_APP_STOP_H
#define RICOCHET_APP_STOP_H

typedef enum stop_reason {
  STOP_NONE,
  STOP_ASKED, /* SIGUSR1 */
  STOP_TIME,  /* the time limit has passed */
  STOP_SIGNAL /* SIGTERM or SIGINT; precedes the others, because the process has about a second left */
} stop_reason;

/** Installs the handlers (SIGUSR1, SIGTERM, SIGINT; SIGXFSZ and SIGPIPE ignored), clears earlier signals and starts
 *  the clock. Must precede the first stop_asked.
 *  @param max_seconds  time limit, INFINITY for none; NaN stops at once */
void stop_watch(double max_seconds);

/** Reason so far; reads the flags and the clock, 50 ns. */
stop_reason stop_asked(void);

/** The signal behind STOP_SIGNAL, 0 when there was none. */
int stop_signal(void);

/** Exits with the code of SIGTERM or SIGINT if one of them was received, else returns. Not collective: mpirun ends the
 * other ranks. What this rank has written stays. */
void stop_leave_by_signal(void);

/** Seconds on the monotonic clock. */
double clock_seconds(void);

#endif

/* Reasons to stop a run early: signals and the time limit.
 *
 * SIGUSR1 and --max-time ask for a checkpoint and exit code 75. SIGTERM and SIGINT mark the process stopped: it keeps
 * what it has written and leaves with the signal's own code. */
#ifndef RICOCHET_APP_STOP_H
#define RICOCHET_APP_STOP_H

typedef enum stop_reason { STOP_NONE, STOP_ASKED, STOP_TIME, STOP_SIGNAL } stop_reason;

/** Installs the handlers (SIGUSR1, SIGTERM, SIGINT; SIGXFSZ and SIGPIPE ignored) and starts the clock.
 *  @param max_seconds  time limit, INFINITY for none */
void stop_watch(double max_seconds);

/** Reason so far; reads the clock and the flags, 50 ns. */
stop_reason stop_asked(void);

/** The signal behind STOP_SIGNAL, 0 when there was none. */
int stop_signal(void);

/** Seconds on the monotonic clock. */
double clock_seconds(void);

#endif

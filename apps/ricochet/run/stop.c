#include "stop.h"

#include <math.h>
#include <signal.h>
#include <stddef.h>
#include <time.h>

enum { BYTES_BETWEEN = 16 << 20 /* well below a second on any disk */ };

/* The C standard lets a signal handler write only static objects of this type. The deadline is static, too: there is
 * one process and one limit. */
static volatile sig_atomic_t asked;
static volatile sig_atomic_t held_signal;
static double deadline = INFINITY;

static void note_request(int number) {
  (void)number;
  asked = 1;
}

static void hold(int number) {
  held_signal = number;
}

static void handle(int number, void (*handler)(int)) {
  struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, NULL); /* fails only for numbers that are no signals */
}

void stop_watch(double max_seconds) {
  asked = 0;
  held_signal = 0;
  deadline = clock_seconds() + max_seconds;
  handle(SIGUSR1, note_request);
  handle(SIGTERM, SIG_DFL); /* a shell may have made them ignored */
  handle(SIGINT, SIG_DFL);
  /* A full quota and a closed pipe then give EFBIG and EPIPE, which the caller reports, and do not kill the process. */
  handle(SIGXFSZ, SIG_IGN);
  handle(SIGPIPE, SIG_IGN);
}

stop_reason stop_asked(void) {
  if (held_signal)
    return STOP_SIGNAL;
  if (asked)
    return STOP_ASKED;
  return clock_seconds() < deadline ? STOP_NONE : STOP_TIME;
}

int stop_poll(void *user) {
  (void)user;
  return stop_asked() != STOP_NONE;
}

bool stop_asked_after(uint64_t bytes, uint64_t *since) {
  *since += bytes;
  if (*since < BYTES_BETWEEN)
    return false;
  *since = 0;
  return stop_asked() != STOP_NONE;
}

void stop_hold_signals(void) {
  handle(SIGTERM, hold);
  handle(SIGINT, hold);
}

void stop_release_signals(void) {
  handle(SIGTERM, SIG_DFL);
  handle(SIGINT, SIG_DFL);
  if (held_signal)
    raise((int)held_signal);
}

double clock_seconds(void) {
  struct timespec now = {0};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

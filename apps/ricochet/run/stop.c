#include "stop.h"

#include <signal.h>
#include <stddef.h>
#include <time.h>

/* The C standard lets a signal handler write only static objects of this type. The deadline is static, too: there is
 * one process and one limit. */
static volatile sig_atomic_t asked;
static volatile sig_atomic_t fatal_signal;
static double deadline;

static void note_request(int number) {
  (void)number;
  asked = 1;
}

static void note_fatal(int number) {
  fatal_signal = number;
}

static void handle(int number, void (*handler)(int)) {
  struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, NULL); /* fails only for numbers that are no signals */
}

void stop_watch(double max_seconds) {
  asked = 0;
  fatal_signal = 0;
  deadline = clock_seconds() + max_seconds;
  handle(SIGUSR1, note_request);
  handle(SIGTERM, note_fatal);
  handle(SIGINT, note_fatal);
  /* A full quota and a closed pipe then give EFBIG and EPIPE, which the caller reports, and do not kill the process. */
  handle(SIGXFSZ, SIG_IGN);
  handle(SIGPIPE, SIG_IGN);
}

stop_reason stop_asked(void) {
  if (fatal_signal)
    return STOP_SIGNAL;
  if (asked)
    return STOP_ASKED;
  return clock_seconds() < deadline ? STOP_NONE : STOP_TIME;
}

int stop_signal(void) {
  return (int)fatal_signal;
}

double clock_seconds(void) {
  struct timespec now = {0};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void stop_leave_by_signal(void) {
  int number = stop_signal();
  if (number == 0)
    return;
  signal(number, SIG_DFL);
  raise(number);
}

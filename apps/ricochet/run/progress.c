#include "progress.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stop.h"

enum { BAR_WIDTH = 20, LINE_WIDTH = 79 };
static const double bar_interval = 0.2, line_interval = 30;

/* mpirun gives its ranks pipes and copies what they write to its own standard error; whether that is a terminal shows
 * in /proc, as mpirun is the parent of the ranks on its machine. */
static int mpirun_is_on_terminal(void) {
  if (!getenv("OMPI_COMM_WORLD_RANK"))
    return 0;
  char path[64], target[PATH_MAX];
  snprintf(path, sizeof path, "/proc/%ld/fd/%d", (long)getppid(), STDERR_FILENO);
  const ssize_t length = readlink(path, target, sizeof target - 1);
  target[length > 0 ? length : 0] = '\0';
  return strncmp(target, "/dev/pts/", 9) == 0 || strncmp(target, "/dev/tty", 8) == 0;
}

void progress_begin(progress *p, progress_mode mode, uint64_t total, uint64_t resumed) {
  p->active = mode != PROGRESS_NEVER;
  p->terminal = mode == PROGRESS_ALWAYS || isatty(STDERR_FILENO) || mpirun_is_on_terminal();
  p->total = total;
  p->resumed = resumed;
  p->began = p->shown = clock_seconds();
}

/* The two largest units; `text` holds 32 bytes. */
static void format_duration(char *text, double seconds) {
  if (!(seconds < 1e9))
    snprintf(text, 32, "over 30 years");
  else if (seconds < 60)
    snprintf(text, 32, "%.0f s", seconds);
  else if (seconds < 3600)
    snprintf(text, 32, "%d min %d s", (int)seconds / 60, (int)seconds % 60);
  else
    snprintf(text, 32, "%d h %d min", (int)seconds / 3600, (int)seconds % 3600 / 60);
}

/* "  53 %  5300/10000 tasks  412/s  12 s left": the rate and the time left as soon as they are known.
 */
static void format_state(const progress *p, uint64_t done, double now, char *text, size_t size) {
  const double share = p->total ? (double)done / (double)p->total : 1;
  /* Rounded down: 100 % says that nothing is left. */
  int length = snprintf(text, size, "%3d %%  %llu/%llu tasks", (int)(100 * share), (unsigned long long)done,
                        (unsigned long long)p->total);
  const double computed = done > p->resumed ? (double)(done - p->resumed) : 0, rate = computed / (now - p->began);
  if (!(rate > 0) || length < 0)
    return;
  length += snprintf(text + length, size - (size_t)length, rate < 10 ? "  %.2g/s" : "  %.0f/s", rate);
  if (done < p->total) {
    char left[32];
    format_duration(left, (double)(p->total - done) / rate);
    snprintf(text + length, size - (size_t)length, "  %s left", left);
  }
}

static void print(progress *p, uint64_t done, double now, const char *line_end) {
  char state[200], bar[BAR_WIDTH + 1];
  if (done > p->total)
    done = p->total;
  format_state(p, done, now, state, sizeof state);
  p->shown = now;
  if (!p->terminal) {
    fprintf(stderr, "ricochet: %s\n", state);
    return;
  }
  const int filled = p->total ? (int)(BAR_WIDTH * ((double)done / (double)p->total)) : BAR_WIDTH;
  memset(bar, '#', (size_t)filled);
  memset(bar + filled, '.', (size_t)(BAR_WIDTH - filled));
  bar[BAR_WIDTH] = '\0';
  /* Padded, so that a shorter text covers the whole of the longer one before it. */
  fprintf(stderr, "\r[%s] %-*s%s", bar, LINE_WIDTH - BAR_WIDTH - 3, state, line_end);
  fflush(stderr);
}

void progress_show(progress *p, uint64_t done) {
  if (!p->active)
    return;
  const double now = clock_seconds();
  if (now - p->shown >= (p->terminal ? bar_interval : line_interval))
    print(p, done, now, "");
}

void progress_end(progress *p, uint64_t done) {
  if (p->active)
    print(p, done, clock_seconds(), p->terminal ? "\n" : "");
  p->active = 0;
}

/* Options of `run` and `check`. */
#ifndef RICOCHET_APP_OPTIONS_H
#define RICOCHET_APP_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "../run/launcher.h"
#include "../run/progress.h"
#include "../base/message.h"

typedef struct run_options {
  const char *study_path;
  const char *output; /* NULL: the study's name with .h5 in the current folder */
  const char **sets;  /* --set assignments; freed by run_options_clear */
  size_t set_count;
  bool resume, force, help;
  double checkpoint_seconds; /* default 30 */
  double max_seconds;        /* INFINITY: no limit */
  progress_mode progress;
  launcher_mode mpi; /* default LAUNCHER_AUTO */
} run_options;

/** Reads the arguments of `run`. @returns 0 or EXIT_USAGE. */
int run_options_parse(int argc, char **argv, run_options *o, message *why);
void run_options_clear(run_options *o);

/** Seconds of "30", "30s", "55m", "2h", "1.5h", "1d"; -1 when it is none of these or not positive. */
double parse_duration(const char *text);

#endif

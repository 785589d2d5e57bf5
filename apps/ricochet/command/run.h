/* What the files of `ricochet run` share: its options, its output, the loop of one rank. */
#ifndef RICOCHET_APP_RUN_H
#define RICOCHET_APP_RUN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../kind/kind.h"
#include "../run/checkpoint.h"
#include "../run/launcher.h"
#include "../run/lock.h"
#include "../run/progress.h"
#include "../run/stop.h"

/* --- options.c --- */

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

/* --- output.c: the output of a run: its paths, the lock on it, and what is there already. */

typedef struct output {
  char path[4096];   /* FILE.h5 */
  char folder[4112]; /* FILE.h5.ckpt */
  lock *lock;
} output;

/** Sets the paths of the output from the options. @returns 0 or EXIT_USAGE for a path that cannot be an output. */
int output_name(output *out, const run_options *o, message *why);

/** For rank 0: takes the lock. Without --resume and --force, an existing result or checkpoint is refused (2); --force
 *  removes an old checkpoint (the old result stays until the new one replaces it).
 *  @returns 0 or the exit code, with the lock released. */
int output_claim(output *out, const run_options *o, message *why);

/** For rank 0, with --resume: whether the existing result is that of this study. It is not read while the checkpoint
 *  has some tasks but not all: then a run that was to replace the result was stopped.
 *  @param finished  set if there is a verified result of the same study
 *  @returns 0; EXIT_USAGE for the result of another study, EXIT_FILES for a damaged one, when there is no checkpoint */
int output_check_result(const output *out, uint64_t digest, uint64_t tasks, uint64_t done, bool *finished,
                        message *why);

/** For rank 0: refuses (3) when the folder has less free than the run will still write. */
int output_check_room(const output *out, double needed, message *why);

/** Collective: every rank's share of the lock, after rank 0 claimed. */
int output_join(output *out, message *why);

/** Collective: releases the lock. @param drop  also removes the checkpoint and its folder */
void output_release(output *out, bool drop);

/* --- texts.c --- */

/** Collective. Gives tables with text columns layouts in which these are as wide as their longest text, so that a
 * result of a million tasks without a reason has none. Reads all rows of such tables once.
 *  @param stored  [count] room for the layouts, which `tables` then refer to */
int fit_texts(result_table *tables, size_t count, table *stored, message *why);

/* --- compute.c: the loop of one rank: takes chunks of missing tasks, evaluates them, appends them to the checkpoint.
 */

typedef struct compute_result {
  double seconds;    /* from the first chunk taken to the last finished, over all ranks */
  uint64_t computed; /* tasks finished by all ranks in this run */
} compute_result;

/** Collective. Computes every task that the checkpoint misses, on all ranks. */
int compute(const study *s, const kind *k, const kind_plan *plan, checkpoint *c, const run_options *o,
            compute_result *result, message *why);

#endif

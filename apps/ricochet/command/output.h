/* The output of a run: its paths, the lock on it, and what is there already. */
#ifndef RICOCHET_APP_OUTPUT_H
#define RICOCHET_APP_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "../run/lock.h"
#include "options.h"

typedef struct output {
  char path[4096];   /* FILE.h5 */
  char folder[4112]; /* FILE.h5.ckpt */
  lock *lock;
} output;

/** Names the output after the options. @returns 0 or EXIT_USAGE for a path that cannot be. */
int output_name(output *out, const run_options *o, message *why);

/** For rank 0: takes the lock. Without --resume and --force, anything that is there is refused (2); --force removes an
 *  old checkpoint (the old result stays until the new one replaces it).
 *  @returns 0 or the exit code, with the lock released. */
int output_claim(output *out, const run_options *o, message *why);

/** For rank 0, with --resume: whether the result that is there is what the run would give. It is not looked at while a
 *  checkpoint with some tasks, but not all, says that a run over it was stopped.
 *  @param finished  set when a verified result of the same study is there
 *  @returns 0; EXIT_USAGE for the result of another study, EXIT_FILES for a damaged one, when there is no checkpoint */
int output_look_at_result(const output *out, uint64_t digest, uint64_t tasks, uint64_t done, bool *finished,
                          message *why);

/** For rank 0: refuses (3) when the folder has less free than the run will still write. */
int output_check_room(const output *out, double needed, message *why);

/** Collective: every rank's share of the lock, after rank 0 claimed. */
int output_join(output *out, message *why);

/** Collective: gives the lock back. @param drop  the checkpoint is of no more use: removes it and its folder */
void output_release(output *out, bool drop);

#endif

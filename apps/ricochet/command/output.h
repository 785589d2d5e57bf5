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
  bool finished;     /* a verified result of the same study is there: nothing to do */
  lock *lock;
} output;

/** Names the output after the options. @returns 0 or EXIT_USAGE for a path that is too long. */
int output_name(output *out, const run_options *o, message *why);

/** For rank 0: takes the lock and decides what to do with what is there. With --resume a finished result of the same
 *  study sets `finished`, another one's is refused (2) and a damaged one too (3); without --resume and --force anything
 *  that is there is refused (2); --force removes an old checkpoint (the old result stays until the new one replaces
 * it).
 *  @param needed  bytes that checkpoint and result will take, refused (3) when the folder has less free
 *  @returns 0 or the exit code, with the lock released. */
int output_claim(output *out, const run_options *o, uint64_t digest, double needed, message *why);

/** Collective: every rank's share of the lock, after rank 0 claimed. */
int output_join(output *out, message *why);

/** Collective: gives the lock back; `done` also removes checkpoint and folder. */
void output_release(output *out, bool done);

#endif

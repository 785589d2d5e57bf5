/* The ranks of a run: start, agreement on failures, small reductions. Commands use no other function of MPI.
 *
 * A process that never started MPI is the only rank, and all functions below work for it.
 * Every function but ranks_rank, ranks_count and ranks_parallel is collective. MPI failures outside the scheduler and
 * the result writer end the job. */
#ifndef RICOCHET_APP_RANKS_H
#define RICOCHET_APP_RANKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../base/message.h"

/** Starts MPI. Without this call the process is the only rank. */
void ranks_start(int *argc, char ***argv);
/** Ends MPI if it was started. */
void ranks_finish(void);
/** Whether MPI was started. */
bool ranks_parallel(void);
int ranks_rank(void);
int ranks_count(void);
void ranks_barrier(void);

/** Agrees on a failure: returns the code of the lowest rank that failed, on every rank, with its message; 0 when none
 *  did. */
int ranks_agree(int code, message *why);

/** Broadcasts the value of rank 0. */
void ranks_share(void *bytes, size_t size);

/** Broadcasts the text of rank 0; malloc'd on the other ranks, which free it. */
int ranks_share_text(char **text, size_t *length, message *why);

double ranks_max(double value);
/** Sums over the ranks, in place; the result is on every rank. */
void ranks_sum(uint64_t *values, size_t count);

#endif

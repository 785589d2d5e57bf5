/* Distributes the tasks of a sweep to the ranks by a shared counter.
 *
 * Without MPI the counter is a number of the one process. With it the counter lives on rank 0 in a one-sided window; a
 * rank takes its next chunk by fetch-and-add, so uneven costs balance and no rank is needed as a master. Over TCP the
 * counter changes only while its owner is inside MPI: long computations call scheduler_poll at least every millisecond.
 *
 * The only operations on the counter are additions and reads by MPI_NO_OP (MPI guarantees that concurrent operations
 * are atomic only if they are of one kind). A stop is therefore an addition too: of a mark larger than the number of
 * items that can ever be requested. */
#ifndef RICOCHET_APP_SCHEDULER_H
#define RICOCHET_APP_SCHEDULER_H

#include <stdbool.h>
#include <stdint.h>

#include "../base/message.h"

typedef struct scheduler scheduler;

/** Collective over all ranks of the run (ranks.h).
 *  @param items  number of work items, numbered from 0; at most 2^63 / (ranks + 1) / (ranks + 2)
 *  @returns 0, or EXIT_RUN when MPI fails or the items are too many; *out is NULL then. */
int scheduler_create(uint64_t items, scheduler **out, message *why);
/** Collective. Takes &s, sets it NULL, accepts NULL. */
void scheduler_destroy(scheduler **s);

/** Takes the next chunk: at most `want` consecutive items (0 counts as 1).
 *  @returns their number, 0 when nothing is left, the run was stopped or MPI failed (see scheduler_failure). */
uint64_t scheduler_take(scheduler *s, uint64_t want, uint64_t *first);

/** Size of the next chunk, from the size of the last one and the seconds it took (0, 0 for the first chunk): aims at
 *  20 ms, grows by at most four times a step, and lets chunks shrink to 10 ms towards the end of the list so that the
 *  ranks finish together. At least 1. */
uint64_t scheduler_next_size(const scheduler *s, uint64_t last_size, double last_seconds);

/** Lets MPI progress, at most every half millisecond (otherwise only a clock reading). Also notices, within 100 ms,
 * that another rank stopped the run. @returns true when the run is stopped. */
bool scheduler_poll(scheduler *s);

/** Stops the run on every rank: scheduler_take returns 0 from then on. Further calls have no effect. */
void scheduler_stop(scheduler *s);

/** Reads the counter now: after a barrier all ranks get the same answer. Inner loops use scheduler_poll. */
bool scheduler_stopped(scheduler *s);

/** Items taken so far by all ranks, when this rank last read the counter (at most 100 ms ago if it polls). */
uint64_t scheduler_taken(const scheduler *s);

/** Failure of MPI in any of the calls above that have no message of their own; the run counts as stopped then.
 *  @returns 0 or EXIT_RUN. */
int scheduler_failure(const scheduler *s, message *why);

#endif

/* Hands out the tasks of a sweep to MPI ranks from a shared counter.
 *
 * The counter lives on rank 0 in a one-sided window; a rank takes its next chunk by fetch-and-add, so uneven costs
 * balance themselves and no rank is lost to a master. Over TCP the counter moves only while its owner is inside MPI:
 * whoever computes for long calls scheduler_poll at least each millisecond. */
#ifndef RICOCHET_APP_SCHEDULER_H
#define RICOCHET_APP_SCHEDULER_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>

#include "../study/message.h"

typedef struct scheduler scheduler;

/** Collective. @param items number of work items, numbered from 0. */
int scheduler_create(MPI_Comm comm, uint64_t items, scheduler **out, message *why);
/** Collective. */
void scheduler_destroy(scheduler **s);

/** Takes the next chunk: at most `want` >= 1 consecutive items.
 *  @returns their number, 0 when nothing is left or the run was stopped. */
uint64_t scheduler_take(scheduler *s, uint64_t want, uint64_t *first);

/** Size of the next chunk, from the seconds that the last one took: aims at chunks of 10 to 50 ms, and lets them shrink
 *  towards the end of the list so that the ranks finish together. */
uint64_t scheduler_next_size(const scheduler *s, uint64_t last_size, double last_seconds);

/** Lets MPI progress, at most every half millisecond (otherwise only a clock reading). Also notices, within 100 ms, that
 *  another rank stopped the run. @returns true when the run is stopped. */
bool scheduler_poll(scheduler *s);

/** Stops the run on every rank: later takes return 0. */
void scheduler_stop(scheduler *s);
bool scheduler_stopped(scheduler *s);

/** Items taken so far by all ranks, as of this rank's last look at the counter. */
uint64_t scheduler_taken(const scheduler *s);

#endif

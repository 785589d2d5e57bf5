/* Which record holds which task: disjoint ranges in the order of the tasks, and the gaps between them. */
#ifndef RICOCHET_APP_CHECKPOINT_INDEX_H
#define RICOCHET_APP_CHECKPOINT_INDEX_H

#include <stddef.h>
#include <stdint.h>

#include "../base/message.h"

/** Tasks [first, first + count), to be found in the record at `offset` of file number `part`. */
typedef struct index_range {
  uint64_t first, count, offset;
  uint64_t part;
} index_range;

/** A run of missing tasks; `before` of them lie in earlier gaps. */
typedef struct index_gap {
  uint64_t first, count, before;
} index_gap;

typedef struct checkpoint_index {
  index_range *ranges; /* [range_count], ascending and disjoint once settled */
  size_t range_count, range_room;
  index_gap *gaps; /* [gap_count], ascending */
  size_t gap_count;
  uint64_t done;
} checkpoint_index;

/** Frees what the index owns and leaves it empty. */
void index_clear(checkpoint_index *index);

/** Notes a range, in any order; it counts from the next index_settle on.
 *  @returns 0, or EXIT_RUN out of memory. */
int index_add(checkpoint_index *index, index_range range, message *why);

/** Sorts, cuts overlaps (the range that begins first keeps its tasks; of two that begin together the one of the lower
 *  part, then offset) and finds the gaps among tasks 0..tasks-1.
 *  @returns 0, or EXIT_RUN out of memory. */
int index_settle(checkpoint_index *index, uint64_t tasks, message *why);

/** The settled range that holds `task`, NULL when it is missing. */
const index_range *index_find(const checkpoint_index *index, uint64_t task);

/** The gap that holds the n-th missing task, NULL when n is past the last one. */
const index_gap *index_find_gap(const checkpoint_index *index, uint64_t n);

#endif

#include "checkpoint_files.h"

#include <stdlib.h>

void index_clear(checkpoint_index *index) {
  free(index->ranges);
  free(index->gaps);
  *index = (checkpoint_index){0};
}

int index_add(checkpoint_index *index, index_range range, message *why) {
  if (index->range_count == index->range_room) {
    const size_t room = index->range_room ? 2 * index->range_room : 64;
    index_range *ranges = room > SIZE_MAX / sizeof *ranges ? NULL : realloc(index->ranges, room * sizeof *ranges);
    if (!ranges)
      return refuse(why, EXIT_RUN, "out of memory for %zu records of the checkpoint", room);
    index->ranges = ranges;
    index->range_room = room;
  }
  index->ranges[index->range_count++] = range;
  return 0;
}

static int compare(uint64_t a, uint64_t b) {
  return (a > b) - (a < b);
}

static int compare_ranges(const void *a, const void *b) {
  const index_range *x = a, *y = b;
  if (x->first != y->first)
    return compare(x->first, y->first);
  return x->part != y->part ? compare(x->part, y->part) : compare(x->offset, y->offset);
}

/* The remaining ranges are disjoint and cover the same tasks, so later calls with further ranges are correct. */
static void cut_overlaps(checkpoint_index *index) {
  size_t kept = 0;
  uint64_t reach = 0;
  for (size_t i = 0; i < index->range_count; i++) {
    index_range range = index->ranges[i];
    const uint64_t end = range.first + range.count;
    if (end <= reach)
      continue;
    if (range.first < reach)
      range.first = reach;
    range.count = end - range.first;
    index->ranges[kept++] = range;
    reach = end;
  }
  index->range_count = kept;
}

static void add_gap(checkpoint_index *index, uint64_t first, uint64_t end) {
  if (first == end)
    return;
  uint64_t before = 0;
  if (index->gap_count) {
    const index_gap last = index->gaps[index->gap_count - 1];
    before = last.before + last.count;
  }
  index->gaps[index->gap_count++] = (index_gap){.first = first, .count = end - first, .before = before};
}

static void find_gaps(checkpoint_index *index, uint64_t tasks) {
  index->gap_count = 0;
  index->done = 0;
  uint64_t reach = 0;
  for (size_t i = 0; i < index->range_count; i++) {
    const index_range range = index->ranges[i];
    add_gap(index, reach, range.first);
    reach = range.first + range.count;
    index->done += range.count;
  }
  add_gap(index, reach, tasks);
}

int index_settle(checkpoint_index *index, uint64_t tasks, message *why) {
  if (index->range_count)
    qsort(index->ranges, index->range_count, sizeof *index->ranges, compare_ranges);
  cut_overlaps(index);
  index_gap *gaps = realloc(index->gaps, (index->range_count + 1) * sizeof *gaps);
  if (!gaps)
    return refuse(why, EXIT_RUN, "out of memory for %zu gaps of the checkpoint", index->range_count + 1);
  index->gaps = gaps;
  find_gaps(index, tasks);
  return 0;
}

const index_range *index_find(const checkpoint_index *index, uint64_t task) {
  size_t low = 0, high = index->range_count; /* invariant: ranges before `low` begin at or before the task */
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (index->ranges[middle].first <= task)
      low = middle + 1;
    else
      high = middle;
  }
  if (!low)
    return NULL;
  const index_range *range = &index->ranges[low - 1];
  return task - range->first < range->count ? range : NULL;
}

const index_gap *index_find_gap(const checkpoint_index *index, uint64_t n) {
  size_t low = 0, high = index->gap_count; /* as in index_find */
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (index->gaps[middle].before <= n)
      low = middle + 1;
    else
      high = middle;
  }
  if (!low)
    return NULL;
  const index_gap *gap = &index->gaps[low - 1];
  return n - gap->before < gap->count ? gap : NULL;
}

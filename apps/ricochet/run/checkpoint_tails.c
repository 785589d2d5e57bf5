#include "checkpoint_files.h"

#include <stdlib.h>

/* Allocates the counts of a record. */
static int grow_counts(checkpoint *c, uint64_t numbers, message *why) {
  if (numbers <= c->counts_room)
    return 0;
  uint64_t *counts = realloc(c->counts, numbers * sizeof *counts);
  if (!counts)
    return refuse(why, EXIT_RUN, "%s: out of memory for %llu counts", c->folder, (unsigned long long)numbers);
  c->counts = counts;
  c->counts_room = numbers;
  return 0;
}

/* Opens the record of a range and reads its counts, verified by their own digest; the rows are not read. */
static int select_counts(checkpoint *c, const index_range *range, message *why) {
  int code = open_part(c, range->part, why);
  if (code || (c->counts_offset == range->offset && c->counts_part == range->part))
    return code;
  c->counts_offset = 0;
  finding found = read_record_header(c, range->offset, &c->counted, why);
  const uint64_t numbers = c->counted.count * c->tails, at = range->offset + sizeof c->counted;
  uint64_t digest = 0;
  if (found == GOOD)
    code = grow_counts(c, numbers, why);
  if (!code && found == GOOD)
    found = read_part(c, c->counts, numbers * sizeof *c->counts, at, why);
  if (!code && found == GOOD)
    found = read_part(c, &digest, sizeof digest, at + numbers * sizeof *c->counts, why);
  if (code || finding_failure(found))
    return code ? code : finding_failure(found);
  if (found == BAD || digest != digest_bytes(0, c->counts, numbers * sizeof *c->counts))
    return refuse_record(c, range, why);
  c->counts_part = range->part;
  c->counts_offset = range->offset;
  return 0;
}

/* Entries of a ragged table in tasks [first, end) of the record whose counts are in memory. */
static uint64_t sum_counts(const checkpoint *c, size_t tail, uint64_t first, uint64_t end) {
  uint64_t sum = 0;
  for (uint64_t task = first; task < end; task++)
    sum += c->counts[(task - c->counted.first) * c->tails + tail];
  return sum;
}

int checkpoint_count_entries(checkpoint *c, message *why) {
  const size_t ranges = c->index.range_count;
  free(c->before);
  c->before = NULL;
  if (!c->tails)
    return 0;
  c->before = calloc((ranges + 1) * c->tails, sizeof *c->before);
  if (!c->before)
    return refuse(why, EXIT_RUN, "%s: out of memory for %zu records", c->folder, ranges);
  for (size_t i = 0; i < ranges; i++) {
    const index_range *range = &c->index.ranges[i];
    const int code = select_counts(c, range, why);
    if (code)
      return code;
    for (size_t k = 0; k < c->tails; k++)
      c->before[(i + 1) * c->tails + k] =
          c->before[i * c->tails + k] + sum_counts(c, k, range->first, range->first + range->count);
  }
  return 0;
}

uint64_t checkpoint_entries(const checkpoint *c, size_t tail) {
  return c->before ? c->before[c->index.range_count * c->tails + tail] : 0;
}

int checkpoint_read_offsets(checkpoint *c, size_t tail, uint64_t first, uint64_t count, uint64_t *offsets,
                            size_t stride, message *why) {
  while (count > 0 && first < c->identity.tasks) {
    const index_range *range = index_find(&c->index, first);
    if (!range || !c->before)
      return refuse(why, EXIT_FILES, "%s: task %llu is in no record that was counted", c->folder,
                    (unsigned long long)first);
    const int code = select_counts(c, range, why);
    if (code)
      return code;
    uint64_t offset = c->before[(size_t)(range - c->index.ranges) * c->tails + tail];
    offset += sum_counts(c, tail, range->first, first);
    for (; count > 0 && first - range->first < range->count; first++, count--, offsets += stride) {
      *offsets = offset;
      offset += sum_counts(c, tail, first, first + 1);
    }
  }
  if (count > 0)
    *offsets = checkpoint_entries(c, tail);
  return 0;
}

/* The range that holds an entry, which exists: the last one with no more entries before it. */
static size_t find_entry(const checkpoint *c, size_t tail, uint64_t entry) {
  size_t low = 0, high = c->index.range_count;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    if (c->before[middle * c->tails + tail] <= entry)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Position of the entries of a ragged table after the header of the record whose counts are in memory. */
static uint64_t tail_begin(const checkpoint *c, size_t tail) {
  const uint64_t first = c->counted.first, tasks = c->counted.count;
  uint64_t at = counts_bytes(c, tasks) + tasks * c->identity.row_bytes;
  for (size_t k = 0; k < tail; k++)
    at += sum_counts(c, k, first, first + tasks) * c->identity.entry_bytes[k];
  return at;
}

int checkpoint_read_entries(checkpoint *c, size_t tail, uint64_t first, uint64_t count, void *entries, message *why) {
  unsigned char *to = entries;
  if (first > checkpoint_entries(c, tail) || count > checkpoint_entries(c, tail) - first)
    return refuse(why, EXIT_FILES, "%s: entry %llu of ragged table %zu is in no record that was counted", c->folder,
                  (unsigned long long)(first + count - 1), tail);
  while (count > 0) {
    const size_t number = find_entry(c, tail, first);
    const index_range *range = &c->index.ranges[number];
    int code = select_counts(c, range, why);
    if (!code)
      code = select_record(c, range, why);
    if (code)
      return code;
    const uint64_t before = c->before[number * c->tails + tail];
    const uint64_t there = c->before[(number + 1) * c->tails + tail] - first, step = count < there ? count : there;
    const uint64_t skipped = sum_counts(c, tail, c->counted.first, range->first) + first - before;
    const uint64_t size = c->identity.entry_bytes[tail];
    code = read_verified(c, to, step * size, range->offset + sizeof c->counted + tail_begin(c, tail) + skipped * size,
                         why);
    if (code)
      return code;
    to += step * size;
    first += step;
    count -= step;
  }
  return 0;
}

#include "chunks.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../run/ranks.h"

enum { CHECKSUM_BYTES = 4 };

chunk_grid chunk_grid_of(const result_table *t, const column *c) {
  chunk_grid g = {.value_bytes = column_value_bytes(c)};
  g.axes = plan_shape(c, t->rows, g.shape);
  plan_chunk(t->layout, c, t->rows, g.chunk);
  g.bytes = g.value_bytes;
  for (int i = 0; i < g.axes; i++) {
    g.counts[i] = (g.shape[i] + g.chunk[i] - 1) / g.chunk[i];
    g.bytes *= g.chunk[i];
  }
  return g;
}

/* --- where they are --- */

static int add_run(chunk_places *places, const file_place *at, chunk_run run) {
  if (places->count == places->room) {
    const size_t room = places->room ? 2 * places->room : 64;
    chunk_run *runs = realloc(places->runs, room * sizeof *runs);
    if (!runs)
      return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
    places->runs = runs;
    places->room = room;
  }
  places->runs[places->count++] = run;
  return 0;
}

/* A data set whose chunks are looked up. */
typedef struct chunk_finder {
  chunk_places *places;
  const file_place *at;
  hid_t data_set;
  uint64_t set;
  const chunk_grid *g;
} chunk_finder;

static int look_up(const chunk_finder *f, uint64_t number, uint64_t *address) {
  int code = 0;
  hsize_t offset[PLAN_MOST_AXES], stored;
  unsigned skipped_filters;
  haddr_t found;
  uint64_t rest = number;
  for (int i = f->g->axes - 1; i >= 0; i--) {
    offset[i] = rest % f->g->counts[i] * f->g->chunk[i];
    rest /= f->g->counts[i];
  }
  HDF5_TRY(f->at, H5Dget_chunk_info_by_coord(f->data_set, offset, &skipped_filters, &found, &stored), "find a chunk");
  if (found == HADDR_UNDEF || skipped_filters || stored != f->g->bytes + CHECKSUM_BYTES)
    code = refuse(f->at->why, EXIT_FILES, "%s: chunk %llu of data set %llu was not laid out", f->at->path,
                  (unsigned long long)number, (unsigned long long)f->set);
  *address = found;
out:
  return code;
}

/* Adds the runs that begin behind chunk `low`, up to chunk `high`. A look-up takes HDF5 a time that grows with the
 * number of chunks, and nearly all of them lie one behind another: runs are found by bisection. Chunks do not overlap
 * and are allocated in order, so a stretch that is exactly as long as its chunks has no gap. */
static int find_between(const chunk_finder *f, uint64_t low, uint64_t low_address, uint64_t high,
                        uint64_t high_address) {
  if (high_address - low_address == (high - low) * (f->g->bytes + CHECKSUM_BYTES))
    return 0;
  if (high == low + 1)
    return add_run(f->places, f->at, (chunk_run){f->set, high, high_address});
  const uint64_t middle = low + (high - low) / 2;
  uint64_t address;
  int code = look_up(f, middle, &address);
  if (!code)
    code = find_between(f, low, low_address, middle, address);
  return code ? code : find_between(f, middle, address, high, high_address);
}

int chunks_find(chunk_places *places, const file_place *at, hid_t data_set, uint64_t set, const chunk_grid *g) {
  const chunk_finder f = {places, at, data_set, set, g};
  uint64_t count = 1, first, last;
  for (int i = 0; i < g->axes; i++)
    count *= g->counts[i];
  int code = look_up(&f, 0, &first);
  if (!code)
    code = add_run(places, at, (chunk_run){set, 0, first});
  if (!code)
    code = look_up(&f, count - 1, &last);
  return code ? code : find_between(&f, 0, first, count - 1, last);
}

int chunks_share(chunk_places *places, const file_place *at) {
  int code = 0;
  ranks_share(&places->count, sizeof places->count);
  if (ranks_rank() != 0 && !(places->runs = calloc(places->count + 1, sizeof *places->runs)))
    code = refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  code = ranks_agree(code, at->why);
  if (!code)
    ranks_share(places->runs, places->count * sizeof *places->runs);
  return code;
}

void chunks_clear(chunk_places *places) {
  free(places->runs);
  *places = (chunk_places){0};
}

/* The last run of a set that begins at a chunk or before it. */
static const chunk_run *run_of(const chunk_places *places, uint64_t set, uint64_t number) {
  size_t low = 0, high = places->count;
  while (high - low > 1) {
    const size_t middle = low + (high - low) / 2;
    const chunk_run *r = &places->runs[middle];
    if (r->set < set || (r->set == set && r->first <= number))
      low = middle;
    else
      high = middle;
  }
  return &places->runs[low];
}

/* --- their bytes --- */

/* Fletcher-32 of bytes as big-endian words of 16 bits, with HDF5's reduction; an odd last byte is padded with zero. */
static uint32_t checksum_of(const unsigned char *bytes, size_t count) {
  enum { WORDS = 360 }; /* so many words cannot overflow the sums */
  uint32_t low = 0, high = 0;
  for (size_t i = 0; i < count;) {
    for (size_t words = 0; words < WORDS && i < count; words++, i += 2) {
      low += (uint32_t)bytes[i] << 8 | (i + 1 < count ? bytes[i + 1] : 0u);
      high += low;
    }
    low = (low & 0xffff) + (low >> 16);
    high = (high & 0xffff) + (high >> 16);
  }
  low = (low & 0xffff) + (low >> 16);
  high = (high & 0xffff) + (high >> 16);
  return high << 16 | low;
}

static void put_checksum(unsigned char *chunk, uint64_t bytes) {
  const uint32_t sum = checksum_of(chunk, bytes);
  for (int i = 0; i < CHECKSUM_BYTES; i++)
    chunk[bytes + (uint64_t)i] = (unsigned char)(sum >> 8 * i);
}

static uint64_t at_most(uint64_t value, uint64_t limit) {
  return value < limit ? value : limit;
}

/* Copies the part of some rows that lies in a chunk; beyond the edges of the data set it keeps its zeros.
 * @param corner  of the chunk, in values along each axis but the first */
static void fill_chunk(const chunk_grid *g, const uint64_t *corner, uint64_t rows, const unsigned char *values,
                       unsigned char *chunk) {
  uint64_t part[PLAN_MOST_AXES] = {rows, 1, 1}, shape[PLAN_MOST_AXES] = {0, 1, 1}, size[PLAN_MOST_AXES] = {0, 1, 1};
  for (int i = 1; i < g->axes; i++) {
    shape[i] = g->shape[i];
    size[i] = g->chunk[i];
    part[i] = at_most(g->chunk[i], g->shape[i] - corner[i]);
  }
  for (uint64_t i = 0; i < rows; i++)
    for (uint64_t j = 0; j < part[1]; j++) {
      const uint64_t from = (i * shape[1] + corner[1] + j) * shape[2] + corner[2], to = (i * size[1] + j) * size[2];
      memcpy(chunk + to * g->value_bytes, values + from * g->value_bytes, part[2] * g->value_bytes);
    }
}

int chunks_write_at(int handle, const unsigned char *bytes, uint64_t count, uint64_t address) {
  while (count > 0) {
    const ssize_t written = pwrite(handle, bytes, count, (off_t)address);
    if (written < 0 && errno != EINTR)
      return errno;
    if (written > 0) {
      bytes += written;
      address += (uint64_t)written;
      count -= (uint64_t)written;
    }
  }
  return 0;
}

int chunks_write(const chunk_file *file, uint64_t set, const chunk_grid *g, uint64_t first, uint64_t count,
                 const unsigned char *values) {
  const uint64_t across[] = {g->axes > 1 ? g->counts[1] : 1, g->axes > 2 ? g->counts[2] : 1};
  uint64_t row_bytes = g->value_bytes;
  for (int i = 1; i < g->axes; i++)
    row_bytes *= g->shape[i];
  int failed = 0;
  for (uint64_t row = 0; row < count; row += g->chunk[0])
    for (uint64_t k = 0; !failed && k < across[0] * across[1]; k++) {
      const uint64_t corner[PLAN_MOST_AXES] = {0, k / across[1] * g->chunk[1], k % across[1] * g->chunk[2]};
      const uint64_t number = (first + row) / g->chunk[0] * across[0] * across[1] + k;
      const chunk_run *run = run_of(file->places, set, number);
      memset(file->buffer, 0, g->bytes);
      fill_chunk(g, corner, at_most(g->chunk[0], count - row), values + row * row_bytes, file->buffer);
      put_checksum(file->buffer, g->bytes);
      failed = chunks_write_at(file->handle, file->buffer, g->bytes + CHECKSUM_BYTES,
                               run->address + (number - run->first) * (g->bytes + CHECKSUM_BYTES));
      if (!failed && ric_poll_stops(file->stop))
        failed = ECANCELED;
    }
  return failed;
}

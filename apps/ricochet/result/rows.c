#include "rows.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../base/digest.h"
#include "../run/ranks.h"
#include "data_set.h"

enum { PIECE_BYTES = 16 << 20 /* of a large row, between two polls */ };

/* One block of rows of a table, and one column of it. */
typedef struct block {
  const file_place *at;
  ric_poll stop;
  const result_table *from;
  uint64_t height;       /* rows */
  unsigned char *rows;   /* [height][row_bytes] */
  unsigned char *values; /* [height][values] of one column */
  unsigned char *chunk;  /* the largest of a column, with its checksum */
} block;

static int block_allocate(block *b, const plan *p, const file_place *at, const result_table *from) {
  const table *layout = from->layout;
  size_t widest = 1, chunk = 1;
  *b = (block){.at = at, .stop = p->stop, .from = from, .height = plan_block_rows(layout)};
  for (size_t k = 0; k < layout->column_count; k++) {
    const chunk_grid g = chunk_grid_of(from, &layout->columns[k]);
    if (column_bytes(&layout->columns[k]) > widest)
      widest = column_bytes(&layout->columns[k]);
    if (g.bytes > chunk)
      chunk = g.bytes;
  }
  const uint64_t height = b->height < from->rows ? b->height : from->rows;
  b->rows = malloc(height * layout->row_bytes + 1);
  b->values = malloc(height * widest + 1);
  b->chunk = malloc(chunk + sizeof(uint32_t));
  if (b->rows && b->values && b->chunk)
    return 0;
  return refuse(at->why, EXIT_RUN, "%s: out of memory for %llu rows of %zu bytes", at->path, (unsigned long long)height,
                layout->row_bytes);
}

static void block_clear(block *b) {
  free(b->rows);
  free(b->values);
  free(b->chunk);
}

static uint64_t rows_from(const block *b, uint64_t first) {
  return b->from->rows - first < b->height ? b->from->rows - first : b->height;
}

static bool is_stored(const result_table *t, const column *c) {
  return t->rows > 0 && column_values(c) > 0;
}

/* --- writing --- */

/* The file that rows are written to. */
typedef struct row_file {
  const chunk_places *places;
  records *written;
  int handle;
} row_file;

/* Gathers a column from the rows of a block, of which one alone may be gigabytes. @returns 0 or EXIT_STOPPED */
static int unpack(const block *b, const column *c, uint64_t count) {
  const size_t bytes = column_bytes(c), row_bytes = b->from->layout->row_bytes;
  int code = 0;
  for (uint64_t i = 0; i < count; i++)
    for (size_t done = 0; !code && done < bytes; done += PIECE_BYTES) {
      const size_t left = bytes - done, step = left < PIECE_BYTES ? left : PIECE_BYTES;
      memcpy(b->values + i * bytes + done, b->rows + i * row_bytes + c->offset + done, step);
      code = left > step ? result_ask(b->stop, b->at) : 0;
    }
  return code;
}

static int remember(const block *b, records *written, const column *c, uint64_t count) {
  const uint64_t digest = digest_words(b->values, count * column_bytes(c));
  unsigned char *added = records_add(written);
  if (!added)
    return refuse(b->at->why, EXIT_RUN, "%s: out of memory", b->at->path);
  memcpy(added, &digest, sizeof digest);
  return 0;
}

static int write_column(const block *b, const row_file *f, const column *c, uint64_t set, uint64_t first,
                        uint64_t count) {
  const chunk_grid g = chunk_grid_of(b->from, c);
  const chunk_file file = {.places = f->places, .handle = f->handle, .stop = b->stop, .buffer = b->chunk};
  const int code = unpack(b, c, count);
  if (code)
    return code;
  const int failed = chunks_write(&file, set, &g, first, count, b->values);
  if (failed == ECANCELED)
    return result_stopped(b->at);
  if (failed)
    return refuse(b->at->why, EXIT_FILES, "%s: cannot write /%s/%s: %s", b->at->path, b->from->layout->group, c->name,
                  strerror(failed));
  return remember(b, f->written, c, count);
}

static int write_block(const block *b, const row_file *f, uint64_t first_set, uint64_t first) {
  const result_table *from = b->from;
  const uint64_t count = rows_from(b, first);
  int code = result_ask(b->stop, b->at);
  if (!code)
    code = from->read(from->user, first, count, b->rows, b->at->why);
  for (size_t k = 0; !code && k < from->layout->column_count; k++)
    if (is_stored(from, &from->layout->columns[k]))
      code = write_column(b, f, &from->layout->columns[k], first_set + k, first, count);
  return code;
}

int rows_write(const plan *p, const chunk_places *places, const file_place *at, records *written) {
  const uint64_t rank = (uint64_t)ranks_rank(), ranks = (uint64_t)ranks_count();
  uint64_t set = 0;
  const row_file f = {places, written, open(p->partial, O_WRONLY | O_NOFOLLOW | O_CLOEXEC)};
  if (f.handle < 0)
    return refuse_errno(at->path, "open it", at->why);
  int code = 0;
  written->record_bytes = sizeof(uint64_t);
  for (size_t i = 0; !code && i < p->stored_count; i++) {
    block b;
    code = block_allocate(&b, p, at, &p->tables[i]);
    for (uint64_t k = rank; !code && k * b.height < b.from->rows; k += ranks)
      code = write_block(&b, &f, set, k * b.height);
    set += p->tables[i].layout->column_count;
    block_clear(&b);
  }
  if (!code && fsync(f.handle) != 0) /* other nodes can read the rows after this */
    code = refuse_errno(at->path, "sync it", at->why);
  if (close(f.handle) != 0 && !code)
    code = refuse_errno(at->path, "close it", at->why);
  return code;
}

/* --- reading back --- */

static int read_slab(const block *b, hid_t set, const column *c, const hsize_t *start, const hsize_t *size,
                     unsigned char *values) {
  int code = 0;
  const char *group = b->from->layout->group;
  const int axes = 1 + column_axes(c);
  hid_t in_file = H5I_INVALID_HID, in_memory = H5I_INVALID_HID, type = H5I_INVALID_HID;
  HDF5_TRY(b->at, type = data_set_type(c), "read /%s/%s", group, c->name);
  HDF5_TRY(b->at, in_file = H5Dget_space(set), "read /%s/%s", group, c->name);
  HDF5_TRY(b->at, H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, NULL, size, NULL), "read /%s/%s", group, c->name);
  HDF5_TRY(b->at, in_memory = H5Screate_simple(axes, size, NULL), "read /%s/%s", group, c->name);
  HDF5_TRY(b->at, H5Dread(set, type, in_memory, in_file, H5P_DEFAULT, values), "read /%s/%s", group, c->name);
out:
  code = hdf5_close(b->at, in_memory, code);
  code = hdf5_close(b->at, in_file, code);
  return hdf5_close(b->at, type, code);
}

/* Rows of a column; a single one that is large in pieces along its first axis. */
static int read_column(const block *b, hid_t set, const column *c, uint64_t first, uint64_t count) {
  hsize_t start[PLAN_MOST_AXES] = {first}, size[PLAN_MOST_AXES];
  data_set_shape(c, count, size);
  if (count > 1 || column_bytes(c) <= PIECE_BYTES)
    return read_slab(b, set, c, start, size, b->values);
  const hsize_t all = size[1];
  const size_t each = column_bytes(c) / all;
  const hsize_t step = each < PIECE_BYTES ? PIECE_BYTES / each : 1;
  int code = 0;
  for (; !code && start[1] < all; start[1] += step) {
    code = result_ask(b->stop, b->at);
    size[1] = all - start[1] < step ? all - start[1] : step;
    if (!code)
      code = read_slab(b, set, c, start, size, b->values + start[1] * each);
  }
  return code;
}

/* Digests come in the order in which they were made. */
static int check_column(const block *b, hid_t set, const column *c, uint64_t first, uint64_t digest) {
  const uint64_t count = rows_from(b, first);
  int code = read_column(b, set, c, first, count);
  if (!code && digest_words(b->values, count * column_bytes(c)) != digest)
    code = refuse(b->at->why, EXIT_FILES, "%s: /%s/%s does not hold what was written, from row %llu on", b->at->path,
                  b->from->layout->group, c->name, (unsigned long long)first);
  return code;
}

static int check_table(const block *b, hid_t file, const records *written, uint64_t *next) {
  const uint64_t rank = (uint64_t)ranks_rank(), ranks = (uint64_t)ranks_count();
  int code = 0;
  const table *layout = b->from->layout;
  hid_t sets[TABLE_MAX_COLUMNS];
  for (size_t k = 0; k < layout->column_count; k++)
    sets[k] = H5I_INVALID_HID;
  for (size_t k = 0; k < layout->column_count; k++) {
    char name[512];
    snprintf(name, sizeof name, "/%s/%s", layout->group, layout->columns[k].name);
    HDF5_TRY(b->at, sets[k] = H5Dopen2(file, name, H5P_DEFAULT), "open %s", name);
  }
  for (uint64_t i = rank; !code && i * b->height < b->from->rows; i += ranks) {
    code = result_ask(b->stop, b->at);
    for (size_t k = 0; !code && k < layout->column_count; k++)
      if (is_stored(b->from, &layout->columns[k])) {
        uint64_t digest;
        memcpy(&digest, written->bytes + (*next)++ * sizeof digest, sizeof digest);
        code = check_column(b, sets[k], &layout->columns[k], i * b->height, digest);
      }
  }
out:
  for (size_t k = 0; k < layout->column_count; k++)
    code = hdf5_close(b->at, sets[k], code);
  return code;
}

int rows_check(const plan *p, const file_place *at, const records *written) {
  int code = 0;
  uint64_t next = 0;
  hid_t file = H5I_INVALID_HID;
  HDF5_TRY(at, file = H5Fopen(p->partial, H5F_ACC_RDONLY, H5P_DEFAULT), "open it");
  for (size_t i = 0; !code && i < p->stored_count; i++) {
    block b;
    code = block_allocate(&b, p, at, &p->tables[i]);
    if (!code)
      code = check_table(&b, file, written, &next);
    block_clear(&b);
  }
out:
  return hdf5_close(at, file, code);
}

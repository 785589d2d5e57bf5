#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "result.h"
#include "../run/ranks.h"
#include "hdf5_call.h"
#include "plan.h"
#include "verify.h"
#include "data_set.h"
#include "skeleton.h"

/* --- rows --- */

/* A table that is written: its data sets, and one block of rows. */
typedef struct table_writer {
  const file_place *at;
  const result_table *from;
  uint64_t block;        /* rows */
  unsigned char *rows;   /* [block][row_bytes] */
  unsigned char *values; /* [block][values] of one column */
  hid_t transfer;
  hid_t sets[TABLE_MAX_COLUMNS], types[TABLE_MAX_COLUMNS];
} table_writer;

static int allocate_block(table_writer *t) {
  const table *layout = t->from->layout;
  size_t widest = 1;
  for (size_t k = 0; k < layout->column_count; k++)
    if (column_bytes(&layout->columns[k]) > widest)
      widest = column_bytes(&layout->columns[k]);
  uint64_t height = t->block < t->from->rows ? t->block : t->from->rows;
  t->rows = malloc(height * layout->row_bytes + 1);
  t->values = malloc(height * widest + 1);
  if (t->rows && t->values)
    return 0;
  return refuse(t->at->why, EXIT_RUN, "%s: out of memory for %llu rows of %zu bytes", t->at->path,
                (unsigned long long)height, layout->row_bytes);
}

static int open_sets(table_writer *t, hid_t file) {
  int code = 0;
  const table *layout = t->from->layout;
  HDF5_TRY(t->at, t->transfer = H5Pcreate(H5P_DATASET_XFER), "write /%s", layout->group);
  if (ranks_parallel()) {
    HDF5_TRY(t->at, H5Pset_dxpl_mpio(t->transfer, H5FD_MPIO_COLLECTIVE), "write /%s", layout->group);
    HDF5_TRY(t->at, H5Pset_dxpl_mpio_collective_opt(t->transfer, H5FD_MPIO_INDIVIDUAL_IO), "write /%s", layout->group);
  }
  for (size_t k = 0; k < layout->column_count; k++) {
    const column *c = &layout->columns[k];
    char name[512];
    snprintf(name, sizeof name, "/%s/%s", layout->group, c->name);
    HDF5_TRY(t->at, t->sets[k] = H5Dopen2(file, name, H5P_DEFAULT), "open %s", name);
    HDF5_TRY(t->at, t->types[k] = data_set_type(c), "open %s", name);
  }
out:
  return code;
}

static int close_sets(table_writer *t, int code) {
  for (size_t k = 0; k < t->from->layout->column_count; k++) {
    code = hdf5_close(t->at, t->types[k], code);
    code = hdf5_close(t->at, t->sets[k], code);
  }
  return hdf5_close(t->at, t->transfer, code);
}

/* Gathers a column from the rows of a block. */
static void unpack(const table_writer *t, const column *c, uint64_t count) {
  size_t bytes = column_bytes(c), row_bytes = t->from->layout->row_bytes;
  for (uint64_t i = 0; i < count; i++)
    memcpy(t->values + i * bytes, t->rows + i * row_bytes + c->offset, bytes);
}

static int write_column(const table_writer *t, size_t k, uint64_t first, uint64_t count) {
  int code = 0;
  const column *c = &t->from->layout->columns[k];
  const char *group = t->from->layout->group;
  const hsize_t start[PLAN_MOST_AXES] = {first};
  hsize_t size[PLAN_MOST_AXES];
  const int rank = data_set_shape(c, count, size);
  hid_t in_file = H5I_INVALID_HID, in_memory = H5I_INVALID_HID;
  unpack(t, c, count);
  HDF5_TRY(t->at, in_file = H5Dget_space(t->sets[k]), "write /%s/%s", group, c->name);
  HDF5_TRY(t->at, H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, NULL, size, NULL), "write /%s/%s", group,
           c->name);
  HDF5_TRY(t->at, in_memory = H5Screate_simple(rank, size, NULL), "write /%s/%s", group, c->name);
  HDF5_TRY(t->at, H5Dwrite(t->sets[k], t->types[k], in_memory, in_file, t->transfer, t->values), "write /%s/%s", group,
           c->name);
out:
  code = hdf5_close(t->at, in_memory, code);
  return hdf5_close(t->at, in_file, code);
}

static int write_block(const table_writer *t, uint64_t first) {
  const result_table *from = t->from;
  uint64_t count = from->rows - first < t->block ? from->rows - first : t->block;
  int code = from->read(from->user, first, count, t->rows, t->at->why);
  for (size_t k = 0; !code && k < from->layout->column_count; k++)
    if (column_values(&from->layout->columns[k]) > 0)
      code = write_column(t, k, first, count);
  return code;
}

static int write_table(const file_place *at, hid_t file, const result_table *from, int rank, int ranks) {
  table_writer t = {.at = at, .from = from, .block = plan_block_rows(from->layout), .transfer = H5I_INVALID_HID};
  for (size_t k = 0; k < TABLE_MAX_COLUMNS; k++)
    t.sets[k] = t.types[k] = H5I_INVALID_HID;
  int code = allocate_block(&t);
  if (!code)
    code = open_sets(&t, file);
  for (uint64_t i = (uint64_t)rank; !code && i * t.block < from->rows; i += (uint64_t)ranks)
    code = write_block(&t, i * t.block);
  free(t.rows);
  free(t.values);
  return close_sets(&t, code);
}

/* Every rank opens the file for itself, with the MPI-IO driver over itself alone. With all ranks in one communicator
 * HDF5 1.10 and MPI-IO hang if a write fails on one of them; with the default driver only one process can open a file
 * for writing. No rank reads what another writes: none changes metadata, and blocks never share a chunk. Without MPI
 * there is one process, which uses the default driver. */
static int rows_write(const plan *p, const file_place *at, int rank, int ranks) {
  int code = 0;
  hid_t access = H5I_INVALID_HID, file = H5I_INVALID_HID;
  HDF5_TRY(at, access = skeleton_access(), "open it");
  if (ranks_parallel())
    HDF5_TRY(at, H5Pset_fapl_mpio(access, MPI_COMM_SELF, MPI_INFO_NULL), "open it in parallel");
  HDF5_TRY(at, file = H5Fopen(p->partial, H5F_ACC_RDWR, access), "open it");
  for (size_t i = 0; !code && i < p->table_count; i++)
    code = write_table(at, file, &p->tables[i], rank, ranks);
  if (!code)
    HDF5_TRY(at, H5Fflush(file, H5F_SCOPE_GLOBAL), "write it"); /* syncs: other nodes can read the rows after this */
out:
  code = hdf5_close(at, file, code);
  return hdf5_close(at, access, code);
}

typedef struct writer {
  plan plan;
  file_place at;
} writer;

/* Collective: each rank checks that it can open the file that rank 0 made. */
static int check_shared_file(const writer *w) {
  struct stat mine;
  long long size = -1;
  int handle = open(w->plan.partial, O_RDWR);
  int failed = handle < 0 || fstat(handle, &mine) != 0 ? errno : 0;
  if (handle >= 0)
    close(handle); /* nothing was written through it */
  if (!failed)
    size = (long long)mine.st_size;
  long long first = size;
  ranks_share(&first, sizeof first);
  if (failed)
    return refuse(w->at.why, EXIT_FILES, "%s: rank %d cannot open it: %s", w->at.path, ranks_rank(), strerror(failed));
  if (size != first)
    return refuse(w->at.why, EXIT_FILES,
                  "%s: %lld bytes on rank %d, %lld on rank 0: is the folder shared by all nodes?", w->at.path, size,
                  ranks_rank(), first);
  return 0;
}

static int sync_at(const writer *w, const char *path) {
  int handle = open(path, O_RDONLY);
  if (handle < 0)
    return refuse(w->at.why, EXIT_FILES, "%s: cannot open %s: %s", w->at.path, path, strerror(errno));
  bool synced = fsync(handle) == 0 || errno == EINVAL; /* EINVAL: a file system without it, for folders */
  int failed = synced ? 0 : errno;
  if (close(handle) != 0 && synced)
    failed = errno;
  return failed ? refuse(w->at.why, EXIT_FILES, "%s: cannot sync %s: %s", w->at.path, path, strerror(failed)) : 0;
}

static int sync_folder(const writer *w) {
  const char *slash = strrchr(w->at.path, '/');
  if (!slash)
    return sync_at(w, ".");
  size_t length = slash == w->at.path ? 1 : (size_t)(slash - w->at.path);
  char *folder = strndup(w->at.path, length);
  if (!folder)
    return refuse(w->at.why, EXIT_RUN, "%s: out of memory", w->at.path);
  int code = sync_at(w, folder);
  free(folder);
  return code;
}

/* Rank 0: syncs the verified file, renames it, and syncs the folder. */
static int publish(const writer *w, int (*commit)(void *user, message *why), void *user) {
  int code = sync_at(w, w->plan.partial);
  if (!code && commit)
    code = commit(user, w->at.why);
  if (!code && rename(w->plan.partial, w->at.path) != 0)
    code = refuse(w->at.why, EXIT_FILES, "%s: cannot rename %s: %s", w->at.path, w->plan.partial, strerror(errno));
  return code ? code : sync_folder(w);
}

int result_write(const char *path, const result_header *header, const result_table *tables, size_t table_count,
                 int (*commit)(void *user, message *why), void *user, message *why) {
  writer w = {.at = {path, why}};
  int rank = ranks_rank(), ranks = ranks_count();
  hdf5_quiet();
  int code = ranks_agree(plan_init(&w.plan, path, header, tables, table_count, why), why);
  if (!code)
    code = ranks_agree(rank == 0 ? space_create(&w.plan, &w.at) : 0, why);
  if (!code)
    code = ranks_agree(check_shared_file(&w), why);
  if (!code)
    code = ranks_agree(rows_write(&w.plan, &w.at, rank, ranks), why);
  if (!code)
    code = ranks_agree(verify_part(&w.at, w.plan.partial, &w.plan, rank, ranks), why);
  if (!code)
    code = ranks_agree(rank == 0 ? publish(&w, commit, user) : 0, why);
  if (code && rank == 0 && w.plan.partial)
    unlink(w.plan.partial); /* absent if it was not yet created */
  plan_clear(&w.plan);
  return code;
}

/* Layout of a result file, computed before anything is written: the tables (the caller's and the swept parameters), the
 * axes they share, the chunks of data sets and the blocks of rows.
 *
 * Every rank makes the same plan from the same tables. The plan, and so the file, does not depend on the number of
 * ranks. */
#ifndef RICOCHET_APP_PLAN_H
#define RICOCHET_APP_PLAN_H

#include "result.h"

enum {
  PLAN_CHUNK_BYTES = 1 << 20, /* limit of a chunk: it fits HDF5's chunk cache of 1 MiB */
  PLAN_BLOCK_BYTES = 4 << 20, /* rows that a rank reads and writes at a time; one row may be longer */
  PLAN_MOST_AXES = 1 + COLUMN_MOST_AXES
};

/** An axis: the data set `/name` with the values 0 .. extent - 1, a table of one column that ranks write like others.
 */
typedef struct plan_scale {
  const char *name;
  uint64_t extent;
  table layout;
} plan_scale;

typedef struct plan {
  const result_header *header;
  ric_poll stop;        /* asked while the file is written; set by the writer */
  char *partial;        /* path of the file while it is written */
  result_table *tables; /* [stored_count] the caller's and /sweep, [table_count] in all; then those of the scales */
  size_t table_count, stored_count;
  table sweep;
  plan_scale *scales; /* [scale_count] distinct axes, "task" first */
  size_t scale_count;
} plan;

/** Makes the plan for writing `tables` to `path`. Borrows header, study and tables, which must outlive it.
 *  @param p  zeroed; plan_clear frees it, also after a failure
 *  @returns 0, or EXIT_RUN when two tables disagree on the extent of an axis, an axis and a group share a name, or
 *  memory runs out */
int plan_init(plan *p, const char *path, const result_header *header, const result_table *tables, size_t table_count,
              message *why);
void plan_clear(plan *p);

/** Upper bound of the bytes of all data sets in the file: chunks, checksums and indices. */
uint64_t plan_bytes(const plan *p);

/** Rows of a block: a power of two, as many as PLAN_BLOCK_BYTES hold but at least one. */
uint64_t plan_block_rows(const table *t);

/** Number of axes of a column's data set, and its shape [axes]. */
int plan_shape(const column *c, uint64_t rows, uint64_t shape[PLAN_MOST_AXES]);

/** Chunk of a column's data set, along each of its axes at least 1. Its rows divide those of a block (or hold all
 *  rows), so no two ranks write the same chunk. */
void plan_chunk(const table *t, const column *c, uint64_t rows, uint64_t chunk[PLAN_MOST_AXES]);

#endif

/* The chunks of a result as plain bytes of its file.
 *
 * HDF5 lays out all chunks on rank 0. Their addresses are then known, and every rank writes those of its own rows by
 * calls of the system: no rank opens the file for writing through HDF5 or MPI, none waits for another, and nothing on
 * the machine is named after the file. A chunk is stored as HDF5 stores it: its values in order, zeros beyond the edge
 * of the data set, and the Fletcher-32 checksum of all that. */
#ifndef RICOCHET_APP_CHUNKS_H
#define RICOCHET_APP_CHUNKS_H

#include "hdf5_call.h"
#include "plan.h"

/** Chunks of one data set that lie one behind another in the file. */
typedef struct chunk_run {
  uint64_t set;     /* number of the data set, counted over the columns of all tables of the plan */
  uint64_t first;   /* number of the chunk; the run ends where the next one of the set begins */
  uint64_t address; /* of it, in bytes */
} chunk_run;

/** Where all chunks are: a few runs, in rising order of sets and chunks. */
typedef struct chunk_places {
  chunk_run *runs; /* [count] */
  size_t count, room;
} chunk_places;

/** Shape and chunks of one data set. */
typedef struct chunk_grid {
  int axes;
  uint64_t shape[PLAN_MOST_AXES], chunk[PLAN_MOST_AXES], counts[PLAN_MOST_AXES]; /* counts: of chunks */
  uint64_t value_bytes, bytes;                                                   /* of a chunk, without checksum */
} chunk_grid;

/** The grid of a column's data set. */
chunk_grid chunk_grid_of(const result_table *t, const column *c);

/** Finds the chunks of a data set that has been allocated, and adds their runs.
 *  @param set  its number; sets come in rising order
 *  @returns 0, EXIT_FILES or EXIT_RUN */
int chunks_find(chunk_places *places, const file_place *at, hid_t data_set, uint64_t set, const chunk_grid *g);

/** Gives the places of rank 0 to all ranks. Collective. */
int chunks_share(chunk_places *places, const file_place *at);
void chunks_clear(chunk_places *places);

/** Writes bytes to a place of a file. @returns 0, or an error of the system */
int chunks_write_at(int handle, const unsigned char *bytes, uint64_t count, uint64_t address);

/** A file that chunks are written to. Borrowed. */
typedef struct chunk_file {
  const chunk_places *places;
  int handle;
  ric_poll stop;         /* asked for each chunk */
  unsigned char *buffer; /* [bytes of the largest chunk + 4] */
} chunk_file;

/** Writes the chunks that hold rows [first, first + count) of a data set.
 *  @param first  the first row of a chunk; count: whole chunks, or up to the last row
 *  @param values  [count][values of a row] in order
 *  @returns 0, an error of the system, or ECANCELED to stop */
int chunks_write(const chunk_file *file, uint64_t set, const chunk_grid *g, uint64_t first, uint64_t count,
                 const unsigned char *values);

#endif

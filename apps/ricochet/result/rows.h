/* The rows of the tables of a result: written by every rank into the chunks of its own, and read back through HDF5. */
#ifndef RICOCHET_APP_ROWS_H
#define RICOCHET_APP_ROWS_H

#include "chunks.h"
#include "plan.h"

/** Writes the blocks of rows of this rank: one of each table for every rank in turn.
 *  @param written  zeroed; digests of what was written, for rows_check */
int rows_write(const plan *p, const chunk_places *places, const file_place *at, records *written);

/** Reads the same blocks through HDF5 and their checksums, and compares them with what was written: a chunk in a wrong
 *  place, or bytes that the storage lost, are EXIT_FILES. */
int rows_check(const plan *p, const file_place *at, const records *written);

#endif

/* Result files: HDF5, written collectively under a temporary name, verified, renamed; and read back for `show`.
 *
 * Every data set is chunked with the fletcher32 checksum, library version bounds V110, strings of fixed length, every
 * axis attached to a dimension scale in the root group. Everything that varies between runs sits in /run. */
#ifndef RICOCHET_APP_RESULT_H
#define RICOCHET_APP_RESULT_H

#include <mpi.h>
#include <stddef.h>
#include <stdint.h>

#include "../study/message.h"
#include "../study/study.h"
#include "../task/table.h"

enum { RESULT_SCHEMA_VERSION = 1 };

/** Rows [first, first + count) of a table, row-major bytes as table.h lays them out. 0 or an exit code. */
typedef int (*result_rows)(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why);

/** A table to write: one row per task, or any other number of rows with a scale of its own. */
typedef struct result_table {
  const table *layout;
  uint64_t rows;
  result_rows read;
  void *user;
} result_table;

/** What is written besides the tables. Strings are borrowed. */
typedef struct result_header {
  const study *study;
  const char *command;    /* the command line */
  const char *git_sha;    /* of the program */
  const char *libraries;  /* "GSL 2.7.1, FFTW 3.3.10, ..." */
  const char *compiler;
  const char *version;    /* of the program */
  /* /run: what varies between runs */
  double compute_seconds; /* from the first chunk taken to the last finished, over all ranks, this run */
  double total_seconds;   /* from the start of the program to the start of the writing */
  int ranks;
  uint64_t tasks_computed, tasks_resumed;
} result_header;

/** Collective over `comm`: writes `path`.tmp, closes it, re-opens and verifies it, syncs, and, when `commit` agrees on
 *  rank 0, renames it to `path` and syncs the folder. On any failure the temporary file is removed and all ranks return
 *  the same code.
 *  @param commit  asked on rank 0 just before the rename (the lock is still ours?); 0 agrees */
int result_write(MPI_Comm comm, const char *path, const result_header *header, const result_table *tables,
                 size_t table_count, int (*commit)(void *user, message *why), void *user, message *why);

/** Reads every data set of the file through its checksums, on this process alone, without MPI.
 *  @returns 0 or EXIT_FILES naming what is damaged. */
int result_verify(const char *path, message *why);

/** Digest of the study that a result belongs to (root attribute `study_digest`).
 *  @returns 0, or EXIT_FILES when it is no result of this program. */
int result_study_digest(const char *path, uint64_t *digest, message *why);

/* What `show` prints, on this process alone. */

/** Prints what is in the file: creator, study title, sweeps with their ranges, every group with its data sets (type,
 *  shape, units, long name), counts of every enum column, special points. */
int result_show(const char *path, message *why);

/** Prints the columns as CSV: for each group with a row per task, the swept parameters and every column with one value
 *  per row, enums by name. @param group NULL for the first such group. */
int result_show_csv(const char *path, const char *group, message *why);

#endif

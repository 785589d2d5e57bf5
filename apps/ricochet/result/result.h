/* Result files: HDF5, written by all ranks under a temporary name, verified, renamed; and read back for `show`.
 *
 * Every data set is chunked with the fletcher32 checksum, the file is of the HDF5 1.10 format throughout (metadata have
 * checksums), strings are of fixed length, every axis is attached to a dimension scale in the root group, and every
 * data set repeats the names of its axes as text in the attribute `axes`. Everything that varies between runs is in
 * /run, except the root attributes `file_time` and `command`. h5py reads the file, and xarray group by group, without
 * options; units are abbreviated ("s"), because xarray turns "seconds" into dates.
 *
 * plan.h divides the tables into chunks and blocks. skeleton.h makes all metadata in memory and creates the file with
 * space for all rows. In writer.c every rank writes its blocks. verify.h reads them back. */
#ifndef RICOCHET_APP_RESULT_H
#define RICOCHET_APP_RESULT_H

#include <stddef.h>
#include <stdint.h>

#include "../base/message.h"
#include "../study/study.h"
#include "../base/table.h"
#include "reader.h"

#define RESULT_CREATOR "ricochet" /* root attribute `creator` of every result */
enum { RESULT_SCHEMA_VERSION = 1 };

/** Rows [first, first + count) of a table, as table.h lays them out. Each rank requests other rows, at its own
 *  pace: collective operations are not allowed in here.
 *  @param rows  [count][row_bytes], to be filled
 *  @returns 0 or an exit code, with its reason in `why` */
typedef int (*result_rows)(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why);

/** A table to write: one row per task, or any other number of rows with a scale of its own. Tables may share a group.
 */
typedef struct result_table {
  const table *layout;
  uint64_t rows; /* may be 0; row_axis "task" means study_tasks rows */
  result_rows read;
  void *user;
} result_table;

/** The attributes of a result. Strings are borrowed. */
typedef struct result_header {
  const study *study;
  const char *command;   /* the command line */
  const char *git_sha;   /* of the program */
  const char *libraries; /* "GSL 2.7.1, FFTW 3.3.10, ..." */
  const char *compiler;
  const char *version; /* of the program */
  /* /run: what varies between runs */
  double compute_seconds; /* from the first chunk taken to the last finished, over all ranks, this run */
  double total_seconds;   /* from the start of the program to the start of the writing */
  int ranks;
  uint64_t arithmetic; /* digest of what processor and libraries compute */
  bool mixed;          /* whether some rows were computed with another */
  uint64_t tasks_computed, tasks_resumed;
} result_header;

/** Refuses a path whose temporary name, `path`.tmp, is taken by anything but the beginning of a result that a killed
 * run left. @returns 0 or EXIT_USAGE */
int result_check_partial(const char *path, message *why);

/** What the writing asks of its caller; a function may be NULL. */
typedef struct result_hooks {
  ric_poll stop;                           /* on every rank, all along: is the run to stop? */
  int (*commit)(void *user, message *why); /* on rank 0, just before the rename: does this run still hold the lock? A
                                              code that is not 0 ends the writing on all ranks. */
  void *user;                              /* of commit */
} result_hooks;

/** Collective over all ranks: writes `path`.tmp, re-opens and verifies it, syncs, renames it to `path` and syncs the
 *  folder. On any failure the temporary file is removed and all ranks return the same code with the same message, that
 * of the lowest rank that failed.
 *
 *  The process must ignore SIGXFSZ: then a limit on the size of files gives an error like any other.
 *  @param hooks  NULL for none
 *  @returns 0; EXIT_FILES when it cannot be written; EXIT_RUN when tables contradict each other or memory runs out;
 *           EXIT_STOPPED; what `read` or `commit` returned */
int result_write(const char *path, const result_header *header, const result_table *tables, size_t table_count,
                 const result_hooks *hooks, message *why);

/** Reads every data set of the file through its checksums, and checks the study's text and the references to the axes,
 *  on this process alone, without MPI_Init.
 *  @returns 0, EXIT_STOPPED, or EXIT_FILES naming what is damaged, also if `path` is not a result of this program. */
int result_verify(const char *path, ric_poll stop, message *why);

/** Whether to stop. @returns 0 or EXIT_STOPPED */
int result_ask(ric_poll stop, const file_place *at);
/** EXIT_STOPPED with its reason. */
int result_stopped(const file_place *at);

/** Digest of the study that a result belongs to (root attribute `study_digest`).
 *  @returns 0, or EXIT_FILES if it is not a result of this program. */
int result_study_digest(const char *path, uint64_t *digest, message *why);

/* What `show` prints on standard output, on this process alone, without MPI_Init. @returns 0; EXIT_FILES if the file
 * is damaged or not a result, or the output cannot be written. */

/** Prints what a kind reports about a result, in sentences. @returns 0, EXIT_FILES or EXIT_RUN */
typedef int result_card(const file_place *at, reader_handle file);

/** Prints what is in the file: creator, study title, sweeps with their ranges, the cards of its groups, every group
 * with its data sets (type, shape, units, long name), counts of every enum column, and up to 40 rows of tables that
 * have no row per task, such as special points.
 *  @param card_of  the card of a group, NULL for none */
int result_show(const char *path, result_card *(*card_of)(const char *group), message *why);

/** Prints a table of a group as CSV (RFC 4180, numbers to 17 digits, enums by name, a row of names first): every data
 * set whose first axis is that of the rows. Of one with more axes each element is a column: `q[3]`, `path[17][3]`. The
 * swept parameters stand before the columns of a table with a row per task; rows of a ragged table (impact_row) begin
 * with the task that they belong to. A group without a row per task comes with the rows of its first axis.
 *
 * "GROUP/AXIS" with the second axis of some data sets (trajectory/sample, orbits/particle) has a row for each of its
 * indices: the indices of both axes, the swept parameters, and these data sets.
 *  @param group  NULL for the first with a row per task; "GROUP/AXIS" for the rows of another axis
 *  @returns also EXIT_USAGE when there is no such group, or nothing in it to print */
int result_show_csv(const char *path, const char *group, message *why);

#endif

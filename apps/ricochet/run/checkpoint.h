/* The checkpoint of a run: a folder with one file per rank, to which the rank appends its finished chunks.
 *
 * A record is (magic, first task, number of tasks, bytes, digests) and the rows; it is never rewritten. A study may
 * have ragged tables (`tails`: each task has any number of entries of a fixed size). Then a record also holds the
 * number of entries of every task, with a digest of its own, before the rows, and the entries after them, table by
 * table. A file is read up to the first record that does not verify. A resumed run opens new files, so an incomplete
 * record at the end of an old file is never overwritten. When the result is assembled, the rows of finished tasks are
 * read from here: a rank holds only the tasks that it computes. Memory: 32 bytes per record, and 8 per record and
 * ragged table.
 *
 * The ranks share the files only. All number the missing tasks identically, because all open the checkpoint before any
 * of them appends (a barrier is between). They read the rows of other ranks after a barrier and a rescan. */
#ifndef RICOCHET_APP_CHECKPOINT_H
#define RICOCHET_APP_CHECKPOINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../base/digest.h"
#include "../base/message.h"

typedef struct checkpoint checkpoint;

enum { CHECKPOINT_MOST_TAILS = 6 };

/** The study and program that a checkpoint belongs to; every file begins with it. */
typedef struct checkpoint_identity {
  uint64_t digest; /* of the study */
  uint64_t tasks;
  uint64_t row_bytes;                          /* >= 1 */
  uint64_t entry_bytes[CHECKPOINT_MOST_TAILS]; /* of each ragged table; 0 after the last one */
  uint64_t arithmetic;                         /* digest of what processor and libraries compute: may differ */
  char version[64];                            /* of the program: rows of different versions are not mixed */
} checkpoint_identity;

/** The entries of ragged tables of the tasks of a chunk. */
typedef struct checkpoint_tails {
  const uint64_t *counts;                     /* [tasks][tails] entries of each task */
  const void *entries[CHECKPOINT_MOST_TAILS]; /* of each ragged table, in the order of the tasks */
} checkpoint_tails;

/** Opens the checkpoint in `folder` (which exists; copied) and reads the records of every file there, verifying all of
 *  their bytes. A file without a whole header counts as empty.
 *  @returns 0; EXIT_USAGE when the files belong to another study, version or shape; EXIT_FILES when they cannot be
 *           read; EXIT_RUN out of memory. *out is NULL unless 0. */
int checkpoint_open(const char *folder, const checkpoint_identity *identity, checkpoint **out, message *why);
/** Takes &c, sets it NULL, accepts NULL. Does not sync. */
void checkpoint_close(checkpoint **c);

/** Reads the records that appeared since (those of this rank, and of the other ranks after a barrier), and numbers the
 *  missing tasks anew. Only their headers are verified here: checkpoint_read verifies the rows, and each rank reads
 * only its share of them. */
int checkpoint_rescan(checkpoint *c, message *why);

/** Whether some files were written where the arithmetic differs, as of the last scan. */
bool checkpoint_mixed(const checkpoint *c);

/** Number of distinct tasks found in records, as of the last scan. */
uint64_t checkpoint_done(const checkpoint *c);

/** The n-th missing task as of the last scan maps to a contiguous run: sets *task to its number and returns how many
 *  missing tasks follow one another from there (at least 1), 0 when n is past the last missing one. */
uint64_t checkpoint_missing(const checkpoint *c, uint64_t n, uint64_t *task);

/** Creates this rank's own file; `rank` only names it. Once per checkpoint_open.
 *  @returns 0 or EXIT_FILES. */
int checkpoint_begin(checkpoint *c, int rank, message *why);

/** Appends one finished chunk, rows [count][row_bytes] and entries (NULL without ragged tables); the data are in
 * the page cache on return and survive the end of this process. After a failure (a full disk) the file ends with its
 * last good record.
 *  @returns 0 or EXIT_FILES. */
int checkpoint_append(checkpoint *c, uint64_t first, uint64_t count, const void *rows, const checkpoint_tails *tails,
                      message *why);

/** fdatasync of this rank's file and, the first time, of the folder and its parent: the data survive a crash of the
 * machine.
 *  @returns 0 (also when this rank has no file) or EXIT_FILES. */
int checkpoint_sync(checkpoint *c, message *why);

/** Reads rows [first, first + count) from whichever records hold them, verifying digests. Reading on in the record that
 *  was verified last does not digest it again.
 *  @returns 0 or EXIT_FILES. */
int checkpoint_read(checkpoint *c, uint64_t first, uint64_t count, void *rows, message *why);

/** Counts the entries of all ragged tables, as the functions below need them, in the records of the last scan.
 *  @returns 0, EXIT_FILES, or EXIT_RUN out of memory */
int checkpoint_count_entries(checkpoint *c, message *why);

/** Number of entries of a ragged table in all tasks that were counted. */
uint64_t checkpoint_entries(const checkpoint *c, size_t tail);

/** Offsets of tasks first, ..., first + count - 1 in a ragged table: the number of entries of all tasks before each.
 * The offset of the task after the last is the number of all entries. All tasks before have been counted.
 *  @param stride  from one offset to the next, in numbers
 *  @returns 0 or EXIT_FILES. */
int checkpoint_read_offsets(checkpoint *c, size_t tail, uint64_t first, uint64_t count, uint64_t *offsets,
                            size_t stride, message *why);

/** Reads entries [first, first + count) of a ragged table, numbered through all tasks; verifies as checkpoint_read.
 *  @returns 0 or EXIT_FILES. */
int checkpoint_read_entries(checkpoint *c, size_t tail, uint64_t first, uint64_t count, void *entries, message *why);

/** Deletes the checkpoint's own files (not the lock) and the folder if that leaves it empty. A missing folder is fine.
 *  @returns 0 or EXIT_FILES. */
int checkpoint_remove(const char *folder, message *why);

#endif

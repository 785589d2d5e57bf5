/* The checkpoint of a run: a folder with one file per rank, to which the rank appends its finished chunks.
 *
 * A record is (magic, first task, number of tasks, bytes, digest) and the rows; it is never rewritten. Reading goes to
 * the first record of a file that does not verify. A run that resumes opens new files beside the old ones, so that a
 * torn tail is never written over. The rows of finished tasks are read back from here when the result is assembled:
 * no rank holds more than it is working on. */
#ifndef RICOCHET_APP_CHECKPOINT_H
#define RICOCHET_APP_CHECKPOINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../study/message.h"

typedef struct checkpoint checkpoint;

/** What a checkpoint belongs to; every file begins with it. */
typedef struct checkpoint_identity {
  uint64_t digest; /* of the study */
  uint64_t tasks;
  uint64_t row_bytes;
  char version[64]; /* of the program: rows of different versions are not mixed */
} checkpoint_identity;

/** FNV-1a, 64 bits, continued from `seed` (0 to begin). */
uint64_t digest_bytes(uint64_t seed, const void *bytes, size_t size);

/** Opens the checkpoint in `folder` (which exists) and reads the records of every file there.
 *  @returns 0; EXIT_USAGE when the files belong to another study or version; EXIT_FILES when they cannot be read. */
int checkpoint_open(const char *folder, const checkpoint_identity *identity, checkpoint **out, message *why);
void checkpoint_close(checkpoint **c);

/** Reads the records that appeared since (the files of the other ranks, after a barrier). */
int checkpoint_rescan(checkpoint *c, message *why);

/** Number of distinct tasks found in records. */
uint64_t checkpoint_done(const checkpoint *c);

/** The n-th missing task as of the last scan maps to a contiguous run: sets *task to its number and returns how many
 *  missing tasks follow one another from there (at least 1), 0 when n is past the last missing one. */
uint64_t checkpoint_missing(const checkpoint *c, uint64_t n, uint64_t *task);

/** Creates this rank's own file; `rank` only names it. */
int checkpoint_begin(checkpoint *c, int rank, message *why);

/** Appends one finished chunk, rows [count][row_bytes]; on disk in the page cache when it returns. */
int checkpoint_append(checkpoint *c, uint64_t first, uint64_t count, const void *rows, message *why);

/** fdatasync of this rank's file and, the first time, of the folder. */
int checkpoint_sync(checkpoint *c, message *why);

/** Reads rows [first, first + count) from whichever records hold them, verifying digests.
 *  @returns 0 or EXIT_FILES. */
int checkpoint_read(checkpoint *c, uint64_t first, uint64_t count, void *rows, message *why);

/** Deletes the checkpoint's own files (not the lock) and the folder if that leaves it empty. */
int checkpoint_remove(const char *folder, message *why);

#endif

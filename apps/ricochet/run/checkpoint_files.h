/* The files of a checkpoint, for its own sources only: names, contents, and the state of an open checkpoint.
 *
 * A file `part-GENERATION-RANK` is one part_header and then records, in the byte order of the machine (with another
 * order the magic number differs). A record is a record_header; with ragged tables, counts [count][tails] and their
 * digest; then rows [count][row_bytes]; then the entries of each ragged table. */
#ifndef RICOCHET_APP_CHECKPOINT_FILES_H
#define RICOCHET_APP_CHECKPOINT_FILES_H

#include <limits.h>
#include <stdbool.h>

#include "checkpoint.h"

/* Which record holds which task: disjoint ranges in the order of the tasks, and the gaps between them. */

/** Tasks [first, first + count) are in the record at `offset` of file number `part`. */
typedef struct index_range {
  uint64_t first, count, offset;
  uint64_t part;
} index_range;

/** A run of missing tasks; `before` of them lie in earlier gaps. */
typedef struct index_gap {
  uint64_t first, count, before;
} index_gap;

typedef struct checkpoint_index {
  index_range *ranges; /* [range_count], ascending and disjoint once settled */
  size_t range_count, range_room;
  index_gap *gaps; /* [gap_count], ascending */
  size_t gap_count;
  uint64_t done;
} checkpoint_index;

/** Frees what the index owns and leaves it empty. */
void index_clear(checkpoint_index *index);

/** Adds a range, in any order; index_settle makes it effective.
 *  @returns 0, or EXIT_RUN out of memory. */
int index_add(checkpoint_index *index, index_range range, message *why);

/** Sorts the ranges, cuts overlaps (the range that begins first keeps its tasks; of two that begin together that of the
 *  lower part, then offset) and finds the gaps among tasks 0..tasks-1.
 *  @returns 0, or EXIT_RUN out of memory. */
int index_settle(checkpoint_index *index, uint64_t tasks, message *why);

/** The settled range that holds `task`, NULL when it is missing. */
const index_range *index_find(const checkpoint_index *index, uint64_t task);

/** The gap that holds the n-th missing task, NULL when n is past the last one. */
const index_gap *index_find_gap(const checkpoint_index *index, uint64_t n);

/* --- the files --- */

#define PART_MAGIC   UINT64_C(0x74706b6368636972) /* "ricchkpt" */
#define RECORD_MAGIC UINT64_C(0x64726f6365726372) /* "rcrecord" */
enum { PART_FORMAT = 4, PART_BUFFER_BYTES = 1 << 20, PART_NAME_BYTES = 40 };

typedef struct part_header {
  uint64_t magic, format;
  checkpoint_identity identity; /* version padded with zeros */
  uint64_t check;               /* digest of all members before */
} part_header;

typedef struct record_header {
  uint64_t magic, first, count, bytes; /* bytes: all that follows the header */
  uint64_t rows;                       /* digest of these */
  uint64_t check;                      /* digest of all members before */
} record_header;

/* Written byte by byte: there must be no padding. */
_Static_assert(sizeof(checkpoint_identity) == 144 && sizeof(part_header) == 168, "part header has padding");
_Static_assert(sizeof(record_header) == 48, "record header has padding");

/** A file found in the folder. */
typedef struct part {
  unsigned generation, rank;
  uint64_t scanned; /* end of its last good record; 0 until its header is complete */
  bool suspect;     /* the rows of the record after that did not verify */
} part;

struct checkpoint {
  char folder[PATH_MAX - PART_NAME_BYTES];
  checkpoint_identity identity;
  unsigned generation; /* of the file that checkpoint_begin creates: one above all that were found */
  part *parts;         /* [part_count], by generation and rank; files found later come after those found earlier */
  size_t part_count;
  bool mixed; /* some part was written with other arithmetic */
  checkpoint_index index;
  size_t tails;
  uint64_t *before; /* [ranges + 1][tails] entries in the ranges before; NULL until they are counted */

  int own_fd; /* -1 before checkpoint_begin and after a failure that could not be undone */
  char own_path[PATH_MAX];
  uint64_t own_size;
  bool folder_synced;

  int read_fd; /* of parts[read_part]; -1 when none is open. Only one, as there may be thousands of parts. */
  size_t read_part;
  size_t verified_part;     /* place of the record that was verified last */
  uint64_t verified_offset; /* 0 when there is none */
  record_header verified;   /* its header */
  size_t counts_part;       /* place of the record whose counts are in memory */
  uint64_t counts_offset;   /* 0 when there is none */
  record_header counted;    /* its header */
  uint64_t *counts;         /* [counted.count][tails] */
  uint64_t counts_room;     /* numbers */
  unsigned char *buffer;    /* [PART_BUFFER_BYTES] */
  uint64_t unasked;         /* bytes read since stop_asked_after was asked */
};

uint64_t part_header_check(const part_header *header);
uint64_t record_header_check(const record_header *header);

/** Path of a part. @param path [PATH_MAX] */
void part_path(const char *folder, unsigned generation, unsigned rank, char *path);

/** Whether a folder entry is named like a part, and which one. */
bool part_name_parse(const char *name, unsigned *generation, unsigned *rank);

/** Bytes between a record's header and its rows. */
uint64_t counts_bytes(const checkpoint *c, uint64_t count);

/** Result of reading: verified; not verified (end of file, incomplete record, damage); an error of the file system,
 *  or a stop, given in `why`. */
typedef enum finding { GOOD, BAD, UNREADABLE, STOPPED } finding;

/** EXIT_FILES or EXIT_STOPPED; 0 for what is GOOD or BAD. */
int finding_failure(finding found);

/** Makes read_fd the file of this part. @returns 0 or EXIT_FILES. */
int open_part(checkpoint *c, size_t number, message *why);

/** Reads from the open part; a file that ends earlier is BAD. Asks for a stop now and then. */
finding read_part(checkpoint *c, void *bytes, size_t size, uint64_t offset, message *why);

/** Reads and verifies a record's header in the open part. */
finding read_record_header(const checkpoint *c, uint64_t offset, record_header *header, message *why);

/** EXIT_FILES: the record of a range does not verify. */
int refuse_record(const checkpoint *c, const index_range *range, message *why);

/** Opens the record of a range and verifies it, unless it was verified last. */
int select_record(checkpoint *c, const index_range *range, message *why);

/** Reads bytes of the open part that have been verified. @returns 0, EXIT_FILES or EXIT_STOPPED. */
int read_verified(checkpoint *c, void *bytes, uint64_t size, uint64_t offset, message *why);

/** Finds new parts in the folder, reads all parts on from the end of the last scan, and updates the index.
 *  @param rows  digest the rows too, not only the headers */
int checkpoint_scan(checkpoint *c, bool rows, message *why);

#endif

/* Reading a result: its groups, their data sets with their attributes, and rows of values as text.
 *
 * Serial, for any process, without MPI. Files may be truncated, damaged, or of another program; all of it is checked.
 */
#ifndef RICOCHET_APP_READER_H
#define RICOCHET_APP_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../base/message.h"

/** HDF5's hid_t, so that kinds can read their results without HDF5. */
typedef int64_t reader_handle;

/** Opens a result for reading. @returns 0, or EXIT_FILES if it is not a result, of a later schema, or truncated. */
int reader_open(const file_place *at, const char *path, reader_handle *file);
/** @param code  of the work done with it  @returns `code`, or EXIT_FILES when only the close failed */
int reader_close(const file_place *at, reader_handle file, int code);

/** Names of the links in a group that lead to groups, or to data sets, in the order made. */
typedef struct reader_names {
  char **at;
  size_t count;
} reader_names;

int reader_list(const file_place *at, reader_handle group, bool groups, reader_names *names);
void reader_names_clear(reader_names *names);

typedef enum reader_type {
  READER_NUMBER,
  READER_INTEGER,
  READER_COMPLEX,
  READER_WORD,
  READER_TEXT,
  READER_OTHER
} reader_type;

enum { READER_MAX_WORDS = 128, READER_MAX_RANK = 32 };

typedef struct reader_set {
  reader_handle id, memory; /* data set; type of its values in memory */
  reader_type type;
  size_t value_bytes; /* in memory */
  int rank;
  uint64_t shape[READER_MAX_RANK];
  char *name;
  char axes[256], units[64], long_name[256];
  char parameter[96], observed[96]; /* name of what its values are of: a parameter, a variable; "": of none */
  char *words[READER_MAX_WORDS];    /* of an enum, by value; NULL where it has none */
} reader_set;

typedef struct reader_group {
  char *name;
  reader_set *sets; /* [count] */
  size_t count;
} reader_group;

/** Opens a group with all its data sets. @param g  zeroed; reader_group_clear also after a failure */
int reader_group_open(const file_place *at, reader_handle file, const char *name, reader_group *g);
void reader_group_clear(reader_group *g);
/** Whether the file has a group of this name. */
bool reader_has(reader_handle file, const char *name);
/** The data set of a name, NULL when the group has none. */
const reader_set *reader_find(const reader_group *g, const char *name);

/** Refuses a data set with values in another file, or that claims more values than its file can hold (no filter packs
 * more tightly than deflate, 1032 to 1; no chunk takes nothing), so that whatever is multiplied and allocated for it
 * stays in proportion to the file. Every set of a reader_group has passed. @param shape  [rank] */
int reader_check_storage(const file_place *at, reader_handle set, const char *name, int rank, const uint64_t *shape,
                         size_t value_bytes);

/** Name of the parameter of a set that holds values of one; earlier results have it as the long name. */
const char *reader_parameter(const reader_set *s);

/** Whether the first axis of the set is `axis`, and its length is one value per row of it. */
bool reader_is_column(const reader_set *s, const char *axis);

/** Name of axis number `k` of the set, "" where it has fewer. @param axis  [256] */
void reader_axis(const reader_set *s, int k, char *axis);

/** Values behind each index of the first `axes` axes of a set: those of a row for 1; 0 if there are too many to count.
 */
uint64_t reader_width(const reader_set *s, int axes);

/** Reads rows [first, first + count) of a set: all values of each.
 *  @param values  [count][reader_width(s, 1)][value_bytes] */
int reader_rows(const file_place *at, const reader_set *s, uint64_t first, uint64_t count, unsigned char *values);

/** Reads of one row of a set with two and more axes the indices [first, first + count) of its second axis.
 *  @param values  [count][reader_width(s, 2)][value_bytes] */
int reader_part_of_row(const file_place *at, const reader_set *s, uint64_t row, uint64_t first, uint64_t count,
                       unsigned char *values);

/** Numbers per value of the set: 2 of complex ones (real and imaginary part), else 1. */
int reader_parts(const reader_set *s);

/** A part of a value as text: numbers with `digits` significant digits, enums by name.
 *  @param text  [size], cut to fit */
void reader_part(const reader_set *s, const unsigned char *value, int part, int digits, char *text, size_t size);

/** The value in one row of a set with one value per row, as text; "" where there is none. @param text  [size] */
int reader_cell(const file_place *at, const reader_set *s, uint64_t row, int digits, char *text, size_t size);

/** A whole value as text, complex ones as "0.5-2i". */
void reader_value(const reader_set *s, const unsigned char *value, int digits, char *text, size_t size);

#endif

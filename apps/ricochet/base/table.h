/* The layout of result rows: a table is a list of columns, a row of it one block of bytes.
 *
 * A kind of study describes its results as tables; the evaluation of a task fills one row of the first, and adds
 * records to the others: rows of tables whose number differs from task to task, such as impacts. Checkpoint, result
 * writer, `show` and the schema page (docs/results.md) all read this description.
 *
 * In C a row is a plain struct of the kind's own, and each column says which member of it holds its value (NUMBER,
 * INTEGER, ... below, which also check the member's type). row_load and row_store go from the bytes to the struct and
 * back, so a column is one line of the list and one member, and nothing else knows its name. */
#ifndef RICOCHET_APP_TABLE_H
#define RICOCHET_APP_TABLE_H

#include <stddef.h>
#include <stdint.h>

typedef enum column_type {
  COLUMN_F64,
  COLUMN_I64,
  COLUMN_COMPLEX, /* two doubles, real and imaginary part; in a file the compound {r, i} that h5py reads as complex */
  COLUMN_ENUM,    /* one signed byte; names give the values 0, 1, 2, ... */
  COLUMN_TEXT     /* fixed length, zero padded */
} column_type;

enum {
  COLUMN_MOST_AXES = 2, /* besides that of the rows */
  COLUMN_MOST_ATTRIBUTES = 4
};

/** A number or text that belongs to a column as a whole, such as a tolerance behind it. */
typedef struct column_attribute {
  const char *name; /* NULL: none */
  double value;     /* where there is no text */
  const char *text;
} column_attribute;

typedef struct column {
  const char *name; /* data set in the table's group */
  column_type type;
  const char *axes[COLUMN_MOST_AXES]; /* names of the further axes' dimension scales in the root group; NULL: none */
  size_t extents[COLUMN_MOST_AXES];   /* values along each of them, may be 0; without meaning where there is no axis */
  size_t text_bytes;                  /* bytes of a COLUMN_TEXT value */
  const char *const *names;           /* words of a COLUMN_ENUM */
  size_t name_count;
  const char *units; /* NULL: "1", dimensionless */
  const char *long_name, *source;
  const char *doc; /* meaning on the schema page; NULL: the long name says it all */
  size_t member;   /* offset in the struct of a row; what it is: see below */
  size_t behind;   /* 0: the row's own; else 1 + the offset of a pointer in the row to the struct with the member */
  column_attribute attributes[COLUMN_MOST_ATTRIBUTES]; /* the first ones that have a name */
  size_t offset; /* of the first value in a row; set by table_lay_out, a multiple of 8 */
} column;

/* A member's offset, if it has one of two types. */
#define COLUMN_MEMBER(row, m, type, other)                                                                             \
  (offsetof(row, m) + 0 * sizeof(char[_Generic(((row *)0)->m, type : 1, other : 1, default : -1)]))

/* Type and member of a column. With further axes (the plural) the member is a pointer to all its values. */
#define NUMBER(row, m)    .type = COLUMN_F64, .member = COLUMN_MEMBER(row, m, double, float)
#define NUMBERS(row, m)   .type = COLUMN_F64, .member = COLUMN_MEMBER(row, m, double *, const double *)
#define INTEGER(row, m)   .type = COLUMN_I64, .member = COLUMN_MEMBER(row, m, long long, unsigned long long)
#define INTEGERS(row, m)  .type = COLUMN_I64, .member = COLUMN_MEMBER(row, m, int64_t *, const int64_t *)
#define COMPLEX(row, m)   .type = COLUMN_COMPLEX, .member = COLUMN_MEMBER(row, m, ric_complex, float)
#define COMPLEXES(row, m) .type = COLUMN_COMPLEX, .member = COLUMN_MEMBER(row, m, ric_complex *, const ric_complex *)
#define TEXT(row, m, size)                                                                                             \
  .type = COLUMN_TEXT, .text_bytes = (size), .member = COLUMN_MEMBER(row, m, const char *, char *)
#define WORDS_OF(list)     .type = COLUMN_ENUM, .names = (list), .name_count = sizeof(list) / sizeof *(list)
#define WORD(row, m, list) WORDS_OF(list), .member = COLUMN_MEMBER(row, m, int, unsigned)
/* Words with further axes are bytes. */
#define WORDS(row, m, list) WORDS_OF(list), .member = COLUMN_MEMBER(row, m, unsigned char *, const unsigned char *)

/* The member is one of a struct that the row points to: COLUMN("energy", NUMBER(ric_orbit, energy), ..., OF(orbits_row,
 * orbit)). Such a column is written, not read. */
#define OF(row, pointer) .behind = 1 + offsetof(row, pointer)

/* A line of a list of columns: name, type and member, what it is, its source, and what else there is to say. */
#define COLUMN(column_name, type_and_member, meaning, ...)                                                             \
  { .name = (column_name), type_and_member, .long_name = (meaning), __VA_ARGS__ }

/** Columns that a table has together. Tables are laid out from such lists, and the schema page prints them. */
typedef struct column_list {
  const char *group;    /* "orbits"; NULL ends an array of lists */
  const char *row_axis; /* dimension scale of the rows: "task" for tables with a row per task */
  const char *offset;   /* of records: data set of their offsets, "impact_offset"; NULL: none, or in an earlier list */
  const char *meaning;  /* its long name */
  const char *doc;      /* lines above the columns on the schema page: condition, what the rows are; NULL: none, and the
                           columns continue the page's table before */
  const column *columns;
  size_t count;
} column_list;

#define COLUMNS(list) .columns = (list), .count = sizeof(list) / sizeof *(list)

enum { TABLE_MAX_COLUMNS = 48 };

typedef struct table {
  const char *group, *row_axis; /* of its lists */
  column columns[TABLE_MAX_COLUMNS];
  size_t column_count;
  size_t row_bytes;
} table;

/** A dimension scale and its extent, as columns of several tables share it. */
typedef struct table_axis {
  const char *name;
  size_t extent;
} table_axis;

/** Bytes of one value of a column: 8, 16 for a complex one, 1 for a word, or text_bytes. */
size_t column_value_bytes(const column *c);

/** Number of further axes, 0 to COLUMN_MOST_AXES. */
int column_axes(const column *c);

/** Values per row: the product of the extents, 1 without a further axis. */
size_t column_values(const column *c);

/** Bytes of a row's values. */
size_t column_bytes(const column *c);

/** Appends copies of a list's columns, with the extents of their axes, and takes its group and row axis. A column with
 *  an axis that is not among `axes` is left out: what a study does not ask for has no axis.
 *  @param axes  [axis_count] */
void table_add(table *t, const column_list *list, const table_axis *axes, size_t axis_count);

/** Takes a column out, if there is one of this name. Before the layout. */
void table_drop(table *t, const char *name);

/** Sets the offsets and row_bytes; returns row_bytes. */
size_t table_lay_out(table *t);

/** Bytes of a row as a number that cannot overflow, before or after table_lay_out. */
double table_row_bytes(const table *t);

/** Column by name, NULL when the table has none. */
const column *table_column(const table *t, const char *name);

/** Gives a column of the table, if it has one of this name, a further attribute: a number, or text, borrowed. */
void table_put_attribute(table *t, const char *name, const char *attribute, double value);
void table_put_text(table *t, const char *name, const char *attribute, const char *text);

/** Says that a column holds values of a parameter of the study, "model.force", borrowed. */
void table_put_parameter(table *t, const char *name, const char *parameter);

/** Reads a row into the struct of its table: numbers and words are copied; pointers to several values and to texts then
 *  lead into the row, which is filled through them. Members whose column the table does not have stay as they are. A
 *  text without a zero at its end has all its bytes.
 *  @param row  [row_bytes] at a multiple of 8 bytes */
void row_load(const table *t, unsigned char *row, void *values);

/** Writes the struct of a row into it. What a pointer leads to is copied, unless it stands in the row already or the
 *  pointer is NULL. */
void row_store(const table *t, unsigned char *row, const void *values);

/** Fills a row of zeros from its struct. */
void row_fill(const table *t, unsigned char *row, const void *values);

/* Records: the rows of a table of which every task adds as many as it needs, those of one task after another. */

typedef struct records {
  size_t record_bytes;  /* set by the owner before the first is added */
  unsigned char *bytes; /* [count][record_bytes] */
  uint64_t count, room;
} records;

/** Adds a record of zeros. @returns it, valid until the next one is added; NULL when out of memory. */
unsigned char *records_add(records *r);

/** Leaves the first `count`, which is at most their number; keeps the memory. */
void records_cut(records *r, uint64_t count);

void records_clear(records *r);

#endif

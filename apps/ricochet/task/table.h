/* The layout of result rows: a table is a list of columns, a row of it one block of bytes.
 *
 * A kind of study describes its results as tables; the evaluation of a task fills one row of the first, and adds
 * records to the others: rows of tables whose number differs from task to task, such as impacts. Checkpoint, result
 * writer, `show` and the schema page all read this description, so a column is added in one place. */
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

/** A number that belongs to a column as a whole, such as a tolerance behind it. */
typedef struct column_attribute {
  const char *name; /* NULL: none */
  double value;
} column_attribute;

typedef struct column {
  const char *name; /* data set in the table's group */
  column_type type;
  const char *axes[COLUMN_MOST_AXES]; /* names of the further axes' dimension scales in the root group; NULL: none */
  size_t extents[COLUMN_MOST_AXES];   /* values along each of them, may be 0; without meaning where there is no axis */
  size_t text_bytes;                  /* bytes of a COLUMN_TEXT value */
  const char *const *names;           /* words of a COLUMN_ENUM */
  size_t name_count;
  const char *units, *long_name, *source;
  column_attribute attributes[COLUMN_MOST_ATTRIBUTES]; /* the first ones that have a name */
  size_t offset; /* of the first value in a row; set by table_lay_out, a multiple of 8 */
} column;

enum { TABLE_MAX_COLUMNS = 48 };

typedef struct table {
  const char *group;    /* "orbits" */
  const char *row_axis; /* dimension scale of the rows: "task" for tables with a row per task */
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

/** Appends copies of columns, with the extents of their axes. A column with an axis that is not among `axes` is left
 *  out: what a study does not ask for has no axis.
 *  @param axes  [axis_count] */
void table_add(table *t, const column *columns, size_t count, const table_axis *axes, size_t axis_count);

/** Takes a column out, if there is one of this name. Before the layout. */
void table_drop(table *t, const char *name);

/** Sets the offsets and row_bytes; returns row_bytes. */
size_t table_lay_out(table *t);

/** Column by name, NULL when the table has none. */
const column *table_column(const table *t, const char *name);

/** Gives a column of the table, if it has one of this name, another long name, borrowed. */
void table_put_long_name(table *t, const char *name, const char *long_name);

/** Gives a column of the table, if it has one of this name, a further attribute. */
void table_put_attribute(table *t, const char *name, const char *attribute, double value);

/* Writing into a row. A NULL column (a table without it) is skipped, so that optional columns need no test. */
void row_put_numbers(unsigned char *row, const column *c, const double *values);
void row_put_number(unsigned char *row, const column *c, double value);
void row_put_integer(unsigned char *row, const column *c, long long value);
void row_put_word(unsigned char *row, const column *c, int value);
void row_put_text(unsigned char *row, const column *c, const char *text);

/** Writes value `i` of a column with further axes. */
void row_put_integer_at(unsigned char *row, const column *c, size_t i, long long value);
void row_put_word_at(unsigned char *row, const column *c, size_t i, int value);

/** The integer of a column without further axes. */
int64_t row_integer(const unsigned char *row, const column *c);

/** Where the numbers of a column stand in a row, to be filled in place; NULL for a NULL column. The row begins at a
 *  multiple of 8 bytes. */
double *row_numbers(unsigned char *row, const column *c);

#endif

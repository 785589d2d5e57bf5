#include "table.h"

#include <stdbool.h>
#include <string.h>

size_t column_value_bytes(const column *c) {
  switch (c->type) {
  case COLUMN_F64:
  case COLUMN_I64:
    return 8;
  case COLUMN_COMPLEX:
    return 16;
  case COLUMN_ENUM:
    return 1;
  case COLUMN_TEXT:
    return c->text_bytes;
  }
  return 0;
}

int column_axes(const column *c) {
  int count = 0;
  while (count < COLUMN_MOST_AXES && c->axes[count])
    count++;
  return count;
}

size_t column_values(const column *c) {
  size_t values = 1;
  for (int i = 0; i < column_axes(c); i++)
    values *= c->extents[i];
  return values;
}

size_t column_bytes(const column *c) {
  return column_values(c) * column_value_bytes(c);
}

/* Sets the extents of a column's axes; false when one of them is not in the list. */
static bool set_extents(column *c, const table_axis *axes, size_t axis_count) {
  for (int i = 0; i < column_axes(c); i++) {
    size_t k = 0;
    while (k < axis_count && strcmp(axes[k].name, c->axes[i]) != 0)
      k++;
    if (k == axis_count)
      return false;
    c->extents[i] = axes[k].extent;
  }
  return true;
}

void table_add(table *t, const column *columns, size_t count, const table_axis *axes, size_t axis_count) {
  for (size_t i = 0; i < count; i++) {
    column added = columns[i];
    if (set_extents(&added, axes, axis_count))
      t->columns[t->column_count++] = added;
  }
}

void table_drop(table *t, const char *name) {
  size_t kept = 0;
  for (size_t i = 0; i < t->column_count; i++)
    if (strcmp(t->columns[i].name, name) != 0)
      t->columns[kept++] = t->columns[i];
  t->column_count = kept;
}

size_t table_lay_out(table *t) {
  size_t at = 0;
  for (size_t i = 0; i < t->column_count; i++) {
    column *c = &t->columns[i];
    c->offset = at;
    at += (column_bytes(c) + 7) / 8 * 8;
  }
  t->row_bytes = at;
  return at;
}

const column *table_column(const table *t, const char *name) {
  for (size_t i = 0; i < t->column_count; i++)
    if (strcmp(t->columns[i].name, name) == 0)
      return &t->columns[i];
  return NULL;
}

void table_put_long_name(table *t, const char *name, const char *long_name) {
  for (size_t i = 0; i < t->column_count; i++)
    if (strcmp(t->columns[i].name, name) == 0)
      t->columns[i].long_name = long_name;
}

void table_put_attribute(table *t, const char *name, const char *attribute, double value) {
  for (size_t i = 0; i < t->column_count; i++) {
    column_attribute *free_one = t->columns[i].attributes;
    if (strcmp(t->columns[i].name, name) != 0)
      continue;
    while (free_one->name)
      free_one++;
    *free_one = (column_attribute){attribute, value};
  }
}

void row_put_numbers(unsigned char *row, const column *c, const double *values) {
  if (c && column_values(c) > 0)
    memcpy(row + c->offset, values, column_bytes(c));
}

double *row_numbers(unsigned char *row, const column *c) {
  return c ? (double *)(void *)(row + c->offset) : NULL;
}

void row_put_number(unsigned char *row, const column *c, double value) {
  if (c)
    memcpy(row + c->offset, &value, sizeof value);
}

void row_put_integer_at(unsigned char *row, const column *c, size_t i, long long value) {
  int64_t wide = value;
  if (c)
    memcpy(row + c->offset + i * sizeof wide, &wide, sizeof wide);
}

void row_put_integer(unsigned char *row, const column *c, long long value) {
  row_put_integer_at(row, c, 0, value);
}

int64_t row_integer(const unsigned char *row, const column *c) {
  int64_t value;
  memcpy(&value, row + c->offset, sizeof value);
  return value;
}

void row_put_word_at(unsigned char *row, const column *c, size_t i, int value) {
  if (c)
    row[c->offset + i] = (unsigned char)value;
}

void row_put_word(unsigned char *row, const column *c, int value) {
  row_put_word_at(row, c, 0, value);
}

void row_put_text(unsigned char *row, const column *c, const char *text) {
  if (!c)
    return;
  size_t length = strnlen(text, c->text_bytes);
  memset(row + c->offset, 0, c->text_bytes);
  memcpy(row + c->offset, text, length);
}

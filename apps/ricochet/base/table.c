#include "table.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

unsigned char *records_add(records *r) {
  if (r->count == r->room) {
    const uint64_t room = r->room ? 2 * r->room : 64;
    unsigned char *more = room > SIZE_MAX / r->record_bytes ? NULL : realloc(r->bytes, room * r->record_bytes);
    if (!more)
      return NULL;
    r->bytes = more;
    r->room = room;
  }
  unsigned char *added = r->bytes + r->count++ * r->record_bytes;
  memset(added, 0, r->record_bytes);
  return added;
}

void records_cut(records *r, uint64_t count) {
  r->count = count;
}

void records_clear(records *r) {
  free(r->bytes);
  *r = (records){.record_bytes = r->record_bytes};
}

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

void table_add(table *t, const column_list *list, const table_axis *axes, size_t axis_count) {
  t->group = list->group;
  t->row_axis = list->row_axis;
  for (size_t i = 0; i < list->count; i++) {
    column added = list->columns[i];
    if (!added.units)
      added.units = "1";
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

double table_row_bytes(const table *t) {
  double bytes = 0;
  for (size_t i = 0; i < t->column_count; i++) {
    const column *c = &t->columns[i];
    double values = 1;
    for (int k = 0; k < column_axes(c); k++)
      values *= (double)c->extents[k];
    bytes += 8 * ceil(values * (double)column_value_bytes(c) / 8);
  }
  return bytes;
}

const column *table_column(const table *t, const char *name) {
  for (size_t i = 0; i < t->column_count; i++)
    if (strcmp(t->columns[i].name, name) == 0)
      return &t->columns[i];
  return NULL;
}

static void put_attribute(table *t, const char *name, column_attribute added) {
  for (size_t i = 0; i < t->column_count; i++) {
    column_attribute *free_one = t->columns[i].attributes;
    if (strcmp(t->columns[i].name, name) != 0)
      continue;
    while (free_one->name)
      free_one++;
    *free_one = added;
  }
}

void table_put_attribute(table *t, const char *name, const char *attribute, double value) {
  put_attribute(t, name, (column_attribute){.name = attribute, .value = value});
}

void table_put_text(table *t, const char *name, const char *attribute, const char *text) {
  put_attribute(t, name, (column_attribute){.name = attribute, .text = text});
}

void table_put_parameter(table *t, const char *name, const char *parameter) {
  table_put_text(t, name, "parameter", parameter);
}

/* Whether the member is a pointer to values rather than a value. */
static bool is_pointer(const column *c) {
  return c->type == COLUMN_TEXT || column_axes(c) > 0;
}

static void load(const column *c, unsigned char *at, unsigned char *member) {
  int64_t wide;
  if (is_pointer(c)) {
    memcpy(member, &at, sizeof at);
  } else if (c->type == COLUMN_ENUM) {
    memcpy(member, &(int){*at}, sizeof(int));
  } else if (c->type == COLUMN_I64) {
    memcpy(&wide, at, sizeof wide);
    memcpy(member, &(long long){wide}, sizeof(long long));
  } else {
    memcpy(member, at, column_value_bytes(c));
  }
}

static void store_text(const column *c, unsigned char *at, const char *text) {
  const size_t length = strnlen(text, c->text_bytes);
  memset(at, 0, c->text_bytes);
  memcpy(at, text, length);
}

static void store(const column *c, unsigned char *at, const unsigned char *member) {
  const void *values;
  int word;
  long long integer;
  if (is_pointer(c)) {
    memcpy(&values, member, sizeof values);
    if (!values || values == at)
      return;
    if (c->type == COLUMN_TEXT)
      store_text(c, at, values);
    else
      memcpy(at, values, column_bytes(c));
  } else if (c->type == COLUMN_ENUM) {
    memcpy(&word, member, sizeof word);
    *at = (unsigned char)word;
  } else if (c->type == COLUMN_I64) {
    memcpy(&integer, member, sizeof integer);
    memcpy(at, &(int64_t){integer}, sizeof(int64_t));
  } else {
    memcpy(at, member, column_value_bytes(c));
  }
}

/* The struct that holds a column's member. */
static const unsigned char *holder_of(const column *c, const unsigned char *values) {
  const void *behind = values;
  if (c->behind)
    memcpy(&behind, values + c->behind - 1, sizeof behind);
  return behind;
}

void row_load(const table *t, unsigned char *row, void *values) {
  for (size_t i = 0; i < t->column_count; i++)
    if (!t->columns[i].behind)
      load(&t->columns[i], row + t->columns[i].offset, (unsigned char *)values + t->columns[i].member);
}

void row_store(const table *t, unsigned char *row, const void *values) {
  for (size_t i = 0; i < t->column_count; i++)
    store(&t->columns[i], row + t->columns[i].offset, holder_of(&t->columns[i], values) + t->columns[i].member);
}

void row_fill(const table *t, unsigned char *row, const void *values) {
  memset(row, 0, t->row_bytes);
  row_store(t, row, values);
}

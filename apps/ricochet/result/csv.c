#include "result.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdf5_call.h"
#include "reader.h"
#include "text_out.h"

enum {
  BLOCK = 4096,   /* rows read at a time */
  MOST_PARTS = 2, /* of a value: complex numbers have two columns */
  ALL_DIGITS = 17 /* a double printed with so many reads back as itself */
};

/* A column of the output, with a block of the values that it is a part of. */
typedef struct csv_column {
  const reader_set *set;
  int part;
  unsigned char *values;
} csv_column;

/* The task that a row of a ragged table belongs to, from the offsets of all tasks. */
typedef struct csv_owner {
  const reader_set *offset; /* NULL: no column `task` */
  uint64_t task;
  int64_t end;          /* of its rows */
  int64_t edges[BLOCK]; /* offsets from `first` on */
  hsize_t first;
} csv_owner;

typedef struct csv {
  const file_place *at;
  hid_t file;
  char name[256];   /* of the group asked for, "" for none */
  const char *axis; /* asked for, or NULL */
  csv_owner owner;
  reader_group sweep, group;
  csv_column *columns; /* [count] */
  size_t count;
  hsize_t rows;
  char *text; /* [text_size] one value */
  size_t text_size;
} csv;

/* RFC 4180: a field with a comma, a quote or a line break stands in quotes, quotes inside doubled. */
static void put_field(const char *text) {
  if (!strpbrk(text, ",\"\r\n")) {
    fputs(text, stdout);
    return;
  }
  putchar('"');
  for (; *text; text++) {
    if (*text == '"')
      putchar('"');
    putchar(*text);
  }
  putchar('"');
}

/* --- which columns --- */

static bool has_rows_of(const reader_group *g, const char *axis) {
  for (size_t k = 0; k < g->count; k++)
    if (reader_is_column(&g->sets[k], axis))
      return true;
  return false;
}

/* "GROUP" or "GROUP/AXIS". */
static void split_name(csv *c, const char *name) {
  const size_t length = strcspn(name, "/");
  snprintf(c->name, sizeof c->name, "%.*s", (int)length, name);
  c->axis = name[length] ? name + length + 1 : NULL;
}

/* The group asked for, or the first but /sweep with a value per task. */
static int open_group(csv *c) {
  const char *name = c->name[0] ? c->name : NULL;
  reader_names names;
  char known[512] = "";
  bool found = false;
  int code = reader_list(c->at, c->file, true, &names);
  for (size_t i = 0; !code && !found && i < names.count; i++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", names.at[i]);
    if (name ? strcmp(names.at[i], name) != 0 : strcmp(names.at[i], "sweep") == 0)
      continue;
    code = reader_group_open(c->at, c->file, names.at[i], &c->group);
    found = !code && (name || has_rows_of(&c->group, "task"));
    if (!found)
      reader_group_clear(&c->group);
  }
  reader_names_clear(&names);
  if (code || found)
    return code;
  if (name)
    return refuse(c->at->why, EXIT_USAGE, "%s: no group %s, expected one of %s", c->at->path, name, known);
  return refuse(c->at->why, EXIT_USAGE, "%s: no group with a row per task", c->at->path);
}

static int add_columns(csv *c, const reader_group *g, const char *axis) {
  for (size_t k = 0; k < g->count; k++) {
    const reader_set *s = &g->sets[k];
    if (!reader_is_column(s, axis))
      continue;
    if (c->count > 0 && s->shape[0] != c->rows)
      return refuse(c->at->why, EXIT_FILES, "%s: %s has %llu rows, expected %llu", c->at->path, s->name,
                    (unsigned long long)s->shape[0], (unsigned long long)c->rows);
    c->rows = s->shape[0];
    for (int part = 0; part < reader_parts(s); part++) {
      csv_column *added = &c->columns[c->count++];
      *added = (csv_column){.set = s, .part = part, .values = calloc(BLOCK, s->value_bytes)};
      if (!added->values)
        return refuse(c->at->why, EXIT_RUN, "%s: out of memory", c->at->path);
    }
    if (c->text_size < s->value_bytes + 1)
      c->text_size = s->value_bytes + 1;
    if (c->text_size < strlen(s->name) + sizeof ".r")
      c->text_size = strlen(s->name) + sizeof ".r";
  }
  return 0;
}

/* The offsets of "impact_row" are those of "impact_offset". */
static void find_owner(csv *c, const char *axis) {
  static const char end[] = "_row";
  const size_t length = strlen(axis), stem = length > sizeof end ? length - (sizeof end - 1) : 0;
  for (size_t k = 0; stem > 0 && strcmp(axis + stem, end) == 0 && k < c->group.count; k++) {
    const reader_set *s = &c->group.sets[k];
    if (strncmp(s->name, axis, stem) == 0 && strcmp(s->name + stem, "_offset") == 0 && s->type == READER_INTEGER &&
        reader_is_column(s, "task_edge"))
      c->owner = (csv_owner){.offset = s, .task = UINT64_MAX, .first = HSIZE_UNDEF};
  }
}

/* A group without a row per task is printed along its first axis, and then without the swept parameters. */
static int choose_columns(csv *c) {
  char axis[256] = "task";
  if (c->axis)
    snprintf(axis, sizeof axis, "%s", c->axis);
  else if (!has_rows_of(&c->group, axis) && c->group.count > 0)
    reader_row_axis(&c->group.sets[0], axis);
  find_owner(c, axis);
  c->text_size = 256; /* the longest word of an enum, and any number */
  c->columns = calloc(MOST_PARTS * (c->sweep.count + c->group.count) + 1, sizeof *c->columns);
  if (!c->columns)
    return refuse(c->at->why, EXIT_RUN, "%s: out of memory", c->at->path);
  if (!has_rows_of(&c->group, axis))
    return refuse(c->at->why, EXIT_USAGE, "%s: group %s has no column with one value per row of %s", c->at->path,
                  c->group.name, axis);
  int code = strcmp(c->group.name, "sweep") != 0 ? add_columns(c, &c->sweep, axis) : 0;
  if (!code)
    code = add_columns(c, &c->group, axis);
  c->text = malloc(c->text_size);
  return code || c->text ? code : refuse(c->at->why, EXIT_RUN, "%s: out of memory", c->at->path);
}

/* --- printing --- */

/* Offset number `i`, read by the block. */
static int read_edge(csv *c, hsize_t i, int64_t *edge) {
  csv_owner *o = &c->owner;
  if (i >= o->offset->shape[0])
    return refuse(c->at->why, EXIT_FILES, "%s: %s ends before its rows do", c->at->path, o->offset->name);
  if (i / BLOCK * BLOCK != o->first) {
    o->first = i / BLOCK * BLOCK;
    const hsize_t left = o->offset->shape[0] - o->first;
    int code = reader_rows(c->at, o->offset, o->first, left < BLOCK ? left : BLOCK, (unsigned char *)o->edges);
    if (code)
      return code;
  }
  *edge = o->edges[i - o->first];
  return 0;
}

/* Prints the task of a row; rows come in order. */
static int print_owner(csv *c, hsize_t row) {
  csv_owner *o = &c->owner;
  while (o->end <= (int64_t)row) {
    o->task++; /* from before the first, which wraps to 0 */
    int code = read_edge(c, o->task + 1, &o->end);
    if (code)
      return code;
  }
  printf("%llu,", (unsigned long long)o->task);
  return 0;
}

static int print_block(csv *c, hsize_t first) {
  hsize_t count = c->rows - first < BLOCK ? c->rows - first : BLOCK;
  int code = 0;
  for (size_t k = 0; !code && k < c->count; k++)
    code = reader_rows(c->at, c->columns[k].set, first, count, c->columns[k].values);
  for (hsize_t i = 0; !code && i < count; i++) {
    if (c->owner.offset)
      code = print_owner(c, first + i);
    for (size_t k = 0; !code && k < c->count; k++) {
      const csv_column *from = &c->columns[k];
      reader_part(from->set, from->values + i * from->set->value_bytes, from->part, ALL_DIGITS, c->text, c->text_size);
      put_field(c->text);
      putchar(k + 1 < c->count ? ',' : '\n');
    }
  }
  return code;
}

static int print_columns(csv *c) {
  int code = 0;
  if (c->owner.offset)
    fputs("task,", stdout);
  for (size_t k = 0; k < c->count; k++) {
    reader_part_name(c->columns[k].set, c->columns[k].part, c->text, c->text_size);
    put_field(c->text);
    putchar(k + 1 < c->count ? ',' : '\n');
  }
  for (hsize_t first = 0; !code && !ferror(stdout) && first < c->rows; first += BLOCK)
    code = print_block(c, first);
  return text_out_finish(code, c->at->why);
}

int result_show_csv(const char *path, const char *group, message *why) {
  const file_place at = {path, why};
  csv c = {.at = &at};
  int code = reader_open(&at, path, &c.file);
  if (code)
    return code;
  if (group)
    split_name(&c, group);
  code = open_group(&c);
  if (!code)
    code = reader_group_open(&at, c.file, "sweep", &c.sweep);
  if (!code)
    code = choose_columns(&c);
  if (!code)
    code = print_columns(&c);
  for (size_t k = 0; k < c.count; k++)
    free(c.columns[k].values);
  free(c.columns);
  free(c.text);
  reader_group_clear(&c.group);
  reader_group_clear(&c.sweep);
  return hdf5_close(&at, c.file, code);
}

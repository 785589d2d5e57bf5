/* Tables of a result as CSV. */
#include "result.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdf5_call.h"
#include "reader.h"

enum {
  BLOCK = 4096,           /* rows read at a time, and offsets */
  BLOCK_BYTES = 16 << 20, /* of a data set, if a row is not larger */
  ALL_DIGITS = 17         /* a double printed with so many reads back as itself */
};

/* A data set in the table, with a block of its rows. */
typedef struct csv_set {
  const reader_set *set;
  int row_axes;          /* of its axes, 1 or 2: those that rows count along */
  uint64_t width;        /* values in a row */
  unsigned char *values; /* [block][width][value_bytes] */
} csv_set;

/* The task that a row of a ragged table belongs to, from the offsets of all tasks. */
typedef struct csv_owner {
  const reader_set *offset; /* NULL: no column `task` */
  uint64_t task;
  int64_t end;          /* of its rows */
  int64_t edges[BLOCK]; /* offsets from `first` on */
  uint64_t first;
} csv_owner;

typedef struct csv {
  const file_place *at;
  hid_t file;
  char name[256];              /* of the group asked for, "" for none */
  const char *axis;            /* asked for, or NULL */
  char outer[256], inner[256]; /* axes of the rows; inner: "" where there is one */
  uint64_t outer_rows, inner_rows, block;
  csv_owner owner;
  reader_group sweep, group;
  csv_set *sets; /* [count] */
  size_t count;
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

/* --- which rows --- */

static bool counts_along(const reader_set *s, int k, const char *axis) {
  char name[256];
  reader_axis(s, k, name);
  return s->type != READER_OTHER && s->rank > k && *name && strcmp(name, axis) == 0;
}

/* The first data set that has this axis in this place. */
static const reader_set *set_along(const reader_group *g, int k, const char *axis) {
  for (size_t i = 0; i < g->count; i++)
    if (counts_along(&g->sets[i], k, axis))
      return &g->sets[i];
  return NULL;
}

/* "GROUP" or "GROUP/AXIS". */
static void split_name(csv *c, const char *name) {
  const size_t length = strcspn(name, "/");
  snprintf(c->name, sizeof c->name, "%.*s", (int)length, name);
  c->axis = name[length] ? name + length + 1 : NULL;
}

/* The group asked for, or the first but /sweep with a row per task. */
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
    found = !code && (name || set_along(&c->group, 0, "task"));
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

/* "task, sample, impact_row": axes that rows can count along. */
static void known_axes(const reader_group *g, char *text, size_t size) {
  text[0] = '\0';
  for (size_t i = 0; i < g->count; i++)
    for (int k = 0; k < 2 && k < g->sets[i].rank; k++) {
      char axis[256], before[300], listed[1100];
      reader_axis(&g->sets[i], k, axis);
      snprintf(before, sizeof before, " %s,", axis);
      snprintf(listed, sizeof listed, " %s,", text);
      const size_t used = strlen(text);
      if (*axis && strcmp(axis, "task_edge") != 0 && !strstr(listed, before))
        snprintf(text + used, size - used, "%s%s", used ? ", " : "", axis);
    }
}

/* The axis asked for is the first of some data sets, or else the second. Without one it is `task`, or the first of a
 * group that has no row per task. */
static int choose_rows(csv *c) {
  const reader_set *s = NULL;
  const char *axis = c->axis ? c->axis : "task";
  if (!c->axis && !set_along(&c->group, 0, axis) && c->group.count > 0)
    s = &c->group.sets[0];
  else
    s = set_along(&c->group, 0, axis);
  if (!s && c->axis && (s = set_along(&c->group, 1, axis)))
    reader_axis(s, 1, c->inner);
  if (!s || s->rank < 1) {
    char known[1024];
    known_axes(&c->group, known, sizeof known);
    return refuse(c->at->why, EXIT_USAGE, "%s: group %s has no column with a row for each %s%s%s", c->at->path,
                  c->group.name, axis, *known ? "; its rows can be " : "", known);
  }
  reader_axis(s, 0, c->outer);
  c->outer_rows = s->shape[0];
  c->inner_rows = *c->inner ? s->shape[1] : 1;
  return 0;
}

/* The offsets of "impact_row" are those of "impact_offset". */
static void find_owner(csv *c) {
  static const char end[] = "_row";
  const size_t length = strlen(c->outer), stem = length > sizeof end ? length - (sizeof end - 1) : 0;
  for (size_t k = 0; stem > 0 && strcmp(c->outer + stem, end) == 0 && k < c->group.count; k++) {
    const reader_set *s = &c->group.sets[k];
    if (strncmp(s->name, c->outer, stem) == 0 && strcmp(s->name + stem, "_offset") == 0 && s->type == READER_INTEGER &&
        reader_is_column(s, "task_edge"))
      c->owner = (csv_owner){.offset = s, .task = UINT64_MAX, .first = UINT64_MAX};
  }
}

/* --- which columns --- */

static int add_set(csv *c, const reader_set *s, int row_axes) {
  const uint64_t inner = row_axes == 2 ? s->shape[1] : c->inner_rows;
  if (s->shape[0] != c->outer_rows || inner != c->inner_rows)
    return refuse(c->at->why, EXIT_FILES, "%s: %s has %llu rows, expected %llu", c->at->path, s->name,
                  (unsigned long long)(s->shape[0] * inner), (unsigned long long)(c->outer_rows * c->inner_rows));
  const size_t name = strlen(s->name) + 24 * (size_t)s->rank + sizeof ".r";
  c->sets[c->count++] = (csv_set){.set = s, .row_axes = row_axes, .width = reader_width(s, row_axes)};
  if (c->text_size < s->value_bytes + 1)
    c->text_size = s->value_bytes + 1;
  if (c->text_size < name)
    c->text_size = name;
  return 0;
}

/* Data sets of a group in the table: along both axes of the rows, or of swept parameters, which hold for all of a task.
 */
static int add_sets(csv *c, const reader_group *g) {
  const int row_axes = *c->inner && g == &c->group ? 2 : 1;
  int code = 0;
  for (size_t k = 0; !code && k < g->count; k++)
    if (counts_along(&g->sets[k], 0, c->outer) && (row_axes == 1 || counts_along(&g->sets[k], 1, c->inner)))
      code = add_set(c, &g->sets[k], row_axes);
  return code;
}

/* As many rows as the largest data set allows. */
static int allocate_blocks(csv *c) {
  c->block = BLOCK;
  for (size_t k = 0; k < c->count; k++) {
    const uint64_t bytes = c->sets[k].width * c->sets[k].set->value_bytes;
    while (c->block > 1 && bytes > BLOCK_BYTES / c->block)
      c->block /= 2;
  }
  bool enough = (c->text = malloc(c->text_size)) != NULL;
  for (size_t k = 0; enough && k < c->count; k++) {
    csv_set *s = &c->sets[k];
    s->values = calloc(c->block * (s->width ? s->width : 1), s->set->value_bytes);
    enough = s->values != NULL;
  }
  return enough ? 0 : refuse(c->at->why, EXIT_RUN, "%s: out of memory", c->at->path);
}

static int choose_columns(csv *c) {
  c->text_size = 256; /* the longest word of an enum, and any number */
  c->sets = calloc(c->sweep.count + c->group.count + 1, sizeof *c->sets);
  if (!c->sets)
    return refuse(c->at->why, EXIT_RUN, "%s: out of memory", c->at->path);
  int code = choose_rows(c);
  if (!code && strcmp(c->group.name, "sweep") != 0 && strcmp(c->outer, "task") == 0)
    code = add_sets(c, &c->sweep);
  if (!code)
    code = add_sets(c, &c->group);
  if (!code)
    find_owner(c);
  return code ? code : allocate_blocks(c);
}

/* --- printing --- */

/* "q[3]", "path[17][3]", "multipliers[0].r" of element `k` of a row. */
static void element_name(const csv *c, const csv_set *s, uint64_t k, int part) {
  size_t used = (size_t)snprintf(c->text, c->text_size, "%s", s->set->name);
  uint64_t behind = s->width;
  for (int axis = s->row_axes; axis < s->set->rank; axis++) {
    behind /= s->set->shape[axis];
    used += (size_t)snprintf(c->text + used, c->text_size - used, "[%llu]", (unsigned long long)(k / behind));
    k %= behind;
  }
  if (reader_parts(s->set) > 1)
    snprintf(c->text + used, c->text_size - used, part ? ".i" : ".r");
}

static void print_names(const csv *c) {
  const char *between = "";
  if (c->owner.offset || *c->inner)
    between = ",", fputs(c->owner.offset ? "task" : c->outer, stdout);
  if (*c->inner && c->owner.offset)
    printf(",%s", c->outer);
  if (*c->inner)
    printf(",%s", c->inner);
  for (size_t i = 0; i < c->count; i++)
    for (uint64_t k = 0; k < c->sets[i].width; k++)
      for (int part = 0; part < reader_parts(c->sets[i].set); part++) {
        fputs(between, stdout);
        between = ",";
        element_name(c, &c->sets[i], k, part);
        put_field(c->text);
      }
  putchar('\n');
}

/* Offset number `i`, read by the block. */
static int read_edge(csv *c, uint64_t i, int64_t *edge) {
  csv_owner *o = &c->owner;
  if (i >= o->offset->shape[0])
    return refuse(c->at->why, EXIT_FILES, "%s: %s ends before its rows do", c->at->path, o->offset->name);
  if (i / BLOCK * BLOCK != o->first) {
    o->first = i / BLOCK * BLOCK;
    const uint64_t left = o->offset->shape[0] - o->first;
    int code = reader_rows(c->at, o->offset, o->first, left < BLOCK ? left : BLOCK, (unsigned char *)o->edges);
    if (code)
      return code;
  }
  *edge = o->edges[i - o->first];
  return 0;
}

/* Prints what a row begins with: the task of a ragged table, whose rows come in order, and the indices of two axes. */
static int print_place(csv *c, uint64_t row, uint64_t inner, const char **between) {
  csv_owner *o = &c->owner;
  while (o->offset && o->end <= (int64_t)row) {
    o->task++; /* from before the first, which wraps to 0 */
    int code = read_edge(c, o->task + 1, &o->end);
    if (code)
      return code;
  }
  if (o->offset)
    printf("%llu", (unsigned long long)o->task);
  if (*c->inner)
    printf("%s%llu,%llu", o->offset ? "," : "", (unsigned long long)row, (unsigned long long)inner);
  *between = o->offset || *c->inner ? "," : "";
  return 0;
}

static void print_values(const csv *c, const csv_set *s, const unsigned char *row, const char **between) {
  for (uint64_t k = 0; k < s->width; k++)
    for (int part = 0; part < reader_parts(s->set); part++) {
      fputs(*between, stdout);
      *between = ",";
      reader_part(s->set, row + k * s->set->value_bytes, part, ALL_DIGITS, c->text, c->text_size);
      put_field(c->text);
    }
}

/* Rows [first, first + count) of the inner axis in one row of the outer; of a single axis the inner one is the row. */
static int print_block(csv *c, uint64_t row, uint64_t first, uint64_t count) {
  int code = 0;
  for (size_t k = 0; !code && k < c->count; k++) {
    csv_set *s = &c->sets[k];
    if (!*c->inner)
      code = s->width ? reader_rows(c->at, s->set, first, count, s->values) : 0;
    else if (s->row_axes == 2)
      code = s->width ? reader_part_of_row(c->at, s->set, row, first, count, s->values) : 0;
    else
      code = reader_rows(c->at, s->set, row, 1, s->values);
  }
  for (uint64_t i = 0; !code && i < count; i++) {
    const char *between = "";
    code = print_place(c, *c->inner ? row : first + i, first + i, &between);
    for (size_t k = 0; !code && k < c->count; k++) {
      const csv_set *s = &c->sets[k];
      const uint64_t at = *c->inner && s->row_axes == 1 ? 0 : i;
      print_values(c, s, s->values + at * s->width * s->set->value_bytes, &between);
    }
    putchar('\n');
  }
  return code;
}

static int print_rows(csv *c) {
  const uint64_t outer = *c->inner ? c->outer_rows : 1, inner = *c->inner ? c->inner_rows : c->outer_rows;
  int code = 0;
  print_names(c);
  for (uint64_t row = 0; !code && row < outer; row++)
    for (uint64_t first = 0; !code && !ferror(stdout) && first < inner; first += c->block)
      code = print_block(c, row, first, inner - first < c->block ? inner - first : c->block);
  return flush_output(code, c->at->why);
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
    code = print_rows(&c);
  for (size_t k = 0; k < c.count; k++)
    free(c.sets[k].values);
  free(c.sets);
  free(c.text);
  reader_group_clear(&c.group);
  reader_group_clear(&c.sweep);
  return hdf5_close(&at, c.file, code);
}

/* What `show` prints of a result: what is in it, or a table as CSV. */
#include "result.h"

#include <errno.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attribute.h"
#include "hdf5_call.h"
#include "reader.h"

enum {
  BLOCK = 4096,     /* rows read at a time */
  ROWS_SHOWN = 40,  /* of a table that has no row per task */
  DIGITS_SHOWN = 12 /* of numbers meant for people; --csv gives all */
};

/* Flushes what was printed. @returns `code`, or EXIT_FILES when that is 0 and something could not be printed */
static int finish_text(int code, message *why) {
  errno = 0;
  if ((fflush(stdout) == 0 && !ferror(stdout)) || code)
    return code;
  return refuse(why, EXIT_FILES, "ricochet: cannot write to standard output: %s",
                errno ? strerror(errno) : "an earlier failure");
}

/* --- the file as a whole --- */

static int show_line(const file_place *at, hid_t object, const char *label, const char *attribute) {
  char *text;
  int code = attribute_text(at, object, attribute, &text);
  if (!code && text[0])
    printf("%-10s %s\n", label, text);
  free(text);
  return code;
}

static int show_heading(const file_place *at, hid_t file) {
  char version[64], time[64], sha[64], *compiler = NULL;
  int64_t layout;
  int code = attribute_text_into(at, file, "creator_version", version, sizeof version);
  if (!code)
    code = attribute_text_into(at, file, "file_time", time, sizeof time);
  if (!code)
    code = attribute_text_into(at, file, "git_sha", sha, sizeof sha);
  if (!code)
    code = attribute_integer(at, file, "schema_version", &layout);
  if (!code)
    code = attribute_text(at, file, "compiler", &compiler);
  if (!code) {
    printf("%s: result of ricochet %s (schema %" PRId64 "), %s\n", at->path, version, layout, time);
    code = show_line(at, file, "title", "title");
  }
  if (!code)
    code = show_line(at, file, "command", "command");
  if (!code)
    printf("%-10s %s, %s\n", "built", sha, compiler);
  free(compiler);
  return code ? code : show_line(at, file, "with", "libraries");
}

static int show_run(const file_place *at, hid_t file) {
  char host[256];
  int64_t ranks, computed, resumed;
  double seconds;
  hid_t run = H5Gopen2(file, "run", H5P_DEFAULT);
  if (run < 0)
    return hdf5_refuse(at, "open /run");
  int code = attribute_text_into(at, run, "host", host, sizeof host);
  if (!code)
    code = attribute_integer(at, run, "ranks", &ranks);
  if (!code)
    code = attribute_integer(at, run, "tasks_computed", &computed);
  if (!code)
    code = attribute_integer(at, run, "tasks_resumed", &resumed);
  if (!code)
    code = attribute_number(at, run, "compute_seconds", &seconds);
  if (!code)
    printf("%-10s %" PRId64 " rank%s on %s, %" PRId64 " tasks computed in %.3g s, %" PRId64 " resumed\n", "run", ranks,
           ranks == 1 ? "" : "s", host, computed, seconds, resumed);
  return hdf5_close(at, run, code);
}

/* --- sweeps --- */

static int range_of(const file_place *at, const reader_set *s, double *low, double *high) {
  double values[BLOCK];
  *low = INFINITY;
  *high = -INFINITY;
  for (hsize_t first = 0; first < s->shape[0]; first += BLOCK) {
    hsize_t count = s->shape[0] - first < BLOCK ? s->shape[0] - first : BLOCK;
    int code = reader_rows(at, s, first, count, (unsigned char *)values);
    if (code)
      return code;
    for (hsize_t i = 0; i < count; i++) {
      *low = fmin(*low, values[i]);
      *high = fmax(*high, values[i]);
    }
  }
  return 0;
}

/* Number of points of each sweep, in the order of the data sets. */
static int read_grid(const file_place *at, hid_t file, size_t count, int64_t *grid) {
  int code = 0;
  hid_t attribute = H5I_INVALID_HID, space = H5I_INVALID_HID;
  HDF5_TRY(at, attribute = H5Aopen_by_name(file, "sweep", "grid", H5P_DEFAULT, H5P_DEFAULT), "read the grid of /sweep");
  HDF5_TRY(at, space = H5Aget_space(attribute), "read the grid of /sweep");
  if (H5Sget_simple_extent_npoints(space) != (hssize_t)count) {
    code = refuse(at->why, EXIT_FILES, "%s: the grid of /sweep does not fit its parameters", at->path);
    goto out;
  }
  HDF5_TRY(at, H5Aread(attribute, H5T_NATIVE_INT64, grid), "read the grid of /sweep");
out:
  code = hdf5_close(at, space, code);
  return hdf5_close(at, attribute, code);
}

static int show_sweeps(const file_place *at, hid_t file) {
  reader_group g;
  int64_t grid[STUDY_MAX_SWEEPS];
  int code = reader_group_open(at, file, "sweep", &g);
  if (!code && g.count > STUDY_MAX_SWEEPS)
    code = refuse(at->why, EXIT_FILES, "%s: %zu swept parameters, expected at most %d", at->path, g.count,
                  STUDY_MAX_SWEEPS);
  if (!code && g.count > 0)
    code = read_grid(at, file, g.count, grid);
  for (size_t k = 0; !code && k < g.count; k++) {
    double low, high;
    if (g.sets[k].type != READER_NUMBER || g.sets[k].rank != 1)
      continue;
    code = range_of(at, &g.sets[k], &low, &high);
    if (!code)
      printf("%-10s %s: %" PRId64 " values from %.*g to %.*g\n", k ? "" : "sweep", g.sets[k].name, grid[k],
             DIGITS_SHOWN, low, DIGITS_SHOWN, high);
  }
  reader_group_clear(&g);
  return code;
}

/* --- groups --- */

static void type_text(const reader_set *s, char *text, size_t size) {
  static const char *const names[] = {"float64", "int64", "complex128", "enum", "text", "other"};
  if (s->type == READER_TEXT)
    snprintf(text, size, "text %zu", s->value_bytes);
  else
    snprintf(text, size, "%s", names[s->type]);
}

/* "[task 15, particle 30]" */
static void shape_text(const reader_set *s, char *text, size_t size) {
  const char *axis = s->axes;
  snprintf(text, size, "[");
  for (int i = 0; i < s->rank; i++) {
    int length = (int)strcspn(axis, " ");
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%.*s %" PRIu64 "%s", i ? ", " : "", length, axis, (uint64_t)s->shape[i],
             i + 1 < s->rank ? "" : "]");
    axis += length;
    axis += *axis == ' ';
  }
}

typedef struct widths {
  int name, type, shape, units;
} widths;

static void widen(int *width, const char *text) {
  if ((int)strlen(text) > *width)
    *width = (int)strlen(text);
}

static void show_sets(const reader_group *g) {
  char type[64], shape[512];
  widths w = {0};
  for (size_t k = 0; k < g->count; k++) {
    type_text(&g->sets[k], type, sizeof type);
    shape_text(&g->sets[k], shape, sizeof shape);
    widen(&w.name, g->sets[k].name);
    widen(&w.type, type);
    widen(&w.shape, shape);
    widen(&w.units, g->sets[k].units);
  }
  printf("\n/%s\n", g->name);
  for (size_t k = 0; k < g->count; k++) {
    type_text(&g->sets[k], type, sizeof type);
    shape_text(&g->sets[k], shape, sizeof shape);
    const reader_set *s = &g->sets[k];
    const char *name = s->parameter[0] ? s->parameter : s->observed;
    printf("  %-*s  %-*s  %-*s  %-*s  %s%s%s\n", w.name, s->name, w.type, type, w.shape, shape, w.units, s->units,
           s->long_name, *name ? ": " : "", name);
  }
}

/* "outcome: admissible 14, grazing 1" */
static int show_counts(const file_place *at, const reader_set *s) {
  uint64_t counts[256] = {0};
  unsigned char values[BLOCK];
  for (hsize_t first = 0; first < s->shape[0]; first += BLOCK) {
    hsize_t count = s->shape[0] - first < BLOCK ? s->shape[0] - first : BLOCK;
    int code = reader_rows(at, s, first, count, values);
    if (code)
      return code;
    for (hsize_t i = 0; i < count; i++)
      counts[values[i]]++;
  }
  const char *between = "";
  printf("  %s:", s->name);
  for (int i = 0; i < 256; i++) {
    char word[256];
    if (counts[i] == 0)
      continue;
    reader_value(s, &(unsigned char){(unsigned char)i}, DIGITS_SHOWN, word, sizeof word);
    printf("%s %s %" PRIu64, between, word, counts[i]);
    between = ",";
  }
  printf("%s\n", between[0] ? "" : " none");
  return 0;
}

/* --- the rows of tables that have no row per task --- */

enum { CELL = 128 }; /* letters shown of a value */

static int read_cells(const file_place *at, const reader_set *s, hsize_t rows, char (*cells)[CELL]) {
  unsigned char *values = calloc(rows + 1, s->value_bytes);
  if (!values)
    return refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  int code = rows ? reader_rows(at, s, 0, rows, values) : 0;
  for (hsize_t i = 0; !code && i < rows; i++)
    reader_value(s, values + i * s->value_bytes, DIGITS_SHOWN, cells[i], CELL);
  free(values);
  return code;
}

/* Columns side by side, each as wide as its widest cell. @param cells  [columns][rows] */
static void show_cells(const reader_set *const *columns, size_t count, hsize_t rows, char (*cells)[CELL]) {
  for (hsize_t i = 0; i <= rows; i++) { /* row 0 holds the names */
    for (size_t k = 0; k < count; k++) {
      int width = 0;
      widen(&width, columns[k]->name);
      for (hsize_t j = 0; j < rows; j++)
        widen(&width, cells[k * rows + j]);
      printf("  %-*s", k + 1 < count ? width : 0, i ? cells[k * rows + i - 1] : columns[k]->name);
    }
    printf("\n");
  }
}

static int show_rows(const file_place *at, const reader_group *g, const char *axis) {
  const reader_set **columns = calloc(g->count + 1, sizeof *columns);
  size_t count = 0;
  for (size_t k = 0; columns && k < g->count; k++)
    if (reader_is_column(&g->sets[k], axis))
      columns[count++] = &g->sets[k];
  hsize_t total = count ? columns[0]->shape[0] : 0, rows = total < ROWS_SHOWN ? total : ROWS_SHOWN;
  char(*cells)[CELL] = calloc(count * rows + 1, CELL);
  int code = columns && cells ? 0 : refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  for (size_t k = 0; !code && k < count; k++)
    code = read_cells(at, columns[k], rows, cells + k * rows);
  if (!code && rows) {
    show_cells(columns, count, rows, cells);
    if (total > rows)
      printf("  ... %" PRIu64 " more\n", (uint64_t)(total - rows));
  }
  free(columns);
  free(cells);
  return code;
}

static int show_group(const file_place *at, hid_t file, const char *name) {
  reader_group g;
  char shown[256] = "task", axis[256];
  int code = reader_group_open(at, file, name, &g);
  if (!code && g.count > 0)
    show_sets(&g);
  for (size_t k = 0; !code && k < g.count; k++)
    if (g.sets[k].type == READER_WORD && g.sets[k].rank == 1)
      code = show_counts(at, &g.sets[k]);
  for (size_t k = 0; !code && k < g.count; k++) {
    reader_row_axis(&g.sets[k], axis);
    if (strcmp(axis, "task") == 0 || strcmp(axis, "task_edge") == 0 || strcmp(axis, shown) == 0)
      continue; /* columns of a table follow one another; offsets say nothing to people */
    code = show_rows(at, &g, axis);
    strcpy(shown, axis);
  }
  reader_group_clear(&g);
  return code;
}

static int show_groups(const file_place *at, hid_t file) {
  reader_names names;
  int code = reader_list(at, file, true, &names);
  for (size_t i = 0; !code && i < names.count; i++)
    if (strcmp(names.at[i], "sweep") != 0)
      code = show_group(at, file, names.at[i]);
  reader_names_clear(&names);
  return code;
}

static int show_cards(const file_place *at, hid_t file, result_card *(*card_of)(const char *group)) {
  reader_names names;
  int code = reader_list(at, file, true, &names);
  for (size_t i = 0; !code && i < names.count; i++) {
    result_card *card = card_of(names.at[i]);
    code = card ? card(at, file) : 0;
  }
  reader_names_clear(&names);
  return code;
}

int result_show(const char *path, result_card *(*card_of)(const char *group), message *why) {
  const file_place at = {path, why};
  hid_t file;
  int code = reader_open(&at, path, &file);
  if (code)
    return code;
  code = show_heading(&at, file);
  if (!code)
    code = show_run(&at, file);
  if (!code)
    code = show_sweeps(&at, file);
  if (!code)
    code = show_cards(&at, file, card_of);
  if (!code)
    code = show_groups(&at, file);
  return hdf5_close(&at, file, finish_text(code, why));
}

/* --- tables as CSV --- */

enum {
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
  return finish_text(code, c->at->why);
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

/* What `show` prints of a result: what is in it. */
#include "result.h"

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
  DIGITS_SHOWN = 12 /* of numbers meant for people; CSV has all */
};

/* --- the file as a whole --- */

static int show_line(const file_place *at, hid_t object, const char *label, const char *attribute) {
  char *text, *shown = NULL;
  int code = attribute_text(at, object, attribute, &text);
  const size_t size = code ? 0 : 4 * strlen(text) + 5;
  if (!code && !(shown = malloc(size)))
    code = refuse(at->why, EXIT_RUN, "%s: out of memory", at->path);
  if (!code)
    escape_text(text, shown, size);
  if (!code && text[0])
    printf("%-10s %s\n", label, shown);
  free(shown);
  free(text);
  return code;
}

static int show_heading(const file_place *at, hid_t file) {
  char version[64], time[64], sha[64], compiler[256];
  int64_t layout;
  int code = attribute_text_into(at, file, "creator_version", version, sizeof version);
  if (!code)
    code = attribute_text_into(at, file, "file_time", time, sizeof time);
  if (!code)
    code = attribute_text_into(at, file, "git_sha", sha, sizeof sha);
  if (!code)
    code = attribute_integer(at, file, "schema_version", &layout);
  if (!code)
    code = attribute_text_into(at, file, "compiler", compiler, sizeof compiler);
  if (!code) {
    printf("%s: result of ricochet %s (schema %" PRId64 "), %s\n", at->path, version, layout, time);
    code = show_line(at, file, "title", "title");
  }
  if (!code)
    code = show_line(at, file, "command", "command");
  if (!code)
    printf("%-10s %s, %s\n", "built", sha, compiler);
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
    reader_axis(&g.sets[k], 0, axis);
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
  return hdf5_close(&at, file, flush_output(code, why));
}

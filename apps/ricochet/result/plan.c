#include "plan.h"

#include <stdlib.h>
#include <string.h>

/* --- the swept parameters as a table of their own, whose rows are computed where they are written --- */

static int read_sweep_rows(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  const plan *p = user;
  const table *t = &p->sweep;
  (void)why;
  for (uint64_t i = 0; i < count; i++)
    for (size_t k = 0; k < t->column_count; k++) {
      const double value = study_sweep_value(p->header->study, k, first + i);
      memcpy(rows + i * t->row_bytes + t->columns[k].offset, &value, sizeof value);
    }
  return 0;
}

static void lay_out_sweep(plan *p) {
  const study *s = p->header->study;
  p->sweep = (table){.group = "sweep", .row_axis = "task"};
  for (size_t k = 0; k < study_sweeps(s); k++) {
    const study_sweep *sweep = study_sweep_at(s, k);
    const study_key entry = sweep->key;
    p->sweep.columns[p->sweep.column_count++] = (column){
        .name = sweep->name,
        .type = COLUMN_F64,
        .units = entry->units ? entry->units : "1", /* dimensionless */
        .long_name = entry->doc,
        .source = "swept parameter of the study",
        .attributes = {{.name = "parameter", .text = sweep->name}},
    };
  }
  table_lay_out(&p->sweep);
  p->tables[p->table_count++] =
      (result_table){.layout = &p->sweep, .rows = study_tasks(s), .read = read_sweep_rows, .user = p};
}

/* --- axes --- */

static int add_scale(plan *p, const char *name, uint64_t extent, message *why) {
  for (size_t i = 0; i < p->scale_count; i++) {
    const plan_scale *scale = &p->scales[i];
    if (strcmp(scale->name, name) != 0)
      continue;
    if (scale->extent == extent)
      return 0;
    return refuse(why, EXIT_RUN, "axis %s = %llu in one column, %llu in another, expected one extent", name,
                  (unsigned long long)scale->extent, (unsigned long long)extent);
  }
  plan_scale *more = realloc(p->scales, (p->scale_count + 1) * sizeof *more);
  if (!more)
    return refuse(why, EXIT_RUN, "no memory for axis %s", name);
  p->scales = more;
  p->scales[p->scale_count++] = (plan_scale){.name = name, .extent = extent};
  return 0;
}

static int add_scales_of(plan *p, const result_table *t, message *why) {
  int code = add_scale(p, t->layout->row_axis, t->rows, why);
  for (size_t k = 0; !code && k < t->layout->column_count; k++) {
    const column *c = &t->layout->columns[k];
    for (int i = 0; !code && i < column_axes(c); i++)
      code = add_scale(p, c->axes[i], c->extents[i], why);
  }
  return code;
}

/* Axes and groups share the root group, and so must not share a name. */
static int check_names(const plan *p, message *why) {
  for (size_t i = 0; i < p->scale_count; i++) {
    bool taken = strcmp(p->scales[i].name, "run") == 0 || strcmp(p->scales[i].name, "study") == 0;
    for (size_t k = 0; k < p->table_count; k++)
      taken = taken || strcmp(p->scales[i].name, p->tables[k].layout->group) == 0;
    if (taken)
      return refuse(why, EXIT_RUN, "axis %s has the name of a group, expected another", p->scales[i].name);
  }
  return 0;
}

static int read_scale(void *user, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  (void)user;
  (void)why;
  for (uint64_t i = 0; i < count; i++) {
    const int64_t value = (int64_t)(first + i);
    memcpy(rows + i * sizeof value, &value, sizeof value);
  }
  return 0;
}

/* The tables of the scales, behind the others. */
static int lay_out_scales(plan *p, message *why) {
  result_table *more = realloc(p->tables, (p->table_count + p->scale_count) * sizeof *more);
  if (!more)
    return refuse(why, EXIT_RUN, "no memory for the axes");
  p->tables = more;
  p->stored_count = p->table_count;
  for (size_t i = 0; i < p->scale_count; i++) {
    plan_scale *scale = &p->scales[i];
    scale->layout = (table){.group = ".", .row_axis = scale->name, .column_count = 1};
    scale->layout.columns[0] = (column){.name = scale->name, .type = COLUMN_I64};
    table_lay_out(&scale->layout);
    p->tables[p->stored_count++] = (result_table){.layout = &scale->layout, .rows = scale->extent, .read = read_scale};
  }
  return 0;
}

/* --- the plan --- */

int plan_init(plan *p, const char *path, const result_header *header, const result_table *tables, size_t table_count,
              message *why) {
  *p = (plan){.header = header};
  p->partial = malloc(strlen(path) + sizeof ".tmp");
  p->tables = calloc(table_count + 1, sizeof *p->tables);
  if (!p->partial || !p->tables)
    return refuse(why, EXIT_RUN, "%s: out of memory", path);
  strcpy(p->partial, path);
  strcat(p->partial, ".tmp");
  for (size_t i = 0; i < table_count; i++)
    p->tables[p->table_count++] = tables[i];
  lay_out_sweep(p);
  int code = add_scale(p, "task", study_tasks(header->study), why);
  for (size_t i = 0; !code && i < p->table_count; i++)
    code = add_scales_of(p, &p->tables[i], why);
  if (!code)
    code = check_names(p, why);
  return code ? code : lay_out_scales(p, why);
}

void plan_clear(plan *p) {
  free(p->partial);
  free(p->tables);
  free(p->scales);
  *p = (plan){0};
}

/* --- blocks and chunks --- */

/* Largest power of two not above `limit`, which is at least 1. */
static uint64_t power_of_two(uint64_t limit) {
  uint64_t power = 1;
  while (power <= limit / 2)
    power *= 2;
  return power;
}

uint64_t plan_block_rows(const table *t) {
  uint64_t fit = t->row_bytes ? PLAN_BLOCK_BYTES / t->row_bytes : PLAN_BLOCK_BYTES;
  return fit ? power_of_two(fit) : 1;
}

int plan_shape(const column *c, uint64_t rows, uint64_t shape[PLAN_MOST_AXES]) {
  const int further = column_axes(c);
  shape[0] = rows;
  for (int i = 0; i < further; i++)
    shape[1 + i] = c->extents[i];
  return 1 + further;
}

void plan_chunk(const table *t, const column *c, uint64_t rows, uint64_t chunk[PLAN_MOST_AXES]) {
  uint64_t fit = PLAN_CHUNK_BYTES / column_value_bytes(c);
  for (int i = column_axes(c) - 1; i >= 0; i--) { /* the last axis first: its values are contiguous */
    uint64_t values = c->extents[i] < fit ? c->extents[i] : fit;
    chunk[1 + i] = values ? values : 1;
    fit /= chunk[1 + i];
  }
  uint64_t height = power_of_two(fit ? fit : 1);
  uint64_t block = plan_block_rows(t);
  if (height > block)
    height = block;
  if (height > rows) /* then all rows are one block; HDF5 allows no chunk longer than the data set */
    height = rows;
  chunk[0] = height ? height : 1;
}

/* Indices: at most 24 bytes for a chunk, a few hundred for a data set (format of HDF5 1.10, "fixed array"). */
static uint64_t column_bytes_at_most(const table *t, const column *c, uint64_t rows) {
  uint64_t chunk[PLAN_MOST_AXES], shape[PLAN_MOST_AXES], chunks = 1, bytes = column_value_bytes(c);
  const int axes = plan_shape(c, rows, shape);
  plan_chunk(t, c, rows, chunk);
  for (int i = 0; i < axes; i++) {
    chunks *= (shape[i] + chunk[i] - 1) / chunk[i];
    bytes *= chunk[i];
  }
  return 1024 + chunks * (bytes + 4 + 24);
}

uint64_t plan_bytes(const plan *p) {
  uint64_t bytes = 0;
  for (size_t i = 0; i < p->stored_count; i++) {
    const result_table *t = &p->tables[i];
    for (size_t k = 0; k < t->layout->column_count; k++)
      bytes += column_bytes_at_most(t->layout, &t->layout->columns[k], t->rows);
  }
  return bytes;
}

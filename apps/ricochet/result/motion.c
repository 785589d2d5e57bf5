#include "motion.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reader.h"

/* A result being read. */
typedef struct source_file {
  place at;
  hid_t file;
  reader_group branch, sweep;
  const char *what; /* "special" or "point" */
} source_file;

static const reader_set *find(const reader_group *g, const char *name) {
  for (size_t i = 0; i < g->count; i++)
    if (strcmp(g->sets[i].name, name) == 0)
      return &g->sets[i];
  return NULL;
}

/* The set "<what>_<name>" of the points that are looked at. */
static const reader_set *find_of(const source_file *f, const char *name) {
  char full[64];
  snprintf(full, sizeof full, "%s_%s", f->what, name);
  return find(&f->branch, full);
}

static int refuse_set(const source_file *f, const char *name) {
  return refuse(f->at.why, EXIT_FILES, "%s: no sound data set %s in it", f->at.path, name);
}

/* Rows of a set with one number, or integer, per row. */
static int read_rows(const source_file *f, const reader_set *s, const char *name, hsize_t first, hsize_t count,
                     void *values) {
  if (!s || s->rank != 1 || s->value_bytes != 8 || (s->type != READER_NUMBER && s->type != READER_INTEGER) ||
      first + count > s->shape[0])
    return refuse_set(f, name);
  return count > 0 ? reader_rows(&f->at, s, first, count, values) : 0;
}

/* The range of rows that a task owns. */
static int read_range(const source_file *f, const char *what, uint64_t task, int64_t range[2]) {
  char name[64];
  snprintf(name, sizeof name, "%s_offset", what);
  const int code = read_rows(f, find(&f->branch, name), name, task, 2, range);
  return code || (range[0] >= 0 && range[1] >= range[0]) ? code : refuse_set(f, name);
}

/* --- the point --- */

static int read_vector(const source_file *f, const char *name, hsize_t row, double **values, size_t *count) {
  const reader_set *s = find_of(f, name);
  if (!s && strcmp(f->what, "point") == 0)
    return refuse(f->at.why, EXIT_USAGE, "%s: it holds no states of points, expected a result with branch.states: true",
                  f->at.path);
  if (!s || s->rank != 2 || s->type != READER_NUMBER || row >= s->shape[0] || s->shape[1] < 1)
    return refuse_set(f, name);
  *count = s->shape[1];
  *values = calloc(s->shape[1], sizeof **values);
  if (!*values)
    return refuse(f->at.why, EXIT_RUN, "%s: no memory for a state", f->at.path);
  return reader_row(&f->at, s, row, (unsigned char *)*values);
}

static int read_point(const source_file *f, hsize_t row, result_motion *m) {
  result_number *followed = &m->numbers[m->number_count++];
  const reader_set *parameter = find_of(f, "parameter");
  size_t speeds = 0;
  int code = read_rows(f, parameter, "parameter", row, 1, &followed->value);
  if (!code)
    code = read_rows(f, find_of(f, "period"), "period", row, 1, &m->period);
  if (!code)
    code = read_rows(f, find_of(f, "energy"), "energy", row, 1, &m->energy);
  if (!code)
    code = read_vector(f, "q", row, &m->q, &m->particles);
  if (!code)
    code = read_vector(f, "v", row, &m->v, &speeds);
  if (!code && speeds != m->particles)
    code = refuse_set(f, "v");
  if (!code)
    snprintf(followed->name, sizeof followed->name, "%.95s", parameter->long_name);
  return code;
}

static int read_impact(const source_file *f, hsize_t row, result_impact *impact) {
  const reader_set *side = find(&f->branch, "impact_side");
  signed char wall = 0;
  int64_t particle = 0;
  int code = read_rows(f, find(&f->branch, "impact_time"), "impact_time", row, 1, &impact->time);
  if (!code)
    code = read_rows(f, find(&f->branch, "impact_particle"), "impact_particle", row, 1, &particle);
  if (!code)
    code = side && side->rank == 1 && side->value_bytes == 1 && row < side->shape[0]
               ? reader_rows(&f->at, side, row, 1, (unsigned char *)&wall)
               : refuse_set(f, "impact_side");
  impact->particle = particle;
  impact->wall = wall != 0;
  return code;
}

static int read_impacts(const source_file *f, const result_where *where, result_motion *m) {
  char name[64];
  int64_t range[2], owner;
  snprintf(name, sizeof name, "impact_%s", f->what);
  int code = read_range(f, "impact", where->task, range);
  if (!code)
    m->impacts = calloc((size_t)(range[1] - range[0]) + 1, sizeof *m->impacts);
  if (!code && !m->impacts)
    code = refuse(f->at.why, EXIT_RUN, "%s: no memory for its impacts", f->at.path);
  for (int64_t row = range[0]; !code && row < range[1]; row++) {
    code = read_rows(f, find(&f->branch, name), name, (hsize_t)row, 1, &owner);
    if (!code && owner == (int64_t)where->index)
      code = read_impact(f, (hsize_t)row, &m->impacts[m->impact_count++]);
  }
  return code;
}

/* What else varies in the result. */
static int read_swept(const source_file *f, uint64_t task, result_motion *m) {
  int code = 0;
  for (size_t i = 0; i < f->sweep.count && m->number_count < RESULT_MOST_NUMBERS && !code; i++) {
    result_number *n = &m->numbers[m->number_count++];
    snprintf(n->name, sizeof n->name, "%.95s", f->sweep.sets[i].name);
    code = read_rows(f, &f->sweep.sets[i], n->name, task, 1, &n->value);
  }
  return code;
}

static int read_motion(const source_file *f, const result_where *where, result_motion *m) {
  const reader_set *outcome = find(&f->branch, "outcome");
  int64_t range[2] = {0};
  if (!outcome)
    return refuse(f->at.why, EXIT_FILES, "%s: no /branch/outcome in it: not a result of kind branch", f->at.path);
  if (where->task >= outcome->shape[0])
    return refuse(f->at.why, EXIT_USAGE, "%s: restart.task = %llu, expected a task from 0 to %llu", f->at.path,
                  (unsigned long long)where->task, (unsigned long long)outcome->shape[0] - 1);
  int code = read_range(f, f->what, where->task, range);
  const uint64_t count = (uint64_t)(range[1] - range[0]);
  if (!code && where->index >= count)
    code = refuse(f->at.why, EXIT_USAGE, "%s: restart.%s = %llu, but task %llu has %llu of them, counted from 0",
                  f->at.path, f->what, (unsigned long long)where->index, (unsigned long long)where->task,
                  (unsigned long long)count);
  if (!code)
    code = read_point(f, (hsize_t)range[0] + where->index, m);
  if (!code)
    code = read_impacts(f, where, m);
  return code ? code : read_swept(f, where->task, m);
}

int result_read_motion(const result_where *where, result_motion *m, message *why) {
  source_file f = {.at = {where->path, why}, .file = H5I_INVALID_HID, .what = where->special ? "special" : "point"};
  *m = (result_motion){0};
  int code = reader_open(&f.at, where->path, &f.file);
  if (code)
    return code;
  if (H5Lexists(f.file, "branch", H5P_DEFAULT) > 0)
    code = reader_group_open(&f.at, f.file, "branch", &f.branch);
  if (!code && H5Lexists(f.file, "sweep", H5P_DEFAULT) > 0)
    code = reader_group_open(&f.at, f.file, "sweep", &f.sweep);
  if (!code)
    code = read_motion(&f, where, m);
  reader_group_clear(&f.branch);
  reader_group_clear(&f.sweep);
  return hdf5_close(&f.at, f.file, code);
}

void result_motion_clear(result_motion *m) {
  free(m->q);
  free(m->v);
  free(m->impacts);
  *m = (result_motion){0};
}

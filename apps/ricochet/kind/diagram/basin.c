/* The attractors of a basin: which tasks have reached the same one is decided when all are done. */
#include <stdlib.h>
#include <string.h>

#include "diagram.h"

#define SOURCE .source = "[FN97] section 6"

typedef struct basin_label {
  long long attractor;
} basin_label;

typedef struct basin_attractor {
  long long period, tasks, first;
  const double *lowest;
} basin_attractor;

static const column task_columns[] = {
    COLUMN("attractor", INTEGER(basin_label, attractor),
           "which attractor the start comes to; -1: none, -2: one past the first 1000", SOURCE,
           .doc = "index of the attractor to which the start converges; -1 if it diverges or fails; -2: an attractor "
                  "that is not among the first 1000"),
};

static const column attractor_columns[] = {
    COLUMN("found_period", INTEGER(basin_attractor, period), "period of the attractor; 0: all without one", SOURCE,
           .doc = "its period; 0: all attractors without a period count as one"),
    COLUMN("found_tasks", INTEGER(basin_attractor, tasks), "number of starts that come to it", SOURCE,
           .doc = "number of starts that converge to it"),
    COLUMN("found_first", INTEGER(basin_attractor, first), "first task that does", SOURCE, .doc = "the first of them"),
    COLUMN("found_lowest", NUMBERS(basin_attractor, lowest),
           "state of it with the smallest observed number; of the first task", SOURCE, .axes = {"coordinate"},
           .doc = "`lowest` of that start. Cycles of equal period are one attractor if these states differ by less "
                  "than 1e-4 of their size"),
};

const column_list basin_attractor_lists[] = {
    {"basin", "task", COLUMNS(task_columns)},
    {"basin", "attractor_row", COLUMNS(attractor_columns), .doc = "The attractors:\n"},
    {0}};

/* The tables, and the attractors found so far. */
typedef struct sorting {
  const kind_plan *plan;
  size_t size;
  table tasks, attractors;
  unsigned char *labels; /* [tasks] rows */
  unsigned char *row;    /* of a task */
  ric_basin *basin;
} sorting;

static int lay_out(sorting *k, const study *s) {
  const table_axis axes[] = {{"coordinate", k->size}};
  table_add(&k->tasks, &basin_attractor_lists[0], axes, 1);
  table_lay_out(&k->tasks);
  table_add(&k->attractors, &basin_attractor_lists[1], axes, 1);
  table_lay_out(&k->attractors);
  k->labels = calloc(study_tasks(s), k->tasks.row_bytes);
  k->row = calloc(1, k->plan->rows.row_bytes);
  return k->labels && k->row && ric_basin_create(k->size, NULL, &k->basin, NULL) == RIC_OK ? 0 : -1;
}

/* @returns 0, or -1 without memory */
static int sort_task(sorting *k, uint64_t task) {
  diagram_row of = {0};
  int64_t label;
  row_load(&k->plan->rows, k->row, &of);
  const ric_attractor run = {
      .kind = (ric_attractor_kind)of.outcome, .period = (size_t)of.attractor_period, .lowest = of.lowest};
  if (ric_basin_add(k->basin, &run, &label, NULL) != RIC_OK)
    return -1;
  row_store(&k->tasks, k->labels + task * k->tasks.row_bytes, &(basin_label){(long long)label});
  return 0;
}

static int sort_all(sorting *k, const study *s, const row_source *done, ric_poll poll, message *why) {
  int code = 0;
  for (uint64_t task = 0; task < study_tasks(s) && !code; task++) {
    if (ric_poll_stops(poll))
      return refuse(why, EXIT_STOPPED, "%s: stopped at its attractors", study_name(s));
    code = done->read(done->user, task, 1, k->row, why);
    if (!code && sort_task(k, task) != 0)
      code = refuse(why, EXIT_RUN, "%s: no memory for the attractors", study_name(s));
  }
  return code;
}

/* @param found  set  @returns 0, or -1 without memory */
static int put_attractors(const sorting *k, records *found) {
  *found = (records){.record_bytes = k->attractors.row_bytes};
  for (size_t i = 0; i < ric_basin_count(k->basin); i++) {
    const ric_basin_attractor a = ric_basin_at(k->basin, i);
    unsigned char *row = records_add(found);
    if (!row)
      return -1;
    row_store(&k->attractors, row,
              &(basin_attractor){.period = (long long)a.period,
                                 .tasks = (long long)a.starts,
                                 .first = (long long)a.first,
                                 .lowest = a.lowest});
  }
  return 0;
}

int basin_attractors(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                     message *why) {
  sorting k = {.plan = plan, .size = diagram_state_size(s)};
  records found = {0};
  int code = lay_out(&k, s) == 0 ? sort_all(&k, s, done, poll, why)
                                 : refuse(why, EXIT_RUN, "%s: no memory for the attractors", study_name(s));
  if (!code && put_attractors(&k, &found) != 0)
    code = refuse(why, EXIT_RUN, "%s: no memory for the attractors", study_name(s));
  ric_basin_destroy(&k.basin);
  free(k.row);
  if (!code) {
    extra[0] = (extra_rows){.layout = k.tasks, .count = study_tasks(s), .rows = k.labels};
    extra[1] = (extra_rows){.layout = k.attractors, .count = found.count, .rows = found.bytes};
    return 0;
  }
  free(k.labels);
  records_clear(&found);
  return code;
}

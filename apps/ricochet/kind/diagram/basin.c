/* The attractors of a basin: tasks that come to the same one are found when all are done. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagram.h"

/* Cycles of one period whose states with the smallest observed number differ by less, relative to the largest number in
 * them, are one attractor: far more than what is left of a transient, far less than what parts two of them. */
static const double same = 1e-4;

/* Beyond the first ones, attractors are not told apart: every task is compared with all of them. */
enum { MOST_ATTRACTORS = 1000, LABEL_NONE = -1, LABEL_OTHER = -2 };

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
           "which attractor the start comes to; -1: none, -2: one past the first 1000", SOURCE),
};

static const column attractor_columns[] = {
    COLUMN("found_period", INTEGER(basin_attractor, period), "period of the attractor; 0: all without one", SOURCE),
    COLUMN("found_tasks", INTEGER(basin_attractor, tasks), "number of starts that come to it", SOURCE),
    COLUMN("found_first", INTEGER(basin_attractor, first), "first task that does", SOURCE),
    COLUMN("found_lowest", NUMBERS(basin_attractor, lowest),
           "state of it with the smallest observed number; of the first task", SOURCE, .axes = {"coordinate"}),
};

typedef struct sorting {
  const kind_plan *plan;
  size_t size;
  table tasks, attractors;
  unsigned char *labels; /* [tasks] rows */
  records found;
  unsigned char *row; /* of a task */
} sorting;

static bool is_near(const double *a, const double *b, size_t size) {
  double apart = 0, largest = 0;
  for (size_t i = 0; i < size; i++) {
    apart = fmax(apart, fabs(a[i] - b[i]));
    largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
  }
  return apart <= same * largest;
}

static unsigned char *attractor_at(const sorting *k, uint64_t i, basin_attractor *values) {
  unsigned char *row = k->found.bytes + i * k->attractors.row_bytes;
  row_load(&k->attractors, row, values);
  return row;
}

/* Index of the attractor of a task, the number of those found where it is a new one. */
static uint64_t find(const sorting *k, const diagram_row *of) {
  uint64_t i = 0;
  for (; i < k->found.count; i++) {
    basin_attractor known = {0};
    attractor_at(k, i, &known);
    if (known.period == of->attractor_period && (known.period == 0 || is_near(of->lowest, known.lowest, k->size)))
      break;
  }
  return i;
}

/* @returns 0, or -1 without memory */
static int add_attractor(sorting *k, uint64_t task, const diagram_row *of) {
  unsigned char *added = records_add(&k->found);
  if (!added)
    return -1;
  row_store(&k->attractors, added,
            &(basin_attractor){.period = of->attractor_period, .first = (long long)task, .lowest = of->lowest});
  return 0;
}

/* @returns 0, or -1 without memory */
static int sort_task(sorting *k, uint64_t task) {
  unsigned char *label = k->labels + task * k->tasks.row_bytes;
  diagram_row of = {0};
  row_load(&k->plan->rows, k->row, &of);
  if (of.outcome != RIC_ATTRACTOR_PERIODIC && of.outcome != RIC_ATTRACTOR_APERIODIC) {
    row_store(&k->tasks, label, &(basin_label){LABEL_NONE});
    return 0;
  }
  const uint64_t i = find(k, &of);
  row_store(&k->tasks, label, &(basin_label){i < MOST_ATTRACTORS ? (long long)i : LABEL_OTHER});
  if (i == MOST_ATTRACTORS)
    return 0;
  if (i == k->found.count && add_attractor(k, task, &of) != 0)
    return -1;
  basin_attractor found = {0};
  unsigned char *row = attractor_at(k, i, &found);
  found.tasks++;
  row_store(&k->attractors, row, &found);
  return 0;
}

static void lay_out(sorting *k, const study *s) {
  const table_axis axes[] = {{"coordinate", k->size}};
  k->tasks = (table){.group = "basin", .row_axis = "task"};
  table_add(&k->tasks, task_columns, sizeof task_columns / sizeof *task_columns, axes, 1);
  table_lay_out(&k->tasks);
  k->attractors = (table){.group = "basin", .row_axis = "attractor_row"};
  table_add(&k->attractors, attractor_columns, sizeof attractor_columns / sizeof *attractor_columns, axes, 1);
  table_lay_out(&k->attractors);
  k->found.record_bytes = k->attractors.row_bytes;
  k->labels = calloc(study_tasks(s), k->tasks.row_bytes);
  k->row = calloc(1, k->plan->rows.row_bytes);
}

static int sort_all(sorting *k, const study *s, const row_source *done, ric_poll poll, message *why) {
  int code = k->labels && k->row ? 0 : refuse(why, EXIT_RUN, "%s: no memory for the attractors", study_name(s));
  for (uint64_t task = 0; task < study_tasks(s) && !code; task++) {
    if (ric_poll_stops(poll))
      return refuse(why, EXIT_STOPPED, "%s: stopped at its attractors", study_name(s));
    code = done->read(done->user, task, 1, k->row, why);
    if (!code && sort_task(k, task) != 0)
      code = refuse(why, EXIT_RUN, "%s: no memory for the attractors", study_name(s));
  }
  return code;
}

int basin_attractors(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                     message *why) {
  sorting k = {.plan = plan, .size = diagram_state_size(s)};
  lay_out(&k, s);
  const int code = sort_all(&k, s, done, poll, why);
  free(k.row);
  if (!code) {
    extra[0] = (extra_rows){.layout = k.tasks, .count = study_tasks(s), .rows = k.labels};
    extra[1] = (extra_rows){.layout = k.attractors, .count = k.found.count, .rows = k.found.bytes};
    return 0;
  }
  free(k.labels);
  records_clear(&k.found);
  return code;
}

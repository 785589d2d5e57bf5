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
  const study *study;
  const kind_plan *plan;
  const row_source *done;
  table tasks, attractors;
  unsigned char *rows; /* [piece] of tasks */
  uint64_t piece;
  ric_basin *basin;
} sorting;

enum { PIECE_BYTES = 1 << 20 /* of rows read at a time; one row may be longer */ };

static void close_sorting(void **sorted) {
  sorting *k = *sorted;
  if (!k)
    return;
  ric_basin_destroy(&k->basin);
  free(k->rows);
  free(k);
  *sorted = NULL;
}

static int refuse_memory(const study *s, message *why) {
  return refuse(why, EXIT_RUN, "%s: no memory for the attractors", study_name(s));
}

static sorting *open_sorting(const study *s, const kind_plan *plan, const row_source *done) {
  sorting *k = calloc(1, sizeof *k);
  void *opened = k;
  const size_t size = diagram_state_size(s);
  const table_axis axes[] = {{"coordinate", size}};
  if (!k)
    return NULL;
  *k = (sorting){.study = s, .plan = plan, .done = done, .piece = 1 + PIECE_BYTES / plan->rows.row_bytes};
  k->rows = calloc(k->piece, plan->rows.row_bytes);
  table_add(&k->tasks, &basin_attractor_lists[0], axes, 1);
  table_lay_out(&k->tasks);
  table_add(&k->attractors, &basin_attractor_lists[1], axes, 1);
  table_lay_out(&k->attractors);
  if (!k->rows || ric_basin_create(size, NULL, &k->basin, NULL) != RIC_OK)
    close_sorting(&opened);
  return opened;
}

/* The run of the i-th of the tasks that have been read. */
static ric_attractor run_of(const sorting *k, uint64_t i) {
  diagram_row of = {0};
  row_load(&k->plan->rows, k->rows + i * k->plan->rows.row_bytes, &of);
  return (ric_attractor){
      .kind = (ric_attractor_kind)of.outcome, .period = (size_t)of.attractor_period, .lowest = of.lowest};
}

static int sort_piece(sorting *k, uint64_t first, uint64_t count, message *why) {
  const int code = k->done->read(k->done->user, first, count, k->rows, why);
  for (uint64_t i = 0; !code && i < count; i++) {
    const ric_attractor run = run_of(k, i);
    int64_t label;
    if (ric_basin_add(k->basin, &run, &label, NULL) != RIC_OK)
      return refuse_memory(k->study, why);
  }
  return code;
}

static int sort_all(sorting *k, ric_poll poll, message *why) {
  const uint64_t tasks = study_tasks(k->study);
  int code = 0;
  for (uint64_t first = 0; first < tasks && !code; first += k->piece) {
    if (ric_poll_stops(poll))
      return refuse(why, EXIT_STOPPED, "%s: stopped at its attractors", study_name(k->study));
    code = sort_piece(k, first, tasks - first < k->piece ? tasks - first : k->piece, why);
  }
  return code;
}

/* Which attractors tasks come to. There are as many rows as tasks, so no rank holds them. */
static int read_labels(void *sorted, uint64_t first, uint64_t count, unsigned char *rows, message *why) {
  sorting *k = sorted;
  int code = 0;
  for (uint64_t done = 0; !code && done < count; done += k->piece) {
    const uint64_t piece = count - done < k->piece ? count - done : k->piece;
    code = k->done->read(k->done->user, first + done, piece, k->rows, why);
    for (uint64_t i = 0; !code && i < piece; i++) {
      const ric_attractor run = run_of(k, i);
      row_store(&k->tasks, rows + (done + i) * k->tasks.row_bytes, &(basin_label){ric_basin_label(k->basin, &run)});
    }
  }
  return code;
}

static int put_attractors(const sorting *k, records *found, message *why) {
  *found = (records){.record_bytes = k->attractors.row_bytes};
  for (size_t i = 0; i < ric_basin_count(k->basin); i++) {
    const ric_basin_attractor a = ric_basin_at(k->basin, i);
    unsigned char *row = records_add(found);
    if (!row)
      return refuse_memory(k->study, why);
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
  records found = {0};
  sorting *k = open_sorting(s, plan, done);
  void *sorted = k;
  int code = k ? sort_all(k, poll, why) : refuse_memory(s, why);
  if (!code)
    code = put_attractors(k, &found, why);
  if (code) {
    records_clear(&found);
    close_sorting(&sorted);
    return code;
  }
  extra[0] = (extra_rows){
      .layout = k->tasks, .count = study_tasks(s), .read = read_labels, .from = sorted, .close = close_sorting};
  extra[1] = (extra_rows){.layout = k->attractors, .count = found.count, .rows = found.bytes};
  return 0;
}

/* Windows of a diagram: where along the last sweep the attractor keeps its period. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagram.h"
#include "model/grazing_map.h"

/* Names of what ends a window, of maps or of motions. @param count  set */
static const char *const *window_edge_names(const study *s, size_t *count) {
  static const char *const of_maps[RIC_GRAZING_EDGES + 1] = {
#define X(name, text) text,
      RIC_GRAZING_EDGE_LIST(X)
#undef X
          "none"};
  static const char *const of_motions[RIC_FAMILY_KINDS + 1] = {
#define X(name, text) text,
      RIC_FAMILY_LIST(X)
#undef X
          "none"};
  *count = model_has(s, MODEL_MAP) ? RIC_GRAZING_EDGES + 1 : RIC_FAMILY_KINDS + 1;
  return model_has(s, MODEL_MAP) ? of_maps : of_motions;
}

/* Index of the sweep that is followed: the last one. */
static size_t last_of(const iterated *it) {
  return study_sweeps(it->study) - 1;
}

#define SOURCE .source = "[FN97] section 6"

/* A row: the members that its columns name. */
typedef struct window_row {
  long long task, tasks, period, impacts;
  double parameter, low, high, low_outside, low_inside, high_inside, high_outside;
  ric_complex multiplier;
  double map_low, map_high;
  const char *reason;
  int low_kind, high_kind;
} window_row;

static const column columns[] = {
    COLUMN("task", INTEGER(window_row, task), "task from which it was followed", SOURCE),
    COLUMN("tasks", INTEGER(window_row, tasks), "number of tasks of the period, one after the other", SOURCE),
    COLUMN("period", INTEGER(window_row, period), "period of the attractor", SOURCE),
    COLUMN("impacts", INTEGER(window_row, impacts), "impacts in a period; -1: not located", SOURCE),
    COLUMN("parameter", NUMBER(window_row, parameter), "value of the last sweep at the task", SOURCE),
    COLUMN("low", NUMBER(window_row, low), "value at which the window begins, located on the cycle", SOURCE),
    COLUMN("high", NUMBER(window_row, high), "value at which it ends, located on the cycle", SOURCE),
    COLUMN("low_outside", NUMBER(window_row, low_outside),
           "below the window, as the attractor says; NaN: end of the sweep", SOURCE),
    COLUMN("low_inside", NUMBER(window_row, low_inside), "in the window, as the attractor says", SOURCE),
    COLUMN("high_inside", NUMBER(window_row, high_inside), "in the window, as the attractor says", SOURCE),
    COLUMN("high_outside", NUMBER(window_row, high_outside),
           "above the window, as the attractor says; NaN: end of the sweep", SOURCE),
    COLUMN("multiplier", COMPLEX(window_row, multiplier), "largest multiplier of the cycle", SOURCE),
    COLUMN("map_low", NUMBER(window_row, map_low),
           "closed form of the map, with one impact: along d exact, beyond grazing to leading order; else NaN", SOURCE),
    COLUMN("map_high", NUMBER(window_row, map_high),
           "closed form of the map, with one impact: along d exact, beyond grazing to leading order; else NaN", SOURCE),
    COLUMN("reason", TEXT(window_row, reason, DIAGRAM_REASON_BYTES), "why an edge is not located; empty where both are",
           SOURCE),
};

/* What ends a window has different names for maps and motions. */
static void lay_out(table *t, const study *s) {
  size_t count;
  const char *const *names = window_edge_names(s, &count);
  const column edge = {
      .type = COLUMN_ENUM, .names = names, .name_count = count, .long_name = "what ends it there", SOURCE};
  column low = edge, high = edge;
  low.name = "low_kind";
  low.member = COLUMN_MEMBER(window_row, low_kind, int, unsigned);
  high.name = "high_kind";
  high.member = COLUMN_MEMBER(window_row, high_kind, int, unsigned);
  *t = (table){.group = "window", .row_axis = "window_row"};
  table_add(t, columns, sizeof columns / sizeof *columns, NULL, 0);
  table_add(t, &low, 1, NULL, 0);
  table_add(t, &high, 1, NULL, 0);
  table_lay_out(t);
}

/* --- what the library asks --------------------------------------------------------------------------------------- */

/* The lines of a study, and the windows that have been found in them. */
typedef struct window_search {
  iterated it;
  const kind_plan *plan;
  const row_source *done;
  const study_sweep *sweep;  /* the last one */
  uint64_t line;             /* first task of the line at hand */
  unsigned char *row;        /* of a task */
  ric_attractor *attractors; /* [points] of the tasks of the line */
  double *ends;              /* [points][size] where they have ended */
  double *exponents;
  table layout;
  records found;
  message *why;
} window_search;

/* The attractor at a value. The line's first task says the rest. */
static ric_status run(double p, const double *start, ric_attractor *attractor, void *user, ric_error *error) {
  window_search *k = user;
  (void)error;
  attractor->exponents = k->exponents;
  study_values_at(k->it.values, k->line);
  study_values_sweep(k->it.values, last_of(&k->it), p);
  iterated_take(&k->it, 0, attractor->z);
  if (start)
    memcpy(attractor->z, start, k->it.size * sizeof *start);
  return iterated_run(&k->it, 1, attractor);
}

static ric_status map_at(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  iterated *it = user;
  study_values_sweep(it->values, last_of(it), p);
  *d = value_number(it->values, KEY_MODEL_D, 0);
  return grazing_map_read(map, it->values, error);
}

static ric_status put_parameter(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  iterated *it = user;
  study_values_sweep(it->values, last_of(it), *p);
  RIC_TRY(iterated_read_model(it, error));
  *given = iterated_period(&it->model);
  RIC_TRY(ric_system_set_lattice(system, &it->model.lattice, error));
  return ric_system_set_obstacles(system, it->model.obstacles, it->model.obstacle_count, error);
}

static ric_status locate_motion(iterated *it, double p, const double *z, double low, double high, ric_window *window,
                                ric_error *error) {
  const lattice_model *m = &it->model;
  ric_system *system = NULL;
  RIC_TRY(ric_system_create_lattice(&m->lattice, m->obstacles, m->obstacle_count, &system, error));
  const ric_family_problem problem = {
      .system = system,
      .motion = {.kind = RIC_MOTION_FORCED, .flow = it->section.trajectory.flow, .poll = it->poll},
      .set = put_parameter,
      .user = it,
      .parameters = 1,
      .given = it->section.period};
  const ric_status status =
      ric_window_locate_motion(&problem, p, it->section.phase * it->section.period, z, low, high, window, error);
  ric_system_destroy(&system);
  return status;
}

static ric_status locate(const double *z, double low, double high, ric_window *window, void *user, ric_error *error) {
  window_search *k = user;
  iterated *it = &k->it;
  const double p = k->sweep->values[window->point];
  const ric_map_line maps = {.size = it->size, .at = map_at, .user = it};
  double *start = calloc(it->size, sizeof *start);
  if (!start)
    return ric_fail(error, RIC_ENOMEM, "no memory");
  study_values_at(it->values, k->line + window->point);
  iterated_take(it, 0, start); /* the model of the task; its start is not wanted */
  free(start);
  return it->maps ? ric_window_locate_cycle(&maps, p, z, low, high, it->poll, window, error)
                  : locate_motion(it, p, z, low, high, window, error);
}

/* --- rows -------------------------------------------------------------------------------------------------------- */

/* The closed form, where it is for: one impact, along d. @param unit  of the parameter over d */
static void put_closed_form(const ric_grazing_map *map, double unit, window_row *row) {
  ric_grazing_window window = {0};
  if (ric_grazing_window_find(map, (size_t)row->period, &window, NULL) == RIC_OK && window.exists) {
    row->map_low = unit * window.low.d;
    row->map_high = unit * window.high.d;
  }
}

/* Along model.d it is exact, along grazing.beyond to leading order. */
static void add_closed_form(iterated *it, window_row *row) {
  const study_key key = study_sweep_at(it->study, last_of(it))->key;
  if (row->impacts != 1)
    return;
  if (it->beyond && key == KEY_GRAZING_BEYOND)
    put_closed_form(&it->beyond->map, -1 / (it->beyond->slope * it->beyond->parameter), row);
  if (!it->maps || key != KEY_MODEL_D)
    return;
  ric_grazing_map map = {0};
  double d;
  study_values_at(it->values, (uint64_t)row->task);
  if (map_at(row->parameter, &map, &d, it, NULL) == RIC_OK)
    put_closed_form(&map, 1, row);
  ric_grazing_map_clear(&map);
}

static int add_window(window_search *k, const ric_window *w) {
  const int none = k->it.maps ? (int)RIC_GRAZING_EDGES : (int)RIC_FAMILY_KINDS;
  unsigned char *record = records_add(&k->found);
  window_row row = {.task = (long long)(k->line + w->point),
                    .tasks = (long long)(w->last - w->first + 1),
                    .period = (long long)w->period,
                    .impacts = (long long)w->impacts,
                    .parameter = k->sweep->values[w->point],
                    .low = w->low,
                    .high = w->high,
                    .low_outside = w->low_outside,
                    .low_inside = w->low_inside,
                    .high_inside = w->high_inside,
                    .high_outside = w->high_outside,
                    .multiplier = w->largest,
                    .map_low = NAN,
                    .map_high = NAN,
                    .reason = w->reason,
                    .low_kind = w->located ? w->low_kind : none,
                    .high_kind = w->located ? w->high_kind : none};
  if (!record)
    return refuse(k->why, EXIT_RUN, "%s: no memory for the windows", study_name(k->it.study));
  add_closed_form(&k->it, &row);
  row_store(&k->layout, record, &row);
  return 0;
}

static int read_line(window_search *k) {
  for (size_t i = 0; i < k->sweep->points; i++) {
    diagram_row of = {0};
    double *end = k->ends + i * k->it.size;
    const int code = k->done->read(k->done->user, k->line + i, 1, k->row, k->why);
    if (code)
      return code;
    row_load(&k->plan->rows, k->row, &of);
    memcpy(end, of.end, k->it.size * sizeof *end);
    k->attractors[i] = (ric_attractor){
        .z = end, .kind = (ric_attractor_kind)of.outcome, .period = (size_t)of.attractor_period, .impacts = of.impacts};
  }
  return 0;
}

static int search_line(window_search *k) {
  ric_windows windows;
  ric_error error = {0};
  int code = read_line(k);
  if (code)
    return code;
  study_values_at(k->it.values, k->line);
  const ric_window_line line = {.points = k->sweep->points,
                                .p = k->sweep->values,
                                .attractors = k->attractors,
                                .size = k->it.size,
                                .measured = iterated_measured(&k->it),
                                .follow = value_flag(k->it.values, KEY_ITERATE_FOLLOW),
                                .run = run,
                                .locate = locate,
                                .user = k};
  const ric_status status = ric_windows_find(&line, &windows, &error);
  if (status == RIC_ESTOPPED)
    return refuse(k->why, EXIT_STOPPED, "%s: stopped at its windows", study_name(k->it.study));
  if (status != RIC_OK)
    return refuse(k->why, EXIT_RUN, "%s: %s", study_name(k->it.study), error.message);
  for (size_t i = 0; i < windows.count && !code; i++)
    code = add_window(k, &windows.windows[i]);
  ric_windows_clear(&windows);
  return code;
}

/* --- all of them -------------------------------------------------------------------------------------------------- */

static int set_up(window_search *k, const study *s, ric_poll poll) {
  const int code = iterated_init(&k->it, s, poll, k->why);
  if (code)
    return code;
  const size_t points = k->sweep->points;
  k->row = calloc(1, k->plan->rows.row_bytes);
  k->attractors = calloc(points, sizeof *k->attractors);
  k->ends = calloc(points * k->it.size, sizeof *k->ends);
  k->exponents = calloc((size_t)value_number(k->it.values, KEY_ITERATE_EXPONENTS, 0), sizeof *k->exponents);
  if (k->row && k->attractors && k->ends && k->exponents)
    return 0;
  return refuse(k->why, EXIT_RUN, "%s: no memory for the windows", study_name(s));
}

static int search_all(window_search *k, const study *s, ric_poll poll) {
  int code = set_up(k, s, poll);
  for (k->line = 0; !code && k->line < study_tasks(s); k->line += k->sweep->points)
    code = search_line(k);
  return code;
}

int diagram_windows(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                    message *why) {
  window_search k = {.plan = plan, .done = done, .why = why};
  if (!diagram_has_windows(s))
    return 0;
  k.sweep = study_sweep_at(s, study_sweeps(s) - 1);
  lay_out(&k.layout, s);
  k.found.record_bytes = k.layout.row_bytes;
  const int code = search_all(&k, s, poll);
  if (!code)
    *extra = (extra_rows){.layout = k.layout, .count = k.found.count, .rows = k.found.bytes};
  else
    records_clear(&k.found);
  iterated_clear(&k.it);
  free(k.row);
  free(k.attractors);
  free(k.ends);
  free(k.exponents);
  return code;
}

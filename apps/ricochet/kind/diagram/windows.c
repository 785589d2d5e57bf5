/* Windows of a diagram: where along the last sweep the attractor keeps its period. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagram.h"
#include "model/grazing_map.h"

static const char *const map_edge_names[RIC_GRAZING_EDGES + 1] = {
#define X(name, text) text,
    RIC_GRAZING_EDGE_LIST(X)
#undef X
        "none"};

static const char *const motion_edge_names[RIC_FAMILY_KINDS + 1] = {
#define X(name, text) text,
    RIC_FAMILY_LIST(X)
#undef X
        "none"};

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
    COLUMN("task", INTEGER(window_row, task), "task from which it was followed", SOURCE,
           .doc = "the task at which the continuation of its cycle started"),
    COLUMN("tasks", INTEGER(window_row, tasks), "number of tasks of the period, one after the other", SOURCE,
           .doc = "number of consecutive tasks with this period and number of impacts"),
    COLUMN("period", INTEGER(window_row, period), "period of the attractor", SOURCE, .doc = "period in iterates"),
    COLUMN("impacts", INTEGER(window_row, impacts), "impacts in a period; -1: not located", SOURCE,
           .doc = "impacts in a period; -1 where no edge was located"),
    COLUMN("parameter", NUMBER(window_row, parameter), "value of the last sweep at the task", SOURCE,
           .doc = "value of the last sweep at that task"),
    COLUMN("low", NUMBER(window_row, low), "value at which the window begins, located on the cycle", SOURCE,
           .doc = "the lower edge: where the continued cycle loses stability or reaches the border; NaN if not "
                  "located. The search extends beyond the sweep, from a tenth of its smallest to ten times its largest "
                  "value if these are positive"),
    COLUMN("high", NUMBER(window_row, high), "value at which it ends, located on the cycle", SOURCE,
           .doc = "the upper edge, likewise"),
    COLUMN("low_outside", NUMBER(window_row, low_outside),
           "below the window, as the attractor says; NaN: end of the sweep", SOURCE,
           .doc = "bracket of the lower edge on the attractors, to a relative width of 1/100, near zero to 1e-9 of a "
                  "step of the sweep: its value outside the window, NaN at an end of the sweep. With `iterate.follow` "
                  "each run starts from the previous one as in the line"),
    COLUMN("low_inside", NUMBER(window_row, low_inside), "in the window, as the attractor says", SOURCE,
           .doc = "the value of that bracket inside the window"),
    COLUMN("high_inside", NUMBER(window_row, high_inside), "in the window, as the attractor says", SOURCE,
           .doc = "bracket of the upper edge, likewise: its value inside the window"),
    COLUMN("high_outside", NUMBER(window_row, high_outside),
           "above the window, as the attractor says; NaN: end of the sweep", SOURCE,
           .doc = "its value outside the window; NaN at an end of the sweep"),
    COLUMN("multiplier", COMPLEX(window_row, multiplier), "largest multiplier of the cycle", SOURCE,
           .doc = "the largest multiplier of the cycle at the task"),
    COLUMN("map_low", NUMBER(window_row, map_low),
           "closed form of the map, with one impact: along d exact, beyond grazing to leading order; else NaN", SOURCE,
           .doc = "for cycles with one impact the lower edge in the closed form of the map: exact along `model.d`, to "
                  "leading order along `grazing.beyond`; NaN for all others"),
    COLUMN("map_high", NUMBER(window_row, map_high),
           "closed form of the map, with one impact: along d exact, beyond grazing to leading order; else NaN", SOURCE,
           .doc = "the upper edge, likewise"),
    COLUMN("reason", TEXT(window_row, reason, DIAGRAM_REASON_BYTES), "why an edge is not located; empty where both are",
           SOURCE),
};

/* What ends a window has different words for maps and motions. */
#define EDGES(words, what)                                                                                             \
  COLUMN("low_kind", WORD(window_row, low_kind, words), "what ends it there", SOURCE, .doc = what),                    \
      COLUMN("high_kind", WORD(window_row, high_kind, words), "what ends it there", SOURCE,                            \
             .doc = "what ends it at the upper edge, likewise")

static const column map_columns[] = {EDGES(
    map_edge_names,
    "of maps, what ends it at the lower edge: `border`: border collision, another iterate "
    "reaches the border; `open`: the window extends beyond the search; `none` if not located; `zero` is not used")};
static const column motion_columns[] = {EDGES(
    motion_edge_names,
    "of motions, the same in the words of `/branch/special_kind`; `regular`: the window extends beyond the search")};

enum { ALL_WINDOWS, WINDOWS_OF_MAPS, WINDOWS_OF_MOTIONS };

#define LIST .group = "window", .row_axis = "window_row"

const column_list diagram_window_lists[] = {
    [ALL_WINDOWS] = {LIST, COLUMNS(columns),
                     .doc = "With `windows: true`, one row for each window along the last sweep, in all lines of a "
                            "grid. A window gives one row even if\n"
                            "transients hide its period at some tasks:\n"},
    [WINDOWS_OF_MAPS] = {LIST, COLUMNS(map_columns)},
    [WINDOWS_OF_MOTIONS] = {LIST, COLUMNS(motion_columns)},
    {0}};

static void lay_out(table *t, const study *s) {
  static const char *const edges[] = {"parameter",   "low",          "high",    "low_outside", "low_inside",
                                      "high_inside", "high_outside", "map_low", "map_high"};
  const bool maps = model_has(s, MODEL_MAP);
  table_add(t, &diagram_window_lists[ALL_WINDOWS], NULL, 0);
  table_add(t, &diagram_window_lists[maps ? WINDOWS_OF_MAPS : WINDOWS_OF_MOTIONS], NULL, 0);
  for (size_t i = 0; i < sizeof edges / sizeof *edges; i++)
    table_put_parameter(t, edges[i], study_sweep_at(s, study_sweeps(s) - 1)->name);
  table_lay_out(t);
}

/* --- callbacks of the library ------------------------------------------------------------------------------------ */

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

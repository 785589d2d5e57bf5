/* Windows of a diagram: where along the last sweep the attractor keeps its period. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagram.h"
#include "model/grazing_map.h"
#include "iterated.h"

/* --- edges on the cycle --- */

/* A window. Numbers are NaN where its edges are not located. */
typedef struct window_edges {
  bool located;
  double low, high;
  int low_kind, high_kind;  /* words of window_edge_names */
  size_t impacts;           /* per cycle */
  ric_complex multiplier;   /* largest one where it was followed from */
  double map_low, map_high; /* the closed form of the map, with one impact: along model.d exact, along grazing.beyond to
                               leading order; NaN for all others */
  char reason[128];         /* why they are not located; "" where they are */
} window_edges;

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

/* --- of maps ------------------------------------------------------------------------------------------------------ */

static ric_status map_at(double p, ric_grazing_map *map, double *d, void *user, ric_error *error) {
  iterated *it = user;
  study_values_sweep(it->values, last_of(it), p);
  *d = value_number(it->values, KEY_MODEL_D, 0);
  return grazing_map_read(map, it->values, error);
}

/* The closed form, where it is for: one impact, along d. @param unit  of the parameter over d */
static ric_status add_closed_form(const ric_grazing_map *map, double unit, size_t period, window_edges *edges,
                                  ric_error *error) {
  ric_grazing_window window = {0};
  if (edges->impacts != 1)
    return RIC_OK;
  const ric_status status = ric_grazing_window_find(map, period, &window, error);
  if (status == RIC_OK && window.exists) {
    edges->map_low = unit * window.low.d;
    edges->map_high = unit * window.high.d;
  }
  return status == RIC_ENUMERIC ? RIC_OK : status; /* singular equations have no window */
}

static ric_status add_exact(iterated *it, double p, size_t period, window_edges *edges, ric_error *error) {
  ric_grazing_map map = {0};
  double d;
  if (study_sweep_at(it->study, last_of(it))->key != KEY_MODEL_D)
    return RIC_OK;
  ric_status status = map_at(p, &map, &d, it, error);
  if (status == RIC_OK)
    status = add_closed_form(&map, 1, period, edges, error);
  ric_grazing_map_clear(&map);
  return status;
}

static ric_status find_of_map(iterated *it, size_t period, double p, double low, double high, double *z,
                              window_edges *edges, ric_error *error) {
  const ric_map_line line = {.size = it->size, .at = map_at, .user = it};
  ric_cycle_window window = {0};
  RIC_TRY(ric_cycle_find(&line, p, period, z, &window, error));
  RIC_TRY(ric_cycle_window_find(&line, p, period, low, high, 0, z, it->poll, &window, error));
  edges->low = window.low.p;
  edges->high = window.high.p;
  edges->low_kind = (int)window.low.kind;
  edges->high_kind = (int)window.high.kind;
  edges->impacts = window.impacts;
  edges->multiplier = window.largest;
  return add_exact(it, p, period, edges, error);
}

/* --- of motions --------------------------------------------------------------------------------------------------- */

static ric_status put_parameter(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  iterated *it = user;
  study_values_sweep(it->values, last_of(it), *p);
  RIC_TRY(iterated_read_model(it, error));
  *given = iterated_period(&it->model);
  RIC_TRY(ric_system_set_lattice(system, &it->model.lattice, error));
  return ric_system_set_obstacles(system, it->model.obstacles, it->model.obstacle_count, error);
}

/* Why the curve came to an end at no special point; "" where it came to one, or to the end of the search. */
static void put_reason(window_edges *edges, const ric_motion_window *window) {
  const bool at_low = window->low.reason[0] != '\0';
  const char *reason = at_low ? window->low.reason : window->high.reason;
  if (reason[0])
    snprintf(edges->reason, sizeof edges->reason, "%s: %.110s", at_low ? "low" : "high", reason);
}

static ric_status find_of_motion(iterated *it, size_t period, double p, double low, double high, const double *z,
                                 window_edges *edges, ric_error *error) {
  const lattice_model *m = &it->model;
  ric_motion_window window = {0};
  ric_system *system = NULL;
  ric_status status = ric_system_create_lattice(&m->lattice, m->obstacles, m->obstacle_count, &system, error);
  const ric_family_problem problem = {
      .system = system,
      .motion = {.kind = RIC_MOTION_FORCED, .flow = it->section.trajectory.flow, .poll = it->poll},
      .set = put_parameter,
      .user = it,
      .parameters = 1,
      .given = it->section.period};
  if (status == RIC_OK)
    status = ric_motion_window_find(&problem, period, p, low, high, it->section.phase * it->section.period, z,
                                    z + m->lattice.particles, NULL, &window, error);
  ric_system_destroy(&system);
  if (status != RIC_OK)
    return status;
  edges->low = window.low.p;
  edges->high = window.high.p;
  edges->low_kind = (int)window.low.kind;
  edges->high_kind = (int)window.high.kind;
  edges->impacts = window.impacts;
  edges->multiplier = window.largest;
  put_reason(edges, &window);
  if (!it->beyond || study_sweep_at(it->study, last_of(it))->key != KEY_GRAZING_BEYOND)
    return RIC_OK;
  return add_closed_form(&it->beyond->map, -1 / (it->beyond->slope * it->beyond->parameter), period, edges, error);
}

/* @param it  at the task to which the cycle belongs; its last sweep moves
 * @param p  value of the last sweep there  @param low, high  how far edges are looked for, around p
 * @param z  [size] a state of the attractor
 * @returns RIC_OK, also without edges; RIC_ESTOPPED */
static ric_status window_edges_find(iterated *it, size_t period, double p, double low, double high, const double *z,
                                    window_edges *edges) {
  ric_error error = {.message = "no memory"};
  double *state = calloc(it->size, sizeof *state);
  ric_status status = state ? RIC_OK : RIC_ENOMEM;
  *edges = (window_edges){.low = NAN,
                          .high = NAN,
                          .low_kind = it->maps ? (int)RIC_GRAZING_EDGES : (int)RIC_FAMILY_KINDS, /* none */
                          .high_kind = it->maps ? (int)RIC_GRAZING_EDGES : (int)RIC_FAMILY_KINDS,
                          .multiplier = {NAN, NAN},
                          .map_low = NAN,
                          .map_high = NAN};
  if (state) {
    iterated_take(it, 0, state); /* the model of the task; its start is not wanted */
    memcpy(state, z, it->size * sizeof *state);
    status = it->maps ? find_of_map(it, period, p, low, high, state, edges, &error)
                      : find_of_motion(it, period, p, low, high, state, edges, &error);
  }
  free(state);
  edges->located = status == RIC_OK;
  if (!edges->located)
    snprintf(edges->reason, sizeof edges->reason, "%.*s", (int)sizeof edges->reason - 1, error.message);
  return status == RIC_ESTOPPED ? status : RIC_OK;
}

/* Brackets on the attractor are this narrow, relative to the parameter; where they close in on zero, as at d = 0
 * itself, relative to the distance of the two values of the sweep. */
static const double bracket_width = 1e-2, bracket_least = 1e-9;

/* What is seen of an attractor. */
typedef struct sight {
  size_t period;   /* 0: no period */
  int64_t impacts; /* in a period; -1: too few iterates are measured to tell */
} sight;

/* A search for windows, and what it has found. */
typedef struct search {
  iterated it;
  const kind_plan *plan;
  const row_source *done;
  size_t sweep, points;  /* the last sweep */
  const double *values;  /* [points] of it */
  uint64_t line;         /* first task of the line at hand */
  sight *sights;         /* [points] of its tasks */
  unsigned char *row;    /* of a task */
  double *z, *exponents; /* [size] of attractors that are run here */
  bool goes_on;          /* the last of them has come to something */
  bool follows;          /* iterate.follow: brackets are followed as the line was */
  double *ends;          /* [points][size] where the tasks of the line have ended, NaN where they came to nothing */
  double *from;          /* [size] where the attractor that is followed has ended */
  table layout;
  records found;
  message *why;
} search;

/* Consecutive tasks of a line with one period and as many impacts. */
typedef struct span {
  size_t first, last;
  sight of;
} span;

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

/* --- on the attractor --------------------------------------------------------------------------------------------- */

static int read_row(const search *k, size_t point, diagram_row *values) {
  const int code = k->done->read(k->done->user, k->line + point, 1, k->row, k->why);
  if (!code)
    row_load(&k->plan->rows, k->row, values);
  return code;
}

/* Where periods are not measured as a whole, the rest counts for at most as many impacts as a period has. */
static sight sight_of(const search *k, size_t period, double impacts) {
  const double of_period = impacts * (double)period;
  const size_t measured = iterated_measured(&k->it);
  if (period == 0)
    return (sight){0};
  const bool tells = measured % period == 0 || (double)measured > 2 * (of_period + 1) * (double)period;
  return (sight){.period = period, .impacts = tells ? llround(of_period) : -1};
}

/* Whether two attractors may belong to one window. */
static bool are_alike(const sight *a, const sight *b) {
  return a->period == b->period && (a->impacts == b->impacts || a->impacts < 0 || b->impacts < 0);
}

/* The attractor at a value. The line's first task says the rest. @param from  [size] its start; NULL: the study's */
static ric_status look_at(search *k, double value, const double *from, sight *seen) {
  ric_attractor a = {.z = k->z, .exponents = k->exponents};
  study_values_at(k->it.values, k->line);
  study_values_sweep(k->it.values, k->sweep, value);
  iterated_take(&k->it, 0, k->z);
  if (from)
    memcpy(k->z, from, k->it.size * sizeof *from);
  RIC_TRY(iterated_run(&k->it, 1, &a));
  k->goes_on = a.kind == RIC_ATTRACTOR_PERIODIC || a.kind == RIC_ATTRACTOR_APERIODIC;
  *seen = sight_of(k, a.kind == RIC_ATTRACTOR_PERIODIC ? a.period : 0, a.impacts);
  return RIC_OK;
}

/* Halves the way from a value inside to one outside until it is narrow.
 * @param earlier  the point of the two from which a line that is followed comes to the edge */
static ric_status narrow(search *k, const span *w, size_t earlier, double *inside, double *outside) {
  const double least = bracket_least * fabs(*inside - *outside), *end = k->ends + earlier * k->it.size;
  const bool starts_inside = earlier >= w->first, follows = k->follows && !isnan(end[0]);
  memcpy(k->from, end, k->it.size * sizeof *end);
  while (fabs(*inside - *outside) > fmax(least, bracket_width * fmax(fabs(*inside), fabs(*outside)))) {
    const double middle = (*inside + *outside) / 2;
    sight there;
    RIC_TRY(look_at(k, middle, follows ? k->from : NULL, &there));
    const bool is_inside = are_alike(&there, &w->of);
    *(is_inside ? inside : outside) = middle;
    if (is_inside == starts_inside && k->goes_on)
      memcpy(k->from, k->z, k->it.size * sizeof *k->z);
  }
  return RIC_OK;
}

/* --- one window --------------------------------------------------------------------------------------------------- */

/* How far edges are looked for: well beyond the sweep, where the parameter does not change its sign. */
enum { BEYOND = 10 };
static void find_bounds(const search *k, double *low, double *high) {
  const double a = fmin(k->values[0], k->values[k->points - 1]), b = fmax(k->values[0], k->values[k->points - 1]);
  *low = a > 0 ? a / BEYOND : b < 0 ? a * BEYOND : a - (b - a);
  *high = b < 0 ? b / BEYOND : a > 0 ? b * BEYOND : b + (b - a);
}

/* Whether a window of the present line, among the first `count`, has been located around a value, with this period or a
 * part of it, and its impacts: near a flip the attractor is slow, and hides its period or returns only after two of
 * them. */
static bool is_known(const search *k, uint64_t count, const sight *of, double value) {
  for (uint64_t i = count; i-- > 0;) {
    window_row w = {0};
    row_load(&k->layout, k->found.bytes + i * k->layout.row_bytes, &w);
    if ((uint64_t)w.task < k->line)
      return false;
    const int64_t times = (int64_t)of->period / w.period;
    if ((int64_t)of->period == times * w.period && (of->impacts < 0 || of->impacts == times * w.impacts) &&
        w.low < value && w.high > value)
      return true;
  }
  return false;
}

/* Takes those out of the present line, from `first` on, that belong to a window that was found after them. */
static void drop_known(search *k, uint64_t first) {
  const table *t = &k->layout;
  uint64_t kept = first;
  for (uint64_t i = first; i < k->found.count; i++) {
    unsigned char *row = k->found.bytes + i * t->row_bytes;
    window_row w = {0};
    row_load(t, row, &w);
    const sight of = {.period = (size_t)w.period, .impacts = w.impacts};
    if (of.impacts < 0 && is_known(k, k->found.count, &of, w.parameter))
      continue;
    memmove(k->found.bytes + kept++ * t->row_bytes, row, t->row_bytes);
  }
  records_cut(&k->found, kept);
}

static void put_window(const search *k, unsigned char *row, const span *w, size_t point, const window_edges *e,
                       const double *bracket) {
  row_store(&k->layout, row,
            &(window_row){.task = (long long)(k->line + point),
                          .tasks = (long long)(w->last - w->first + 1),
                          .period = (long long)w->of.period,
                          .impacts = e->located ? (long long)e->impacts : -1,
                          .parameter = k->values[point],
                          .low = e->low,
                          .high = e->high,
                          .low_outside = bracket[0],
                          .low_inside = bracket[1],
                          .high_inside = bracket[2],
                          .high_outside = bracket[3],
                          .multiplier = e->multiplier,
                          .map_low = e->map_low,
                          .map_high = e->map_high,
                          .reason = e->reason,
                          .low_kind = e->low_kind,
                          .high_kind = e->high_kind});
}

/* Where it begins and ends on the attractor, in the order of the columns. */
static ric_status find_bracket(search *k, const span *w, double *bracket) {
  double first[2] = {k->values[w->first], NAN}, last[2] = {k->values[w->last], NAN}; /* inside, outside */
  if (w->first > 0) {
    first[1] = k->values[w->first - 1];
    RIC_TRY(narrow(k, w, w->first - 1, &first[0], &first[1]));
  }
  if (w->last + 1 < k->points) {
    last[1] = k->values[w->last + 1];
    RIC_TRY(narrow(k, w, w->last, &last[0], &last[1]));
  }
  const bool rises = k->values[k->points - 1] >= k->values[0];
  const double *low = rises ? first : last, *high = rises ? last : first;
  bracket[0] = low[1];
  bracket[1] = low[0];
  bracket[2] = high[0];
  bracket[3] = high[1];
  return RIC_OK;
}

/* @returns 0, or EXIT_RUN, EXIT_FILES, EXIT_STOPPED */
static int add_window(search *k, const span *w) {
  const size_t point = w->first + (w->last - w->first) / 2;
  double low, high, bracket[4];
  diagram_row of = {0};
  window_edges edges;
  if (is_known(k, k->found.count, &w->of, k->values[point]))
    return 0;
  const int code = read_row(k, point, &of);
  if (code)
    return code;
  find_bounds(k, &low, &high);
  ric_status status = find_bracket(k, w, bracket);
  study_values_at(k->it.values, k->line + point);
  if (status == RIC_OK)
    status = window_edges_find(&k->it, w->of.period, k->values[point], low, high, of.end, &edges);
  if (status != RIC_OK)
    return refuse(k->why, EXIT_STOPPED, "%s: stopped at its windows", study_name(k->it.study));
  unsigned char *row = records_add(&k->found);
  if (!row)
    return refuse(k->why, EXIT_RUN, "%s: no memory for the windows", study_name(k->it.study));
  put_window(k, row, w, point, &edges, bracket);
  return 0;
}

/* --- all of them -------------------------------------------------------------------------------------------------- */

/* From where a line that is followed goes on behind a task. */
static void put_end(search *k, size_t point, const diagram_row *of) {
  double *end = k->ends + point * k->it.size;
  memcpy(end, of->end, k->it.size * sizeof *end);
  if (of->outcome != RIC_ATTRACTOR_PERIODIC && of->outcome != RIC_ATTRACTOR_APERIODIC)
    end[0] = NAN;
}

static int read_line(search *k) {
  study_values_at(k->it.values, k->line);
  for (size_t i = 0; i < k->points; i++) {
    diagram_row of = {0};
    const int code = read_row(k, i, &of);
    if (code)
      return code;
    k->sights[i] = sight_of(k, (size_t)of.attractor_period, of.impacts);
    put_end(k, i, &of);
  }
  return 0;
}

static int search_line(search *k) {
  const uint64_t first = k->found.count;
  int code = read_line(k);
  for (size_t i = 0, next; i < k->points && !code; i = next) {
    for (next = i + 1; next < k->points && are_alike(&k->sights[next], &k->sights[i]);)
      next++;
    if (k->sights[i].period > 0)
      code = add_window(k, &(span){.first = i, .last = next - 1, .of = k->sights[i]});
  }
  drop_known(k, first);
  return code;
}

static int set_up(search *k, const study *s, ric_poll poll) {
  const int code = iterated_init(&k->it, s, poll, k->why);
  if (code)
    return code;
  const size_t exponents = (size_t)value_number(k->it.values, KEY_ITERATE_EXPONENTS, 0);
  k->sights = calloc(k->points, sizeof *k->sights);
  k->row = calloc(1, k->plan->rows.row_bytes);
  k->follows = value_flag(k->it.values, KEY_ITERATE_FOLLOW);
  k->ends = calloc(k->points * k->it.size, sizeof *k->ends);
  k->z = calloc(2 * k->it.size, sizeof *k->z);
  k->from = k->z ? k->z + k->it.size : NULL;
  k->exponents = calloc(exponents, sizeof *k->exponents);
  if (k->sights && k->row && k->ends && k->z && k->exponents)
    return 0;
  return refuse(k->why, EXIT_RUN, "%s: no memory for the windows", study_name(s));
}

static int search_all(search *k, const study *s, ric_poll poll) {
  int code = set_up(k, s, poll);
  for (k->line = 0; !code && k->line < study_tasks(s); k->line += k->points)
    code = search_line(k);
  return code;
}

int diagram_windows(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                    message *why) {
  search k = {.plan = plan, .done = done, .why = why};
  if (!diagram_has_windows(s))
    return 0;
  const study_sweep *last = study_sweep_at(s, study_sweeps(s) - 1);
  k.sweep = study_sweeps(s) - 1;
  k.points = last->points;
  k.values = last->values;
  lay_out(&k.layout, s);
  k.found.record_bytes = k.layout.row_bytes;
  const int code = search_all(&k, s, poll);
  if (!code)
    *extra = (extra_rows){.layout = k.layout, .count = k.found.count, .rows = k.found.bytes};
  else
    records_clear(&k.found);
  iterated_clear(&k.it);
  free(k.sights);
  free(k.row);
  free(k.ends);
  free(k.z);
  free(k.exponents);
  return code;
}

/* Windows of a diagram: where along the last sweep the attractor keeps its period. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagram.h"
#include "window_edges.h"

/* Brackets on the attractor are this narrow, relative to the parameter. */
static const double bracket_width = 1e-2;

/* A search for windows, and what it has found. */
typedef struct search {
  iterated it;
  const kind_plan *plan;
  const row_source *done;
  size_t sweep, points;  /* the last sweep */
  const double *values;  /* [points] of it */
  uint64_t line;         /* first task of the line at hand */
  int64_t *periods;      /* [points] of its tasks, 0: no period */
  unsigned char *row;    /* of a task */
  double *z, *exponents; /* [size] of attractors that are run here */
  table layout;
  records found;
  message *why;
} search;

/* Consecutive tasks of a line with one period. */
typedef struct span {
  size_t first, last;
  size_t period;
} span;

#define NUMBER  .type = COLUMN_F64, .units = "1"
#define INTEGER .type = COLUMN_I64, .units = "1"
#define SOURCE  .source = "[FN97] section 6"

static const column columns[] = {
    {.name = "task", INTEGER, .long_name = "task from which it was followed", SOURCE},
    {.name = "tasks", INTEGER, .long_name = "number of tasks of the period, one after the other", SOURCE},
    {.name = "period", INTEGER, .long_name = "period of the attractor", SOURCE},
    {.name = "impacts", INTEGER, .long_name = "impacts in a period; -1: not located", SOURCE},
    {.name = "parameter", NUMBER, .long_name = "value of the last sweep at the task", SOURCE},
    {.name = "low", NUMBER, .long_name = "value at which the window begins, located on the cycle", SOURCE},
    {.name = "high", NUMBER, .long_name = "value at which it ends, located on the cycle", SOURCE},
    {.name = "low_outside",
     NUMBER,
     .long_name = "below the window, as the attractor says; NaN: end of the sweep",
     SOURCE},
    {.name = "low_inside", NUMBER, .long_name = "in the window, as the attractor says", SOURCE},
    {.name = "high_inside", NUMBER, .long_name = "in the window, as the attractor says", SOURCE},
    {.name = "high_outside",
     NUMBER,
     .long_name = "above the window, as the attractor says; NaN: end of the sweep",
     SOURCE},
    {.name = "multiplier",
     .type = COLUMN_COMPLEX,
     .units = "1",
     .long_name = "largest multiplier of the cycle",
     SOURCE},
    {.name = "map_low",
     NUMBER,
     .long_name = "closed form of the map, with one impact: along d exact, beyond grazing to leading order; else NaN",
     SOURCE},
    {.name = "map_high",
     NUMBER,
     .long_name = "closed form of the map, with one impact: along d exact, beyond grazing to leading order; else NaN",
     SOURCE},
    {.name = "reason",
     .type = COLUMN_TEXT,
     .text_bytes = DIAGRAM_REASON_BYTES,
     .units = "1",
     .long_name = "why an edge is not located; empty where both are",
     SOURCE},
};

/* What ends a window has different names for maps and motions. */
static void lay_out(table *t, const study *s) {
  size_t count;
  const char *const *names = window_edge_names(s, &count);
  const column kinds[] = {{.name = "low_kind",
                           .type = COLUMN_ENUM,
                           .names = names,
                           .name_count = count,
                           .units = "1",
                           .long_name = "what ends it there",
                           SOURCE},
                          {.name = "high_kind",
                           .type = COLUMN_ENUM,
                           .names = names,
                           .name_count = count,
                           .units = "1",
                           .long_name = "what ends it there",
                           SOURCE}};
  *t = (table){.group = "window", .row_axis = "window_row"};
  table_add(t, columns, sizeof columns / sizeof *columns, NULL, 0);
  table_add(t, kinds, 2, NULL, 0);
  table_lay_out(t);
}

/* --- on the attractor --------------------------------------------------------------------------------------------- */

static int read_row(const search *k, size_t point) {
  return k->done->read(k->done->user, k->line + point, 1, k->row, k->why);
}

/* The period of the attractor at a value, 0: none. The line's first task says the rest. */
static ric_status period_at(search *k, double value, size_t *period) {
  ric_attractor a = {.z = k->z, .exponents = k->exponents};
  study_values_at(k->it.values, k->line);
  study_values_sweep(k->it.values, k->sweep, value);
  iterated_take(&k->it, 0, k->z);
  RIC_TRY(iterated_run(&k->it, 1, &a));
  *period = a.kind == RIC_ATTRACTOR_PERIODIC ? a.period : 0;
  return RIC_OK;
}

/* Halves the way from a value inside to one outside until it is narrow. */
static ric_status narrow(search *k, size_t period, double *inside, double *outside) {
  while (fabs(*inside - *outside) > bracket_width * fmax(fabs(*inside), fabs(*outside))) {
    const double middle = (*inside + *outside) / 2;
    size_t there;
    RIC_TRY(period_at(k, middle, &there));
    *(there == period ? inside : outside) = middle;
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

static int64_t integer_of(const table *t, const unsigned char *row, const char *name) {
  int64_t value;
  memcpy(&value, row + table_column(t, name)->offset, sizeof value);
  return value;
}

/* Whether a window of the present line, among the first `count`, has been located around a value, with this period or a
 * part of it: near a flip the attractor is slow, and hides its period or returns only after two of them. */
static bool is_known(const search *k, uint64_t count, size_t period, double value) {
  const table *t = &k->layout;
  for (uint64_t i = count; i-- > 0;) {
    unsigned char *row = k->found.bytes + i * t->row_bytes;
    if ((uint64_t)integer_of(t, row, "task") < k->line)
      return false;
    if (period % (size_t)integer_of(t, row, "period") == 0 && *row_numbers(row, table_column(t, "low")) < value &&
        *row_numbers(row, table_column(t, "high")) > value)
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
    const bool located = integer_of(t, row, "impacts") >= 0;
    const size_t period = (size_t)integer_of(t, row, "period");
    if (!located && is_known(k, k->found.count, period, *row_numbers(row, table_column(t, "parameter"))))
      continue;
    memmove(k->found.bytes + kept++ * t->row_bytes, row, t->row_bytes);
  }
  records_cut(&k->found, kept);
}

static void put_window(const search *k, unsigned char *row, const span *w, size_t point, const window_edges *e,
                       const double *bracket) {
  static const char *const brackets[] = {"low_outside", "low_inside", "high_inside", "high_outside"};
  const table *t = &k->layout;
  row_put_integer(row, table_column(t, "task"), (long long)(k->line + point));
  row_put_integer(row, table_column(t, "tasks"), (long long)(w->last - w->first + 1));
  row_put_integer(row, table_column(t, "period"), (long long)w->period);
  row_put_integer(row, table_column(t, "impacts"), e->located ? (long long)e->impacts : -1);
  row_put_number(row, table_column(t, "parameter"), k->values[point]);
  row_put_number(row, table_column(t, "low"), e->low);
  row_put_number(row, table_column(t, "high"), e->high);
  for (size_t i = 0; i < 4; i++)
    row_put_number(row, table_column(t, brackets[i]), bracket[i]);
  row_put_numbers(row, table_column(t, "multiplier"), &e->multiplier.re);
  row_put_number(row, table_column(t, "map_low"), e->map_low);
  row_put_number(row, table_column(t, "map_high"), e->map_high);
  row_put_text(row, table_column(t, "reason"), e->reason);
  row_put_word(row, table_column(t, "low_kind"), e->low_kind);
  row_put_word(row, table_column(t, "high_kind"), e->high_kind);
}

/* Where it begins and ends on the attractor, in the order of the columns. */
static ric_status find_bracket(search *k, const span *w, double *bracket) {
  double first[2] = {k->values[w->first], NAN}, last[2] = {k->values[w->last], NAN}; /* inside, outside */
  if (w->first > 0) {
    first[1] = k->values[w->first - 1];
    RIC_TRY(narrow(k, w->period, &first[0], &first[1]));
  }
  if (w->last + 1 < k->points) {
    last[1] = k->values[w->last + 1];
    RIC_TRY(narrow(k, w->period, &last[0], &last[1]));
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
  window_edges edges;
  if (is_known(k, k->found.count, w->period, k->values[point]))
    return 0;
  const int code = read_row(k, point);
  if (code)
    return code;
  find_bounds(k, &low, &high);
  ric_status status = find_bracket(k, w, bracket);
  study_values_at(k->it.values, k->line + point);
  if (status == RIC_OK)
    status = window_edges_find(&k->it, w->period, k->values[point], low, high,
                               row_numbers(k->row, table_column(&k->plan->rows, "end")), &edges);
  if (status != RIC_OK)
    return refuse(k->why, EXIT_STOPPED, "%s: stopped at its windows", study_name(k->it.study));
  unsigned char *row = records_add(&k->found);
  if (!row)
    return refuse(k->why, EXIT_RUN, "%s: no memory for the windows", study_name(k->it.study));
  put_window(k, row, w, point, &edges, bracket);
  return 0;
}

/* --- all of them -------------------------------------------------------------------------------------------------- */

static int read_line(search *k) {
  const column *period = table_column(&k->plan->rows, "attractor_period");
  for (size_t i = 0; i < k->points; i++) {
    const int code = read_row(k, i);
    if (code)
      return code;
    memcpy(&k->periods[i], k->row + period->offset, sizeof k->periods[i]);
  }
  return 0;
}

static int search_line(search *k) {
  const uint64_t first = k->found.count;
  int code = read_line(k);
  for (size_t i = 0, next; i < k->points && !code; i = next) {
    for (next = i + 1; next < k->points && k->periods[next] == k->periods[i];)
      next++;
    if (k->periods[i] > 0)
      code = add_window(k, &(span){.first = i, .last = next - 1, .period = (size_t)k->periods[i]});
  }
  drop_known(k, first);
  return code;
}

static int set_up(search *k, const study *s, ric_poll poll) {
  const int code = iterated_init(&k->it, s, poll, k->why);
  if (code)
    return code;
  const size_t exponents = (size_t)value_number(k->it.values, KEY_ITERATE_EXPONENTS, 0);
  k->periods = calloc(k->points, sizeof *k->periods);
  k->row = calloc(1, k->plan->rows.row_bytes);
  k->z = calloc(k->it.size, sizeof *k->z);
  k->exponents = calloc(exponents, sizeof *k->exponents);
  if (k->periods && k->row && k->z && k->exponents)
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
  if (!study_windows(s))
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
  free(k.periods);
  free(k.row);
  free(k.z);
  free(k.exponents);
  return code;
}

#include "orbits_special.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "chain_model.h"

enum { MOST_POINTS = 100000 };

static const char *const special_names[] = {"resonance", "singular"};

typedef struct special {
  int kind; /* index of special_names */
  double parameter;
  long mode, harmonic;
  int outcome; /* ric_outcome of the orbit exactly there */
} special;

/* The range of the one sweep, and along what it goes. */
typedef struct range {
  ric_along along;
  double low, high, period;
} range;

static range range_of(const study *s, const study_values *v) {
  const study_sweep *sweep = study_sweep_at(s, 0);
  range r = {.along = sweep->key == KEY_MODEL_GAMMA ? RIC_ALONG_GAMMA : RIC_ALONG_PERIOD,
             .low = sweep->values[0],
             .high = sweep->values[0],
             .period = value_number(v, KEY_ORBIT_PERIOD, 0)};
  for (size_t i = 1; i < sweep->points; i++) {
    r.low = sweep->values[i] < r.low ? sweep->values[i] : r.low;
    r.high = sweep->values[i] > r.high ? sweep->values[i] : r.high;
  }
  return r;
}

static ric_status count_resonances(const chain_model *m, const range *r, size_t *count, ric_error *error) {
  return ric_chain_resonances(&m->chain, r->along, r->period, r->low, r->high, NULL, 0, count, error);
}

int orbits_special_plan(const study *s, const study_values *v, message *why) {
  chain_model model = {0};
  size_t count = 0;
  char place[256];
  if (!value_flag(v, KEY_ORBIT_SPECIAL_POINTS) || chain_model_init(&model, v) != 0)
    return 0;
  range r = range_of(s, v);
  ric_error error;
  ric_status listed = count_resonances(&model, &r, &count, &error);
  chain_model_clear(&model);
  if (listed == RIC_OK && count <= MOST_POINTS)
    return 0;
  study_place(s, KEY_ORBIT_SPECIAL_POINTS, place, sizeof place);
  if (listed != RIC_OK)
    return refuse(why, EXIT_USAGE, "%s: %s", place, error.message);
  return refuse(why, EXIT_USAGE, "%s: %zu resonances in the range of the sweep, expected at most %d", place, count,
                MOST_POINTS);
}

/* What becomes of the orbit exactly there: most resonances do nothing to a pattern, and not every zero of the
 * determinant is driven. */
static ric_status judge(const chain_model *m, const ric_pattern *pattern, ric_orbit_solver *solver, const range *r,
                        special *list, size_t count, ric_error *error) {
  ric_orbit orbit;
  ric_chain chain = m->chain;
  ric_status status = ric_orbit_init(&orbit, chain.particles, ric_pattern_impacts(pattern), error);
  for (size_t i = 0; i < count && status == RIC_OK; i++) {
    if (r->along == RIC_ALONG_GAMMA)
      chain.gamma = list[i].parameter;
    status = ric_orbit_solve(solver, &chain, pattern, r->along == RIC_ALONG_GAMMA ? r->period : list[i].parameter,
                             &orbit, error);
    list[i].outcome = (int)orbit.outcome;
  }
  ric_orbit_clear(&orbit);
  return status;
}

static int by_parameter(const void *a, const void *b) {
  const special *x = a, *y = b;
  if (x->parameter != y->parameter)
    return x->parameter < y->parameter ? -1 : 1;
  if (x->kind != y->kind)
    return x->kind - y->kind;
  return x->mode < y->mode ? -1 : x->mode > y->mode;
}

/* Both lists: counted when the arrays are NULL, with counts of 0, and written when there is room for them. */
static ric_status fetch_points(const chain_model *m, const ric_pattern *pattern, ric_orbit_solver *solver,
                               const range *r, ric_resonance *resonances, size_t *poles, double *singular,
                               size_t *zeros, ric_error *error) {
  RIC_TRY(ric_chain_resonances(&m->chain, r->along, r->period, r->low, r->high, resonances, *poles, poles, error));
  return ric_orbit_singular_points(solver, &m->chain, pattern, r->along, r->period, r->low, r->high, singular, *zeros,
                                   zeros, error);
}

static void merge(const ric_resonance *resonances, size_t poles, const double *singular, size_t zeros, special *list) {
  for (size_t i = 0; i < poles; i++)
    list[i] = (special){.parameter = resonances[i].parameter,
                        .mode = (long)resonances[i].mode,
                        .harmonic = (long)resonances[i].harmonic};
  for (size_t i = 0; i < zeros; i++)
    list[poles + i] = (special){.kind = 1, .parameter = singular[i], .mode = -1};
  qsort(list, poles + zeros, sizeof *list, by_parameter);
}

/* Both lists merged into [count]; NULL on failure. */
static special *list_points(const chain_model *m, const ric_pattern *pattern, ric_orbit_solver *solver, const range *r,
                            size_t *count, ric_error *error) {
  size_t poles = 0, zeros = 0;
  if (fetch_points(m, pattern, solver, r, NULL, &poles, NULL, &zeros, error) != RIC_OK)
    return NULL;
  ric_resonance *resonances = calloc(poles + 1, sizeof *resonances);
  double *singular = calloc(zeros + 1, sizeof *singular);
  special *list = calloc(poles + zeros + 1, sizeof *list);
  bool fetched = resonances && singular && list &&
                 fetch_points(m, pattern, solver, r, resonances, &poles, singular, &zeros, error) == RIC_OK;
  if (fetched) {
    *count = poles + zeros;
    merge(resonances, poles, singular, zeros, list);
  } else {
    free(list);
    list = NULL;
  }
  free(resonances);
  free(singular);
  return list;
}

static const column columns[] = {
    {.name = "kind",
     .type = COLUMN_ENUM,
     .names = special_names,
     .name_count = 2,
     .units = "1",
     .long_name = "resonance of a mode, or zero of the contact determinant",
     .source = "[JAP] (11)-(12)"},
    {.name = "parameter",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "value of the swept parameter",
     .source = "[JAP] (11)-(12)"},
    {.name = "outcome",
     .type = COLUMN_ENUM,
     .names = orbit_outcome_names,
     .name_count = RIC_OUTCOME_COUNT,
     .units = "1",
     .long_name = "outcome of the orbit exactly there",
     .source = "[JAP] (9)"},
    {.name = "mode", .type = COLUMN_I64, .units = "1", .long_name = "resonant mode, else -1", .source = "[JAP] (12)"},
    {.name = "harmonic",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "oscillations of the mode per period, else 0",
     .source = "[JAP] (12)"},
};

static void lay_out(table *t) {
  *t = (table){.group = "special", .row_axis = "special_point"};
  for (size_t i = 0; i < sizeof columns / sizeof *columns; i++)
    t->columns[t->column_count++] = columns[i];
  table_lay_out(t);
}

static int fill(extra_rows *extra, const special *list, size_t count) {
  const table *t = &extra->layout;
  extra->rows = calloc(count + 1, t->row_bytes);
  if (!extra->rows)
    return -1;
  extra->count = count;
  for (size_t i = 0; i < count; i++) {
    unsigned char *row = extra->rows + i * t->row_bytes;
    row_put_word(row, table_column(t, "kind"), list[i].kind);
    row_put_number(row, table_column(t, "parameter"), list[i].parameter);
    row_put_word(row, table_column(t, "outcome"), list[i].outcome);
    row_put_integer(row, table_column(t, "mode"), list[i].mode);
    row_put_integer(row, table_column(t, "harmonic"), list[i].harmonic);
  }
  return 0;
}

int orbits_special(const study *s, ric_poll poll, extra_rows *extra, message *why) {
  *extra = (extra_rows){0};
  ric_error error = {.message = "out of memory"};
  chain_model model = {0};
  ric_pattern *pattern = NULL;
  ric_orbit_solver *solver = NULL;
  special *list = NULL;
  size_t count = 0;
  int done = 0;
  ric_orbit_options options = ric_orbit_options_default();
  options.poll = poll;
  study_values *v = study_values_create(s);
  if (v && !value_flag(v, KEY_ORBIT_SPECIAL_POINTS)) {
    study_values_destroy(&v);
    return 0;
  }
  if (v && chain_model_init(&model, v) == 0 && chain_model_pattern(v, &pattern, &error) == RIC_OK &&
      ric_orbit_solver_create(&options, &solver, &error) == RIC_OK) {
    range r = range_of(s, v);
    lay_out(&extra->layout);
    list = list_points(&model, pattern, solver, &r, &count, &error);
    done = list && judge(&model, pattern, solver, &r, list, count, &error) == RIC_OK && fill(extra, list, count) == 0;
  }
  free(list);
  ric_orbit_solver_destroy(&solver);
  ric_pattern_destroy(&pattern);
  chain_model_clear(&model);
  study_values_destroy(&v);
  return done ? 0
              : refuse(why, error.status == RIC_ESTOPPED ? EXIT_STOPPED : EXIT_RUN, "%s: special points: %s",
                       study_name(s), error.message);
}

#include "orbits.h"
#include "kind/pattern.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "model/chain.h"
#include "stability.h"

enum { MOST_POINTS = 100000 };

/* What a special point is: resonances and singular points, and the kinds of ric_critical_kind behind them. */
enum { SPECIAL_RESONANCE, SPECIAL_SINGULAR, SPECIAL_CRITICAL, SPECIAL_KINDS = SPECIAL_CRITICAL + RIC_CRITICAL_KINDS };
static const char *const special_names[SPECIAL_KINDS] = {"resonance", "singular",
#define X(name, text) text,
                                                         RIC_CRITICAL_LIST(X)
#undef X
};

/* What the number of multipliers outside the circle does as the parameter grows. */
enum { CHANGE_NONE, CHANGE_OUTWARDS, CHANGE_INWARDS, CHANGES };
static const char *const change_names[CHANGES] = {"none", "outwards", "inwards"};

typedef struct special {
  int kind; /* index of special_names */
  double parameter;
  long long mode, harmonic;
  int outcome; /* ric_outcome of the orbit exactly there */
  ric_complex multiplier;
  int change;
  double uncertainty;
} special;

/* The range of the one sweep, and along what it goes. */
typedef struct range {
  ric_along along;
  double low, high, period;
  size_t points;
} range;

/* A search for special points, and what it has found. */
typedef struct search {
  const chain_model *model;
  ric_pattern *pattern;
  ric_orbit_solver *solver;
  range range;
  special *list; /* [count] */
  size_t count;
} search;

static range range_of(const study *s, const study_values *v) {
  const study_sweep *sweep = study_sweep_at(s, 0);
  range r = {.along = sweep->key == KEY_MODEL_GAMMA ? RIC_ALONG_GAMMA : RIC_ALONG_PERIOD,
             .low = sweep->values[0],
             .high = sweep->values[0],
             .period = value_number(v, KEY_ORBIT_PERIOD, 0),
             .points = sweep->points};
  for (size_t i = 1; i < sweep->points; i++) {
    r.low = sweep->values[i] < r.low ? sweep->values[i] : r.low;
    r.high = sweep->values[i] > r.high ? sweep->values[i] : r.high;
  }
  return r;
}

static ric_status count_resonances(const chain_model *m, const range *r, size_t *count, ric_error *error) {
  return ric_chain_resonances(&m->chain, r->along, r->period, r->low, r->high, NULL, 0, count, error);
}

/* Critical parameters are looked for by the method that gives all multipliers. */
static int refuse_long_chain(const study *s, const study_values *v, message *why) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  char place[256];
  if (!stability_wanted(v) || n <= RIC_REDUCED_PARTICLES)
    return 0;
  study_place(s, KEY_ORBIT_SPECIAL_POINTS, place, sizeof place);
  return refuse(why, EXIT_USAGE,
                "%s = true with orbit.stable lists critical parameters of at most %d particles, and there are %.0f",
                place, RIC_REDUCED_PARTICLES, n);
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
    return refuse_long_chain(s, v, why);
  study_place(s, KEY_ORBIT_SPECIAL_POINTS, place, sizeof place);
  if (listed != RIC_OK)
    return refuse(why, EXIT_USAGE, "%s: %s", place, error.message);
  return refuse(why, EXIT_USAGE, "%s: %zu resonances in the range of the sweep, expected at most %d", place, count,
                MOST_POINTS);
}

/* --- finding them --- */

/* Makes room for more points. @returns the first of them, NULL when out of memory */
static special *extend(search *s, size_t more, ric_error *error) {
  special *list = realloc(s->list, (s->count + more + 1) * sizeof *list);
  if (!list) {
    ric_fail(error, RIC_ENOMEM, "no memory for %zu special points", s->count + more);
    return NULL;
  }
  s->list = list;
  for (size_t i = 0; i < more; i++)
    list[s->count + i] = (special){.mode = -1, .multiplier = {NAN, NAN}, .uncertainty = NAN};
  s->count += more;
  return list + s->count - more;
}

/* The lists of the library are fetched twice: for their number, and with room for it. */
static ric_status add_resonances(search *s, ric_error *error) {
  const range *r = &s->range;
  const ric_chain *chain = &s->model->chain;
  size_t count = 0;
  RIC_TRY(ric_chain_resonances(chain, r->along, r->period, r->low, r->high, NULL, 0, &count, error));
  ric_resonance *found = calloc(count + 1, sizeof *found);
  special *list = found ? extend(s, count, error) : NULL;
  ric_status status =
      list ? ric_chain_resonances(chain, r->along, r->period, r->low, r->high, found, count, &count, error)
           : RIC_ENOMEM;
  for (size_t i = 0; status == RIC_OK && i < count; i++) {
    list[i].kind = SPECIAL_RESONANCE;
    list[i].parameter = found[i].parameter;
    list[i].mode = (long)found[i].mode;
    list[i].harmonic = (long)found[i].harmonic;
  }
  free(found);
  return status;
}

static ric_status fetch_singular(const search *s, double *found, size_t *count, ric_error *error) {
  const range *r = &s->range;
  return ric_orbit_singular_points(s->solver, &s->model->chain, s->pattern, r->along, r->period, r->low, r->high, found,
                                   *count, count, error);
}

static ric_status add_singular(search *s, ric_error *error) {
  size_t count = 0;
  RIC_TRY(fetch_singular(s, NULL, &count, error));
  double *found = calloc(count + 1, sizeof *found);
  special *list = found ? extend(s, count, error) : NULL;
  ric_status status = list ? fetch_singular(s, found, &count, error) : RIC_ENOMEM;
  for (size_t i = 0; status == RIC_OK && i < count; i++) {
    list[i].kind = SPECIAL_SINGULAR;
    list[i].parameter = found[i];
  }
  free(found);
  return status;
}

/* The search is long: it is repeated only in the unlikely case of more than a few. Its grid is that of the sweep. */
static ric_status fetch_critical(const search *s, ric_critical **found, size_t *count, ric_error *error) {
  const range *r = &s->range;
  size_t room = 0;
  ric_status status = RIC_OK;
  *count = 64;
  *found = NULL;
  while (status == RIC_OK && *count > room) {
    room = *count;
    free(*found);
    *found = calloc(room, sizeof **found);
    if (!*found)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu critical parameters", room);
    status = ric_orbit_critical_points(s->solver, &s->model->chain, s->pattern, r->along, r->period, r->low, r->high,
                                       r->points, *found, room, count, error);
  }
  return status;
}

static ric_status add_critical(search *s, ric_error *error) {
  ric_critical *found;
  size_t count;
  ric_status status = fetch_critical(s, &found, &count, error);
  special *list = status == RIC_OK ? extend(s, count, error) : NULL;
  for (size_t i = 0; list && i < count; i++) {
    list[i].kind = SPECIAL_CRITICAL + (int)found[i].kind;
    list[i].parameter = found[i].parameter;
    list[i].multiplier = found[i].mu;
    list[i].change = found[i].outwards ? CHANGE_OUTWARDS : CHANGE_INWARDS;
    list[i].uncertainty = found[i].uncertainty;
  }
  free(found);
  return status == RIC_OK && !list ? RIC_ENOMEM : status;
}

/* What becomes of the orbit exactly there: most resonances do nothing to a pattern, and not every zero of the
 * determinant is driven. */
static ric_status judge(search *s, ric_error *error) {
  const range *r = &s->range;
  ric_orbit orbit;
  ric_chain chain = s->model->chain;
  ric_status status = ric_orbit_init(&orbit, chain.particles, ric_pattern_impacts(s->pattern), error);
  for (size_t i = 0; i < s->count && status == RIC_OK; i++) {
    if (r->along == RIC_ALONG_GAMMA)
      chain.gamma = s->list[i].parameter;
    status = ric_orbit_solve(s->solver, &chain, s->pattern,
                             r->along == RIC_ALONG_GAMMA ? r->period : s->list[i].parameter, &orbit, error);
    s->list[i].outcome = (int)orbit.outcome;
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

static ric_status find_all(search *s, bool critical, ric_error *error) {
  RIC_TRY(add_resonances(s, error));
  RIC_TRY(add_singular(s, error));
  if (critical && s->range.low < s->range.high) /* else nothing lies between */
    RIC_TRY(add_critical(s, error));
  if (s->count > 0)
    qsort(s->list, s->count, sizeof *s->list, by_parameter);
  return judge(s, error);
}

/* --- the table --- */

static const column columns[] = {
    COLUMN("kind", WORD(special, kind, special_names),
           "resonance of a mode, zero of the contact determinant, or where multipliers leave the circle or come back",
           .source = "[JAP] (11)-(12), (16)"),
    COLUMN("parameter", NUMBER(special, parameter), "value of the swept parameter", .source = "[JAP] (11)-(12)"),
    COLUMN("outcome", WORD(special, outcome, orbit_outcome_names), "outcome of the orbit exactly there",
           .source = "[JAP] (9)"),
    COLUMN("mode", INTEGER(special, mode), "resonant mode, else -1", .source = "[JAP] (12)"),
    COLUMN("harmonic", INTEGER(special, harmonic), "oscillations of the mode per period, else 0",
           .source = "[JAP] (12)"),
};

static const column critical_columns[] = {
    COLUMN("multiplier", COMPLEX(special, multiplier),
           "critical multiplier on the unit circle, in the upper half plane; NaN for other points",
           .source = "[JAP] (16)"),
    COLUMN("change", WORD(special, change, change_names), "way of the multipliers as the parameter grows",
           .source = "[JAP] (16)"),
    COLUMN("uncertainty", NUMBER(special, uncertainty),
           "of a critical parameter: half the width of its last bracket, or rounding; NaN for other points",
           .source = "[JAP] (16)"),
};

static void lay_out(table *t, bool critical) {
  *t = (table){.group = "special", .row_axis = "special_point"};
  table_add(t, columns, sizeof columns / sizeof *columns, NULL, 0);
  if (critical)
    table_add(t, critical_columns, sizeof critical_columns / sizeof *critical_columns, NULL, 0);
  table_lay_out(t);
}

static ric_status fill(extra_rows *extra, const search *s, ric_error *error) {
  const table *t = &extra->layout;
  extra->rows = calloc(s->count + 1, t->row_bytes);
  if (!extra->rows)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu special points", s->count);
  extra->count = s->count;
  for (size_t i = 0; i < s->count; i++)
    row_store(t, extra->rows + i * t->row_bytes, &s->list[i]);
  return RIC_OK;
}

/* --- for a study --- */

static ric_status set_up(search *s, chain_model *model, const study_values *v, ric_poll poll, ric_error *error) {
  ric_orbit_options options = ric_orbit_options_default();
  options.poll = poll;
  s->model = model;
  if (chain_model_init(model, v) != 0)
    return ric_fail(error, RIC_ENOMEM, "no memory for the floors");
  RIC_TRY(pattern_read(v, &s->pattern, error));
  return ric_orbit_solver_create(&options, &s->solver, error);
}

static int list_points(const study *s, const study_values *v, ric_poll poll, extra_rows *extra, message *why) {
  ric_error error = {.message = "out of memory"};
  chain_model model = {0};
  search found = {.range = range_of(s, v)};
  lay_out(&extra->layout, stability_wanted(v));
  ric_status status = set_up(&found, &model, v, poll, &error);
  if (status == RIC_OK)
    status = find_all(&found, stability_wanted(v), &error);
  if (status == RIC_OK)
    status = fill(extra, &found, &error);
  free(found.list);
  ric_orbit_solver_destroy(&found.solver);
  ric_pattern_destroy(&found.pattern);
  chain_model_clear(&model);
  if (status == RIC_OK)
    return 0;
  return refuse(why, status == RIC_ESTOPPED ? EXIT_STOPPED : EXIT_RUN, "%s: special points: %s", study_name(s),
                error.message);
}

int orbits_special(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                   message *why) {
  (void)plan;
  (void)done;
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  int code = value_flag(v, KEY_ORBIT_SPECIAL_POINTS) ? list_points(s, v, poll, extra, why) : 0;
  study_values_destroy(&v);
  return code;
}

#include "orbits.h"
#include "kind/pattern.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "model/chain.h"
#include "stability.h"

enum { MOST_POINTS = 100000 };

static const char *const special_names[RIC_SPECIAL_KINDS] = {
#define X(name, text) text,
    RIC_SPECIAL_LIST(X)
#undef X
};

/* What the number of multipliers outside the circle does as the parameter grows. */
enum { CHANGE_NONE, CHANGE_OUTWARDS, CHANGE_INWARDS, CHANGES };
static const char *const change_names[CHANGES] = {"none", "outwards", "inwards"};

/* A row: the members that its columns name. */
typedef struct special_row {
  int kind;
  double parameter;
  long long mode, harmonic;
  int outcome;
  ric_complex multiplier;
  int change;
  double uncertainty;
} special_row;

/* The range of the one sweep, and along what it goes; critical parameters are looked for on its grid. */
static ric_special_range range_of(const study *s, const study_values *v) {
  const study_sweep *sweep = study_sweep_at(s, 0);
  ric_special_range r = {.along = sweep->key == KEY_MODEL_GAMMA ? RIC_ALONG_GAMMA : RIC_ALONG_PERIOD,
                         .low = sweep->values[0],
                         .high = sweep->values[0],
                         .period = value_number(v, KEY_ORBIT_PERIOD, 0),
                         .points = stability_wanted(v) ? sweep->points : 0};
  for (size_t i = 1; i < sweep->points; i++) {
    r.low = sweep->values[i] < r.low ? sweep->values[i] : r.low;
    r.high = sweep->values[i] > r.high ? sweep->values[i] : r.high;
  }
  return r;
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
  const ric_special_range r = range_of(s, v);
  ric_error error;
  ric_status listed = ric_chain_resonances(&model.chain, r.along, r.period, r.low, r.high, NULL, 0, &count, &error);
  chain_model_clear(&model);
  if (listed == RIC_OK && count <= MOST_POINTS)
    return refuse_long_chain(s, v, why);
  study_place(s, KEY_ORBIT_SPECIAL_POINTS, place, sizeof place);
  if (listed != RIC_OK)
    return refuse(why, EXIT_USAGE, "%s: %s", place, error.message);
  return refuse(why, EXIT_USAGE, "%s: %zu resonances in the range of the sweep, expected at most %d", place, count,
                MOST_POINTS);
}

/* --- the table --- */

static const column columns[] = {
    COLUMN("kind", WORD(special_row, kind, special_names),
           "resonance of a mode, zero of the contact determinant, or where multipliers leave the circle or come back",
           .source = "[JAP] (11)-(12), (16)",
           .doc = "`resonance` of a mode, `singular` contact matrix; with `stable` or `multipliers` also the critical "
                  "parameters, at which multipliers leave the unit circle or return to it: `plus_one` and `minus_one`, "
                  "a pair at that point, and `collision` of two pairs. They are located between neighbours of a grid "
                  "with as many points as the sweep"),
    COLUMN("parameter", NUMBER(special_row, parameter), "value of the swept parameter", .source = "[JAP] (11)-(12)",
           .doc = "value of the swept parameter there, in increasing order"),
    COLUMN("outcome", WORD(special_row, outcome, orbit_outcome_names), "outcome of the orbit exactly there",
           .source = "[JAP] (9)",
           .doc = "outcome of the pattern's orbit exactly there: `grazing` or `resonant` if a resonance affects it, "
                  "`singular` if amplitudes blow up, `resonant` if the singular equations are solvable"),
    COLUMN("mode", INTEGER(special_row, mode), "resonant mode, else -1", .source = "[JAP] (12)",
           .doc = "the resonant mode; -1 for points that are no resonance"),
    COLUMN("harmonic", INTEGER(special_row, harmonic), "oscillations of the mode per period, else 0",
           .source = "[JAP] (12)", .doc = "its oscillations per period; 0 for points that are no resonance"),
};

static const column critical_columns[] = {
    COLUMN("multiplier", COMPLEX(special_row, multiplier),
           "critical multiplier on the unit circle, in the upper half plane; NaN for other points",
           .source = "[JAP] (16)"),
    COLUMN("change", WORD(special_row, change, change_names), "way of the multipliers as the parameter grows",
           .source = "[JAP] (16)",
           .doc = "`outwards`: the number of multipliers outside the unit circle increases with the parameter; "
                  "`inwards`: it decreases; `none` for other points"),
    COLUMN("uncertainty", NUMBER(special_row, uncertainty),
           "of a critical parameter: half the width of its last bracket, or rounding; NaN for other points",
           .source = "[JAP] (16)",
           .doc = "of a critical parameter: half the width of its last bracket, or the rounding error in it; NaN for "
                  "other points"),
};

#define LIST .group = "special", .row_axis = "special_point"

const column_list orbits_special_lists[] = {
    {LIST, COLUMNS(columns), .doc = "With `special_points: true`, along the one swept parameter (gamma or period):\n"},
    {LIST, COLUMNS(critical_columns), .doc = "With `stable` or `multipliers`, too:\n"},
    {0}};

static void lay_out(table *t, const study *s, bool critical) {
  table_add(t, &orbits_special_lists[0], NULL, 0);
  if (critical)
    table_add(t, &orbits_special_lists[1], NULL, 0);
  table_put_parameter(t, "parameter", study_sweep_at(s, 0)->name);
  table_lay_out(t);
}

/* --- for a study --- */

/* The rows found so far. */
typedef struct special_rows {
  const table *layout;
  records found;
  bool full; /* there is no memory for more */
} special_rows;

static int add_row(const ric_special_point *p, void *user) {
  special_rows *rows = user;
  unsigned char *record = records_add(&rows->found);
  rows->full = !record;
  if (!record)
    return 1;
  row_store(rows->layout, record,
            &(special_row){.kind = (int)p->kind,
                           .parameter = p->parameter,
                           .mode = p->mode < SIZE_MAX ? (long long)p->mode : -1,
                           .harmonic = (long long)p->harmonic,
                           .outcome = (int)p->outcome,
                           .multiplier = p->multiplier,
                           .change = p->change > 0   ? CHANGE_OUTWARDS
                                     : p->change < 0 ? CHANGE_INWARDS
                                                     : CHANGE_NONE,
                           .uncertainty = p->uncertainty});
  return 0;
}

static ric_status find_points(const study *s, const study_values *v, ric_poll poll, special_rows *rows,
                              ric_error *error) {
  chain_model model = {0};
  ric_pattern *pattern = NULL;
  ric_orbit_solver *solver = NULL;
  ric_orbit_options options = ric_orbit_options_default();
  ric_special_range range = range_of(s, v);
  options.poll = poll;
  ric_status status = chain_model_init(&model, v) == 0 ? pattern_read(v, &pattern, error)
                                                       : ric_fail(error, RIC_ENOMEM, "no memory for the floors");
  if (status == RIC_OK)
    status = ric_orbit_solver_create(&options, &solver, error);
  range.chain = &model.chain;
  range.pattern = pattern;
  if (status == RIC_OK)
    status = ric_orbit_special_points(solver, &range, add_row, rows, error);
  ric_orbit_solver_destroy(&solver);
  ric_pattern_destroy(&pattern);
  chain_model_clear(&model);
  return status;
}

static int list_points(const study *s, const study_values *v, ric_poll poll, extra_rows *extra, message *why) {
  ric_error error = {.message = "out of memory"};
  lay_out(&extra->layout, s, stability_wanted(v));
  special_rows rows = {.layout = &extra->layout, .found = {.record_bytes = extra->layout.row_bytes}};
  ric_status status = find_points(s, v, poll, &rows, &error);
  if (rows.full)
    status = ric_fail(&error, RIC_ENOMEM, "no memory for %zu of them", (size_t)rows.found.count + 1);
  extra->count = rows.found.count;
  extra->rows = rows.found.bytes;
  if (status == RIC_OK)
    return 0;
  records_clear(&rows.found);
  extra->rows = NULL;
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

#include <string.h>

#include "diagram.h"
#include "kind/family/family_check.h"
#include "kind/fill.h"

#define SOURCE .source = "[FN97] section 6"
#define MAP    .source = "[FN97] (5.11)"

static const char *const outcome_names[RIC_ATTRACTOR_KINDS] = {
#define X(name, text) text,
    RIC_ATTRACTOR_LIST(X)
#undef X
};

/* Of both kinds, as `end_columns`. */
static const column row_columns[] = {
    COLUMN("outcome", WORD(diagram_row, outcome, outcome_names), "what the iterates come to", SOURCE,
           .doc = "`aperiodic`: no period up to the limit: chaos, a longer period, or a transient that is not over; "
                  "`diverged`: a number of the state exceeds 1e100; `failed`: a motion that cannot be continued, a "
                  "section that is not crossed, a model that the library does not accept, no grazing point"),
    COLUMN("reason", TEXT(diagram_row, reason, DIAGRAM_REASON_BYTES), "why they come to nothing; else empty", SOURCE,
           .doc = "why it diverged or failed, otherwise empty; with `grazing.beyond` also why there is no map"),
    COLUMN("attractor_period", INTEGER(diagram_row, attractor_period),
           "period of the attractor, 0: none up to period_limit", SOURCE,
           .doc = "period in iterates, 0: none up to the limit; attributes `period_limit` and `period_tol`: the states "
                  "return to within this fraction of their extent. Near the edges of windows convergence is slow, and "
                  "a period may not be detected"),
    COLUMN(
        "impacts", NUMBER(diagram_row, impacts), "impacts per iterate, on the average", SOURCE,
        .doc =
            "mean number of impacts per iterate over a period, or over `iterate.measure`; NaN if diverged or failed"),
};

/* Of diagrams. */
static const column diagram_columns[] = {
    COLUMN("lyapunov", NUMBER(diagram_row, lyapunov), "largest Lyapunov exponent per iterate", SOURCE,
           .doc = "with `lyapunov: true`: the largest exponent, natural logarithm per iterate, for a motion with "
                  "saltation at impacts; NaN if unknown"),
    COLUMN("exponents", NUMBERS(diagram_row, exponents), "Lyapunov exponents per iterate", SOURCE, .axes = {"exponent"},
           .doc = "with `exponents: 2` or more: all of them, largest first"),
    COLUMN("values", NUMBERS(diagram_row, values), "observed variable", SOURCE, .axes = {"iterate"},
           .doc = "unless `keep: 0`: the kept iterates of the observed number, whose name is the attribute "
                  "`observed`; NaN where there are none"),
    COLUMN("state", NUMBERS(diagram_row, state), "kept iterates", SOURCE, .axes = {"iterate", "coordinate"},
           .doc = "with `states: true`: the kept iterates"),
};

static const column end_columns[] = {
    COLUMN("end", NUMBERS(diagram_row, end), "state after all measured iterates", SOURCE, .axes = {"coordinate"},
           .doc = "the last measured iterate; if the task diverged, the last valid state"),
    COLUMN("lowest", NUMBERS(diagram_row, lowest), "state on the attractor with the smallest observed number", SOURCE,
           .axes = {"coordinate"},
           .doc = "the state on the attractor with the smallest observed number: on a cycle always the same state; NaN "
                  "if diverged or failed"),
};

/* Of diagrams beyond grazing. */
static const column beyond_columns[] = {
    COLUMN("parameter", NUMBER(diagram_row, parameter), "parameter that is followed", SOURCE,
           .doc = "value of `branch.parameter`; its key is the attribute `parameter`"),
    COLUMN("d", NUMBER(diagram_row, d), "how far the periodic motion would pass the obstacle, to first order", SOURCE,
           .doc = "penetration of the periodic motion without the obstacle, to first order: the d of the map"),
    COLUMN("map_period", INTEGER(diagram_row, map_period), "period of the attractor of the map, 0: none", MAP,
           .doc = "as `attractor_period`, of the return map with the same numbers of iterates"),
    COLUMN("map_impacts", NUMBER(diagram_row, map_impacts), "impacts per iterate of the map", MAP,
           .doc = "as `impacts`, of the map"),
    COLUMN("map_lyapunov", NUMBER(diagram_row, map_lyapunov), "its largest Lyapunov exponent per iterate", MAP,
           .doc = "with `lyapunov: true`: as `lyapunov`, of the map"),
    COLUMN("map_values", NUMBERS(diagram_row, map_values),
           "its iterates as values of the motion: beside the periodic one", MAP, .axes = {"iterate"},
           .doc = "unless `keep: 0`: iterates of the map, added to the periodic motion without the obstacle"),
    COLUMN("distance", NUMBER(diagram_row, distance),
           "between the values of the motion and of the map, over the extent of the latter", MAP,
           .doc = "unless `keep: 0`: Hausdorff distance of both sets of values, divided by the extent of those of the "
                  "map; infinite if that is zero, as for period 1"),
};

#define LIST(kind) .group = (kind), .row_axis = "task"

/* The last one is that of diagrams beyond grazing. */
enum { DIAGRAM_BEYOND = 3 };

const column_list diagram_lists[] = {
    {LIST("diagram"), COLUMNS(row_columns)},
    {LIST("diagram"), COLUMNS(diagram_columns)},
    {LIST("diagram"), COLUMNS(end_columns)},
    [DIAGRAM_BEYOND] = {LIST("diagram"), COLUMNS(beyond_columns),
                        .doc = "With `grazing.beyond`, for motions; NaN (`map_period` 0) if there is no map:\n"},
    {0}};

const column_list basin_lists[] = {{LIST("basin"), COLUMNS(row_columns)}, {LIST("basin"), COLUMNS(end_columns)}, {0}};

static size_t exponents_of(const study_values *v) {
  return value_flag(v, KEY_ITERATE_LYAPUNOV) ? (size_t)value_number(v, KEY_ITERATE_EXPONENTS, 0) : 0;
}

static bool is_basin(const study *s) {
  return study_is_kind(s, "basin");
}

void diagram_lay_out(const study *s, const study_values *v, table *rows) {
  const size_t exponents = exponents_of(v), keep = is_basin(s) ? 0 : (size_t)value_number(v, KEY_ITERATE_KEEP, 0);
  const bool states = keep > 0 && value_flag(v, KEY_ITERATE_STATES);
  table_axis axes[3];
  size_t count = 0;
  if (exponents > 1)
    axes[count++] = (table_axis){"exponent", exponents};
  if (keep > 0)
    axes[count++] = (table_axis){"iterate", keep};
  axes[count++] = (table_axis){"coordinate", diagram_state_size(s)};
  *rows = (table){0};
  for (const column_list *list = is_basin(s) ? basin_lists : diagram_lists; list->group; list++)
    if (list != &diagram_lists[DIAGRAM_BEYOND] || diagram_is_beyond(s))
      table_add(rows, list, axes, count);
  if (exponents == 0) {
    table_drop(rows, "lyapunov");
    table_drop(rows, "map_lyapunov");
  }
  if (!states)
    table_drop(rows, "state");
  if (keep == 0)
    table_drop(rows, "distance");
  if (diagram_is_beyond(s))
    table_put_parameter(rows, "parameter", family_followed(s)->name);
  table_put_text(rows, "values", "observed", value_word(v, KEY_ITERATE_OBSERVE));
  table_put_attribute(rows, "attractor_period", "period_limit", value_number(v, KEY_ITERATE_PERIOD_LIMIT, 0));
  table_put_attribute(rows, "attractor_period", "period_tol", value_number(v, KEY_ITERATE_PERIOD_TOL, 0));
  table_lay_out(rows);
}

ric_status diagram_begin_row(const table *layout, ric_poll stop, unsigned char *bytes, diagram_row *row,
                             ric_attractor *a) {
  *row = (diagram_row){0};
  if (!fill_zero(bytes, layout->row_bytes, stop))
    return RIC_ESTOPPED;
  row_load(layout, bytes, row);
  a->values = row->values;
  a->states = row->state;
  a->lowest = row->lowest;
  return RIC_OK;
}

void diagram_put_row(diagram_row *row, const ric_attractor *a) {
  row->outcome = (int)a->kind;
  row->reason = a->reason;
  row->attractor_period = (long long)a->period;
  row->impacts = a->impacts;
  row->end = a->z;
  row->lyapunov = a->exponents[0];
  row->exponents = a->exponents;
}

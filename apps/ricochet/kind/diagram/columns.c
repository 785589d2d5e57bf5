#include <math.h>
#include <string.h>

#include "diagram.h"

#define SOURCE .source = "[FN97] section 6"
#define MAP    .source = "[FN97] (5.11)"

static const char *const outcome_names[RIC_ATTRACTOR_KINDS] = {
#define X(name, text) text,
    RIC_ATTRACTOR_LIST(X)
#undef X
};

/* The columns of both kinds, in the order of the schema page. */
static const column columns[] = {
    COLUMN("outcome", WORD(diagram_row, outcome, outcome_names), "what the iterates come to", SOURCE),
    COLUMN("reason", TEXT(diagram_row, reason, DIAGRAM_REASON_BYTES), "why they come to nothing; else empty", SOURCE),
    COLUMN("attractor_period", INTEGER(diagram_row, attractor_period),
           "period of the attractor, 0: none up to period_limit", SOURCE),
    COLUMN("impacts", NUMBER(diagram_row, impacts), "impacts per iterate, on the average", SOURCE),
    COLUMN("lyapunov", NUMBER(diagram_row, lyapunov), "largest Lyapunov exponent per iterate", SOURCE),
    COLUMN("exponents", NUMBERS(diagram_row, exponents), "Lyapunov exponents per iterate", SOURCE,
           .axes = {"exponent"}),
    COLUMN("values", NUMBERS(diagram_row, values), NULL, SOURCE, .axes = {"iterate"}),
    COLUMN("state", NUMBERS(diagram_row, state), "kept iterates", SOURCE, .axes = {"iterate", "coordinate"}),
    COLUMN("end", NUMBERS(diagram_row, end), "state after all measured iterates", SOURCE, .axes = {"coordinate"}),
    COLUMN("lowest", NUMBERS(diagram_row, lowest), "state on the attractor with the smallest observed number", SOURCE,
           .axes = {"coordinate"}),
};

/* Of diagrams beyond grazing. */
static const column beyond_columns[] = {
    COLUMN("parameter", NUMBER(diagram_row, parameter), "branch.parameter", SOURCE),
    COLUMN("d", NUMBER(diagram_row, d), "how far the periodic motion would pass the obstacle, to first order", SOURCE),
    COLUMN("map_period", INTEGER(diagram_row, map_period), "period of the attractor of the map, 0: none", MAP),
    COLUMN("map_impacts", NUMBER(diagram_row, map_impacts), "impacts per iterate of the map", MAP),
    COLUMN("map_lyapunov", NUMBER(diagram_row, map_lyapunov), "its largest Lyapunov exponent per iterate", MAP),
    COLUMN("map_values", NUMBERS(diagram_row, map_values),
           "its iterates as values of the motion: beside the periodic one", MAP, .axes = {"iterate"}),
    COLUMN("distance", NUMBER(diagram_row, distance),
           "between the values of the motion and of the map, over the extent of the latter", MAP),
};

static size_t exponents_of(const study_values *v) {
  return value_flag(v, KEY_ITERATE_LYAPUNOV) ? (size_t)value_number(v, KEY_ITERATE_EXPONENTS, 0) : 0;
}

static size_t kept_of(const study *s, const study_values *v) {
  return strcmp(study_kind(s), "diagram") == 0 ? (size_t)value_number(v, KEY_ITERATE_KEEP, 0) : 0;
}

void diagram_lay_out(const study *s, const study_values *v, table *rows) {
  const size_t exponents = exponents_of(v), keep = kept_of(s, v);
  const bool states = keep > 0 && value_flag(v, KEY_ITERATE_STATES);
  table_axis axes[3];
  size_t count = 0;
  if (exponents > 1)
    axes[count++] = (table_axis){"exponent", exponents};
  if (keep > 0)
    axes[count++] = (table_axis){"iterate", keep};
  axes[count++] = (table_axis){"coordinate", diagram_state_size(s)};
  *rows = (table){.group = study_kind(s), .row_axis = "task"};
  table_add(rows, columns, sizeof columns / sizeof *columns, axes, count);
  if (diagram_is_beyond(s))
    table_add(rows, beyond_columns, sizeof beyond_columns / sizeof *beyond_columns, axes, count);
  if (exponents == 0) {
    table_drop(rows, "lyapunov");
    table_drop(rows, "map_lyapunov");
  }
  if (!states)
    table_drop(rows, "state");
  if (keep == 0)
    table_drop(rows, "distance");
  table_put_long_name(rows, "values", value_word(v, KEY_ITERATE_OBSERVE));
  table_put_attribute(rows, "attractor_period", "period_limit", value_number(v, KEY_ITERATE_PERIOD_LIMIT, 0));
  table_put_attribute(rows, "attractor_period", "period_tol", value_number(v, KEY_ITERATE_PERIOD_TOL, 0));
  table_lay_out(rows);
}

diagram_row diagram_begin_row(const table *rows, unsigned char *row, ric_attractor *a) {
  diagram_row values = {0};
  memset(row, 0, rows->row_bytes);
  row_load(rows, row, &values);
  a->values = values.values;
  a->states = values.state;
  a->lowest = values.lowest;
  return values;
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

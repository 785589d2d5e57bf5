#include <math.h>
#include <string.h>

#include "diagram.h"

#define NUMBER  .type = COLUMN_F64, .units = "1"
#define INTEGER .type = COLUMN_I64, .units = "1"
#define SOURCE  .source = "[FN97] section 6"
#define MAP     .source = "[FN97] (5.11)"

static const char *const outcome_names[RIC_ATTRACTOR_KINDS] = {
#define X(name, text) text,
    RIC_ATTRACTOR_LIST(X)
#undef X
};

/* The columns of both kinds, in the order of the schema page. */
static const column columns[] = {
    {.name = "outcome",
     .type = COLUMN_ENUM,
     .names = outcome_names,
     .name_count = RIC_ATTRACTOR_KINDS,
     .units = "1",
     .long_name = "what the iterates come to",
     SOURCE},
    {.name = "reason",
     .type = COLUMN_TEXT,
     .text_bytes = DIAGRAM_REASON_BYTES,
     .units = "1",
     .long_name = "why they come to nothing; else empty",
     SOURCE},
    {.name = "attractor_period", INTEGER, .long_name = "period of the attractor, 0: none up to period_limit", SOURCE},
    {.name = "impacts", NUMBER, .long_name = "impacts per iterate, on the average", SOURCE},
    {.name = "lyapunov", NUMBER, .long_name = "largest Lyapunov exponent per iterate", SOURCE},
    {.name = "exponents", NUMBER, .axes = {"exponent"}, .long_name = "Lyapunov exponents per iterate", SOURCE},
    {.name = "values", NUMBER, .axes = {"iterate"}, SOURCE},
    {.name = "state", NUMBER, .axes = {"iterate", "coordinate"}, .long_name = "kept iterates", SOURCE},
    {.name = "end", NUMBER, .axes = {"coordinate"}, .long_name = "state after all measured iterates", SOURCE},
    {.name = "lowest",
     NUMBER,
     .axes = {"coordinate"},
     .long_name = "state on the attractor with the smallest observed number",
     SOURCE},
};

/* Of diagrams beyond grazing. */
static const column beyond_columns[] = {
    {.name = "parameter", NUMBER, .long_name = "branch.parameter", SOURCE},
    {.name = "d", NUMBER, .long_name = "how far the periodic motion would pass the obstacle, to first order", SOURCE},
    {.name = "map_period", INTEGER, .long_name = "period of the attractor of the map, 0: none", MAP},
    {.name = "map_impacts", NUMBER, .long_name = "impacts per iterate of the map", MAP},
    {.name = "map_lyapunov", NUMBER, .long_name = "its largest Lyapunov exponent per iterate", MAP},
    {.name = "map_values",
     NUMBER,
     .axes = {"iterate"},
     .long_name = "its iterates as values of the motion: beside the periodic one",
     MAP},
    {.name = "distance",
     NUMBER,
     .long_name = "between the values of the motion and of the map, over the extent of the latter",
     MAP},
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
  axes[count++] = (table_axis){"coordinate", study_state_size(s)};
  *rows = (table){.group = study_kind(s), .row_axis = "task"};
  table_add(rows, columns, sizeof columns / sizeof *columns, axes, count);
  if (study_is_beyond(s))
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

double diagram_row_bytes(const study *s, const study_values *v) {
  const double keep = (double)kept_of(s, v), size = (double)study_state_size(s);
  return 8 * (keep * (2 + (value_flag(v, KEY_ITERATE_STATES) ? size : 0)) + (double)exponents_of(v) + 2 * size + 16) +
         DIAGRAM_REASON_BYTES;
}

ric_attractor diagram_begin_row(const table *rows, unsigned char *row, double *z, double *exponents) {
  memset(row, 0, rows->row_bytes);
  return (ric_attractor){.z = z,
                         .values = row_numbers(row, table_column(rows, "values")),
                         .states = row_numbers(row, table_column(rows, "state")),
                         .lowest = row_numbers(row, table_column(rows, "lowest")),
                         .exponents = exponents};
}

void diagram_put_row(const table *rows, unsigned char *row, const ric_attractor *a) {
  row_put_word(row, table_column(rows, "outcome"), (int)a->kind);
  row_put_text(row, table_column(rows, "reason"), a->reason);
  row_put_integer(row, table_column(rows, "attractor_period"), (long long)a->period);
  row_put_number(row, table_column(rows, "impacts"), a->impacts);
  row_put_numbers(row, table_column(rows, "end"), a->z);
  if (table_column(rows, "lyapunov"))
    row_put_number(row, table_column(rows, "lyapunov"), a->exponents[0]);
  row_put_numbers(row, table_column(rows, "exponents"), a->exponents);
}

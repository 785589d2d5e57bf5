#include <stdbool.h>
#include <string.h>

#include "trajectory.h"

static const char *const outcome_names[TRAJECTORY_OUTCOMES] = {
#define X(name, text) text,
    RIC_RUN_OUTCOME_LIST(X)
#undef X
        "no_orbit",
    "refused"};

static const char *const side_names[] = {"floor", "wall"};

static const char *const event_names[RIC_EVENT_KINDS] = {
#define X(name, text) text,
    RIC_EVENT_LIST(X)
#undef X
};

/* The columns, in the order of the schema page. */
static const column row_columns[] = {
    {.name = "outcome",
     .type = COLUMN_ENUM,
     .names = outcome_names,
     .name_count = TRAJECTORY_OUTCOMES,
     .units = "1",
     .long_name = "how the run ended",
     .source = "[JAP] (1)-(3)"},
    {.name = "reason",
     .type = COLUMN_TEXT,
     .text_bytes = RIC_REASON_BYTES,
     .units = "1",
     .long_name = "why it did not reach the end; empty when it did",
     .source = "[JAP] (1)-(3)"},
    {.name = "t",
     .type = COLUMN_F64,
     .axes = {"sample"},
     .units = "1",
     .long_name = "times of the samples",
     .source = "[JAP] (1)-(3)"},
    {.name = "q",
     .type = COLUMN_F64,
     .axes = {"sample", "particle"},
     .units = "1",
     .long_name = "displacements, NaN where the run did not come",
     .source = "[JAP] (1)-(3)"},
    {.name = "v",
     .type = COLUMN_F64,
     .axes = {"sample", "particle"},
     .units = "1",
     .long_name = "velocities, after the impact where there is one",
     .source = "[JAP] (1)-(3)"},
    {.name = "time",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "time that the run reached",
     .source = "[JAP] (1)-(3)"},
    {.name = "energy_start", .type = COLUMN_F64, .units = "1", .long_name = "energy at t = 0", .source = "[JAP] (1)"},
    {.name = "energy_end",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "energy at the time reached",
     .source = "[JAP] (1)"},
    {.name = "impact_loss",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "energy that the impacts took",
     .source = "[FN97] (2.9)"},
    {.name = "steps", .type = COLUMN_I64, .units = "1", .long_name = "steps of the integrator", .source = "count"},
    {.name = "force_evaluations",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "evaluations of the forces",
     .source = "count"},
    {.name = "lyapunov",
     .type = COLUMN_F64,
     .axes = {"exponent"},
     .units = "1",
     .long_name = "Lyapunov exponents per unit of time, NaN where none are known",
     .source = "logarithms of the diagonal of R"},
};

static const column impact_columns[] = {
    {.name = "impact_time", .type = COLUMN_F64, .units = "1", .long_name = "time of an impact", .source = "[JAP] (3)"},
    {.name = "impact_particle",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "particle that hits",
     .source = "[JAP] (3)"},
    {.name = "impact_side",
     .type = COLUMN_ENUM,
     .names = side_names,
     .name_count = 2,
     .units = "1",
     .long_name = "which of its obstacles it hits",
     .source = "[JAP] (3)"},
    {.name = "impact_kind",
     .type = COLUMN_ENUM,
     .names = event_names,
     .name_count = RIC_EVENT_KINDS,
     .units = "1",
     .long_name = "kind of the impact",
     .source = "[FN97] (2.9)"},
    {.name = "impact_gap_rate",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "rate of the gap just before the impact",
     .source = "[FN97] (2.9)"},
    {.name = "impact_impulse",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "impulse of the impact",
     .source = "[FN97] (2.9)"},
};

static const column event_columns[] = {
    {.name = "event_time", .type = COLUMN_F64, .units = "1", .long_name = "time of an event", .source = "[FN97] (2.9)"},
    {.name = "event_particle",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "particle that it happens to",
     .source = "[FN97] (2.9)"},
    {.name = "event_side",
     .type = COLUMN_ENUM,
     .names = side_names,
     .name_count = 2,
     .units = "1",
     .long_name = "at which of its obstacles",
     .source = "[FN97] (2.9)"},
    {.name = "event_kind",
     .type = COLUMN_ENUM,
     .names = event_names,
     .name_count = RIC_EVENT_KINDS,
     .units = "1",
     .long_name = "kind of the event",
     .source = "[FN97] (2.9)"},
    {.name = "event_depth",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "smallest gap of a grazing contact, NaN for other kinds",
     .source = "[FN97] (4.1)"},
    {.name = "event_accumulation",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "time at which the impacts of a chatter accumulate, NaN for other kinds",
     .source = "[FN97] (2.9)"},
};

static const column lyapunov_columns[] = {
    {.name = "lyapunov_time",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "time over which the exponents were taken",
     .source = "logarithms of the diagonal of R"},
    {.name = "lyapunov_history",
     .type = COLUMN_F64,
     .axes = {"exponent"},
     .units = "1",
     .long_name = "Lyapunov exponents by then",
     .source = "logarithms of the diagonal of R"},
};

enum {
  ROW_COLUMNS = sizeof row_columns / sizeof *row_columns,
  IMPACT_COLUMNS = sizeof impact_columns / sizeof *impact_columns,
  EVENT_COLUMNS = sizeof event_columns / sizeof *event_columns,
  LYAPUNOV_COLUMNS = sizeof lyapunov_columns / sizeof *lyapunov_columns
};

trajectory_shape trajectory_shape_of(const study_values *v) {
  const double particles = value_number(v, KEY_MODEL_PARTICLES, 0);
  return (trajectory_shape){.particles = particles,
                            .samples = value_number(v, KEY_TIME_SAMPLES, 0),
                            .exponents = value_flag(v, KEY_TIME_LYAPUNOV) ? 2 * particles : 0};
}

double trajectory_row_bytes(const trajectory_shape *shape) {
  return 8 * shape->samples * (1 + 2 * shape->particles) + 8 * shape->exponents + RIC_REASON_BYTES + 8 * ROW_COLUMNS;
}

void trajectory_lay_out(const trajectory_shape *shape, kind_plan *plan) {
  static const struct {
    const char *axis;
    const column *columns;
    size_t count;
    const char *offset, *meaning;
  } tails[TRAJECTORY_TAILS] = {[TAIL_IMPACTS] = {"impact_row", impact_columns, IMPACT_COLUMNS, "impact_offset",
                                                 "impacts of a task: from its offset up to the next"},
                               [TAIL_EVENTS] = {"event_row", event_columns, EVENT_COLUMNS, "event_offset",
                                                "other events of a task: from its offset up to the next"},
                               [TAIL_LYAPUNOV] = {"lyapunov_row", lyapunov_columns, LYAPUNOV_COLUMNS, "lyapunov_offset",
                                                  "convergence of a task's exponents: from its offset up to the next"}};
  const table_axis axes[] = {{"sample", (size_t)shape->samples},
                             {"particle", (size_t)shape->particles},
                             {"exponent", (size_t)shape->exponents}};
  const size_t axis_count = shape->exponents > 0 ? 3 : 2;
  plan->rows = (table){.group = "trajectory", .row_axis = "task"};
  table_add(&plan->rows, row_columns, ROW_COLUMNS, axes, axis_count);
  table_lay_out(&plan->rows);
  plan->tail_count = shape->exponents > 0 ? TRAJECTORY_TAILS : TAIL_LYAPUNOV;
  for (size_t k = 0; k < plan->tail_count; k++)
    kind_lay_out_tail(&plan->tails[k], "trajectory", tails[k].axis, tails[k].offset, tails[k].meaning, tails[k].columns,
                      tails[k].count, axes, axis_count);
}

void trajectory_put_event(const table *t, const ric_event *event, int side, unsigned char *record) {
  const bool impact = strcmp(t->row_axis, "impact_row") == 0;
  row_put_number(record, table_column(t, impact ? "impact_time" : "event_time"), event->time);
  row_put_integer(record, table_column(t, impact ? "impact_particle" : "event_particle"), (long long)event->coordinate);
  row_put_word(record, table_column(t, impact ? "impact_side" : "event_side"), side > 0 ? 0 : 1);
  row_put_word(record, table_column(t, impact ? "impact_kind" : "event_kind"), (int)event->kind);
  row_put_number(record, table_column(t, "impact_gap_rate"), event->gap_rate);
  row_put_number(record, table_column(t, "impact_impulse"), event->impulse);
  row_put_number(record, table_column(t, "event_depth"), event->depth);
  row_put_number(record, table_column(t, "event_accumulation"), event->accumulation);
}

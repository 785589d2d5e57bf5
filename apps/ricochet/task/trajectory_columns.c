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

/* The columns, in the order of the schema page; extents follow from the axes. */
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

enum {
  ROW_COLUMNS = sizeof row_columns / sizeof *row_columns,
  IMPACT_COLUMNS = sizeof impact_columns / sizeof *impact_columns,
  EVENT_COLUMNS = sizeof event_columns / sizeof *event_columns
};

double trajectory_row_bytes(double particles, double samples) {
  return 8 * samples * (1 + 2 * particles) + RIC_REASON_BYTES + 8 * ROW_COLUMNS;
}

static void lay_out_row(size_t particles, size_t samples, table *t) {
  *t = (table){.group = "trajectory", .row_axis = "task", .column_count = ROW_COLUMNS};
  for (size_t i = 0; i < ROW_COLUMNS; i++) {
    t->columns[i] = row_columns[i];
    for (int k = 0; k < column_axes(&t->columns[i]); k++)
      t->columns[i].extents[k] = strcmp(t->columns[i].axes[k], "sample") == 0 ? samples : particles;
  }
  table_lay_out(t);
}

static void lay_out_records(const char *axis, const column *columns, size_t count, table *t) {
  *t = (table){.group = "trajectory", .row_axis = axis, .column_count = count};
  memcpy(t->columns, columns, count * sizeof *columns);
  table_lay_out(t);
}

void trajectory_lay_out(size_t particles, size_t samples, kind_plan *plan) {
  lay_out_row(particles, samples, &plan->rows);
  plan->tail_count = TRAJECTORY_TAILS;
  plan->tails[TAIL_IMPACTS] =
      (tail){.offset = "impact_offset", .meaning = "impacts of a task: from its offset up to the next"};
  plan->tails[TAIL_EVENTS] =
      (tail){.offset = "event_offset", .meaning = "other events of a task: from its offset up to the next"};
  lay_out_records("impact_row", impact_columns, IMPACT_COLUMNS, &plan->tails[TAIL_IMPACTS].records);
  lay_out_records("event_row", event_columns, EVENT_COLUMNS, &plan->tails[TAIL_EVENTS].records);
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

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
    COLUMN("outcome", WORD(trajectory_row, outcome, outcome_names), "how the run ended", .source = "[JAP] (1)-(3)"),
    COLUMN("reason", TEXT(trajectory_row, reason, RIC_REASON_BYTES), "why it did not reach the end; empty when it did",
           .source = "[JAP] (1)-(3)"),
    COLUMN("t", NUMBERS(trajectory_row, t), "times of the samples", .source = "[JAP] (1)-(3)", .axes = {"sample"}),
    COLUMN("q", NUMBERS(trajectory_row, q), "displacements, NaN where the run did not come", .source = "[JAP] (1)-(3)",
           .axes = {"sample", "particle"}),
    COLUMN("v", NUMBERS(trajectory_row, v), "velocities, after the impact where there is one",
           .source = "[JAP] (1)-(3)", .axes = {"sample", "particle"}),
    COLUMN("time", NUMBER(trajectory_row, time), "time that the run reached", .source = "[JAP] (1)-(3)"),
    COLUMN("energy_start", NUMBER(trajectory_row, energy_start), "energy at t = 0", .source = "[JAP] (1)"),
    COLUMN("energy_end", NUMBER(trajectory_row, energy_end), "energy at the time reached", .source = "[JAP] (1)"),
    COLUMN("impact_loss", NUMBER(trajectory_row, impact_loss), "energy that the impacts took",
           .source = "[FN97] (2.9)"),
    COLUMN("steps", INTEGER(trajectory_row, steps), "steps of the integrator", .source = "count"),
    COLUMN("force_evaluations", INTEGER(trajectory_row, force_evaluations), "evaluations of the forces",
           .source = "count"),
    COLUMN("lyapunov", NUMBERS(trajectory_row, lyapunov),
           "Lyapunov exponents per unit of time, NaN where none are known", .source = "logarithms of the diagonal of R",
           .axes = {"exponent"}),
};

static const column impact_columns[] = {
    COLUMN("impact_time", NUMBER(event_record, time), "time of an impact", .source = "[JAP] (3)"),
    COLUMN("impact_particle", INTEGER(event_record, particle), "particle that hits", .source = "[JAP] (3)"),
    COLUMN("impact_side", WORD(event_record, side, side_names), "which of its obstacles it hits",
           .source = "[JAP] (3)"),
    COLUMN("impact_kind", WORD(event_record, kind, event_names), "kind of the impact", .source = "[FN97] (2.9)"),
    COLUMN("impact_gap_rate", NUMBER(event_record, gap_rate), "rate of the gap just before the impact",
           .source = "[FN97] (2.9)"),
    COLUMN("impact_impulse", NUMBER(event_record, impulse), "impulse of the impact", .source = "[FN97] (2.9)"),
};

static const column event_columns[] = {
    COLUMN("event_time", NUMBER(event_record, time), "time of an event", .source = "[FN97] (2.9)"),
    COLUMN("event_particle", INTEGER(event_record, particle), "particle that it happens to", .source = "[FN97] (2.9)"),
    COLUMN("event_side", WORD(event_record, side, side_names), "at which of its obstacles", .source = "[FN97] (2.9)"),
    COLUMN("event_kind", WORD(event_record, kind, event_names), "kind of the event", .source = "[FN97] (2.9)"),
    COLUMN("event_depth", NUMBER(event_record, depth), "smallest gap of a grazing contact, NaN for other kinds",
           .source = "[FN97] (4.1)"),
    COLUMN("event_accumulation", NUMBER(event_record, accumulation),
           "time at which the impacts of a chatter accumulate, NaN for other kinds", .source = "[FN97] (2.9)"),
};

static const column lyapunov_columns[] = {
    COLUMN("lyapunov_time", NUMBER(lyapunov_record, time), "time over which the exponents were taken",
           .source = "logarithms of the diagonal of R"),
    COLUMN("lyapunov_history", NUMBERS(lyapunov_record, history), "Lyapunov exponents by then",
           .source = "logarithms of the diagonal of R", .axes = {"exponent"}),
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

#include <stdbool.h>

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

static const column row_columns[] = {
    COLUMN("outcome", WORD(trajectory_row, outcome, outcome_names), "how the run ended", .source = "[JAP] (1)-(3)",
           .doc = "how the run ended; `event_limit`: more events per time than `time.events_per_time`; `unresolved`: a "
                  "gap or a force varies too fast for the steps; `grazing` and `not_differentiable`, with `lyapunov: "
                  "true`: at a grazing contact, or impacts whose order matters, tangent vectors are undefined and the "
                  "run ends; `no_orbit`: the start was to be an orbit that has no state; `refused`: the library does "
                  "not accept the model or the start"),
    COLUMN("reason", TEXT(trajectory_row, reason, RIC_REASON_BYTES), "why it did not reach the end; empty when it did",
           .source = "[JAP] (1)-(3)"),
    COLUMN("t", NUMBERS(trajectory_row, t), "times of the samples", .source = "[JAP] (1)-(3)", .axes = {"sample"},
           .doc = "sampled times: equal steps from 0 to the duration"),
    COLUMN("q", NUMBERS(trajectory_row, q), "displacements, NaN where the run did not come", .source = "[JAP] (1)-(3)",
           .axes = {"sample", "particle"}, .doc = "displacements there; NaN after the end of the run"),
    COLUMN("v", NUMBERS(trajectory_row, v), "velocities, after the impact where there is one",
           .source = "[JAP] (1)-(3)", .axes = {"sample", "particle"},
           .doc = "velocities there; at an impact those after it; NaN after the end of the run"),
    COLUMN("time", NUMBER(trajectory_row, time), "time that the run reached", .source = "[JAP] (1)-(3)"),
    COLUMN("energy_start", NUMBER(trajectory_row, energy_start), "energy at t = 0", .source = "[JAP] (1)",
           .doc = "energy at t = 0, without that of the force"),
    COLUMN("energy_end", NUMBER(trajectory_row, energy_end), "energy at the time reached", .source = "[JAP] (1)",
           .doc = "energy at the time reached, without that of the force"),
    COLUMN("impact_loss", NUMBER(trajectory_row, impact_loss), "energy that the impacts took", .source = "[FN97] (2.9)",
           .doc = "energy dissipated by impacts"),
    COLUMN("steps", INTEGER(trajectory_row, steps), "steps of the integrator", .source = "count"),
    COLUMN("force_evaluations", INTEGER(trajectory_row, force_evaluations), "evaluations of the forces",
           .source = "count"),
    COLUMN("lyapunov", NUMBERS(trajectory_row, lyapunov),
           "Lyapunov exponents per unit of time, NaN where none are known", .source = "logarithms of the diagonal of R",
           .axes = {"exponent"},
           .doc = "with `lyapunov: true`: exponents per unit of time, over the time reached; `-inf` for directions "
                  "lost when a contact sticks, NaN if none are known"),
};

static const column impact_columns[] = {
    COLUMN("impact_time", NUMBER(event_record, time), "time of an impact", .source = "[JAP] (3)"),
    COLUMN("impact_particle", INTEGER(event_record, particle), "particle that hits", .source = "[JAP] (3)"),
    COLUMN("impact_side", WORD(event_record, side, side_names), "which of its obstacles it hits",
           .source = "[JAP] (3)"),
    COLUMN("impact_kind", WORD(event_record, kind, event_names), "kind of the impact", .source = "[FN97] (2.9)",
           .doc = "kind of the impact: one of the first five words; the others are those of events"),
    COLUMN("impact_gap_rate", NUMBER(event_record, gap_rate), "rate of the gap just before the impact",
           .source = "[FN97] (2.9)", .doc = "rate of the gap just before the impact, <= 0"),
    COLUMN("impact_impulse", NUMBER(event_record, impulse), "impulse of the impact", .source = "[FN97] (2.9)",
           .doc = "impulse of the impact, >= 0"),
};

static const column event_columns[] = {
    COLUMN("event_time", NUMBER(event_record, time), "time of an event", .source = "[FN97] (2.9)"),
    COLUMN("event_particle", INTEGER(event_record, particle), "particle that it happens to", .source = "[FN97] (2.9)"),
    COLUMN("event_side", WORD(event_record, side, side_names), "at which of its obstacles", .source = "[FN97] (2.9)"),
    COLUMN("event_kind", WORD(event_record, kind, event_names), "kind of the event", .source = "[FN97] (2.9)",
           .doc = "`grazing` without a jump (near miss), `chatter`, `rest` (a contact begins to stick) and `release`, "
                  "`contact` and `parting` (onset and end of a Hertz contact); the other words are those of impacts"),
    COLUMN("event_depth", NUMBER(event_record, depth), "smallest gap of a grazing contact, NaN for other kinds",
           .source = "[FN97] (4.1)"),
    COLUMN("event_accumulation", NUMBER(event_record, accumulation),
           "time at which the impacts of a chatter accumulate, NaN for other kinds", .source = "[FN97] (2.9)"),
};

static const column lyapunov_columns[] = {
    COLUMN("lyapunov_time", NUMBER(lyapunov_record, time), "time over which the exponents were taken",
           .source = "logarithms of the diagonal of R",
           .doc = "averaging time: each at least 1.05 times the previous one, and the last one"),
    COLUMN("lyapunov_history", NUMBERS(lyapunov_record, history), "Lyapunov exponents by then",
           .source = "logarithms of the diagonal of R", .axes = {"exponent"}, .doc = "exponents at that time"),
};

enum { ROWS, TAILS };

const column_list trajectory_lists[] = {
    [ROWS] = {"trajectory", "task", COLUMNS(row_columns), .doc = "A task is one motion.\n"},
    [TAILS + TAIL_IMPACTS] = {"trajectory", "impact_row", "impact_offset",
                              "impacts of a task: from its offset up to the next", COLUMNS(impact_columns),
                              .doc = "Ragged: every event at which a velocity jumps, in the order of time.\n"},
    [TAILS + TAIL_EVENTS] = {"trajectory", "event_row", "event_offset",
                             "other events of a task: from its offset up to the next", COLUMNS(event_columns),
                             .doc = "Ragged: the other events, and chatter once more, in the order of time.\n"},
    [TAILS + TAIL_LYAPUNOV] = {"trajectory", "lyapunov_row", "lyapunov_offset",
                               "convergence of a task's exponents: from its offset up to the next",
                               COLUMNS(lyapunov_columns),
                               .doc = "With `lyapunov: true`, ragged: how the exponents converged.\n"},
    {0}};

trajectory_shape trajectory_shape_of(const study_values *v) {
  const double particles = value_number(v, KEY_MODEL_PARTICLES, 0);
  return (trajectory_shape){.particles = particles,
                            .samples = value_number(v, KEY_TIME_SAMPLES, 0),
                            .exponents = value_flag(v, KEY_TIME_LYAPUNOV) ? 2 * particles : 0};
}

void trajectory_lay_out(const trajectory_shape *shape, kind_plan *plan) {
  const table_axis axes[] = {{"sample", (size_t)shape->samples},
                             {"particle", (size_t)shape->particles},
                             {"exponent", (size_t)shape->exponents}};
  const size_t axis_count = shape->exponents > 0 ? 3 : 2;
  plan->rows = (table){0};
  table_add(&plan->rows, &trajectory_lists[ROWS], axes, axis_count);
  table_lay_out(&plan->rows);
  plan->tail_count = shape->exponents > 0 ? TRAJECTORY_TAILS : TAIL_LYAPUNOV;
  for (size_t k = 0; k < plan->tail_count; k++)
    kind_lay_out_tail(&plan->tails[k], &trajectory_lists[TAILS + k], axes, axis_count);
}

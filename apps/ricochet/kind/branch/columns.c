#include "branch.h"

#include <math.h>
#include <string.h>

#include "kind/family/curve_trace.h"
#include "kind/orbits/orbits.h"

static const char *const origin_names[BRANCH_ORIGINS] = {"start", "grazing", "impact_lost", "branch_point",
                                                         "period_doubling"};

static const char *const special_names[RIC_FAMILY_KINDS] = {
#define X(name, text) text,
    RIC_FAMILY_LIST(X)
#undef X
};

static const char *const stability_names[RIC_STABILITIES] = {
#define X(name, text) text,
    RIC_STABILITY_LIST(X)
#undef X
};

static const char *const side_names[] = {"floor", "wall"};

#define CURVE .source = "F(z, p) = 0"

/* The columns, in the order of the schema page. */
static const column row_columns[] = {
    {.name = "outcome",
     WORD(branch_row, outcome, curve_outcome_names),
     .long_name = "how the first segment ended",
     CURVE},
    {.name = "reason",
     TEXT(branch_row, reason, CURVE_REASON_BYTES),
     .long_name = "why; empty when the outcome speaks for itself",
     CURVE},
    {.name = "points", INTEGER(branch_row, points), .long_name = "number of points of all segments", .source = "count"},
    {.name = "segments", INTEGER(branch_row, segments), .long_name = "number of segments", .source = "count"},
    {.name = "iterations",
     INTEGER(branch_row, iterations),
     .long_name = "corrections by Newton's method",
     .source = "count"},
    {.name = "jacobians",
     INTEGER(branch_row, jacobians),
     .long_name = "evaluations of the Jacobian",
     .source = "count"},
};

static const column point_columns[] = {
    {.name = "point_segment",
     INTEGER(branch_point, segment),
     .long_name = "segment of the task that the point belongs to",
     CURVE},
    {.name = "point_parameter", NUMBER(branch_point, parameter), .long_name = "the key that is followed", CURVE},
    {.name = "point_outcome",
     WORD(branch_point, outcome, orbit_outcome_names),
     .long_name = "whether the motion is one",
     .source = "[JAP] (9)"},
    {.name = "point_energy",
     NUMBER(branch_point, energy),
     .long_name = "energy, of motions with losses at their first state",
     CURVE},
    {.name = "point_period", NUMBER(branch_point, period), .long_name = "period", CURVE},
    {.name = "point_amplitude",
     NUMBER(branch_point, amplitude),
     .long_name = "largest displacement over the period",
     CURVE},
    {.name = "point_multiplier_max",
     NUMBER(branch_point, multiplier_max),
     .long_name = "largest modulus of a Floquet multiplier",
     .source = "[JAP] (16)"},
    {.name = "point_stable",
     WORD(branch_point, stable, stability_names),
     .long_name = "whether all multipliers lie in the unit disc",
     .source = "[JAP] (16)"},
    {.name = "point_clearance",
     NUMBER(branch_point, clearance),
     .long_name = "smallest gap of a rigid obstacle away from its impacts",
     .source = "[JAP] (9)"},
    {.name = "point_arclength",
     NUMBER(branch_point, arclength),
     .long_name = "arclength from the first point of the segment",
     CURVE},
    {.name = "point_iterations",
     INTEGER(branch_point, iterations),
     .long_name = "corrections by Newton's method",
     .source = "count"},
    {.name = "point_residual",
     NUMBER(branch_point, residual),
     .long_name = "largest violation of the equations",
     CURVE},
    {.name = "point_q",
     NUMBERS(branch_point, q),
     .axes = {"particle"},
     .long_name = "displacements of the first state",
     CURVE},
    {.name = "point_v",
     NUMBERS(branch_point, v),
     .axes = {"particle"},
     .long_name = "velocities of the first state",
     CURVE},
    {.name = "point_history_q",
     NUMBERS(branch_point, history_q),
     .axes = {"sample", "particle"},
     .long_name = "displacements over the period, at equal distances in time",
     CURVE},
    {.name = "point_history_v",
     NUMBERS(branch_point, history_v),
     .axes = {"sample", "particle"},
     .long_name = "velocities there",
     CURVE},
    {.name = "point_multipliers",
     COMPLEXES(branch_point, multipliers),
     .axes = {"multiplier"},
     .long_name = "Floquet multipliers, the largest modulus first",
     .source = "[JAP] (16)"},
};

static const column special_columns[] = {
    {.name = "special_kind", WORD(branch_special, kind, special_names), .long_name = "what happens there", CURVE},
    {.name = "special_segment",
     INTEGER(branch_special, segment),
     .long_name = "segment of the task that the point belongs to",
     CURVE},
    {.name = "special_parameter", NUMBER(branch_special, parameter), .long_name = "the key that is followed", CURVE},
    {.name = "special_point",
     INTEGER(branch_special, point),
     .long_name = "point of the task before it, from 0",
     CURVE},
    {.name = "special_obstacle",
     INTEGER(branch_special, obstacle),
     .long_name = "obstacle of it, floors by particle, then walls; -1 when there is none",
     CURVE},
    {.name = "special_particle",
     INTEGER(branch_special, particle),
     .long_name = "particle of that obstacle, -1 when there is none",
     CURVE},
    {.name = "special_time",
     NUMBER(branch_special, time),
     .long_name = "when it is touched, NaN when there is none",
     CURVE},
    {.name = "special_order", INTEGER(branch_special, order), .long_name = "3 or 4 of a resonance, else 0", CURVE},
    {.name = "special_period", NUMBER(branch_special, period), .long_name = "period", CURVE},
    {.name = "special_energy",
     NUMBER(branch_special, energy),
     .long_name = "energy, of motions with losses at their first state",
     CURVE},
    {.name = "special_amplitude",
     NUMBER(branch_special, amplitude),
     .long_name = "largest displacement over the period",
     CURVE},
    {.name = "special_clearance",
     NUMBER(branch_special, clearance),
     .long_name = "smallest gap of a rigid obstacle away from its impacts",
     .source = "[JAP] (9)"},
    {.name = "special_multiplier_max",
     NUMBER(branch_special, multiplier_max),
     .long_name = "largest modulus of a Floquet multiplier",
     .source = "[JAP] (16)"},
    {.name = "special_arclength",
     NUMBER(branch_special, arclength),
     .long_name = "arclength from the first point of the segment",
     CURVE},
    {.name = "special_q",
     NUMBERS(branch_special, q),
     .axes = {"particle"},
     .long_name = "displacements of the first state",
     CURVE},
    {.name = "special_v",
     NUMBERS(branch_special, v),
     .axes = {"particle"},
     .long_name = "velocities of the first state",
     CURVE},
};

static const column impact_columns[] = {
    {.name = "impact_point",
     INTEGER(branch_impact, point),
     .long_name = "point of the task that it belongs to, -1 of special ones",
     CURVE},
    {.name = "impact_special",
     INTEGER(branch_impact, special),
     .long_name = "special point of the task that it belongs to, else -1",
     CURVE},
    {.name = "impact_time", NUMBER(branch_impact, time), .long_name = "time in the period", .source = "[JAP] (3)"},
    {.name = "impact_particle",
     INTEGER(branch_impact, particle),
     .long_name = "particle that hits",
     .source = "[JAP] (3)"},
    {.name = "impact_side",
     WORD(branch_impact, side, side_names),
     .long_name = "which of its obstacles it hits",
     .source = "[JAP] (3)"},
    {.name = "impact_gap_rate",
     NUMBER(branch_impact, gap_rate),
     .long_name = "rate of the gap just before the impact",
     .source = "[FN97] (2.9)"},
    {.name = "impact_impulse",
     NUMBER(branch_impact, impulse),
     .long_name = "impulse of the impact",
     .source = "[FN97] (2.9)"},
};

static const column segment_columns[] = {
    {.name = "segment_origin", WORD(branch_segment, origin, origin_names), .long_name = "where it begins", CURVE},
    {.name = "segment_special",
     INTEGER(branch_segment, special),
     .long_name = "special point of the task at which it begins, -1 for the first one",
     CURVE},
    {.name = "segment_outcome", WORD(branch_segment, outcome, curve_outcome_names), .long_name = "how it ended", CURVE},
    {.name = "segment_reason",
     TEXT(branch_segment, reason, CURVE_REASON_BYTES),
     .long_name = "why; empty when the outcome speaks for itself",
     CURVE},
    {.name = "segment_impacts", INTEGER(branch_segment, impacts), .long_name = "impacts per period", .source = "count"},
    {.name = "segment_missed",
     INTEGER(branch_segment, missed),
     .long_name = "sign changes of test functions where no special point was found",
     .source = "count"},
};

static const column curve_columns[] = {
    {.name = "curve_energy",
     NUMBER(branch_curve_point, energy),
     .long_name = "energy, of motions with losses at their first state",
     CURVE},
    {.name = "curve_outcome",
     WORD(branch_curve_point, outcome, orbit_outcome_names),
     .long_name = "whether the motion is one",
     .source = "[JAP] (9)"},
    {.name = "curve_iterations",
     INTEGER(branch_curve_point, iterations),
     .long_name = "corrections by Newton's method",
     .source = "count"},
};

#define COUNT(columns) (sizeof(columns) / sizeof *(columns))

static void lay_out_curves(const char *followed, const char *traced, kind_plan *plan) {
  plan->tail_count = BRANCH_TAILS_WITH_CURVES;
  const curve_tables tables = {.group = "branch",
                               .followed = followed,
                               .traced = traced,
                               .special = true,
                               .own = curve_columns,
                               .own_count = COUNT(curve_columns)};
  curve_trace_lay_out(&tables, &plan->tails[BRANCH_CURVES], &plan->tails[BRANCH_CURVE_ENDS]);
}

void branch_lay_out(const study_values *v, const char *followed, const char *traced, kind_plan *plan) {
  const size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  const table_axis state = {"particle", n};
  const double samples = value_number(v, KEY_BRANCH_SAMPLES, 0); /* minus infinity: none */
  table_axis axes[3];
  size_t count = 0;
  if (value_flag(v, KEY_BRANCH_STATES) || samples > 0)
    axes[count++] = state;
  if (samples > 0)
    axes[count++] = (table_axis){"sample", (size_t)samples};
  if (strcmp(value_word(v, KEY_BRANCH_MULTIPLIERS), "all") == 0)
    axes[count++] = (table_axis){"multiplier", 2 * n};
  plan->rows = (table){.group = "branch", .row_axis = "task"};
  table_add(&plan->rows, row_columns, COUNT(row_columns), NULL, 0);
  table_lay_out(&plan->rows);
  plan->tail_count = BRANCH_TAILS;
  kind_lay_out_tail(&plan->tails[BRANCH_POINTS], "branch", "point_row", "point_offset",
                    "points of a task: from its offset up to the next", point_columns, COUNT(point_columns), axes,
                    count);
  kind_lay_out_tail(&plan->tails[BRANCH_SPECIAL], "branch", "special_row", "special_offset",
                    "special points of a task: from its offset up to the next", special_columns, COUNT(special_columns),
                    &state, 1);
  kind_lay_out_tail(&plan->tails[BRANCH_IMPACTS], "branch", "impact_row", "impact_offset",
                    "impacts of a task's motions: from its offset up to the next", impact_columns,
                    COUNT(impact_columns), NULL, 0);
  kind_lay_out_tail(&plan->tails[BRANCH_SEGMENTS], "branch", "segment_row", "segment_offset",
                    "segments of a task: from its offset up to the next", segment_columns, COUNT(segment_columns), NULL,
                    0);
  table_put_long_name(&plan->tails[BRANCH_POINTS].records, "point_parameter", followed);
  table_put_long_name(&plan->tails[BRANCH_SPECIAL].records, "special_parameter", followed);
  if (traced)
    lay_out_curves(followed, traced, plan);
}

#include "branch.h"

#include <math.h>
#include <string.h>

#include "kind/family/curve_trace.h"
#include "kind/orbits/orbits.h"

static const char *const origin_names[RIC_EXPLORE_ORIGINS] = {
#define X(name, text) text,
    RIC_EXPLORE_ORIGIN_LIST(X)
#undef X
};

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
    COLUMN("outcome", WORD(branch_row, outcome, curve_outcome_names), "how the first segment ended", CURVE),
    COLUMN("reason", TEXT(branch_row, reason, CURVE_REASON_BYTES), "why; empty when the outcome speaks for itself",
           CURVE),
    COLUMN("points", INTEGER(branch_row, points), "number of points of all segments", .source = "count"),
    COLUMN("segments", INTEGER(branch_row, segments), "number of segments", .source = "count"),
    COLUMN("iterations", INTEGER(branch_row, iterations), "corrections by Newton's method", .source = "count"),
    COLUMN("jacobians", INTEGER(branch_row, jacobians), "evaluations of the Jacobian", .source = "count"),
};

static const column point_columns[] = {
    COLUMN("point_segment", INTEGER(branch_point, segment), "segment of the task that the point belongs to", CURVE),
    COLUMN("point_parameter", NUMBER(branch_point, parameter), "the key that is followed", CURVE),
    COLUMN("point_outcome", WORD(branch_point, outcome, orbit_outcome_names), "whether the motion is one",
           .source = "[JAP] (9)"),
    COLUMN("point_energy", NUMBER(branch_point, energy), "energy, of motions with losses at their first state", CURVE),
    COLUMN("point_period", NUMBER(branch_point, period), "period", CURVE),
    COLUMN("point_amplitude", NUMBER(branch_point, amplitude), "largest displacement over the period", CURVE),
    COLUMN("point_multiplier_max", NUMBER(branch_point, multiplier_max), "largest modulus of a Floquet multiplier",
           .source = "[JAP] (16)"),
    COLUMN("point_stable", WORD(branch_point, stable, stability_names), "whether all multipliers lie in the unit disc",
           .source = "[JAP] (16)"),
    COLUMN("point_clearance", NUMBER(branch_point, clearance), "smallest gap of a rigid obstacle away from its impacts",
           .source = "[JAP] (9)"),
    COLUMN("point_arclength", NUMBER(branch_point, arclength), "arclength from the first point of the segment", CURVE),
    COLUMN("point_iterations", INTEGER(branch_point, iterations), "corrections by Newton's method", .source = "count"),
    COLUMN("point_residual", NUMBER(branch_point, residual), "largest violation of the equations", CURVE),
    COLUMN("point_q", NUMBERS(branch_point, q), "displacements of the first state", CURVE, .axes = {"particle"}),
    COLUMN("point_v", NUMBERS(branch_point, v), "velocities of the first state", CURVE, .axes = {"particle"}),
    COLUMN("point_history_q", NUMBERS(branch_point, history_q),
           "displacements over the period, at equal distances in time", CURVE, .axes = {"sample", "particle"}),
    COLUMN("point_history_v", NUMBERS(branch_point, history_v), "velocities there", CURVE,
           .axes = {"sample", "particle"}),
    COLUMN("point_multipliers", COMPLEXES(branch_point, multipliers), "Floquet multipliers, the largest modulus first",
           .source = "[JAP] (16)", .axes = {"multiplier"}),
};

static const column special_columns[] = {
    COLUMN("special_kind", WORD(branch_special, kind, special_names), "what happens there", CURVE),
    COLUMN("special_segment", INTEGER(branch_special, segment), "segment of the task that the point belongs to", CURVE),
    COLUMN("special_parameter", NUMBER(branch_special, parameter), "the key that is followed", CURVE),
    COLUMN("special_point", INTEGER(branch_special, point), "point of the task before it, from 0", CURVE),
    COLUMN("special_obstacle", INTEGER(branch_special, obstacle),
           "obstacle of it, floors by particle, then walls; -1 when there is none", CURVE),
    COLUMN("special_particle", INTEGER(branch_special, particle), "particle of that obstacle, -1 when there is none",
           CURVE),
    COLUMN("special_time", NUMBER(branch_special, time), "when it is touched, NaN when there is none", CURVE),
    COLUMN("special_order", INTEGER(branch_special, order), "3 or 4 of a resonance, else 0", CURVE),
    COLUMN("special_period", NUMBER(branch_special, period), "period", CURVE),
    COLUMN("special_energy", NUMBER(branch_special, energy), "energy, of motions with losses at their first state",
           CURVE),
    COLUMN("special_amplitude", NUMBER(branch_special, amplitude), "largest displacement over the period", CURVE),
    COLUMN("special_clearance", NUMBER(branch_special, clearance),
           "smallest gap of a rigid obstacle away from its impacts", .source = "[JAP] (9)"),
    COLUMN("special_multiplier_max", NUMBER(branch_special, multiplier_max), "largest modulus of a Floquet multiplier",
           .source = "[JAP] (16)"),
    COLUMN("special_arclength", NUMBER(branch_special, arclength), "arclength from the first point of the segment",
           CURVE),
    COLUMN("special_q", NUMBERS(branch_special, q), "displacements of the first state", CURVE, .axes = {"particle"}),
    COLUMN("special_v", NUMBERS(branch_special, v), "velocities of the first state", CURVE, .axes = {"particle"}),
};

static const column impact_columns[] = {
    COLUMN("impact_point", INTEGER(branch_impact, point), "point of the task that it belongs to, -1 of special ones",
           CURVE),
    COLUMN("impact_special", INTEGER(branch_impact, special), "special point of the task that it belongs to, else -1",
           CURVE),
    COLUMN("impact_time", NUMBER(branch_impact, time), "time in the period", .source = "[JAP] (3)"),
    COLUMN("impact_particle", INTEGER(branch_impact, particle), "particle that hits", .source = "[JAP] (3)"),
    COLUMN("impact_side", WORD(branch_impact, side, side_names), "which of its obstacles it hits",
           .source = "[JAP] (3)"),
    COLUMN("impact_gap_rate", NUMBER(branch_impact, gap_rate), "rate of the gap just before the impact",
           .source = "[FN97] (2.9)"),
    COLUMN("impact_impulse", NUMBER(branch_impact, impulse), "impulse of the impact", .source = "[FN97] (2.9)"),
};

static const column segment_columns[] = {
    COLUMN("segment_origin", WORD(branch_segment, origin, origin_names), "where it begins", CURVE),
    COLUMN("segment_special", INTEGER(branch_segment, special),
           "special point of the task at which it begins, -1 for the first one", CURVE),
    COLUMN("segment_outcome", WORD(branch_segment, outcome, curve_outcome_names), "how it ended", CURVE),
    COLUMN("segment_reason", TEXT(branch_segment, reason, CURVE_REASON_BYTES),
           "why; empty when the outcome speaks for itself", CURVE),
    COLUMN("segment_impacts", INTEGER(branch_segment, impacts), "impacts per period", .source = "count"),
    COLUMN("segment_missed", INTEGER(branch_segment, missed),
           "sign changes of test functions where no special point was found", .source = "count"),
};

static const column curve_columns[] = {
    COLUMN("curve_energy", NUMBER(branch_curve_point, energy), "energy, of motions with losses at their first state",
           CURVE),
    COLUMN("curve_outcome", WORD(branch_curve_point, outcome, orbit_outcome_names), "whether the motion is one",
           .source = "[JAP] (9)"),
    COLUMN("curve_iterations", INTEGER(branch_curve_point, iterations), "corrections by Newton's method",
           .source = "count"),
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

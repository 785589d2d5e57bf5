#include "branch.h"

#include <math.h>
#include <string.h>

#include "curve_trace.h"
#include "orbits.h"

const char *const branch_outcome_names[BRANCH_OUTCOMES] = {
#define X(name, text) text,
    RIC_CURVE_END_LIST(X)
#undef X
        "failed_start",
    "refused"};

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

#define NUMBER     .type = COLUMN_F64, .units = "1"
#define INTEGER    .type = COLUMN_I64, .units = "1"
#define WORD(list) .type = COLUMN_ENUM, .names = (list), .name_count = sizeof(list) / sizeof *(list), .units = "1"
#define CURVE      .source = "F(z, p) = 0"

/* The columns, in the order of the schema page. */
static const column row_columns[] = {
    {.name = "outcome", WORD(branch_outcome_names), .long_name = "how the first segment ended", CURVE},
    {.name = "reason",
     .type = COLUMN_TEXT,
     .text_bytes = BRANCH_REASON_BYTES,
     .units = "1",
     .long_name = "why; empty when the outcome speaks for itself",
     CURVE},
    {.name = "points", INTEGER, .long_name = "number of points of all segments", .source = "count"},
    {.name = "segments", INTEGER, .long_name = "number of segments", .source = "count"},
    {.name = "iterations", INTEGER, .long_name = "corrections by Newton's method", .source = "count"},
    {.name = "jacobians", INTEGER, .long_name = "evaluations of the Jacobian", .source = "count"},
};

static const column point_columns[] = {
    {.name = "point_segment", INTEGER, .long_name = "segment of the task that the point belongs to", CURVE},
    {.name = "point_parameter", NUMBER, .long_name = "the key that is followed", CURVE},
    {.name = "point_outcome",
     WORD(orbit_outcome_names),
     .long_name = "whether the motion is one",
     .source = "[JAP] (9)"},
    {.name = "point_energy", NUMBER, .long_name = "energy, of motions with losses at their first state", CURVE},
    {.name = "point_period", NUMBER, .long_name = "period", CURVE},
    {.name = "point_amplitude", NUMBER, .long_name = "largest displacement over the period", CURVE},
    {.name = "point_multiplier_max",
     NUMBER,
     .long_name = "largest modulus of a Floquet multiplier",
     .source = "[JAP] (16)"},
    {.name = "point_stable",
     WORD(stability_names),
     .long_name = "whether all multipliers lie in the unit disc",
     .source = "[JAP] (16)"},
    {.name = "point_clearance",
     NUMBER,
     .long_name = "smallest gap of a rigid obstacle away from its impacts",
     .source = "[JAP] (9)"},
    {.name = "point_arclength", NUMBER, .long_name = "arclength from the first point of the segment", CURVE},
    {.name = "point_iterations", INTEGER, .long_name = "corrections by Newton's method", .source = "count"},
    {.name = "point_residual", NUMBER, .long_name = "largest violation of the equations", CURVE},
    {.name = "point_q", NUMBER, .axes = {"particle"}, .long_name = "displacements of the first state", CURVE},
    {.name = "point_v", NUMBER, .axes = {"particle"}, .long_name = "velocities of the first state", CURVE},
    {.name = "point_history_q",
     NUMBER,
     .axes = {"sample", "particle"},
     .long_name = "displacements over the period, at equal distances in time",
     CURVE},
    {.name = "point_history_v", NUMBER, .axes = {"sample", "particle"}, .long_name = "velocities there", CURVE},
    {.name = "point_multipliers",
     .type = COLUMN_COMPLEX,
     .axes = {"multiplier"},
     .units = "1",
     .long_name = "Floquet multipliers, the largest modulus first",
     .source = "[JAP] (16)"},
};

static const column special_columns[] = {
    {.name = "special_kind", WORD(special_names), .long_name = "what happens there", CURVE},
    {.name = "special_segment", INTEGER, .long_name = "segment of the task that the point belongs to", CURVE},
    {.name = "special_parameter", NUMBER, .long_name = "the key that is followed", CURVE},
    {.name = "special_point", INTEGER, .long_name = "point of the task before it, from 0", CURVE},
    {.name = "special_obstacle",
     INTEGER,
     .long_name = "obstacle of it, floors by particle, then walls; -1 when there is none",
     CURVE},
    {.name = "special_particle", INTEGER, .long_name = "particle of that obstacle, -1 when there is none", CURVE},
    {.name = "special_time", NUMBER, .long_name = "when it is touched, NaN when there is none", CURVE},
    {.name = "special_order", INTEGER, .long_name = "3 or 4 of a resonance, else 0", CURVE},
    {.name = "special_period", NUMBER, .long_name = "period", CURVE},
    {.name = "special_energy", NUMBER, .long_name = "energy, of motions with losses at their first state", CURVE},
    {.name = "special_amplitude", NUMBER, .long_name = "largest displacement over the period", CURVE},
    {.name = "special_clearance",
     NUMBER,
     .long_name = "smallest gap of a rigid obstacle away from its impacts",
     .source = "[JAP] (9)"},
    {.name = "special_multiplier_max",
     NUMBER,
     .long_name = "largest modulus of a Floquet multiplier",
     .source = "[JAP] (16)"},
    {.name = "special_arclength", NUMBER, .long_name = "arclength from the first point of the segment", CURVE},
    {.name = "special_q", NUMBER, .axes = {"particle"}, .long_name = "displacements of the first state", CURVE},
    {.name = "special_v", NUMBER, .axes = {"particle"}, .long_name = "velocities of the first state", CURVE},
};

static const column impact_columns[] = {
    {.name = "impact_point", INTEGER, .long_name = "point of the task that it belongs to, -1 of special ones", CURVE},
    {.name = "impact_special", INTEGER, .long_name = "special point of the task that it belongs to, else -1", CURVE},
    {.name = "impact_time", NUMBER, .long_name = "time in the period", .source = "[JAP] (3)"},
    {.name = "impact_particle", INTEGER, .long_name = "particle that hits", .source = "[JAP] (3)"},
    {.name = "impact_side", WORD(side_names), .long_name = "which of its obstacles it hits", .source = "[JAP] (3)"},
    {.name = "impact_gap_rate",
     NUMBER,
     .long_name = "rate of the gap just before the impact",
     .source = "[FN97] (2.9)"},
    {.name = "impact_impulse", NUMBER, .long_name = "impulse of the impact", .source = "[FN97] (2.9)"},
};

static const column segment_columns[] = {
    {.name = "segment_origin", WORD(origin_names), .long_name = "where it begins", CURVE},
    {.name = "segment_special",
     INTEGER,
     .long_name = "special point of the task at which it begins, -1 for the first one",
     CURVE},
    {.name = "segment_outcome", WORD(branch_outcome_names), .long_name = "how it ended", CURVE},
    {.name = "segment_reason",
     .type = COLUMN_TEXT,
     .text_bytes = BRANCH_REASON_BYTES,
     .units = "1",
     .long_name = "why; empty when the outcome speaks for itself",
     CURVE},
    {.name = "segment_impacts", INTEGER, .long_name = "impacts per period", .source = "count"},
    {.name = "segment_missed",
     INTEGER,
     .long_name = "sign changes of test functions where no special point was found",
     .source = "count"},
};

static const column curve_columns[] = {
    {.name = "curve_energy", NUMBER, .long_name = "energy, of motions with losses at their first state", CURVE},
    {.name = "curve_outcome",
     WORD(orbit_outcome_names),
     .long_name = "whether the motion is one",
     .source = "[JAP] (9)"},
    {.name = "curve_iterations", INTEGER, .long_name = "corrections by Newton's method", .source = "count"},
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

static void put_multipliers(const ric_multipliers *found, const column *c, unsigned char *record) {
  double *parts = row_numbers(record, c);
  for (size_t i = 0; parts && i < column_values(c); i++) {
    const bool known = found && i < found->count;
    parts[2 * i] = known ? found->mu[i].re : NAN;
    parts[2 * i + 1] = known ? found->mu[i].im : NAN;
  }
}

void branch_put_point(const table *t, const ric_family_point *point, double value, double amplitude, size_t segment,
                      unsigned char *record) {
  const ric_orbit *o = point->orbit;
  const ric_multipliers *m = point->multipliers;
  row_put_integer(record, table_column(t, "point_segment"), (long long)segment);
  row_put_number(record, table_column(t, "point_parameter"), value);
  row_put_word(record, table_column(t, "point_outcome"), (int)o->outcome);
  row_put_number(record, table_column(t, "point_energy"), o->energy);
  row_put_number(record, table_column(t, "point_period"), o->period);
  row_put_number(record, table_column(t, "point_amplitude"), amplitude);
  row_put_number(record, table_column(t, "point_multiplier_max"), m ? m->largest : NAN);
  row_put_word(record, table_column(t, "point_stable"), m ? (int)m->stable : (int)RIC_STABILITY_UNKNOWN);
  row_put_number(record, table_column(t, "point_clearance"), o->clearance);
  row_put_number(record, table_column(t, "point_arclength"), point->arclength);
  row_put_integer(record, table_column(t, "point_iterations"), point->iterations);
  row_put_number(record, table_column(t, "point_residual"), o->residual);
  row_put_numbers(record, table_column(t, "point_q"), o->q);
  row_put_numbers(record, table_column(t, "point_v"), o->v);
  put_multipliers(m, table_column(t, "point_multipliers"), record);
}

void branch_put_special(const table *t, const ric_family_point *point, double value, double amplitude, size_t segment,
                        uint64_t before, long long particle, unsigned char *record) {
  const ric_orbit *o = point->orbit;
  const bool any = particle >= 0;
  row_put_word(record, table_column(t, "special_kind"), (int)point->kind);
  row_put_integer(record, table_column(t, "special_segment"), (long long)segment);
  row_put_number(record, table_column(t, "special_parameter"), value);
  row_put_integer(record, table_column(t, "special_point"), (long long)before - 1);
  row_put_integer(record, table_column(t, "special_obstacle"), any ? (long long)point->obstacle : -1);
  row_put_integer(record, table_column(t, "special_particle"), particle);
  row_put_number(record, table_column(t, "special_time"), point->time);
  row_put_integer(record, table_column(t, "special_order"), point->order);
  row_put_number(record, table_column(t, "special_period"), o->period);
  row_put_number(record, table_column(t, "special_energy"), o->energy);
  row_put_number(record, table_column(t, "special_amplitude"), amplitude);
  row_put_number(record, table_column(t, "special_clearance"), o->clearance);
  row_put_number(record, table_column(t, "special_multiplier_max"),
                 point->multipliers ? point->multipliers->largest : NAN);
  row_put_number(record, table_column(t, "special_arclength"), point->arclength);
  row_put_numbers(record, table_column(t, "special_q"), o->q);
  row_put_numbers(record, table_column(t, "special_v"), o->v);
}

void branch_put_curve_point(const table *t, const ric_family_curve_point *point, unsigned char *record) {
  row_put_number(record, table_column(t, "curve_energy"), point->orbit->energy);
  row_put_word(record, table_column(t, "curve_outcome"), (int)point->orbit->outcome);
  row_put_integer(record, table_column(t, "curve_iterations"), point->iterations);
}

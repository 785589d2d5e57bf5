#include "branch.h"

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

static const char *const side_names[] = {"floor", "wall"};

#define CURVE        .source = "F(z, p) = 0"
#define AS_OF_POINTS .doc = "as of points"

static const column row_columns[] = {
    COLUMN("outcome", WORD(branch_row, outcome, curve_outcome_names), "how the first segment ended", CURVE,
           .doc = "how the first segment ended; `bound`: the parameter has reached a bound, where the last point lies; "
                  "`points`: the largest number of steps; `closed`: the branch has returned to its start; "
                  "`not_converged`: a step shorter than allowed would be needed; `failed_start`: no initial motion was "
                  "found; `refused`: the library does not accept the model"),
    COLUMN("reason", TEXT(branch_row, reason, CURVE_REASON_BYTES), "why; empty when the outcome speaks for itself",
           CURVE, .doc = "what failed last; empty if the outcome needs no reason"),
    COLUMN("points", INTEGER(branch_row, points), "number of points of all segments", .source = "count"),
    COLUMN("segments", INTEGER(branch_row, segments), "number of segments", .source = "count"),
    COLUMN("iterations", INTEGER(branch_row, iterations), "corrections by Newton's method", .source = "count",
           .doc = "corrections by Newton's method, of segments and curves"),
    COLUMN("jacobians", INTEGER(branch_row, jacobians), "evaluations of the Jacobian", .source = "count",
           .doc = "evaluations of the Jacobian, likewise"),
};

static const column point_columns[] = {
    COLUMN("point_segment", INTEGER(branch_point, segment), "segment of the task that the point belongs to", CURVE),
    COLUMN("point_parameter", NUMBER(branch_point, parameter), "parameter that is followed", CURVE,
           .doc = "the parameter that is followed; its key is the attribute `parameter`"),
    COLUMN("point_outcome", WORD(branch_point, outcome, orbit_outcome_names), "whether the motion is one",
           .source = "[JAP] (9)",
           .doc = "`inadmissible`: a solution of the equations that passes through an obstacle, has a negative "
                  "impulse, or has its impacts out of order; `failed`: the equations are violated by more than 1e-6, "
                  "for example with a large `branch.tolerance`, or the system has no motions of this kind; `resonant`, "
                  "`singular`, `not_converged` are words of `/orbits/outcome` only"),
    COLUMN("point_energy", NUMBER(branch_point, energy), "energy, of motions with losses at their first state", CURVE,
           .doc = "total energy; for motions with force or losses that of the first state"),
    COLUMN("point_period", NUMBER(branch_point, period), "period", CURVE),
    COLUMN("point_amplitude", NUMBER(branch_point, amplitude), "largest displacement over the period", CURVE,
           .doc = "largest displacement of a particle over the period"),
    COLUMN("point_multiplier_max", NUMBER(branch_point, multiplier_max), "largest modulus of a Floquet multiplier",
           .source = "[JAP] (16)",
           .doc = "largest modulus of a Floquet multiplier; NaN when unknown, and with `multipliers: false`"),
    COLUMN("point_stable", WORD(branch_point, stable, orbit_stability_names),
           "whether all multipliers lie in the unit disc", .source = "[JAP] (16)", .doc = "as `/orbits/stable`"),
    COLUMN("point_clearance", NUMBER(branch_point, clearance), "smallest gap of a rigid obstacle away from its impacts",
           .source = "[JAP] (9)",
           .doc = "smallest gap of a rigid obstacle away from its own impacts; NaN when there is none"),
    COLUMN("point_arclength", NUMBER(branch_point, arclength), "arclength from the first point of the segment", CURVE),
    COLUMN("point_iterations", INTEGER(branch_point, iterations), "corrections by Newton's method", .source = "count"),
    COLUMN("point_residual", NUMBER(branch_point, residual), "largest violation of the equations", CURVE),
    COLUMN("point_q", NUMBERS(branch_point, q), "displacements of the first state", CURVE, .axes = {"particle"},
           .doc = "with `states: true`: displacements of the first state: for even motions at t = 0+, for others after "
                  "the first impact, or at t = 0 if there is none"),
    COLUMN("point_v", NUMBERS(branch_point, v), "velocities of the first state", CURVE, .axes = {"particle"},
           .doc = "with `states: true`: velocities of that state"),
    COLUMN("point_history_q", NUMBERS(branch_point, history_q),
           "displacements over the period, at equal distances in time", CURVE, .axes = {"sample", "particle"},
           .doc = "with `branch.samples`: displacements over the period at equidistant times from the first state on "
                  "(at an impact those before it)"),
    COLUMN("point_history_v", NUMBERS(branch_point, history_v), "velocities there", CURVE,
           .axes = {"sample", "particle"}, .doc = "with `branch.samples`: velocities at these times"),
    COLUMN("point_multipliers", COMPLEXES(branch_point, multipliers), "Floquet multipliers, the largest modulus first",
           .source = "[JAP] (16)", .axes = {"multiplier"},
           .doc = "with `multipliers: all`: Floquet multipliers, the largest modulus first; NaN when unknown"),
};

static const column special_columns[] = {
    COLUMN("special_kind", WORD(branch_special, kind, special_names), "what happens there", CURVE,
           .doc = "`symmetry_breaking`: a pair of multipliers of an even motion passes +1, and motions that are not "
                  "even branch off; `energy_extreme`: the same without a branching family: the energy is extreme among "
                  "neighbouring periods; `torus`: Neimark-Sacker; `resonance`: a pair of multipliers of an even motion "
                  "passes a third or fourth root of unity; `grazing`: a grazing point; `impact_lost`: an impact "
                  "becomes a grazing contact; `impulse_sign`: an impulse changes sign; `order`: two impacts coincide; "
                  "`regular` is not used"),
    COLUMN("special_segment", INTEGER(branch_special, segment), "segment of the task that the point belongs to", CURVE),
    COLUMN("special_parameter", NUMBER(branch_special, parameter), "parameter that is followed", CURVE,
           .doc = "the parameter there, as of points"),
    COLUMN("special_point", INTEGER(branch_special, point), "point of the task before it, from 0", CURVE,
           .doc = "the point of the task before it"),
    COLUMN("special_obstacle", INTEGER(branch_special, obstacle),
           "obstacle of it, floors by particle, then walls; -1 when there is none", CURVE,
           .doc = "its obstacle, floors counted by particle and then walls; -1 if it has none"),
    COLUMN("special_particle", INTEGER(branch_special, particle), "particle of that obstacle, -1 when there is none",
           CURVE, .doc = "the particle of that obstacle; -1 if it has none"),
    COLUMN("special_time", NUMBER(branch_special, time), "when it is touched, NaN when there is none", CURVE,
           .doc = "when in the period; NaN if it has no obstacle"),
    COLUMN("special_order", INTEGER(branch_special, order), "3 or 4 of a resonance, else 0", CURVE,
           .doc = "3 or 4 of a `resonance`, else 0"),
    COLUMN("special_period", NUMBER(branch_special, period), "period", CURVE),
    COLUMN("special_energy", NUMBER(branch_special, energy), "energy, of motions with losses at their first state",
           CURVE, AS_OF_POINTS),
    COLUMN("special_amplitude", NUMBER(branch_special, amplitude), "largest displacement over the period", CURVE,
           AS_OF_POINTS),
    COLUMN("special_clearance", NUMBER(branch_special, clearance),
           "smallest gap of a rigid obstacle away from its impacts", .source = "[JAP] (9)", AS_OF_POINTS),
    COLUMN("special_multiplier_max", NUMBER(branch_special, multiplier_max), "largest modulus of a Floquet multiplier",
           .source = "[JAP] (16)", AS_OF_POINTS),
    COLUMN("special_arclength", NUMBER(branch_special, arclength), "arclength from the first point of the segment",
           CURVE),
    COLUMN("special_q", NUMBERS(branch_special, q), "displacements of the first state", CURVE, .axes = {"particle"}),
    COLUMN("special_v", NUMBERS(branch_special, v), "velocities of the first state", CURVE, .axes = {"particle"}),
};

static const column impact_columns[] = {
    COLUMN("impact_point", INTEGER(branch_impact, point), "point of the task that it belongs to, -1 of special ones",
           CURVE, .doc = "the point of the task; -1 if it belongs to a special point"),
    COLUMN("impact_special", INTEGER(branch_impact, special), "special point of the task that it belongs to, else -1",
           CURVE, .doc = "the special point of the task; -1 if it belongs to a point"),
    COLUMN("impact_time", NUMBER(branch_impact, time), "time in the period", .source = "[JAP] (3)",
           .doc = "when, in [0, T)"),
    COLUMN("impact_particle", INTEGER(branch_impact, particle), "particle that hits", .source = "[JAP] (3)"),
    COLUMN("impact_side", WORD(branch_impact, side, side_names), "which of its obstacles it hits",
           .source = "[JAP] (3)"),
    COLUMN("impact_gap_rate", NUMBER(branch_impact, gap_rate), "rate of the gap just before the impact",
           .source = "[FN97] (2.9)", .doc = "rate of the gap just before it, < 0 for an impact"),
    COLUMN("impact_impulse", NUMBER(branch_impact, impulse), "impulse of the impact", .source = "[FN97] (2.9)"),
};

static const column segment_columns[] = {
    COLUMN("segment_origin", WORD(branch_segment, origin, origin_names), "where it begins", CURVE,
           .doc = "`start`, or the kind of the special point at which it begins"),
    COLUMN("segment_special", INTEGER(branch_segment, special),
           "special point of the task at which it begins, -1 for the first one", CURVE,
           .doc = "that special point of the task; -1 of the first segment"),
    COLUMN("segment_outcome", WORD(branch_segment, outcome, curve_outcome_names), "how it ended", CURVE,
           .doc = "as of the task; `failed_start` if the other family could not be started"),
    COLUMN("segment_reason", TEXT(branch_segment, reason, CURVE_REASON_BYTES),
           "why; empty when the outcome speaks for itself", CURVE, .doc = "as of the task"),
    COLUMN("segment_impacts", INTEGER(branch_segment, impacts), "impacts per period", .source = "count"),
    COLUMN("segment_missed", INTEGER(branch_segment, missed),
           "sign changes of test functions where no special point was found", .source = "count"),
};

static const column curve_columns[] = {
    COLUMN("curve_energy", NUMBER(branch_curve_point, energy), "energy, of motions with losses at their first state",
           CURVE, AS_OF_POINTS),
    COLUMN("curve_outcome", WORD(branch_curve_point, outcome, orbit_outcome_names), "whether the motion is one",
           .source = "[JAP] (9)", AS_OF_POINTS),
    COLUMN("curve_iterations", INTEGER(branch_curve_point, iterations), "corrections by Newton's method",
           .source = "count"),
};

enum { ROWS, TAILS };

const column_list branch_lists[] = {
    [ROWS] = {"branch", "task", COLUMNS(row_columns)},
    [TAILS + BRANCH_POINTS] = {"branch", "point_row", "point_offset",
                               "points of a task: from its offset up to the next", COLUMNS(point_columns),
                               .doc = "Ragged: the points, in the order of the continuation run.\n"},
    [TAILS + BRANCH_SPECIAL] = {"branch", "special_row", "special_offset",
                                "special points of a task: from its offset up to the next", COLUMNS(special_columns),
                                .doc = "Ragged: special points, in the order of the continuation run; the list of "
                                       "points above does not contain them.\n"},
    [TAILS +
        BRANCH_IMPACTS] = {"branch", "impact_row", "impact_offset",
                           "impacts of a task's motions: from its offset up to the next", COLUMNS(impact_columns),
                           .doc = "Ragged: impacts of the special points, and with `states: true` of the points.\n"},
    [TAILS + BRANCH_SEGMENTS] = {"branch", "segment_row", "segment_offset",
                                 "segments of a task: from its offset up to the next", COLUMNS(segment_columns),
                                 .doc = "Ragged: the segments.\n"},
    [TAILS + BRANCH_CURVES] = {"branch", "curve_row", "curve_offset", CURVE_POINTS_MEANING,
                               COLUMNS(curve_point_columns),
                               .doc = "With the section `branch.trace`, ragged: points of the curves, of one special "
                                      "point after another, part 0 before\n"
                                      "part 1.\n"},
    {"branch", "curve_row", COLUMNS(curve_columns)},
    {"branch", "curve_end_row", "curve_end_offset", CURVE_ENDS_MEANING, COLUMNS(curve_end_columns),
     .doc = "With the section `branch.trace`, ragged: the ends of the curves, one per part.\n"},
    {0}};

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
  plan->rows = (table){0};
  table_add(&plan->rows, &branch_lists[ROWS], NULL, 0);
  table_lay_out(&plan->rows);
  plan->tail_count = traced ? BRANCH_TAILS_WITH_CURVES : BRANCH_TAILS;
  kind_lay_out_tail(&plan->tails[BRANCH_POINTS], &branch_lists[TAILS + BRANCH_POINTS], axes, count);
  kind_lay_out_tail(&plan->tails[BRANCH_SPECIAL], &branch_lists[TAILS + BRANCH_SPECIAL], &state, 1);
  kind_lay_out_tail(&plan->tails[BRANCH_IMPACTS], &branch_lists[TAILS + BRANCH_IMPACTS], NULL, 0);
  kind_lay_out_tail(&plan->tails[BRANCH_SEGMENTS], &branch_lists[TAILS + BRANCH_SEGMENTS], NULL, 0);
  table_put_parameter(&plan->tails[BRANCH_POINTS].records, "point_parameter", followed);
  table_put_parameter(&plan->tails[BRANCH_SPECIAL].records, "special_parameter", followed);
  if (traced)
    curve_trace_lay_out(&branch_lists[TAILS + BRANCH_CURVES], followed, traced, NULL, 0, &plan->tails[BRANCH_CURVES]);
}

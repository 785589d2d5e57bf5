#include "grazing.h"

#include <math.h>
#include <string.h>

#include "kind/family/curve_trace.h"

static const char *const outcome_names[GRAZING_OUTCOMES] = {
#define X(name, text) text,
    GRAZING_OUTCOME_LIST(X)
#undef X
};

/* The last word of these lists stands for nothing. */
static const char *const verdict_names[] = {
#define X(name, text) text,
    RIC_GRAZING_VERDICT_LIST(X)
#undef X
        "none"};

static const char *const edge_names[] = {
#define X(name, text) text,
    RIC_GRAZING_EDGE_LIST(X)
#undef X
        "none"};

static const char *const regime_names[RIC_GRAZING_REGIMES] = {
#define X(name, text) text,
    RIC_GRAZING_REGIME_LIST(X)
#undef X
};

static const char *const side_names[] = {"floor", "wall", "none"};
static const char *const flag_names[] = {"FALSE", "TRUE"}; /* h5py reads an enum of these words as bool */

#define POINT     .source = "[FN97] (4.1)"
#define SECTION   .source = "[FN97] (5.5)-(5.8)"
#define CRITERION .source = "[FN97] (5.10)"
#define MAP       .source = "[FN97] (5.11)"
#define LIMIT_MAP .source = "[FN97] (5.14)"

#define AS_OF_TASK .doc = "as of the task"

static const column row_columns[] = {
    COLUMN("outcome", WORD(grazing_row, outcome, outcome_names), "whether the family grazes", POINT,
           .doc = "whether the family grazes; `none`: the family has reached its end without a grazing point; "
                  "`degenerate`: the theory does not apply: A_g near zero, two grazing points at once, an impact that "
                  "is not transversal, a minimum of the gap that does not depend on the parameter; `failed`: the "
                  "continuation fails, or coefficients cannot be computed; `failed_start`: no initial motion was "
                  "found; `refused`: the library does not accept the model"),
    COLUMN("reason", TEXT(grazing_row, reason, GRAZING_REASON_BYTES), "why not; empty when it does", POINT,
           .doc = "why there is no grazing point; empty if there is one"),
    COLUMN("parameter", NUMBER(grazing_row, parameter), "parameter that is followed", POINT,
           .doc = "where, in the parameter that is followed; its key is the attribute `parameter`. For `degenerate` "
                  "rows, like the next six columns, to the accuracy of the branch"),
    COLUMN("period", NUMBER(grazing_row, period), "period of the grazing motion", POINT),
    COLUMN("time", NUMBER(grazing_row, time), "when in the period it touches the obstacle", POINT,
           .doc = "time of the grazing point in [0, T)"),
    COLUMN("phase", NUMBER(grazing_row, phase), "this time over the period", POINT),
    COLUMN("obstacle", INTEGER(grazing_row, obstacle), "obstacle that is touched, floors by particle, then walls",
           POINT, .doc = "the obstacle, floors counted by particle and then walls"),
    COLUMN("particle", INTEGER(grazing_row, particle), "particle of it", POINT, .doc = "its particle"),
    COLUMN("side", WORD(grazing_row, side, side_names), "which of its obstacles", POINT, .doc = "its side"),
    COLUMN("slope", NUMBER(grazing_row, slope), "change of the gap's minimum per change of the parameter", POINT,
           .doc = "change of the gap's minimum per change of the parameter: d = -slope (p - parameter) to first order"),
    COLUMN("A_g", NUMBER(grazing_row, A_g), "second derivative of the gap in time at grazing", POINT),
    COLUMN("restitution", NUMBER(grazing_row, restitution), "restitution at vanishing gap rate",
           .source = "[FN97] (2.9)"),
    COLUMN("verdict", WORD(grazing_row, verdict, verdict_names), "what the coefficients c_i say", CRITERION,
           .doc = "`continuous`: all c_i > 0; `discontinuous`: one is negative; `undecided` also for degenerate "
                  "points; `none` without a point"),
    COLUMN("verdict_reason", TEXT(grazing_row, verdict_reason, GRAZING_REASON_BYTES), "why; empty when continuous",
           CRITERION, .doc = "which c_i, or which condition fails; empty when continuous"),
    COLUMN("regime", WORD(grazing_row, regime, regime_names), "what the multiplier predicts beyond grazing", LIMIT_MAP,
           .doc = "for continuous ones the regime predicted by the dominant multiplier lambda: `chaos` (lambda > 2/3), "
                  "`windows` (1/4 < lambda < 2/3), `overlap` (lambda < 1/4), `border`"),
    COLUMN("first_negative", INTEGER(grazing_row, first_negative), "the first i with c_i < 0, -1: none", CRITERION),
    COLUMN("first_zero", INTEGER(grazing_row, first_zero), "the first i with c_i = 0 within the tolerance, -1: none",
           CRITERION),
    COLUMN("settled", INTEGER(grazing_row, settled), "from this i on all c_i > 0 is proved, -1: not", CRITERION,
           .doc = "from this i on all c_i > 0 is proved; -1 unless continuous"),
    COLUMN("multiplier", COMPLEX(grazing_row, multiplier), "dominant multiplier of L", CRITERION,
           .doc = "the dominant multiplier of L, of a pair the one with positive imaginary part"),
    COLUMN("second", NUMBER(grazing_row, second), "largest modulus of the others, 0: none", CRITERION,
           .doc = "largest modulus of the other multipliers, 0: none"),
    COLUMN("alpha", NUMBER(grazing_row, alpha), "eta P xi, P the projector of the dominant multiplier", LIMIT_MAP,
           .doc = "eta P xi with the projector P of a dominant multiplier that is real and simple"),
    COLUMN("stretch", NUMBER(grazing_row, stretch), "root of 2 A_g", MAP),
    COLUMN("coefficient", NUMBERS(grazing_row, coefficient), "c_i = eta L^i xi", CRITERION, .axes = {"power"}),
    COLUMN("eta", NUMBERS(grazing_row, eta), "gradient of the gap's minimum", SECTION, .axes = {"coordinate"},
           .doc = "coefficient of the return map on the Poincare section at `grazing.section`: gradient of the gap's "
                  "minimum"),
    COLUMN("xi", NUMBERS(grazing_row, xi), "change of the state per gap rate", SECTION, .axes = {"coordinate"},
           .doc = "the same: change of state at an impact to first order in the root of the depth"),
    COLUMN("kappa", NUMBERS(grazing_row, kappa), "its part of second order", MAP, .axes = {"coordinate"},
           .doc = "the same: that change to second order"),
    COLUMN(
        "departure", NUMBERS(grazing_row, departure), "where a discontinuous one leaves to", CRITERION,
        .axes = {"coordinate"},
        .doc =
            "for discontinuous ones the direction of departure, L^i xi of length 1 with the first i for which c_i < 0"),
    COLUMN("L", NUMBERS(grazing_row, L), "derivative of the return map", SECTION, .axes = {"coordinate", "column"},
           .doc = "derivative of the return map without impacts. Coordinates of forced motions are displacements, then "
                  "velocities"),
    COLUMN("multipliers", COMPLEXES(grazing_row, multipliers), "eigenvalues of L, largest first", SECTION,
           .axes = {"eigenvalue"}, .doc = "eigenvalues of L, the largest modulus first"),
    COLUMN("q", NUMBERS(grazing_row, q), "displacements at the touch", POINT, .axes = {"particle"},
           .doc = "displacements at the grazing point"),
    COLUMN("v", NUMBERS(grazing_row, v), "velocities there", POINT, .axes = {"particle"}),
};

static const column window_columns[] = {
    COLUMN("window_period", INTEGERS(grazing_row, window_period), "period of the one-impact orbits", MAP,
           .axes = {"window"}, .doc = "period of the one-impact orbits of the map"),
    COLUMN("window_exists", WORDS(grazing_row, window_exists, flag_names), "whether they have a window", MAP,
           .axes = {"window"}, .doc = "whether they are admissible and stable anywhere (h5py reads this enum as bool)"),
    COLUMN("window_low", NUMBERS(grazing_row, window_low), "parameter at the edge of smaller d", MAP,
           .axes = {"window"},
           .doc = "parameter at the lower end of their range of d: parameter - d / slope to first order; above "
                  "`window_high` if the slope is positive"),
    COLUMN("window_high", NUMBERS(grazing_row, window_high), "parameter at the edge of larger d", MAP,
           .axes = {"window"}, .doc = "parameter at its upper end, likewise"),
    COLUMN("window_low_d", NUMBERS(grazing_row, window_low_d), "smaller d at which it ends", MAP, .axes = {"window"},
           .doc = "lower end of the range of d in which they are admissible and stable"),
    COLUMN("window_high_d", NUMBERS(grazing_row, window_high_d), "larger d at which it ends", MAP, .axes = {"window"},
           .doc = "upper end of that range; infinite when `open`"),
    COLUMN("window_low_kind", WORDS(grazing_row, window_low_kind, edge_names), "what ends it there", MAP,
           .axes = {"window"},
           .doc = "what ends it at its lower end; `border`: border collision, another iterate reaches the border; "
                  "`flip`: period doubling; `complex`: Neimark-Sacker; `zero`: d = 0"),
    COLUMN("window_high_kind", WORDS(grazing_row, window_high_kind, edge_names), "what ends it there", MAP,
           .axes = {"window"}, .doc = "what ends it at its upper end"),
    COLUMN("predicted_border_d", NUMBERS(grazing_row, predicted_border_d), "leading order: its border edge", LIMIT_MAP,
           .axes = {"window"}, .doc = "for continuous ones d of the border collision to leading order as d -> 0"),
    COLUMN("predicted_flip_d", NUMBERS(grazing_row, predicted_flip_d), "leading order: its flip edge", LIMIT_MAP,
           .axes = {"window"},
           .doc = "the same of the flip; for lambda > 2/3 it lies above the border and there is no window"),
};

static const column curve_columns[] = {
    COLUMN("curve_phase", NUMBER(grazing_curve_point, phase), "time of the touch over the period", POINT, AS_OF_TASK),
    COLUMN("curve_A_g", NUMBER(grazing_curve_point, A_g), "second derivative of the gap in time there", POINT,
           AS_OF_TASK),
    COLUMN("curve_verdict", WORD(grazing_curve_point, verdict, verdict_names), "what the coefficients c_i say",
           CRITERION, AS_OF_TASK),
    COLUMN("curve_first_negative", INTEGER(grazing_curve_point, first_negative), "the first i with c_i < 0, -1: none",
           CRITERION, AS_OF_TASK),
    COLUMN("curve_multiplier", COMPLEX(grazing_curve_point, multiplier), "dominant multiplier", CRITERION, AS_OF_TASK),
    COLUMN("curve_coefficient", NUMBERS(grazing_curve_point, coefficient), "c_i = eta L^i xi", CRITERION,
           .axes = {"power"}, AS_OF_TASK),
    COLUMN("curve_change", INTEGER(grazing_curve_point, change), "the i whose c_i changes its sign there, -1: none",
           CRITERION,
           .doc = "the i whose c_i changes its sign at this point, located on the curve; -1 of all other points"),
};

enum { ROWS, WINDOWS, CURVES };

/* Curves go through the grazing point of the task, which is no column. */
const column_list grazing_lists[] = {
    [ROWS] = {"grazing", "task", COLUMNS(row_columns)},
    [WINDOWS] = {"grazing", "task", COLUMNS(window_columns), .doc = "Unless `windows: 0`:\n"},
    [CURVES] =
        {"grazing", "curve_row", "curve_offset", CURVE_POINTS_MEANING, .columns = curve_point_columns + 1,
         .count = CURVE_POINT_COLUMNS - 1,
         .doc =
             "With the section `branch.trace`, ragged: points of the curve in two parameters, part 0 before part 1.\n"},
    {"grazing", "curve_row", COLUMNS(curve_columns)},
    {"grazing", "curve_end_row", "curve_end_offset", CURVE_ENDS_MEANING, .columns = curve_end_columns + 1,
     .count = CURVE_END_COLUMNS - 1,
     .doc = "With the section `branch.trace`, ragged: the ends of the curve, one per part.\n"},
    {0}};

double grazing_coordinates(const study_values *v) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  return strcmp(value_word(v, KEY_ORBIT_MOTION), "forced") == 0 ? 2 * n : 2 * n - 1;
}

void grazing_lay_out(const study_values *v, const char *followed, const char *traced, kind_plan *plan) {
  const size_t coordinates = (size_t)grazing_coordinates(v), windows = (size_t)value_number(v, KEY_GRAZING_WINDOWS, 0);
  const table_axis axes[] = {{"particle", (size_t)value_number(v, KEY_MODEL_PARTICLES, 0)},
                             {"power", (size_t)value_number(v, KEY_GRAZING_COEFFICIENTS, 0)},
                             {"coordinate", coordinates},
                             {"column", coordinates},
                             {"eigenvalue", coordinates},
                             {"window", windows}};
  const size_t axis_count = sizeof axes / sizeof *axes;
  plan->rows = (table){0};
  table_add(&plan->rows, &grazing_lists[ROWS], axes, axis_count);
  if (windows)
    table_add(&plan->rows, &grazing_lists[WINDOWS], axes, axis_count);
  table_put_parameter(&plan->rows, "parameter", followed);
  table_put_parameter(&plan->rows, "window_low", followed);
  table_put_parameter(&plan->rows, "window_high", followed);
  table_lay_out(&plan->rows);
  plan->tail_count = traced ? GRAZING_TAILS : 0;
  if (traced)
    curve_trace_lay_out(&grazing_lists[CURVES], followed, traced, axes, axis_count, &plan->tails[GRAZING_CURVES]);
}

static bool ends_in_none(const column *c) {
  return strcmp(c->names[c->name_count - 1], "none") == 0;
}

/* Words whose list ends in `none` have that, those of a regime begin with it. */
static void clear_column(const column *c, unsigned char *at) {
  const size_t count = column_values(c);
  const int64_t no_place = -1;
  const double no_number = NAN;
  if (c->type == COLUMN_ENUM)
    memset(at, ends_in_none(c) ? (int)c->name_count - 1 : 0, count);
  for (size_t i = 0; c->type == COLUMN_I64 && i < count; i++)
    memcpy(at + i * sizeof no_place, &no_place, sizeof no_place);
  const bool numbers = c->type == COLUMN_F64 || c->type == COLUMN_COMPLEX;
  for (size_t i = 0; numbers && i < column_bytes(c) / sizeof no_number; i++)
    memcpy(at + i * sizeof no_number, &no_number, sizeof no_number);
}

grazing_row grazing_clear_row(const table *t, unsigned char *row) {
  grazing_row values = {0};
  memset(row, 0, t->row_bytes);
  for (size_t k = 0; k < t->column_count; k++)
    clear_column(&t->columns[k], row + t->columns[k].offset);
  row_load(t, row, &values);
  return values;
}

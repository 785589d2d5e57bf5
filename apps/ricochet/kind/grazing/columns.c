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

/* The columns, in the order of the schema page. */
static const column row_columns[] = {
    COLUMN("outcome", WORD(grazing_row, outcome, outcome_names), "whether the family grazes", POINT),
    COLUMN("reason", TEXT(grazing_row, reason, GRAZING_REASON_BYTES), "why not; empty when it does", POINT),
    COLUMN("parameter", NUMBER(grazing_row, parameter), "the key that is followed", POINT),
    COLUMN("period", NUMBER(grazing_row, period), "period of the grazing motion", POINT),
    COLUMN("time", NUMBER(grazing_row, time), "when in the period it touches the obstacle", POINT),
    COLUMN("phase", NUMBER(grazing_row, phase), "this time over the period", POINT),
    COLUMN("obstacle", INTEGER(grazing_row, obstacle), "obstacle that is touched, floors by particle, then walls",
           POINT),
    COLUMN("particle", INTEGER(grazing_row, particle), "particle of it", POINT),
    COLUMN("side", WORD(grazing_row, side, side_names), "which of its obstacles", POINT),
    COLUMN("slope", NUMBER(grazing_row, slope), "change of the gap's minimum per change of the parameter", POINT),
    COLUMN("A_g", NUMBER(grazing_row, A_g), "second derivative of the gap in time at grazing", POINT),
    COLUMN("restitution", NUMBER(grazing_row, restitution), "restitution at vanishing gap rate",
           .source = "[FN97] (2.9)"),
    COLUMN("verdict", WORD(grazing_row, verdict, verdict_names), "what the coefficients c_i say", CRITERION),
    COLUMN("verdict_reason", TEXT(grazing_row, verdict_reason, GRAZING_REASON_BYTES), "why; empty when continuous",
           CRITERION),
    COLUMN("regime", WORD(grazing_row, regime, regime_names), "what the multiplier predicts beyond grazing", LIMIT_MAP),
    COLUMN("first_negative", INTEGER(grazing_row, first_negative), "the first i with c_i < 0, -1: none", CRITERION),
    COLUMN("first_zero", INTEGER(grazing_row, first_zero), "the first i with c_i = 0 within the tolerance, -1: none",
           CRITERION),
    COLUMN("settled", INTEGER(grazing_row, settled), "from this i on all c_i > 0 is proved, -1: not", CRITERION),
    COLUMN("multiplier", COMPLEX(grazing_row, multiplier), "dominant multiplier of L", CRITERION),
    COLUMN("second", NUMBER(grazing_row, second), "largest modulus of the others, 0: none", CRITERION),
    COLUMN("alpha", NUMBER(grazing_row, alpha), "eta P xi, P the projector of the dominant multiplier", LIMIT_MAP),
    COLUMN("stretch", NUMBER(grazing_row, stretch), "root of 2 A_g", MAP),
    COLUMN("coefficient", NUMBERS(grazing_row, coefficient), "c_i = eta L^i xi", CRITERION, .axes = {"power"}),
    COLUMN("eta", NUMBERS(grazing_row, eta), "gradient of the gap's minimum", SECTION, .axes = {"coordinate"}),
    COLUMN("xi", NUMBERS(grazing_row, xi), "change of the state per gap rate", SECTION, .axes = {"coordinate"}),
    COLUMN("kappa", NUMBERS(grazing_row, kappa), "its part of second order", MAP, .axes = {"coordinate"}),
    COLUMN("departure", NUMBERS(grazing_row, departure), "where a discontinuous one leaves to", CRITERION,
           .axes = {"coordinate"}),
    COLUMN("L", NUMBERS(grazing_row, L), "derivative of the return map", SECTION, .axes = {"coordinate", "column"}),
    COLUMN("multipliers", COMPLEXES(grazing_row, multipliers), "eigenvalues of L, largest first", SECTION,
           .axes = {"eigenvalue"}),
    COLUMN("q", NUMBERS(grazing_row, q), "displacements at the touch", POINT, .axes = {"particle"}),
    COLUMN("v", NUMBERS(grazing_row, v), "velocities there", POINT, .axes = {"particle"}),
    COLUMN("window_period", INTEGERS(grazing_row, window_period), "period of the one-impact orbits", MAP,
           .axes = {"window"}),
    COLUMN("window_exists", WORDS(grazing_row, window_exists, flag_names), "whether they have a window", MAP,
           .axes = {"window"}),
    COLUMN("window_low", NUMBERS(grazing_row, window_low), "parameter at the edge of smaller d", MAP,
           .axes = {"window"}),
    COLUMN("window_high", NUMBERS(grazing_row, window_high), "parameter at the edge of larger d", MAP,
           .axes = {"window"}),
    COLUMN("window_low_d", NUMBERS(grazing_row, window_low_d), "smaller d at which it ends", MAP, .axes = {"window"}),
    COLUMN("window_high_d", NUMBERS(grazing_row, window_high_d), "larger d at which it ends", MAP, .axes = {"window"}),
    COLUMN("window_low_kind", WORDS(grazing_row, window_low_kind, edge_names), "what ends it there", MAP,
           .axes = {"window"}),
    COLUMN("window_high_kind", WORDS(grazing_row, window_high_kind, edge_names), "what ends it there", MAP,
           .axes = {"window"}),
    COLUMN("predicted_border_d", NUMBERS(grazing_row, predicted_border_d), "leading order: its border edge", LIMIT_MAP,
           .axes = {"window"}),
    COLUMN("predicted_flip_d", NUMBERS(grazing_row, predicted_flip_d), "leading order: its flip edge", LIMIT_MAP,
           .axes = {"window"}),
};

static const column curve_columns[] = {
    COLUMN("curve_phase", NUMBER(grazing_curve_point, phase), "time of the touch over the period", POINT),
    COLUMN("curve_A_g", NUMBER(grazing_curve_point, A_g), "second derivative of the gap in time there", POINT),
    COLUMN("curve_verdict", WORD(grazing_curve_point, verdict, verdict_names), "what the coefficients c_i say",
           CRITERION),
    COLUMN("curve_first_negative", INTEGER(grazing_curve_point, first_negative), "the first i with c_i < 0, -1: none",
           CRITERION),
    COLUMN("curve_multiplier", COMPLEX(grazing_curve_point, multiplier), "dominant multiplier", CRITERION),
    COLUMN("curve_coefficient", NUMBERS(grazing_curve_point, coefficient), "c_i = eta L^i xi", CRITERION,
           .axes = {"power"}),
    COLUMN("curve_change", INTEGER(grazing_curve_point, change), "the i whose c_i changes its sign there, -1: none",
           CRITERION),
};

#define COUNT(columns) (sizeof(columns) / sizeof *(columns))

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
  const curve_tables curves = {.group = "grazing",
                               .followed = followed,
                               .traced = traced,
                               .own = curve_columns,
                               .own_count = COUNT(curve_columns),
                               .axes = axes,
                               .axis_count = COUNT(axes)};
  plan->rows = (table){.group = "grazing", .row_axis = "task"};
  table_add(&plan->rows, row_columns, COUNT(row_columns), axes, COUNT(axes) - (windows ? 0 : 1));
  table_put_long_name(&plan->rows, "parameter", followed);
  table_lay_out(&plan->rows);
  plan->tail_count = traced ? GRAZING_TAILS : 0;
  if (traced)
    curve_trace_lay_out(&curves, &plan->tails[GRAZING_CURVES], &plan->tails[GRAZING_CURVE_ENDS]);
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

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
    {.name = "outcome", WORD(grazing_row, outcome, outcome_names), .long_name = "whether the family grazes", POINT},
    {.name = "reason",
     TEXT(grazing_row, reason, GRAZING_REASON_BYTES),
     .long_name = "why not; empty when it does",
     POINT},
    {.name = "parameter", NUMBER(grazing_row, parameter), .long_name = "the key that is followed", POINT},
    {.name = "period", NUMBER(grazing_row, period), .long_name = "period of the grazing motion", POINT},
    {.name = "time", NUMBER(grazing_row, time), .long_name = "when in the period it touches the obstacle", POINT},
    {.name = "phase", NUMBER(grazing_row, phase), .long_name = "this time over the period", POINT},
    {.name = "obstacle",
     INTEGER(grazing_row, obstacle),
     .long_name = "obstacle that is touched, floors by particle, then walls",
     POINT},
    {.name = "particle", INTEGER(grazing_row, particle), .long_name = "particle of it", POINT},
    {.name = "side", WORD(grazing_row, side, side_names), .long_name = "which of its obstacles", POINT},
    {.name = "slope",
     NUMBER(grazing_row, slope),
     .long_name = "change of the gap's minimum per change of the parameter",
     POINT},
    {.name = "A_g", NUMBER(grazing_row, A_g), .long_name = "second derivative of the gap in time at grazing", POINT},
    {.name = "restitution",
     NUMBER(grazing_row, restitution),
     .long_name = "restitution at vanishing gap rate",
     .source = "[FN97] (2.9)"},
    {.name = "verdict",
     WORD(grazing_row, verdict, verdict_names),
     .long_name = "what the coefficients c_i say",
     CRITERION},
    {.name = "verdict_reason",
     TEXT(grazing_row, verdict_reason, GRAZING_REASON_BYTES),
     .long_name = "why; empty when continuous",
     CRITERION},
    {.name = "regime",
     WORD(grazing_row, regime, regime_names),
     .long_name = "what the multiplier predicts beyond grazing",
     LIMIT_MAP},
    {.name = "first_negative",
     INTEGER(grazing_row, first_negative),
     .long_name = "the first i with c_i < 0, -1: none",
     CRITERION},
    {.name = "first_zero",
     INTEGER(grazing_row, first_zero),
     .long_name = "the first i with c_i = 0 within the tolerance, -1: none",
     CRITERION},
    {.name = "settled",
     INTEGER(grazing_row, settled),
     .long_name = "from this i on all c_i > 0 is proved, -1: not",
     CRITERION},
    {.name = "multiplier", COMPLEX(grazing_row, multiplier), .long_name = "dominant multiplier of L", CRITERION},
    {.name = "second", NUMBER(grazing_row, second), .long_name = "largest modulus of the others, 0: none", CRITERION},
    {.name = "alpha",
     NUMBER(grazing_row, alpha),
     .long_name = "eta P xi, P the projector of the dominant multiplier",
     LIMIT_MAP},
    {.name = "stretch", NUMBER(grazing_row, stretch), .long_name = "root of 2 A_g", MAP},
    {.name = "coefficient",
     NUMBERS(grazing_row, coefficient),
     .axes = {"power"},
     .long_name = "c_i = eta L^i xi",
     CRITERION},
    {.name = "eta",
     NUMBERS(grazing_row, eta),
     .axes = {"coordinate"},
     .long_name = "gradient of the gap's minimum",
     SECTION},
    {.name = "xi",
     NUMBERS(grazing_row, xi),
     .axes = {"coordinate"},
     .long_name = "change of the state per gap rate",
     SECTION},
    {.name = "kappa",
     NUMBERS(grazing_row, kappa),
     .axes = {"coordinate"},
     .long_name = "its part of second order",
     MAP},
    {.name = "departure",
     NUMBERS(grazing_row, departure),
     .axes = {"coordinate"},
     .long_name = "where a discontinuous one leaves to",
     CRITERION},
    {.name = "L",
     NUMBERS(grazing_row, L),
     .axes = {"coordinate", "column"},
     .long_name = "derivative of the return map",
     SECTION},
    {.name = "multipliers",
     COMPLEXES(grazing_row, multipliers),
     .axes = {"eigenvalue"},
     .long_name = "eigenvalues of L, largest first",
     SECTION},
    {.name = "q", NUMBERS(grazing_row, q), .axes = {"particle"}, .long_name = "displacements at the touch", POINT},
    {.name = "v", NUMBERS(grazing_row, v), .axes = {"particle"}, .long_name = "velocities there", POINT},
    {.name = "window_period",
     INTEGERS(grazing_row, window_period),
     .axes = {"window"},
     .long_name = "period of the one-impact orbits",
     MAP},
    {.name = "window_exists",
     WORDS(grazing_row, window_exists, flag_names),
     .axes = {"window"},
     .long_name = "whether they have a window",
     MAP},
    {.name = "window_low",
     NUMBERS(grazing_row, window_low),
     .axes = {"window"},
     .long_name = "parameter at the edge of smaller d",
     MAP},
    {.name = "window_high",
     NUMBERS(grazing_row, window_high),
     .axes = {"window"},
     .long_name = "parameter at the edge of larger d",
     MAP},
    {.name = "window_low_d",
     NUMBERS(grazing_row, window_low_d),
     .axes = {"window"},
     .long_name = "smaller d at which it ends",
     MAP},
    {.name = "window_high_d",
     NUMBERS(grazing_row, window_high_d),
     .axes = {"window"},
     .long_name = "larger d at which it ends",
     MAP},
    {.name = "window_low_kind",
     WORDS(grazing_row, window_low_kind, edge_names),
     .axes = {"window"},
     .long_name = "what ends it there",
     MAP},
    {.name = "window_high_kind",
     WORDS(grazing_row, window_high_kind, edge_names),
     .axes = {"window"},
     .long_name = "what ends it there",
     MAP},
    {.name = "predicted_border_d",
     NUMBERS(grazing_row, predicted_border_d),
     .axes = {"window"},
     .long_name = "leading order: its border edge",
     LIMIT_MAP},
    {.name = "predicted_flip_d",
     NUMBERS(grazing_row, predicted_flip_d),
     .axes = {"window"},
     .long_name = "leading order: its flip edge",
     LIMIT_MAP},
};

static const column curve_columns[] = {
    {.name = "curve_phase",
     NUMBER(grazing_curve_point, phase),
     .long_name = "time of the touch over the period",
     POINT},
    {.name = "curve_A_g",
     NUMBER(grazing_curve_point, A_g),
     .long_name = "second derivative of the gap in time there",
     POINT},
    {.name = "curve_verdict",
     WORD(grazing_curve_point, verdict, verdict_names),
     .long_name = "what the coefficients c_i say",
     CRITERION},
    {.name = "curve_first_negative",
     INTEGER(grazing_curve_point, first_negative),
     .long_name = "the first i with c_i < 0, -1: none",
     CRITERION},
    {.name = "curve_multiplier",
     COMPLEX(grazing_curve_point, multiplier),
     .long_name = "dominant multiplier",
     CRITERION},
    {.name = "curve_coefficient",
     NUMBERS(grazing_curve_point, coefficient),
     .axes = {"power"},
     .long_name = "c_i = eta L^i xi",
     CRITERION},
    {.name = "curve_change",
     INTEGER(grazing_curve_point, change),
     .long_name = "the i whose c_i changes its sign there, -1: none",
     CRITERION},
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

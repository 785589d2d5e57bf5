#include "grazing.h"

#include <math.h>
#include <string.h>

#include "curve_trace.h"

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

#define NUMBER     .type = COLUMN_F64, .units = "1"
#define INTEGER    .type = COLUMN_I64, .units = "1"
#define COMPLEX    .type = COLUMN_COMPLEX, .units = "1"
#define WORD(list) .type = COLUMN_ENUM, .names = (list), .name_count = sizeof(list) / sizeof *(list), .units = "1"
#define TEXT       .type = COLUMN_TEXT, .text_bytes = GRAZING_REASON_BYTES, .units = "1"
#define POINT      .source = "[FN97] (4.1)"
#define SECTION    .source = "[FN97] (5.5)-(5.8)"
#define CRITERION  .source = "[FN97] (5.10)"
#define MAP        .source = "[FN97] (5.11)"
#define LIMIT_MAP  .source = "[FN97] (5.14)"

/* The columns, in the order of the schema page. */
static const column row_columns[] = {
    {.name = "outcome", WORD(outcome_names), .long_name = "whether the family grazes", POINT},
    {.name = "reason", TEXT, .long_name = "why not; empty when it does", POINT},
    {.name = "parameter", NUMBER, .long_name = "the key that is followed", POINT},
    {.name = "period", NUMBER, .long_name = "period of the grazing motion", POINT},
    {.name = "time", NUMBER, .long_name = "when in the period it touches the obstacle", POINT},
    {.name = "phase", NUMBER, .long_name = "this time over the period", POINT},
    {.name = "obstacle", INTEGER, .long_name = "obstacle that is touched, floors by particle, then walls", POINT},
    {.name = "particle", INTEGER, .long_name = "particle of it", POINT},
    {.name = "side", WORD(side_names), .long_name = "which of its obstacles", POINT},
    {.name = "slope", NUMBER, .long_name = "change of the gap's minimum per change of the parameter", POINT},
    {.name = "A_g", NUMBER, .long_name = "second derivative of the gap in time at grazing", POINT},
    {.name = "restitution", NUMBER, .long_name = "restitution at vanishing gap rate", .source = "[FN97] (2.9)"},
    {.name = "verdict", WORD(verdict_names), .long_name = "what the coefficients c_i say", CRITERION},
    {.name = "verdict_reason", TEXT, .long_name = "why; empty when continuous", CRITERION},
    {.name = "regime", WORD(regime_names), .long_name = "what the multiplier predicts beyond grazing", LIMIT_MAP},
    {.name = "first_negative", INTEGER, .long_name = "the first i with c_i < 0, -1: none", CRITERION},
    {.name = "first_zero", INTEGER, .long_name = "the first i with c_i = 0 within the tolerance, -1: none", CRITERION},
    {.name = "settled", INTEGER, .long_name = "from this i on all c_i > 0 is proved, -1: not", CRITERION},
    {.name = "multiplier", COMPLEX, .long_name = "dominant multiplier of L", CRITERION},
    {.name = "second", NUMBER, .long_name = "largest modulus of the others, 0: none", CRITERION},
    {.name = "alpha", NUMBER, .long_name = "eta P xi, P the projector of the dominant multiplier", LIMIT_MAP},
    {.name = "stretch", NUMBER, .long_name = "root of 2 A_g", MAP},
    {.name = "coefficient", NUMBER, .axes = {"power"}, .long_name = "c_i = eta L^i xi", CRITERION},
    {.name = "eta", NUMBER, .axes = {"coordinate"}, .long_name = "gradient of the gap's minimum", SECTION},
    {.name = "xi", NUMBER, .axes = {"coordinate"}, .long_name = "change of the state per gap rate", SECTION},
    {.name = "kappa", NUMBER, .axes = {"coordinate"}, .long_name = "its part of second order", MAP},
    {.name = "departure",
     NUMBER,
     .axes = {"coordinate"},
     .long_name = "where a discontinuous one leaves to",
     CRITERION},
    {.name = "L", NUMBER, .axes = {"coordinate", "column"}, .long_name = "derivative of the return map", SECTION},
    {.name = "multipliers", COMPLEX, .axes = {"eigenvalue"}, .long_name = "eigenvalues of L, largest first", SECTION},
    {.name = "q", NUMBER, .axes = {"particle"}, .long_name = "displacements at the touch", POINT},
    {.name = "v", NUMBER, .axes = {"particle"}, .long_name = "velocities there", POINT},
    {.name = "window_period", INTEGER, .axes = {"window"}, .long_name = "period of the one-impact orbits", MAP},
    {.name = "window_exists", WORD(flag_names), .axes = {"window"}, .long_name = "whether they have a window", MAP},
    {.name = "window_low", NUMBER, .axes = {"window"}, .long_name = "parameter at the edge of smaller d", MAP},
    {.name = "window_high", NUMBER, .axes = {"window"}, .long_name = "parameter at the edge of larger d", MAP},
    {.name = "window_low_d", NUMBER, .axes = {"window"}, .long_name = "smaller d at which it ends", MAP},
    {.name = "window_high_d", NUMBER, .axes = {"window"}, .long_name = "larger d at which it ends", MAP},
    {.name = "window_low_kind", WORD(edge_names), .axes = {"window"}, .long_name = "what ends it there", MAP},
    {.name = "window_high_kind", WORD(edge_names), .axes = {"window"}, .long_name = "what ends it there", MAP},
    {.name = "predicted_border_d",
     NUMBER,
     .axes = {"window"},
     .long_name = "leading order: its border edge",
     LIMIT_MAP},
    {.name = "predicted_flip_d", NUMBER, .axes = {"window"}, .long_name = "leading order: its flip edge", LIMIT_MAP},
};

static const column curve_columns[] = {
    {.name = "curve_phase", NUMBER, .long_name = "time of the touch over the period", POINT},
    {.name = "curve_A_g", NUMBER, .long_name = "second derivative of the gap in time there", POINT},
    {.name = "curve_verdict", WORD(verdict_names), .long_name = "what the coefficients c_i say", CRITERION},
    {.name = "curve_first_negative", INTEGER, .long_name = "the first i with c_i < 0, -1: none", CRITERION},
    {.name = "curve_multiplier", COMPLEX, .long_name = "dominant multiplier", CRITERION},
    {.name = "curve_coefficient", NUMBER, .axes = {"power"}, .long_name = "c_i = eta L^i xi", CRITERION},
    {.name = "curve_change", INTEGER, .long_name = "the i whose c_i changes its sign there, -1: none", CRITERION},
};

#define COUNT(columns) (sizeof(columns) / sizeof *(columns))

double grazing_coordinates(const study_values *v) {
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  return strcmp(value_word(v, KEY_ORBIT_MOTION), "forced") == 0 ? 2 * n : 2 * n - 1;
}

double grazing_row_bytes(const study_values *v) {
  const double c = grazing_coordinates(v), windows = value_number(v, KEY_GRAZING_WINDOWS, 0);
  return 8 * (c * c + 8 * c + 10 * windows + value_number(v, KEY_GRAZING_COEFFICIENTS, 0) + COUNT(row_columns)) +
         2 * GRAZING_REASON_BYTES;
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
static void clear_words(const column *c, unsigned char *row) {
  for (size_t i = 0; i < column_values(c); i++)
    row_put_word_at(row, c, i, ends_in_none(c) ? (int)c->name_count - 1 : 0);
}

static void clear_numbers(const column *c, unsigned char *row) {
  double *numbers = row_numbers(row, c);
  for (size_t i = 0; i < column_bytes(c) / sizeof *numbers; i++)
    numbers[i] = NAN;
}

void grazing_clear_row(const table *t, unsigned char *row) {
  memset(row, 0, t->row_bytes);
  for (size_t k = 0; k < t->column_count; k++) {
    const column *c = &t->columns[k];
    if (c->type == COLUMN_ENUM)
      clear_words(c, row);
    else if (c->type == COLUMN_F64 || c->type == COLUMN_COMPLEX)
      clear_numbers(c, row);
    for (size_t i = 0; c->type == COLUMN_I64 && i < column_values(c); i++)
      row_put_integer_at(row, c, i, -1);
  }
}

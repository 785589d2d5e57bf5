#include "orbits.h"

#include <string.h>

#include "stability.h"

const char *const orbit_outcome_names[RIC_OUTCOME_COUNT] = {
#define X(name, text) text,
    RIC_OUTCOME_LIST(X)
#undef X
};

static const char *const verification_names[RIC_VERIFICATION_RESULTS] = {
#define X(name, text) text,
    RIC_VERIFICATION_LIST(X)
#undef X
};

static const char *const stability_names[RIC_STABILITIES] = {
#define X(name, text) text,
    RIC_STABILITY_LIST(X)
#undef X
};

/* The columns, in the order of the schema page: those of every orbit, of the verifier, of the multipliers. */
static const column columns[] = {
    {.name = "outcome",
     .type = COLUMN_ENUM,
     .names = orbit_outcome_names,
     .name_count = RIC_OUTCOME_COUNT,
     .units = "1",
     .long_name = "outcome of the orbit",
     .source = "[JAP] (9)"},
    {.name = "reason",
     .type = COLUMN_TEXT,
     .text_bytes = RIC_REASON_BYTES,
     .units = "1",
     .long_name = "which particle, when, by how much",
     .source = "[JAP] (9)"},
    {.name = "q",
     .type = COLUMN_F64,
     .axes = {"particle"},
     .units = "1",
     .long_name = "position at t = 0+",
     .source = "[JAP] (7)-(8)"},
    {.name = "v",
     .type = COLUMN_F64,
     .axes = {"particle"},
     .units = "1",
     .long_name = "velocity at t = 0+",
     .source = "[JAP] (7)-(8)"},
    {.name = "impulse",
     .type = COLUMN_F64,
     .axes = {"impact"},
     .units = "1",
     .long_name = "velocity jump of each impact, at_start then at_half",
     .source = "[JAP] (3)"},
    {.name = "energy", .type = COLUMN_F64, .units = "1", .long_name = "total energy", .source = "[JAP] (1)"},
    {.name = "residual",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "largest violation of the orbit's equations",
     .source = "[JAP] (7)-(8)"},
    {.name = "clearance",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "smallest gap of the particles that the pattern leaves free",
     .source = "[JAP] (9)"},
    {.name = "clearance_time",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "time of the smallest gap, in [0, T/2]",
     .source = "[JAP] (9)"},
    {.name = "clearance_particle",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "particle of the smallest gap, -1 when every particle is in the pattern",
     .source = "[JAP] (9)"},
    {.name = "condition",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "condition number of the equations solved",
     .source = "[JAP] (11)"},
    {.name = "mode",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "resonant mode of the outcomes grazing and resonant, else -1",
     .source = "[JAP] (12)"},
    {.name = "harmonic",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "oscillations of that mode per period, else 0",
     .source = "[JAP] (12)"},
};

static const column verifier_columns[] = {
    {.name = "verified",
     .type = COLUMN_ENUM,
     .names = verification_names,
     .name_count = RIC_VERIFICATION_RESULTS,
     .units = "1",
     .long_name = "what an event-driven run over one period found",
     .source = "[JAP] (1)-(3)"},
    {.name = "closure_error",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "difference after one period, relative to the largest displacement and velocity",
     .source = "[JAP] (1)-(3)"},
};

static const column stability_columns[] = {
    {.name = "stable",
     .type = COLUMN_ENUM,
     .names = stability_names,
     .name_count = RIC_STABILITIES,
     .units = "1",
     .long_name = "whether all multipliers lie in the unit disc",
     .source = "[JAP] (16)"},
    {.name = "stable_reason",
     .type = COLUMN_TEXT,
     .text_bytes = sizeof((ric_multipliers){0}.reason),
     .units = "1",
     .long_name = "which multiplier, or why none is known; empty when stable",
     .source = "[JAP] (16)"},
    {.name = "multiplier_max",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "largest modulus of a Floquet multiplier",
     .source = "[JAP] (16)"},
    {.name = "multipliers",
     .type = COLUMN_COMPLEX,
     .axes = {"multiplier"},
     .units = "1",
     .long_name = "Floquet multipliers, the largest modulus first",
     .source = "[JAP] (16)"},
    {.name = "multiplier_outside",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "number of multipliers outside the unit circle by more than the band, -1 when unknown",
     .source = "[JAP] (16)"},
    {.name = "multiplier_real_above",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "number of them that are real and positive, -1 when unknown",
     .source = "[JAP] (16)"},
    {.name = "multiplier_real_below",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "number of them that are real and negative, -1 when unknown",
     .source = "[JAP] (16)"},
    {.name = "multiplier_complex",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "number of them that are not real, -1 when unknown",
     .source = "[JAP] (16)"},
};

static const column ritz_columns[] = {
    {.name = "ritz_functions",
     .type = COLUMN_I64,
     .units = "1",
     .long_name = "trial functions per particle, 0 when none were found",
     .source = "[VID] (2)"},
    {.name = "ritz_frequency",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "angular frequency of the motion when the impact is ignored",
     .source = "[VID] (2)"},
    {.name = "ritz_error",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "largest difference of a displacement, at any time, from the orbit found by shooting",
     .source = "[VID] (2)"},
    {.name = "ritz_error_v",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "the same of a velocity",
     .source = "[VID] (2)"},
    {.name = "ritz_defect",
     .type = COLUMN_F64,
     .units = "1",
     .long_name = "largest residual of the equations of motion over the largest acceleration",
     .source = "[VID] (1a)"},
};

#define ADD(t, columns, axes, axis_count)                                                                              \
  table_add((t), (columns), sizeof(columns) / sizeof *(columns), (axes), (axis_count))

void orbits_lay_out(const study_values *v, table *t) {
  const size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  const size_t impacts = value_count(v, KEY_ORBIT_AT_START) + value_count(v, KEY_ORBIT_AT_HALF);
  table_axis axes[3] = {{"impact", impacts}};
  size_t count = 1;
  if (value_flag(v, KEY_ORBIT_STATES))
    axes[count++] = (table_axis){"particle", n};
  if (value_flag(v, KEY_ORBIT_MULTIPLIERS))
    axes[count++] = (table_axis){"multiplier", 2 * n};
  *t = (table){.group = "orbits", .row_axis = "task"};
  ADD(t, columns, axes, count);
  if (value_flag(v, KEY_ORBIT_VERIFY))
    ADD(t, verifier_columns, axes, count);
  if (stability_wanted(v)) {
    ADD(t, stability_columns, axes, count);
    stability_put_tolerances(t);
  }
  if (strcmp(value_word(v, KEY_ORBIT_METHOD), "ritz") == 0)
    ADD(t, ritz_columns, axes, count);
  table_lay_out(t);
}

void orbits_put(const ric_orbit *o, const char *reason, const ric_verification *verification, const table *t,
                unsigned char *row) {
  memset(row, 0, t->row_bytes);
  row_put_word(row, table_column(t, "outcome"), (int)o->outcome);
  row_put_text(row, table_column(t, "reason"), reason);
  row_put_numbers(row, table_column(t, "q"), o->q);
  row_put_numbers(row, table_column(t, "v"), o->v);
  row_put_numbers(row, table_column(t, "impulse"), o->impulse);
  row_put_number(row, table_column(t, "energy"), o->energy);
  row_put_number(row, table_column(t, "residual"), o->residual);
  row_put_number(row, table_column(t, "clearance"), o->clearance);
  row_put_number(row, table_column(t, "clearance_time"), o->clearance_time);
  row_put_integer(row, table_column(t, "clearance_particle"), o->clearance_particle);
  row_put_number(row, table_column(t, "condition"), o->condition);
  row_put_integer(row, table_column(t, "mode"), o->mode);
  row_put_integer(row, table_column(t, "harmonic"), o->harmonic);
  row_put_word(row, table_column(t, "verified"), (int)verification->result);
  row_put_number(row, table_column(t, "closure_error"), verification->closure_error);
}

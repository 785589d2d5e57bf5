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
     WORD(orbits_row, outcome, orbit_outcome_names),
     .long_name = "outcome of the orbit",
     .source = "[JAP] (9)"},
    {.name = "reason",
     TEXT(orbits_row, reason, RIC_REASON_BYTES),
     .long_name = "which particle, when, by how much",
     .source = "[JAP] (9)"},
    {.name = "q",
     NUMBERS(orbits_row, q),
     .axes = {"particle"},
     .long_name = "position at t = 0+",
     .source = "[JAP] (7)-(8)"},
    {.name = "v",
     NUMBERS(orbits_row, v),
     .axes = {"particle"},
     .long_name = "velocity at t = 0+",
     .source = "[JAP] (7)-(8)"},
    {.name = "impulse",
     NUMBERS(orbits_row, impulse),
     .axes = {"impact"},
     .long_name = "velocity jump of each impact, at_start then at_half",
     .source = "[JAP] (3)"},
    {.name = "energy", NUMBER(orbits_row, energy), .long_name = "total energy", .source = "[JAP] (1)"},
    {.name = "residual",
     NUMBER(orbits_row, residual),
     .long_name = "largest violation of the orbit's equations",
     .source = "[JAP] (7)-(8)"},
    {.name = "clearance",
     NUMBER(orbits_row, clearance),
     .long_name = "smallest gap of the particles that the pattern leaves free",
     .source = "[JAP] (9)"},
    {.name = "clearance_time",
     NUMBER(orbits_row, clearance_time),
     .long_name = "time of the smallest gap, in [0, T/2]",
     .source = "[JAP] (9)"},
    {.name = "clearance_particle",
     INTEGER(orbits_row, clearance_particle),
     .long_name = "particle of the smallest gap, -1 when every particle is in the pattern",
     .source = "[JAP] (9)"},
    {.name = "condition",
     NUMBER(orbits_row, condition),
     .long_name = "condition number of the equations solved",
     .source = "[JAP] (11)"},
    {.name = "mode",
     INTEGER(orbits_row, mode),
     .long_name = "resonant mode of the outcomes grazing and resonant, else -1",
     .source = "[JAP] (12)"},
    {.name = "harmonic",
     INTEGER(orbits_row, harmonic),
     .long_name = "oscillations of that mode per period, else 0",
     .source = "[JAP] (12)"},
};

static const column verifier_columns[] = {
    {.name = "verified",
     WORD(orbits_row, verified, verification_names),
     .long_name = "what an event-driven run over one period found",
     .source = "[JAP] (1)-(3)"},
    {.name = "closure_error",
     NUMBER(orbits_row, closure_error),
     .long_name = "difference after one period, relative to the largest displacement and velocity",
     .source = "[JAP] (1)-(3)"},
};

static const column stability_columns[] = {
    {.name = "stable",
     WORD(orbits_row, stable, stability_names),
     .long_name = "whether all multipliers lie in the unit disc",
     .source = "[JAP] (16)"},
    {.name = "stable_reason",
     TEXT(orbits_row, stable_reason, sizeof((ric_multipliers){0}.reason)),
     .long_name = "which multiplier, or why none is known; empty when stable",
     .source = "[JAP] (16)"},
    {.name = "multiplier_max",
     NUMBER(orbits_row, multiplier_max),
     .long_name = "largest modulus of a Floquet multiplier",
     .source = "[JAP] (16)"},
    {.name = "multipliers",
     COMPLEXES(orbits_row, multipliers),
     .axes = {"multiplier"},
     .long_name = "Floquet multipliers, the largest modulus first",
     .source = "[JAP] (16)"},
    {.name = "multiplier_outside",
     INTEGER(orbits_row, multiplier_outside),
     .long_name = "number of multipliers outside the unit circle by more than the band, -1 when unknown",
     .source = "[JAP] (16)"},
    {.name = "multiplier_real_above",
     INTEGER(orbits_row, multiplier_real_above),
     .long_name = "number of them that are real and positive, -1 when unknown",
     .source = "[JAP] (16)"},
    {.name = "multiplier_real_below",
     INTEGER(orbits_row, multiplier_real_below),
     .long_name = "number of them that are real and negative, -1 when unknown",
     .source = "[JAP] (16)"},
    {.name = "multiplier_complex",
     INTEGER(orbits_row, multiplier_complex),
     .long_name = "number of them that are not real, -1 when unknown",
     .source = "[JAP] (16)"},
};

static const column ritz_columns[] = {
    {.name = "ritz_functions",
     INTEGER(orbits_row, ritz_functions),
     .long_name = "trial functions per particle, 0 when none were found",
     .source = "[VID] (2)"},
    {.name = "ritz_frequency",
     NUMBER(orbits_row, ritz_frequency),
     .long_name = "angular frequency of the motion when the impact is ignored",
     .source = "[VID] (2)"},
    {.name = "ritz_error",
     NUMBER(orbits_row, ritz_error),
     .long_name = "largest difference of a displacement, at any time, from the orbit found by shooting",
     .source = "[VID] (2)"},
    {.name = "ritz_error_v",
     NUMBER(orbits_row, ritz_error_v),
     .long_name = "the same of a velocity",
     .source = "[VID] (2)"},
    {.name = "ritz_defect",
     NUMBER(orbits_row, ritz_defect),
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

orbits_row orbits_row_of(const ric_orbit *o, const char *reason, const ric_verification *verification) {
  return (orbits_row){.outcome = (int)o->outcome,
                      .reason = reason,
                      .q = o->q,
                      .v = o->v,
                      .impulse = o->impulse,
                      .energy = o->energy,
                      .residual = o->residual,
                      .clearance = o->clearance,
                      .clearance_time = o->clearance_time,
                      .clearance_particle = o->clearance_particle,
                      .condition = o->condition,
                      .mode = o->mode,
                      .harmonic = o->harmonic,
                      .verified = (int)verification->result,
                      .closure_error = verification->closure_error};
}

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

const char *const orbit_stability_names[RIC_STABILITIES] = {
#define X(name, text) text,
    RIC_STABILITY_LIST(X)
#undef X
};

#define OF_ORBIT        OF(orbits_row, orbit)
#define OF_VERIFICATION OF(orbits_row, verification)

/* The columns: those of every orbit, of the verifier, of the multipliers, of Ritz's method. */
static const column columns[] = {
    COLUMN("outcome", WORD(ric_orbit, outcome, orbit_outcome_names), "outcome of the orbit", OF_ORBIT,
           .source = "[JAP] (9)", .doc = "outcome of the orbit; states of `singular` and `failed` tasks are NaN"),
    COLUMN("reason", TEXT(orbits_row, reason, RIC_REASON_BYTES), "which particle, when, by how much",
           .source = "[JAP] (9)",
           .doc = "which particle, when, by how much; empty if admissible and, with `verify: true`, verified"),
    COLUMN("q", NUMBERS(ric_orbit, q), "position at t = 0+", OF_ORBIT, .source = "[JAP] (7)-(8)", .axes = {"particle"},
           .doc = "displacement at t = 0+ (absent with `states: false`); with `method: ritz` of the approximation"),
    COLUMN("v", NUMBERS(ric_orbit, v), "velocity at t = 0+", OF_ORBIT, .source = "[JAP] (7)-(8)", .axes = {"particle"},
           .doc = "velocity there, likewise"),
    COLUMN("impulse", NUMBERS(ric_orbit, impulse), "velocity jump of each impact, at_start then at_half", OF_ORBIT,
           .source = "[JAP] (3)", .axes = {"impact"}),
    COLUMN("energy", NUMBER(ric_orbit, energy), "total energy", OF_ORBIT, .source = "[JAP] (1)",
           .doc = "total energy; with `method: ritz` of the approximation"),
    COLUMN("residual", NUMBER(ric_orbit, residual), "largest violation of the orbit's equations", OF_ORBIT,
           .source = "[JAP] (7)-(8)",
           .doc = "largest violation of the contact conditions and of the equations of motion"),
    COLUMN("clearance", NUMBER(ric_orbit, clearance), "smallest gap of the particles that the pattern leaves free",
           OF_ORBIT, .source = "[JAP] (9)",
           .doc = "smallest gap of the particles that the pattern leaves free and that have a floor; within 1e-12 of "
                  "the true one, relative to the largest displacement; NaN when there is none"),
    COLUMN("clearance_time", NUMBER(ric_orbit, clearance_time), "time of the smallest gap, in [0, T/2]", OF_ORBIT,
           .source = "[JAP] (9)", .doc = "time of the smallest gap, in [0, T/2]; NaN when there is none"),
    COLUMN("clearance_particle", INTEGER(ric_orbit, clearance_particle),
           "particle of the smallest gap, -1 when every particle is in the pattern", OF_ORBIT, .source = "[JAP] (9)",
           .doc = "particle of the smallest gap; -1 when there is none"),
    COLUMN("condition", NUMBER(ric_orbit, condition), "condition number of the equations solved", OF_ORBIT,
           .source = "[JAP] (11)",
           .doc = "condition number: about the orbit's amplitude over the floor's distance (impulse), of the matrix of "
                  "(11) (dense)"),
    COLUMN("mode", INTEGER(ric_orbit, mode), "resonant mode of the outcomes grazing and resonant, else -1", OF_ORBIT,
           .source = "[JAP] (12)"),
    COLUMN("harmonic", INTEGER(ric_orbit, harmonic), "oscillations of that mode per period, else 0", OF_ORBIT,
           .source = "[JAP] (12)"),
};

static const column verifier_columns[] = {
    COLUMN("verified", WORD(ric_verification, result, verification_names),
           "what an event-driven run over one period found", OF_VERIFICATION, .source = "[JAP] (1)-(3)",
           .doc = "result of an event-driven run over one period; `impact_missing`, `impact_extra`: compared with the "
                  "predicted impacts; `not_run` for orbits that are neither admissible nor grazing"),
    COLUMN("closure_error", NUMBER(ric_verification, closure_error),
           "difference after one period, relative to the largest displacement and velocity", OF_VERIFICATION,
           .source = "[JAP] (1)-(3)",
           .doc = "largest difference of displacements and velocities after that period, relative to the largest "
                  "displacement and velocity; NaN when not run"),
};

static const column stability_columns[] = {
    COLUMN(
        "stable", WORD(orbits_row, stable, orbit_stability_names), "whether all multipliers lie in the unit disc",
        .source = "[JAP] (16)",
        .doc =
            "whether all multipliers lie in the unit disc; `undecided`: a multiplier is too close to the unit circle; "
            "`unknown`: no orbit, or one that grazes. Attributes: `band` (distance from the unit circle beyond which a "
            "multiplier decides), `band_at_one` (the same near 1), `multiplier_tol` (a modulus within it of 1 is 1)"),
    COLUMN("stable_reason", TEXT(orbits_row, stable_reason, sizeof((ric_multipliers){0}.reason)),
           "which multiplier, or why none is known; empty when stable", .source = "[JAP] (16)"),
    COLUMN("multiplier_max", NUMBER(orbits_row, multiplier_max), "largest modulus of a Floquet multiplier",
           .source = "[JAP] (16)", .doc = "largest modulus of a Floquet multiplier; NaN when unknown"),
    COLUMN("multipliers", COMPLEXES(orbits_row, multipliers), "Floquet multipliers, the largest modulus first",
           .source = "[JAP] (16)", .axes = {"multiplier"},
           .doc =
               "with `multipliers: true`: all of them, the largest modulus first, then by argument; NaN when unknown"),
    COLUMN("multiplier_outside", INTEGER(orbits_row, multiplier_outside),
           "number of multipliers outside the unit circle by more than the band, -1 when unknown",
           .source = "[JAP] (16)"),
    COLUMN("multiplier_real_above", INTEGER(orbits_row, multiplier_real_above),
           "number of them that are real and positive, -1 when unknown", .source = "[JAP] (16)",
           .doc = "number of these that are real and above 1; -1 when unknown"),
    COLUMN("multiplier_real_below", INTEGER(orbits_row, multiplier_real_below),
           "number of them that are real and negative, -1 when unknown", .source = "[JAP] (16)",
           .doc = "number of these that are real and below -1; -1 when unknown"),
    COLUMN("multiplier_complex", INTEGER(orbits_row, multiplier_complex),
           "number of them that are not real, -1 when unknown", .source = "[JAP] (16)",
           .doc = "number of these that are complex; -1 when unknown"),
};

static const column ritz_columns[] = {
    COLUMN("ritz_functions", INTEGER(orbits_row, ritz_functions),
           "trial functions per particle, 0 when none were found", .source = "[VID] (2)"),
    COLUMN("ritz_frequency", NUMBER(orbits_row, ritz_frequency),
           "angular frequency of the motion when the impact is ignored", .source = "[VID] (2)"),
    COLUMN("ritz_error", NUMBER(orbits_row, ritz_error),
           "largest difference of a displacement, at any time, from the orbit found by shooting",
           .source = "[VID] (2)"),
    COLUMN("ritz_error_v", NUMBER(orbits_row, ritz_error_v), "the same of a velocity", .source = "[VID] (2)",
           .doc = "largest difference of a velocity, at any time, from that orbit"),
    COLUMN("ritz_defect", NUMBER(orbits_row, ritz_defect),
           "largest residual of the equations of motion over the largest acceleration", .source = "[VID] (1a)"),
};

enum { ROWS, VERIFIER, STABILITY, RITZ };

#define LIST .group = "orbits", .row_axis = "task"

const column_list orbits_lists[] = {
    [ROWS] = {LIST, COLUMNS(columns), .doc = "A task is one periodic orbit.\n"},
    [VERIFIER] = {LIST, COLUMNS(verifier_columns), .doc = "With `verify: true`:\n"},
    [STABILITY] = {LIST, COLUMNS(stability_columns),
                   .doc = "With `stable: true`, and with `multipliers: true`, which implies it. Inadmissible orbits "
                          "have multipliers, too:\n"
                          "those of the motion through the obstacles that the pattern ignores.\n"},
    [RITZ] = {LIST, COLUMNS(ritz_columns),
              .doc = "With `method: ritz`. All columns except `q`, `v`, `energy` and these are those of the orbit "
                     "found by shooting:\n"},
    {0}};

void orbits_lay_out(const study_values *v, table *t) {
  const size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  const size_t impacts = value_count(v, KEY_ORBIT_AT_START) + value_count(v, KEY_ORBIT_AT_HALF);
  table_axis axes[3] = {{"impact", impacts}};
  size_t count = 1;
  if (value_flag(v, KEY_ORBIT_STATES))
    axes[count++] = (table_axis){"particle", n};
  if (value_flag(v, KEY_ORBIT_MULTIPLIERS))
    axes[count++] = (table_axis){"multiplier", 2 * n};
  *t = (table){0};
  table_add(t, &orbits_lists[ROWS], axes, count);
  if (value_flag(v, KEY_ORBIT_VERIFY))
    table_add(t, &orbits_lists[VERIFIER], axes, count);
  if (stability_wanted(v)) {
    table_add(t, &orbits_lists[STABILITY], axes, count);
    stability_put_tolerances(t);
  }
  if (strcmp(value_word(v, KEY_ORBIT_METHOD), "ritz") == 0)
    table_add(t, &orbits_lists[RITZ], axes, count);
  table_lay_out(t);
}

ric_status orbits_verified(ric_status status, const ric_error *error, ric_verification *v) {
  if (status == RIC_OK || status == RIC_ESTOPPED)
    return status;
  *v = (ric_verification){.result = RIC_RUN_FAILED, .closure_error = NAN};
  snprintf(v->reason, sizeof v->reason, "%.*s", (int)sizeof v->reason - 1, error->message);
  return RIC_OK;
}

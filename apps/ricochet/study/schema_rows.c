/* The schema table: sections `orbit`, `start` and `time`, and where every key's row stands. */
#include "schema_rows.h"

#include "study.h"

static const schema_entry sweep_rows[SWEEP_KEY_COUNT] = {
    [SWEEP_PARAMETER] = {.path = "sweep.parameter",
                         .type = VALUE_TEXT,
                         .scalar = true,
                         .required = true,
                         .doc = "The key that is swept, or an element of its list: `model.gamma`, `model.floor[3]`."},
    [SWEEP_VALUES] = {.path = "sweep.values",
                      .type = VALUE_NUMBER,
                      .list = true,
                      ANY,
                      .doc = "The values, in the order of the tasks."},
    [SWEEP_FROM] = {.path = "sweep.from",
                    .type = VALUE_NUMBER,
                    .scalar = true,
                    ANY,
                    .doc = "Instead of `values`: the first value."},
    [SWEEP_TO] = {.path = "sweep.to",
                  .type = VALUE_NUMBER,
                  .scalar = true,
                  ANY,
                  .doc = "The last value, larger than `from`, met exactly."},
    [SWEEP_POINTS] = {.path = "sweep.points",
                      .type = VALUE_INTEGER,
                      .scalar = true,
                      .low = 1,
                      .high = STUDY_MAX_POINTS,
                      .doc = "Number of values, both ends included; 1 only where `from` equals `to`."},
    [SWEEP_SCALE] = {.path = "sweep.scale",
                     .type = VALUE_WORD,
                     .scalar = true,
                     .fallback = "linear",
                     .words = "linear|log",
                     .doc = "`linear`: equal steps; `log`: equal ratios, `from` above 0."},
    [SWEEP_BACK] = {.path = "sweep.back",
                    .type = VALUE_FLAG,
                    .scalar = true,
                    .fallback = "false",
                    .doc = "The values once more in the reverse order, after the others: with `iterate.follow`, there "
                           "and back."},
};

const schema_entry *schema_sweep_row(sweep_key key) {
  return &sweep_rows[key];
}

/* Types of model of which each method finds orbits. */
static const char *const method_models[] = {"chain", "chain", NULL, NULL};

static const schema_entry rows[KEY_BRANCH_PARAMETER - KEY_ORBIT_PERIOD] = {
    [KEY_ORBIT_PERIOD -
     KEY_ORBIT_PERIOD] = {.path = "orbit.period",
                          .type = VALUE_NUMBER,
                          .scalar = true,
                          .required = true,
                          .low = 0,
                          .low_open = true,
                          .high = INFINITY,
                          .sweep = true,
                          .doc = "Period T of the orbit; a particle alone has the period 2 pi. In a trajectory, the "
                                 "section orbit gives the start: the orbit's state just after t = 0. In a branch, a "
                                 "first guess where the motion or its energy decides about the period, and with "
                                 "`orbit.mode` no guess is needed."},
    [KEY_ORBIT_AT_START -
        KEY_ORBIT_PERIOD] = {.path = "orbit.at_start",
                             .type = VALUE_INTEGER,
                             .list = true,
                             .fallback = "[]",
                             .low = 0,
                             .high = INFINITY,
                             .sweep = true,
                             .doc = "Particles that hit at t = 0 modulo T their floor, or in a branch their wall where "
                                    "they have no floor; with Hertz contacts, that press it then."},
    [KEY_ORBIT_AT_HALF -
        KEY_ORBIT_PERIOD] = {.path = "orbit.at_half",
                             .type = VALUE_INTEGER,
                             .list = true,
                             .fallback = "[]",
                             .low = 0,
                             .high = INFINITY,
                             .sweep = true,
                             .doc = "Particles that hit at t = T/2 modulo T. The two lists name at least one particle "
                                    "(in a branch also none), and each at most once."},
    [KEY_ORBIT_MOTION - KEY_ORBIT_PERIOD] =
        {.path = "orbit.motion",
         WORD,
         .kinds = "branch|grazing|diagram",
         .fallback = "even",
         .words = "even|forced|conservative|autonomous",
         .doc = "`even`: about t = 0 and T/2, of models without damping; `forced`: with the period of the force or a "
                "multiple of it; `conservative`: without force or losses; `autonomous`: without force, the period is "
                "found."},
    [KEY_ORBIT_ENERGY -
        KEY_ORBIT_PERIOD] = {.path = "orbit.energy",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .null = true,
                             .fallback = "null",
                             ANY,
                             .kinds = "branch|grazing|diagram",
                             .sweep = true,
                             .doc =
                                 "Energy of an even or conservative motion, instead of its period; null: the period is "
                                 "given."},
    [KEY_ORBIT_FORCING_PERIODS -
        KEY_ORBIT_PERIOD] = {.path = "orbit.forcing_periods",
                             .type = VALUE_INTEGER,
                             .scalar = true,
                             .null = true,
                             .fallback = "null",
                             .low = 1,
                             .high = 1e6,
                             .kinds = "branch|grazing|diagram",
                             .sweep = true,
                             .doc = "The period is this many of the model's force, instead of `orbit.period`; "
                                    "null: 1 for forced motions without `orbit.period`."},
    [KEY_ORBIT_SEQUENCE -
        KEY_ORBIT_PERIOD] = {.path = "orbit.sequence",
                             .type = VALUE_INTEGER,
                             .list = true,
                             .fallback = "[]",
                             .low = 0,
                             .high = INFINITY,
                             .kinds = "branch|grazing|diagram",
                             .sweep = true,
                             .doc =
                                 "Particles in the order in which they hit their floor, or their wall where they have "
                                 "no floor, in one period; of even motions between 0 and T/2."},
    [KEY_ORBIT_TIMES - KEY_ORBIT_PERIOD] = {.path = "orbit.times",
                                            .type = VALUE_NUMBER,
                                            .list = true,
                                            .fallback = "[]",
                                            ANY,
                                            .kinds = "branch|grazing|diagram",
                                            .sweep = true,
                                            .doc = "First guess of the times of these impacts, rising."},
    [KEY_ORBIT_EXCITED -
        KEY_ORBIT_PERIOD] = {.path = "orbit.excited",
                             .type = VALUE_INTEGER,
                             .list = true,
                             .fallback = "[]",
                             .low = 0,
                             .high = INFINITY,
                             .kinds = "branch|grazing|diagram",
                             .sweep = true,
                             .doc = "Particles that swing in the first guess of a motion without impacts: at t = 0 at "
                                    "the amplitude at which one alone, with its cubic spring, has the period T; the "
                                    "others are at rest."},
    [KEY_ORBIT_MODE - KEY_ORBIT_PERIOD] =
        {.path = "orbit.mode",
         .type = VALUE_INTEGER,
         .scalar = true,
         .null = true,
         .fallback = "null",
         .low = 0,
         .high = INFINITY,
         .kinds = "branch|grazing|diagram",
         .sweep = true,
         .doc = "First guess of a motion whose energy is given: the normal mode of this place, from 0 in "
                "the order of frequencies, of the linear part of the model, at rest at t = 0, with its "
                "period and the amplitude of that energy; null: another guess. With one particle in "
                "`orbit.at_start` and a branch along the energy without `branch.from` the branch is the "
                "family that this particle hits once in `orbit.swings` swings of the mode, and starts "
                "where the mode touches the obstacle."},
    [KEY_ORBIT_SWINGS -
        KEY_ORBIT_PERIOD] = {.path = "orbit.swings",
                             .type = VALUE_INTEGER,
                             .scalar = true,
                             .fallback = "1",
                             .low = 1,
                             .high = 1000,
                             .kinds = "branch",
                             .sweep = true,
                             .doc =
                                 "Periods of the mode `orbit.mode` from one impact of the particle in `orbit.at_start` "
                                 "to the next."},
    [KEY_ORBIT_METHOD - KEY_ORBIT_PERIOD] =
        {.path = "orbit.method",
         WORD,
         .kinds = "orbits",
         .fallback = "impulse",
         .other_models = "duffing_chain",
         .other_fallback = "shooting",
         .words = "impulse|dense|shooting|ritz",
         .word_models = method_models,
         .doc = "`impulse`: the impulse response, fast for any size; `dense`: the boundary-value problem "
                "with dense matrices, a reference for small chains; `shooting`: Newton's method, from the "
                "orbit of the linear part along growing nonlinear terms; `ritz`: Ritz's method with its "
                "error, measured against the orbit found by shooting."},
    [KEY_ORBIT_FUNCTIONS - KEY_ORBIT_PERIOD] = {.path = "orbit.functions",
                                                .type = VALUE_INTEGER,
                                                .scalar = true,
                                                .fallback = "16",
                                                .low = 1,
                                                .high = 300,
                                                .kinds = "orbits",
                                                .sweep = true,
                                                .doc = "Most trial functions per particle of `method: ritz`."},
    [KEY_ORBIT_CONSTANTS -
        KEY_ORBIT_PERIOD] = {.path = "orbit.constants",
                             FLAG,
                             .kinds = "orbits",
                             .fallback = "true",
                             .doc = "Whether constants are among them; without, the error of `method: ritz` stalls."},
    [KEY_ORBIT_TOLERANCE -
        KEY_ORBIT_PERIOD] = {.path = "orbit.tolerance",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .null = true,
                             .fallback = "null",
                             .low = 0,
                             .low_open = true,
                             .high = INFINITY,
                             .kinds = "orbits",
                             .sweep = true,
                             .doc = "`method: ritz` takes no more functions when the measured error is below it; null: "
                                    "as many as `orbit.functions`."},
    [KEY_ORBIT_STATES -
        KEY_ORBIT_PERIOD] = {.path = "orbit.states",
                             FLAG,
                             .kinds = "orbits",
                             .fallback = "true",
                             .doc = "Whether the result stores displacements and velocities just after t = 0."},
    [KEY_ORBIT_SPECIAL_POINTS -
        KEY_ORBIT_PERIOD] = {.path = "orbit.special_points",
                             FLAG,
                             .kinds = "orbits",
                             .fallback = "false",
                             .doc = "Resonances and singular points along the swept parameter are listed in the "
                                    "result, and with `orbit.stable` or `orbit.multipliers` the critical ones; "
                                    "needs one sweep, over model.gamma or orbit.period."},
    [KEY_ORBIT_MULTIPLIERS -
        KEY_ORBIT_PERIOD] = {.path = "orbit.multipliers",
                             FLAG,
                             .kinds = "orbits",
                             .fallback = "false",
                             .doc = "All Floquet multipliers of every orbit, and the verdict of `orbit.stable`; for "
                                    "chains of up to 400 particles."},
    [KEY_ORBIT_STABLE -
        KEY_ORBIT_PERIOD] = {.path = "orbit.stable",
                             FLAG,
                             .kinds = "orbits",
                             .fallback = "false",
                             .doc =
                                 "Whether every orbit is stable, and how many multipliers lie outside the unit circle; "
                                 "for chains of any size."},
    [KEY_ORBIT_VERIFY - KEY_ORBIT_PERIOD] =
        {.path = "orbit.verify",
         FLAG,
         .kinds = "orbits",
         .fallback = "false",
         .doc = "An event-driven run over one period checks every orbit that is admissible or grazing."},
    [KEY_START_Q -
        KEY_ORBIT_PERIOD] = {.path = "start.q",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .list = true,
                             .per_particle = true,
                             .fallback = "0",
                             ANY,
                             .kinds = "trajectory|branch|grazing|diagram|basin",
                             .models = LATTICES,
                             .sweep = true,
                             .doc = "Displacements at t = 0, in a branch of the first guess, after the first impact of "
                                    "`orbit.sequence`: one number for all, or one per particle."},
    [KEY_START_V -
        KEY_ORBIT_PERIOD] = {.path = "start.v",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .list = true,
                             .per_particle = true,
                             .fallback = "0",
                             ANY,
                             .kinds = "trajectory|branch|grazing|diagram|basin",
                             .models = LATTICES,
                             .sweep = true,
                             .doc = "Velocities at t = 0, in a branch of the first guess, after the first impact of "
                                    "`orbit.sequence`: one number for all, or one per particle."},
    [KEY_TIME_DURATION - KEY_ORBIT_PERIOD] = {.path = "time.duration",
                                              .type = VALUE_NUMBER,
                                              .scalar = true,
                                              .required = true,
                                              .low = 0,
                                              .low_open = true,
                                              .high = 1e9, /* beyond, a double resolves less than 1e-7 of time */
                                              .kinds = "trajectory",
                                              .sweep = true,
                                              .doc = "The motion is followed from t = 0 to this time."},
    [KEY_TIME_SAMPLES - KEY_ORBIT_PERIOD] =
        {.path = "time.samples",
         .type = VALUE_INTEGER,
         .scalar = true,
         .fallback = "1001",
         .low = 2,
         .high = 1e9,
         .kinds = "trajectory",
         .no_sweep = "it changes the shape of the result",
         .doc = "Number of states in the result, at equal steps from 0 to the duration, both included."},
    [KEY_TIME_FLOW - KEY_ORBIT_PERIOD] =
        {.path = "time.flow",
         WORD,
         .fallback = "auto",
         .words = "auto|taylor|cvodes",
         .kinds = "trajectory",
         .doc = "Integrator between impacts. `taylor`: Taylor series; `cvodes`: SUNDIALS CVODES; `auto`: "
                "the better one for the model."},
    [KEY_TIME_TOLERANCE -
        KEY_ORBIT_PERIOD] = {.path = "time.tolerance",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .null = true,
                             .fallback = "null",
                             .low = 0,
                             .high = 0.01,
                             .kinds = "trajectory",
                             .sweep = true,
                             .doc = "Local error of a step of the integrator, relative to the size of the state; null "
                                    "or 0: the integrator's own."},
    [KEY_TIME_EVENTS_PER_TIME -
        KEY_ORBIT_PERIOD] = {.path = "time.events_per_time",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .fallback = "1e5",
                             .low = 0,
                             .low_open = true,
                             .high = INFINITY,
                             .kinds = "trajectory",
                             .sweep = true,
                             .doc = "More impacts than this per unit time, averaged from the start, end a "
                                    "trajectory with the outcome `event_limit`."},
    [KEY_TIME_LYAPUNOV -
        KEY_ORBIT_PERIOD] = {.path = "time.lyapunov",
                             FLAG,
                             .fallback = "false",
                             .kinds = "trajectory",
                             .doc =
                                 "All Lyapunov exponents of the motion, and how they converge. A motion that grazes an "
                                 "obstacle has none: it ends there."},
    [KEY_TIME_LYAPUNOV_INTERVAL -
        KEY_ORBIT_PERIOD] = {.path = "time.lyapunov_interval",
                             .type = VALUE_NUMBER,
                             .scalar = true,
                             .fallback = "1",
                             .low = 1e-6, /* a double resolves no less of time.duration at its largest */
                             .high = INFINITY,
                             .kinds = "trajectory",
                             .sweep = true,
                             .doc = "Time after which tangent vectors are made orthonormal again. Too long, and "
                                    "they overflow or become parallel."},
};

const schema_entry *schema_row(study_key key) {
  if (key < KEY_ORBIT_PERIOD)
    return schema_model_row(key);
  if (key < KEY_BRANCH_PARAMETER)
    return &rows[key - KEY_ORBIT_PERIOD];
  return key < KEY_ITERATE_TRANSIENT ? schema_branch_row(key) : schema_iterate_row(key);
}

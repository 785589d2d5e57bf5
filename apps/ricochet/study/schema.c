#include "schema.h"

#include <math.h>
#include <string.h>

#include "study.h"

#define ANY .low = -INFINITY, .high = INFINITY

static const schema_entry rows[KEY_COUNT] = {
    [KEY_KIND] = {.path = "kind",
                  .type = VALUE_WORD,
                  .scalar = true,
                  .required = true,
                  .words = "orbits",
                  .later_words = "branch|trajectory|grazing|diagram|atlas|basin",
                  .no_sweep = "it is a word, not a number",
                  .doc = "What to compute. `orbits`: the periodic orbit of one impact pattern at every grid point."},
    [KEY_TITLE] = {.path = "title",
                   .type = VALUE_TEXT,
                   .scalar = true,
                   .fallback = "",
                   .no_sweep = "it is text, not a number",
                   .doc = "Free text, copied to the result."},
    [KEY_MODEL_TYPE] = {.path = "model.type",
                        .type = VALUE_WORD,
                        .scalar = true,
                        .required = true,
                        .words = "chain",
                        .later_words = "duffing_chain|oscillator|grazing_map",
                        .no_sweep = "it is a word, not a number",
                        .doc = "`chain`: unit masses on unit springs, coupled to their neighbours by linear springs."},
    [KEY_MODEL_PARTICLES] = {.path = "model.particles",
                             .type = VALUE_INTEGER,
                             .scalar = true,
                             .required = true,
                             .low = 1,
                             .high = 1e9,
                             .no_sweep = "it changes the shape of the result",
                             .doc = "Number of particles, counted from 0 in all that follows."},
    [KEY_MODEL_ENDS] = {.path = "model.ends",
                        .type = VALUE_WORD,
                        .scalar = true,
                        .fallback = "periodic",
                        .words = "periodic|fixed|free",
                        .no_sweep = "it is a word, not a number",
                        .doc = "`periodic`: a ring; `fixed`: the end particles are coupled to walls; `free`: they are "
                               "not."},
    [KEY_MODEL_GAMMA] = {.path = "model.gamma",
                         .type = VALUE_NUMBER,
                         .scalar = true,
                         .required = true,
                         .low = 0,
                         .high = INFINITY,
                         .sweep = true,
                         .doc = "Stiffness of the coupling springs."},
    [KEY_MODEL_FLOOR] = {.path = "model.floor",
                         .type = VALUE_NUMBER,
                         .scalar = true,
                         .list = true,
                         .null = true,
                         .fallback = "-1",
                         ANY,
                         .sweep = true,
                         .doc = "Displacement at which a particle hits its obstacle: one number for all, or one per "
                                "particle; null is no obstacle."},
    [KEY_MODEL_RESTITUTION] = {.path = "model.restitution",
                               .type = VALUE_NUMBER,
                               .scalar = true,
                               .fallback = "1",
                               .low = 0,
                               .high = 1,
                               .sweep = true,
                               .doc =
                                   "Speed after an impact over speed before it. Orbits of an undamped chain need 1."},
    [KEY_ORBIT_PERIOD] = {.path = "orbit.period",
                          .type = VALUE_NUMBER,
                          .scalar = true,
                          .required = true,
                          .low = 0,
                          .low_open = true,
                          .high = INFINITY,
                          .sweep = true,
                          .doc = "Period T of the orbit; a particle alone has the period 2 pi."},
    [KEY_ORBIT_AT_START] = {.path = "orbit.at_start",
                            .type = VALUE_INTEGER,
                            .list = true,
                            .fallback = "[]",
                            .low = 0,
                            .high = INFINITY,
                            .sweep = true,
                            .doc = "Particles that hit at t = 0 modulo T."},
    [KEY_ORBIT_AT_HALF] = {.path = "orbit.at_half",
                           .type = VALUE_INTEGER,
                           .list = true,
                           .fallback = "[]",
                           .low = 0,
                           .high = INFINITY,
                           .sweep = true,
                           .doc =
                               "Particles that hit at t = T/2 modulo T. The two lists name at least one particle, and "
                               "each at most once."},
    [KEY_ORBIT_METHOD] = {.path = "orbit.method",
                          .type = VALUE_WORD,
                          .scalar = true,
                          .fallback = "impulse",
                          .words = "impulse|dense",
                          .later_words = "shooting|ritz",
                          .no_sweep = "it is a word, not a number",
                          .doc =
                              "`impulse`: the impulse response, fast for any size; `dense`: the boundary-value problem "
                              "with dense matrices, a reference for small chains."},
    [KEY_ORBIT_STATES] = {.path = "orbit.states",
                          .type = VALUE_FLAG,
                          .scalar = true,
                          .fallback = "true",
                          .no_sweep = "it is a flag, not a number",
                          .doc = "Whether the result stores displacements and velocities just after t = 0."},
    [KEY_ORBIT_SPECIAL_POINTS] = {.path = "orbit.special_points",
                                  .type = VALUE_FLAG,
                                  .scalar = true,
                                  .fallback = "false",
                                  .no_sweep = "it is a flag, not a number",
                                  .doc = "Resonances and singular points along the swept parameter are listed in the "
                                         "result; needs one sweep, over model.gamma or orbit.period."},
    [KEY_ORBIT_MULTIPLIERS] = {.path = "orbit.multipliers",
                               .type = VALUE_FLAG,
                               .scalar = true,
                               .fallback = "false",
                               .later = true,
                               .no_sweep = "it is a flag, not a number",
                               .doc = "Floquet multipliers of every orbit; of a later version."},
    [KEY_ORBIT_VERIFY] = {.path = "orbit.verify",
                          .type = VALUE_FLAG,
                          .scalar = true,
                          .fallback = "false",
                          .later = true,
                          .no_sweep = "it is a flag, not a number",
                          .doc = "An event-driven run over one period checks every orbit; of a later version."},
};

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
};

const schema_entry *schema_row(study_key key) {
  return &rows[key];
}
const schema_entry *schema_sweep_row(sweep_key key) {
  return &sweep_rows[key];
}

study_key schema_find(const char *path) {
  int key = 0;
  while (key < KEY_COUNT && strcmp(rows[key].path, path) != 0)
    key++;
  return (study_key)key;
}

bool schema_is_section(const char *name) {
  const size_t length = strlen(name);
  for (int key = 0; key < KEY_COUNT; key++)
    if (strncmp(rows[key].path, name, length) == 0 && rows[key].path[length] == '.')
      return true;
  return false;
}

bool schema_is_later_section(const char *name) {
  static const char *const later[] = {"start", "time", "iterate"};
  for (size_t i = 0; i < sizeof later / sizeof *later; i++)
    if (strcmp(later[i], name) == 0)
      return true;
  return false;
}

schema_fit schema_check(const schema_entry *entry, double value) {
  if (entry->type == VALUE_INTEGER && isfinite(value) && value != floor(value))
    return FIT_NOT_INTEGER;
  const bool above = entry->low_open ? value > entry->low : value >= entry->low;
  const bool below = entry->high_open ? value < entry->high : value <= entry->high;
  const double most = entry->type == VALUE_INTEGER ? 0x1p53 : INFINITY; /* above, doubles skip integers */
  return above && below && fabs(value) < most ? FIT_OK : FIT_OUT_OF_RANGE;
}

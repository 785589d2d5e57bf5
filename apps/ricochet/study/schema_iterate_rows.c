/* The schema table, section `iterate`: how attractors of maps and of sections are found, and what is stored of them. */
#include "schema_rows.h"

#define OF_ITERATE .kinds = "diagram|basin"
#define COUNTED    .type = VALUE_INTEGER, .scalar = true, OF_ITERATE
#define SHAPE      .no_sweep = "it changes the shape of the result"

static const schema_entry rows[KEY_COUNT - KEY_ITERATE_TRANSIENT] = {
    [KEY_ITERATE_TRANSIENT - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.transient",
         COUNTED,
         .fallback = "9000",
         .low = 0,
         .high = 1e15,
         .sweep = true,
         .doc = "Iterates that are left out at first. An iterate of a map is one application of it, of a motion the "
                "way from one crossing of the section to the next."},
    [KEY_ITERATE_KEEP - KEY_ITERATE_TRANSIENT] = {.path = "iterate.keep",
                                                  .type = VALUE_INTEGER,
                                                  .scalar = true,
                                                  .kinds = "diagram",
                                                  .fallback = "1000",
                                                  .low = 0,
                                                  .high = 1e9,
                                                  SHAPE,
                                                  .doc = "Iterates after those whose values are stored; 0: none."},
    [KEY_ITERATE_MEASURE - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.measure",
         COUNTED,
         .null = true,
         .fallback = "null",
         .low = 1,
         .high = 1e15,
         .sweep = true,
         .doc = "Iterates after the transient over which exponents and impacts are averaged, at least `keep`; null: as "
                "many as are kept, and 1000 where none are."},
    [KEY_ITERATE_START - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.start",
         .type = VALUE_NUMBER,
         .scalar = true,
         .list = true,
         .fallback = "0",
         ANY,
         OF_ITERATE,
         .models = "grazing_map",
         .sweep = true,
         .doc = "Start of a map: one number for all of z, or each. Motions start at the state of the section `start`."},
    [KEY_ITERATE_SECTION - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.section",
         WORD,
         .fallback = "strobe",
         .words = "strobe|impact",
         OF_ITERATE,
         .models = LATTICES,
         .doc = "`strobe`: the state once in every period of the force; `impact`: the state after every impact."},
    [KEY_ITERATE_PHASE - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.phase",
         .type = VALUE_NUMBER,
         .scalar = true,
         .fallback = "0",
         .low = 0,
         .high = 1,
         .high_open = true,
         OF_ITERATE,
         .models = LATTICES,
         .sweep = true,
         .doc = "Time of the start over the period of the force, and with `section: strobe` of the section."},
    [KEY_ITERATE_PARTICLE - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.particle",
         COUNTED,
         .null = true,
         .fallback = "null",
         .low = 0,
         .high = 1e9,
         .models = LATTICES,
         .sweep = true,
         .doc = "Whose impacts make the section with `section: impact`, on its floor, or on its wall where it has no "
                "floor; null: those of all."},
    [KEY_ITERATE_OBSERVE - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.observe",
         .type = VALUE_TEXT,
         .scalar = true,
         .fallback = "",
         OF_ITERATE,
         .no_sweep = "it is a word, not a number",
         .doc =
             "Which number of the state is stored: of a map `z1`, `z2`, ..., by default the first; of a motion `q0`, "
             "`q1`, ... or `v0`, ... of a particle, or with `section: impact` the `time` within the period of the "
             "force; by default the displacement of the last particle with an obstacle."},
    [KEY_ITERATE_STATES - KEY_ITERATE_TRANSIENT] = {.path = "iterate.states",
                                                    FLAG,
                                                    .fallback = "false",
                                                    .kinds = "diagram",
                                                    .doc = "Store all numbers of the kept iterates."},
    [KEY_ITERATE_LYAPUNOV - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.lyapunov",
         FLAG,
         .fallback = "false",
         .kinds = "diagram",
         .doc = "The largest Lyapunov exponent, natural logarithm per iterate; of motions through their impacts."},
    [KEY_ITERATE_EXPONENTS - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.exponents",
         .type = VALUE_INTEGER,
         .scalar = true,
         .kinds = "diagram",
         .fallback = "1",
         .low = 1,
         .high = 1e6,
         SHAPE,
         .doc = "How many exponents `lyapunov` finds, the largest first; more than one are stored besides it."},
    [KEY_ITERATE_PERIOD_LIMIT - KEY_ITERATE_TRANSIENT] = {.path = "iterate.period_limit",
                                                          COUNTED,
                                                          .fallback = "64",
                                                          .low = 1,
                                                          .high = 100000,
                                                          .sweep = true,
                                                          .doc = "Longest period of an attractor that is looked for."},
    [KEY_ITERATE_PERIOD_TOL - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.period_tol",
         .type = VALUE_NUMBER,
         .scalar = true,
         .fallback = "1e-6",
         .low = 0,
         .low_open = true,
         .high = 0.1,
         OF_ITERATE,
         .sweep = true,
         .doc = "An attractor is periodic when its iterates return within this part of its extent."},
    [KEY_ITERATE_FOLLOW - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.follow",
         FLAG,
         .fallback = "false",
         .kinds = "diagram",
         .doc = "Along the last sweep every point starts where the one before it has ended, the first one at the start "
                "of the study, and a run that is stopped begins the line again; false: all start there."},
    [KEY_ITERATE_WINDOWS - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.windows",
         FLAG,
         .fallback = "false",
         .kinds = "diagram",
         .doc = "List the windows of the last sweep in which the attractor is periodic, with their edges: bracketed on "
                "the attractor, then located on the cycle itself."},
    [KEY_ITERATE_TOLERANCE - KEY_ITERATE_TRANSIENT] =
        {.path = "iterate.tolerance",
         .type = VALUE_NUMBER,
         .scalar = true,
         .null = true,
         .fallback = "null",
         .low = 0,
         .high = 0.01,
         OF_ITERATE,
         .models = LATTICES,
         .sweep = true,
         .doc = "Local error of a step of the integrator, relative to the size of the state; null or 0: the "
                "integrator's own."},
};

const schema_entry *schema_iterate_row(study_key key) {
  return &rows[key - KEY_ITERATE_TRANSIENT];
}

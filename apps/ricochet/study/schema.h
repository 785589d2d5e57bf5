/* The schema of study files: one table of every key with its type, default, range or allowed words, and one line of
 * documentation. Refusals, `--set`, sweeps, `check` and the study-file reference are all driven by it. */
#ifndef RICOCHET_APP_SCHEMA_H
#define RICOCHET_APP_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/** Every key of a study, in the order of the reference. Row `key` of the table describes it. */
typedef enum study_key {
  KEY_KIND,
  KEY_TITLE,
  KEY_MODEL_TYPE,
  KEY_MODEL_PARTICLES,
  KEY_MODEL_ENDS,
  KEY_MODEL_GAMMA,
  KEY_MODEL_FLOOR,
  KEY_MODEL_RESTITUTION,
  KEY_MODEL_MASS,
  KEY_MODEL_STIFFNESS,
  KEY_MODEL_QUADRATIC,
  KEY_MODEL_CUBIC,
  KEY_MODEL_DAMPING,
  KEY_MODEL_LINK_QUADRATIC,
  KEY_MODEL_LINK_CUBIC,
  KEY_MODEL_LINK_DAMPING,
  KEY_MODEL_WALL,
  KEY_MODEL_HERTZ,
  KEY_MODEL_FORCE,
  KEY_MODEL_FREQUENCY,
  KEY_MODEL_PHASE,
  KEY_MODEL_D,
  KEY_MODEL_LAMBDA,
  KEY_MODEL_OMEGA,
  KEY_MODEL_L,
  KEY_MODEL_ETA,
  KEY_MODEL_XI,
  KEY_MODEL_KAPPA,
  KEY_MODEL_STRETCH,
  KEY_ORBIT_PERIOD,
  KEY_ORBIT_AT_START,
  KEY_ORBIT_AT_HALF,
  KEY_ORBIT_MOTION,
  KEY_ORBIT_ENERGY,
  KEY_ORBIT_FORCING_PERIODS,
  KEY_ORBIT_SEQUENCE,
  KEY_ORBIT_TIMES,
  KEY_ORBIT_EXCITED,
  KEY_ORBIT_MODE,
  KEY_ORBIT_SWINGS,
  KEY_ORBIT_METHOD,
  KEY_ORBIT_FUNCTIONS,
  KEY_ORBIT_CONSTANTS,
  KEY_ORBIT_TOLERANCE,
  KEY_ORBIT_STATES,
  KEY_ORBIT_SPECIAL_POINTS,
  KEY_ORBIT_MULTIPLIERS,
  KEY_ORBIT_STABLE,
  KEY_ORBIT_VERIFY,
  KEY_START_Q,
  KEY_START_V,
  KEY_TIME_DURATION,
  KEY_TIME_SAMPLES,
  KEY_TIME_FLOW,
  KEY_TIME_TOLERANCE,
  KEY_TIME_EVENTS_PER_TIME,
  KEY_TIME_LYAPUNOV,
  KEY_TIME_LYAPUNOV_INTERVAL,
  KEY_BRANCH_PARAMETER,
  KEY_BRANCH_FROM,
  KEY_BRANCH_TO,
  KEY_BRANCH_LOW,
  KEY_BRANCH_HIGH,
  KEY_BRANCH_SCALE,
  KEY_BRANCH_STEP,
  KEY_BRANCH_STEP_LEAST,
  KEY_BRANCH_STEP_MOST,
  KEY_BRANCH_NATURAL,
  KEY_BRANCH_POINTS,
  KEY_BRANCH_TOLERANCE,
  KEY_BRANCH_MULTIPLIERS,
  KEY_BRANCH_STATES,
  KEY_BRANCH_SAMPLES,
  KEY_BRANCH_CROSS,
  KEY_BRANCH_SWITCH,
  KEY_BRANCH_SEGMENTS,
  KEY_BRANCH_TRACE_PARAMETER,
  KEY_BRANCH_TRACE_LOW,
  KEY_BRANCH_TRACE_HIGH,
  KEY_BRANCH_TRACE_FIRST_LOW,
  KEY_BRANCH_TRACE_FIRST_HIGH,
  KEY_BRANCH_TRACE_STEP,
  KEY_BRANCH_TRACE_STEP_MOST,
  KEY_BRANCH_TRACE_POINTS,
  KEY_BRANCH_TRACE_KINDS,
  KEY_RESTART_FILE,
  KEY_RESTART_TASK,
  KEY_RESTART_SPECIAL,
  KEY_RESTART_POINT,
  KEY_GRAZING_SECTION,
  KEY_GRAZING_COEFFICIENTS,
  KEY_GRAZING_WINDOWS,
  KEY_GRAZING_BEYOND,
  KEY_ITERATE_TRANSIENT,
  KEY_ITERATE_KEEP,
  KEY_ITERATE_MEASURE,
  KEY_ITERATE_START,
  KEY_ITERATE_SECTION,
  KEY_ITERATE_PHASE,
  KEY_ITERATE_PARTICLE,
  KEY_ITERATE_OBSERVE,
  KEY_ITERATE_STATES,
  KEY_ITERATE_LYAPUNOV,
  KEY_ITERATE_EXPONENTS,
  KEY_ITERATE_PERIOD_LIMIT,
  KEY_ITERATE_PERIOD_TOL,
  KEY_ITERATE_FOLLOW,
  KEY_ITERATE_WINDOWS,
  KEY_ITERATE_TOLERANCE,
  KEY_COUNT
} study_key;

typedef enum value_type {
  VALUE_NUMBER,  /* finite double, also as a multiple of pi */
  VALUE_INTEGER, /* integral number, |value| < 2^53 */
  VALUE_FLAG,    /* true | false */
  VALUE_WORD,    /* one of `words`; in a list each as its place among them, from 0 */
  VALUE_TEXT     /* free text */
} value_type;

typedef struct schema_entry {
  const char *path; /* "model.gamma" */
  value_type type;
  bool list;            /* a list of `type` is allowed */
  bool scalar;          /* a single value is allowed */
  bool null;            /* null is allowed, for a single value and inside a list: read as minus infinity ("none") */
  bool required;        /* no default; a study needs it, if it concerns its kind and its type of model (see study_check
                           for exceptions) */
  const char *fallback; /* default as YAML text, "" when absent by default */
  double low, high;     /* range of a number, ends included unless open */
  bool low_open, high_open;
  const char *words;       /* allowed words, "impulse|dense" */
  const char *later_words; /* words of a later version: refused with "not in this version" */
  const char *const
      *word_models;         /* types of model that each of `words` is for, NULL among them: all; NULL: all for all */
  const char *kinds;        /* kinds of study that the key is for, "orbits|trajectory"; NULL: all */
  const char *models;       /* types of model that the key is for, "chain|duffing_chain"; NULL: all */
  const char *other_models; /* types of model whose default is `other_fallback`; NULL: none */
  const char *other_fallback;
  bool per_particle;          /* a list has one element per particle */
  const char *last_models;    /* types of model of which a single value is that of the last particle; NULL: none */
  const char *orbits_default; /* methods that find orbits for the default only, "impulse|dense"; NULL: none */
  bool sweep;                 /* numbers only: can be the parameter of a sweep */
  const char *no_sweep;       /* why it cannot be swept, for the refusal */
  const char *units;          /* NULL for dimensionless */
  const char *doc;            /* one line for the reference */
} schema_entry;

/** The keys of one entry of `sweep`, described by rows of the same kind. */
typedef enum sweep_key {
  SWEEP_PARAMETER,
  SWEEP_VALUES,
  SWEEP_FROM,
  SWEEP_TO,
  SWEEP_POINTS,
  SWEEP_SCALE,
  SWEEP_BACK,
  SWEEP_KEY_COUNT
} sweep_key;

/** How a number meets the row of its key. */
typedef enum schema_fit { FIT_OK, FIT_NOT_INTEGER, FIT_OUT_OF_RANGE } schema_fit;

/** The row of a key; the table has KEY_COUNT rows. They stand in several files,
 *  by sections. */
const schema_entry *schema_row(study_key key);
/** The row of a key of a sweep entry, its path "sweep.from". */
const schema_entry *schema_sweep_row(sweep_key key);

/** Key of a path, KEY_COUNT when there is none. */
study_key schema_find(const char *path);

/** Whether keys of the table stand under this name: `model`, `orbit`, `start`, `time`, `branch`, `branch.trace`,
 *  `restart`, `grazing`, `iterate`. */
bool schema_is_section(const char *name);

/** Sees every section once, in the order of the table, `sweep` last. @param name  not ended by a zero */
void schema_sections(void (*see)(const char *name, size_t length, void *user), void *user);

/** Writes the known key nearest to `path` into `near`, or "" when none is near enough to suggest. Nearness is the edit
 *  distance, swapped neighbours counting once, of the whole paths or of their last names: `model.gama` finds
 *  `model.gamma`, and so does `gamma`. Sections and the keys of sweep entries (`sweep.from`) are known too.
 *  @param size  of `near`, at least 64 */
void schema_nearest(const char *path, char *near, size_t size);
/** The same among the keys that can be swept. */
void schema_nearest_parameter(const char *path, char *near, size_t size);

/** Writes "a|b|c" as "a or b or c". */
void schema_either(const char *words, char *text, size_t size);
/** Whether a key is for studies of this kind. */
bool schema_concerns(const schema_entry *entry, const char *kind);
/** Whether a key is for models of this type. */
bool schema_concerns_model(const schema_entry *entry, const char *model);
/** Types of model that a word of the entry is for, NULL: all. */
const char *schema_word_models(const schema_entry *entry, const char *word);
/** The default for models of this type as YAML text; NULL and "" as in the entry. @param model  may be NULL */
const char *schema_fallback(const schema_entry *entry, const char *model);
/** Place of a word in "a|b|c", from 0; -1 when it is none of them, as of NULL. @param length  of the word */
long schema_find_word(const char *word, size_t length, const char *words);
/** Whether it is one of them. */
bool schema_is_among(const char *word, size_t length, const char *words);

/** What an entry allows, in words: "a number from 0 to 1", "one of periodic, fixed, free". */
void schema_allowed(const schema_entry *entry, char *text, size_t size);
/** What one element of it allows: the same without the word "list". */
void schema_allowed_item(const schema_entry *entry, char *text, size_t size);
/** The names known in a section, "" for the top level: "type, particles, ends, ...". */
void schema_names(const char *section, char *text, size_t size);

/** Whether a number or integer is one that the entry allows; NaN is out of range. */
schema_fit schema_check(const schema_entry *entry, double value);

/** Prints the study-file reference in Markdown, from the table. */
void schema_reference(FILE *out);

#endif

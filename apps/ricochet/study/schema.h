/* The schema of study files: one table of every key with its type, default, range or allowed words, and one line of
 * documentation. Refusals, `--set`, sweeps, `check` and the study-file reference are all driven by it. */
#ifndef RICOCHET_APP_SCHEMA_H
#define RICOCHET_APP_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>

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
  KEY_ORBIT_PERIOD,
  KEY_ORBIT_AT_START,
  KEY_ORBIT_AT_HALF,
  KEY_ORBIT_METHOD,
  KEY_ORBIT_STATES,
  KEY_ORBIT_SPECIAL_POINTS,
  KEY_ORBIT_MULTIPLIERS,
  KEY_ORBIT_VERIFY,
  KEY_COUNT
} study_key;

typedef enum value_type {
  VALUE_NUMBER,  /* finite double, also as a multiple of pi */
  VALUE_INTEGER, /* integral number, |value| < 2^53 */
  VALUE_FLAG,    /* true | false */
  VALUE_WORD,    /* one of `words` */
  VALUE_TEXT     /* free text */
} value_type;

typedef struct schema_entry {
  const char *path; /* "model.gamma" */
  value_type type;
  bool list;            /* a list of `type` is allowed */
  bool scalar;          /* a single value is allowed */
  bool null;            /* null is allowed, for a single value and inside a list: read as minus infinity ("none") */
  bool required;        /* no default */
  const char *fallback; /* default as YAML text, "" when absent by default */
  double low, high;     /* range of a number, ends included unless open */
  bool low_open, high_open;
  const char *words;       /* allowed words, "impulse|dense" */
  const char *later_words; /* words of a later version: refused with "not in this version" */
  bool later;              /* flag of a later version: `false` is accepted, `true` is refused as above */
  bool sweep;              /* numbers only: can be the parameter of a sweep */
  const char *no_sweep;    /* why it cannot be swept, for the refusal */
  const char *units;       /* "" for dimensionless */
  const char *doc;         /* one line for the reference */
} schema_entry;

/** The row of a key; the table has KEY_COUNT rows. */
const schema_entry *schema_row(study_key key);

/** Key of a path, KEY_COUNT when there is none. */
study_key schema_find(const char *path);

/** Writes the known key nearest to `path` (edit distance) into `near`, or "" when none is near enough to suggest. */
void schema_nearest(const char *path, char *near, size_t size);

/** What an entry allows, in words: "a number with 0 <= value", "one of periodic, fixed, free". */
void schema_allowed(const schema_entry *entry, char *text, size_t size);

#endif

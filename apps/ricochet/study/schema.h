/* The schema of study files: every key with its type, default, range or allowed words, and one line of documentation;
 * the kinds of study and the types of model, and which keys each accepts. Refusals, `--set`, sweeps, `check` and the
 * study-file reference are all driven by it.
 *
 * Nothing in this folder depends on a particular kind or type of model. The rows of their keys are in their own folders
 * (`*.inc`), and kind/kinds.c assembles the schema. */
#ifndef RICOCHET_APP_SCHEMA_H
#define RICOCHET_APP_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "../base/embedded.h"
#include "../base/message.h"

typedef enum value_type {
  VALUE_NUMBER,  /* finite double, also as a multiple of pi */
  VALUE_INTEGER, /* integral number, |value| < 2^53 */
  VALUE_FLAG,    /* true | false */
  VALUE_WORD,    /* one of `words`; in a list each as its place among them, from 0 */
  VALUE_TEXT     /* free text */
} value_type;

/** One key. How rows are written: keys.h. */
typedef struct schema_entry {
  const char *path;  /* "model.gamma" */
  const char *group; /* group of keys that kinds and types of model accept together, "start"; "": all accept it */
  value_type type;
  bool list;            /* a list of `type` is allowed */
  bool scalar;          /* a single value is allowed */
  bool null;            /* null is allowed, for a single value and inside a list: read as minus infinity ("none") */
  bool required;        /* no default: a study whose kind and model accept the key must give it, unless `wants` of the
                           kind returns false */
  const char *fallback; /* default as YAML text, "" when absent by default */
  double low, high;     /* range of a number, ends included unless open */
  bool low_open, high_open;
  const char *words;          /* allowed words, "impulse|dense" */
  const char *later_words;    /* words of a later version: refused with "not in this version" */
  const unsigned *word_needs; /* features of the model that each of `words` needs, 0 for none; NULL: none does */
  unsigned needs;             /* features of the model that the key needs; 0: none */
  bool per_particle;          /* a list has one element per particle */
  bool sweep;                 /* numbers only: can be the parameter of a sweep */
  const char *no_sweep;       /* why it cannot be swept, for the refusal */
  const char *units;          /* NULL for dimensionless */
  const char *doc;            /* one line for the reference */
} schema_entry;

/** A key is its row, of which there is one: keys are compared as pointers. NULL is no key. */
typedef const schema_entry *study_key;

typedef struct study study;
typedef struct document document;

/** A default of a type of model that replaces the default of the row. */
typedef struct schema_default {
  const char *path, *fallback;
} schema_default;

/** A kind of study or a type of model: what the reader of studies needs of it. */
typedef struct schema_choice {
  const char *name;    /* its word, "orbits" */
  const char *summary; /* half a sentence, for lists */
  const char *groups;  /* of the keys that it accepts, "start|time" */
  /** Features. Of a type of model: those it has. Of a kind: its model must have one of them; 0: any model. */
  unsigned features;

  /* Of a type of model. */
  const schema_default *defaults; /* ended by a path NULL; NULL: none */
  const char *last_keys; /* keys per particle of which a single value is that of the last particle; NULL: none */
  /** Number of particles of a study whose single keys have been checked; 0, or NULL: lists are not per particle. */
  size_t (*particles)(const study *s);

  /* Of both; NULL where there is nothing to do. */
  /** Fills in values that the study omits, after all keys and sweeps are read. */
  int (*complete)(study *s, const document *d, message *why);
  /** Refuses combinations of keys that contradict each other. */
  int (*check)(const study *s, const document *d, message *why);

  /* Of a kind. */
  /** Whether the study must give a required key that its kind accepts; NULL: yes. */
  bool (*wants)(const study *s, const document *d, study_key key);
} schema_choice;

typedef struct schema {
  const study_key *keys; /* [key_count] in the order of the reference */
  size_t key_count;
  const schema_choice *const *kinds, *const *models; /* each ended by NULL */
  study_key kind, model;                             /* the keys whose words are their names */
  const embedded_text *chapters; /* Markdown of the reference, by the names of kinds and types of model; and the
                                    `introduction` before them */
} schema;

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

/** Whether a number satisfies the row of its key. */
typedef enum schema_fit { FIT_OK, FIT_NOT_INTEGER, FIT_OUT_OF_RANGE } schema_fit;

/** The row of a key of a sweep entry, its path "sweep.from". */
study_key schema_sweep_row(sweep_key key);

/** Key of a path, NULL when there is none. */
study_key schema_find(const schema *t, const char *path);

/** The kind or type of a name among `choices`, NULL when there is none. @param name  may be NULL */
const schema_choice *schema_choice_of(const schema_choice *const *choices, const char *name);
/** Whether a kind accepts a key. */
bool schema_kind_takes(const schema_choice *kind, study_key key);
/** Whether a type of model accepts a key. */
bool schema_model_takes(const schema_choice *model, study_key key);
/** Writes "a or b": the kinds that accept a key; the types of model that accept a key, or have one of these features.
 */
void schema_kinds_of(const schema *t, study_key key, char *text, size_t size);
void schema_models_of(const schema *t, study_key key, char *text, size_t size);
void schema_models_with(const schema *t, unsigned features, char *text, size_t size);
/** Features of the model that a word of a key needs; 0: none. */
unsigned schema_word_needs(study_key key, const char *word);
/** The default for a type of model as YAML text; NULL and "" as in the row. @param model  may be NULL */
const char *schema_fallback(study_key key, const schema_choice *model);

/** Whether the schema has keys in a section of this name: `model`, `branch.trace`. */
bool schema_is_section(const schema *t, const char *name);
/** Calls for every section once, in the order of the table, `sweep` last. @param name  not ended by a zero */
void schema_sections(const schema *t, void (*call)(const char *name, size_t length, void *user), void *user);

/** Writes the known key nearest to `path` into `near`, or "" when none is near enough to suggest. Nearness is the edit
 *  distance, swapped neighbours counting once, of the whole paths or of their last names: `model.gama` finds
 *  `model.gamma`, and so does `gamma`. Sections and the keys of sweep entries (`sweep.from`) are known too.
 *  @param size  of `near`, at least 64 */
void schema_nearest(const schema *t, const char *path, char *near, size_t size);
/** The same among the keys that can be swept. */
void schema_nearest_parameter(const schema *t, const char *path, char *near, size_t size);

/** Place of a word in "a|b|c", from 0; -1 when it is none of them or `words` is NULL. @param length  of the word */
long schema_find_word(const char *word, size_t length, const char *words);
/** Whether it is one of them. */
bool schema_is_among(const char *word, size_t length, const char *words);

/** What an entry allows, in words: "a number from 0 to 1", "one of periodic, fixed, free". */
void schema_allowed(study_key key, char *text, size_t size);
/** What one element of it allows: the same without the word "list". */
void schema_allowed_item(study_key key, char *text, size_t size);
/** The names known in a section, "" for the top level: "type, particles, ends, ...". */
void schema_names(const schema *t, const char *section, char *text, size_t size);

/** Whether a number or integer is one that the key allows; NaN is out of range. */
schema_fit schema_check(study_key key, double value);

/** Prints the study-file reference in Markdown. */
void schema_reference(const schema *t, FILE *out);

#endif

/* The internals of a study, for the code that reads and checks one: this folder, and the checks of kinds and models.
 *
 * study_parse reads the tree (document.h), applies `--set`, reads each key against its row (typed.c), then the sweeps
 * (sweep.c), calls `complete` of the model and the kind, then checks that keys fit together (check.c), last `check` of
 * the model and the kind. The tree is freed when the study is complete. */
#ifndef RICOCHET_APP_CHECK_H
#define RICOCHET_APP_CHECK_H

#include "document.h"
#include "study.h"

/* --- typed values: one node of the document read against one key --- */

typedef struct typed_value {
  bool present; /* given, or with a default */
  bool list;
  size_t count;    /* elements of a list, 1 for a scalar */
  double *numbers; /* [count] numbers, integers, flags as 0 and 1, words of a list as their places; else NULL */
  char *text;      /* word or text outside a list */
  int node;        /* in the document, while there is one; 0 for a default */
  size_t line;     /* of the key in the file; 0 for a default or an assignment */
  char *assigned;  /* the "--set path=value" that gives it, NULL for none */
} typed_value;

/** Reads the value of a key.
 *  @param key    node of the key, whose line is kept
 *  @param node   node of the value
 *  @param label  how messages call the key: "model.gamma", "sweep[1].from"
 *  @param value  overwritten; the caller clears it, also after a refusal
 *  @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int typed_read(const document *d, int key, int node, study_key row, const char *label, typed_value *value,
               message *why);

/** The default of a row, absent where there is none. False: out of memory.
 *  @param model  the type of model, NULL where the study does not say it */
bool typed_default(study_key row, const schema_choice *model, typed_value *value);
void typed_clear(typed_value *value);

/** Node of element `i` of a value that was given. */
int typed_item_node(const document *d, const typed_value *value, size_t i);

/** Refuses a computed value outside the range of the row. @param node  whose place the message names */
int typed_check(const document *d, int node, study_key row, const char *label, double value, message *why);

/* --- a study --- */

enum { STUDY_SLOTS = 512 /* a power of two, well above the number of keys */, STUDY_MAX_MOVED = 4 };

typedef struct sweep_entry {
  study_sweep view;           /* what study_sweep_at returns; its values are the array below */
  double *values;             /* [view.points], owned */
  uint64_t stride;            /* tasks between two values: the product of the points of all later sweeps */
  int nodes[SWEEP_KEY_COUNT]; /* values of its keys in the document while there is one; 0 where not given */
} sweep_entry;

/* A number that varies while a task runs, such as the continuation parameter. */
typedef struct moved_number {
  study_key by; /* the key whose word names it */
  study_parameter parameter;
  double start; /* its value at the start of a task */
} moved_number;

struct study {
  const schema *schema;
  const schema_choice *kind, *model; /* NULL until their words are read */
  char *name, *text;
  typed_value *values;               /* [schema->key_count] in the order of the schema */
  unsigned short slots[STUDY_SLOTS]; /* hash table from a key to 1 + its place there */
  sweep_entry sweeps[STUDY_MAX_SWEEPS];
  size_t sweep_count;
  moved_number moved[STUDY_MAX_MOVED];
  size_t moved_count;
  uint64_t tasks, digest;
};

/** Place of a key among the values. */
size_t study_place_of(const study *s, study_key key);

/* --- queries --- */

/** Value of a key. */
const typed_value *study_value(const study *s, study_key key);
/** Whether a key has a value other than null. */
bool study_has(const study *s, study_key key);
/** Its first number. */
double study_number(const study *s, study_key key);
/** Its word; "" when absent. */
const char *study_word(const study *s, study_key key);
bool study_is_kind(const study *s, const char *kind);

/** The sweep over an element of a key (item -1: over a scalar), NULL when there is none. */
const sweep_entry *sweep_over(const study *s, study_key key, long item);
/** Node that gives value `i` of a sweep. */
int sweep_value_node(const document *d, const sweep_entry *e, size_t i);

/** Node that gives a key or sweeps it, 0 if it has its default. */
int check_node_of_key(const study *s, study_key key);
/** Node of a section, or of a key of it that is swept; 0 when nothing of it is given. */
int check_node_of_section(const study *s, const document *d, const char *section);

/** Refuses a study, with its name as the place: for faults that no single key causes. @returns EXIT_USAGE */
int check_refuse(const study *s, message *why, const char *format, ...) __attribute__((format(printf, 3, 4)));

/** Finds a value of a key, given or swept, that is not its default.
 *  @param label  set to what messages call it, "model.floor[3]" or "swept model.floor[3]"; at least 128 bytes
 *  @returns its node; 0 where there is none, -1 without memory */
int check_find_other(const study *s, const document *d, study_key key, char *label, size_t size, double *value);

/* --- numbers by their names --- */

/** The words of messages about a parameter, by its use. */
typedef struct parameter_use {
  const char *label;   /* "sweep[1].parameter", "branch.parameter" */
  const char *noun;    /* "sweep": unknown sweep parameter */
  const char *verb;    /* "sweep": sweep one element by its index */
  const char *done;    /* "cannot be swept" */
  const char *example; /* what it may be */
  int node;            /* of the name in the document */
} parameter_use;

/** Finds the number of a name as in `model.floor[3]`; the values of the study are read already.
 *  @returns 0, or EXIT_USAGE for a name that is not one number that can vary, with the nearest one. */
int parameter_find(const study *s, const document *d, const parameter_use *use, const char *name,
                   study_parameter *parameter, message *why);
/** Gives an omitted key the first value of its sweep, or the start of its branch, as if the study gave it.
 *  @param key_node  of the word `parameter`, whose line is kept */
int parameter_supply(study *s, const document *d, const parameter_use *use, int key_node, study_key key, double value,
                     message *why);

/* --- what `complete` may change --- */

/** Declares that a number varies while a task runs. @param start  its value at the start of every task */
void study_move(study *s, study_key by, const study_parameter *parameter, double start);
/** Sets the number, or the word, of a key that has a value or a default, without marking it as given by the study. */
void study_fill_number(study *s, study_key key, double value);
int study_fill_word(study *s, study_key key, const char *word, message *why);

/* --- for this folder --- */

/** Refuses an unknown key of a section, naming the nearest one or all. @param section  "" for the top level. */
int refuse_unknown_key(const study *s, const document *d, int key, const char *section, message *why);
/** Reads `sweep`, one entry or a list of them, and gives omitted swept keys their first value. @param node  0: none. */
int sweep_read(study *s, const document *d, int node, message *why);
/** Checks missing keys, keys of another kind or model, and lengths of lists; then calls `check` of model and kind. */
int study_check(const study *s, const document *d, message *why);

#endif

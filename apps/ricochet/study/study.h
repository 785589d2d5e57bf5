/* A study: a validated study file with its typed values and the grid of tasks that its sweeps span.
 *
 * Reading is strict: an unknown key (the nearest known one is named), a duplicate key, a wrong type, trailing
 * characters, a value out of range, anchors, aliases, tags, a second document, nesting deeper than 32, files over 8 MiB
 * are refused with `FILE:LINE:`, key, value and what is allowed. This folder uses neither MPI nor HDF5. */
#ifndef RICOCHET_APP_STUDY_H
#define RICOCHET_APP_STUDY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <ricochet/status.h>

#include "../base/message.h"
#include "schema.h"

enum {
  STUDY_MAX_BYTES = 8 << 20, /* size of a study file */
  STUDY_MAX_DEPTH = 32,      /* nesting of its nodes */
  STUDY_MAX_SWEEPS = 8,
  STUDY_MAX_POINTS = 1 << 24 /* values of one sweep: every rank holds them */
};

/** A number of the study by its name. */
typedef struct study_parameter {
  char name[96]; /* "model.gamma", "model.floor[3]" */
  study_key key;
  long item; /* index of a list element, -1 for a scalar */
} study_parameter;

/** One entry of `sweep`: a parameter and its values. */
typedef struct study_sweep {
  char name[96]; /* "model.gamma", "model.floor[3]" */
  study_key key;
  long item; /* index of a list element, -1 for a scalar */
  size_t points;
  const double *values; /* [points] */
} study_sweep;

/** Reads a whole file, or pipe, into memory.
 *  @param stop  asked while there are no bytes to read
 *  @param text  set to malloc'd bytes with a terminating 0; the caller frees
 *  @returns 0, EXIT_FILES when it cannot be read, EXIT_USAGE when it is larger than STUDY_MAX_BYTES,
 *           EXIT_STOPPED. */
int study_read_file(const char *path, ric_poll stop, char **text, size_t *length, message *why);

/** A value that the program assigns before the study is checked; it replaces that of the study. */
typedef struct study_assignment {
  const char *path;      /* "orbit.period", borrowed */
  const double *numbers; /* [count] */
  size_t count;
  enum { ASSIGN_NUMBER, ASSIGN_LIST, ASSIGN_NULL, ASSIGN_EMPTY /* a section without keys */ } what;
} study_assignment;

/** A study to be read. */
typedef struct study_source {
  const schema *schema; /* borrowed, must outlive the study */
  const char *name;     /* name of the text in messages, usually the file's path */
  const char *text;     /* [length] */
  size_t length;
  const char *const *sets; /* [set_count] `--set` assignments "path=value", the value in YAML; applied to the tree
                              before validation, so any key can be set, also `sweep[0].points`. Messages about them
                              begin with `--set path=value:` */
  size_t set_count;
  const char *assigned_by;             /* how messages about the following begin, "restart" */
  const study_assignment *assignments; /* [assignment_count] applied after `sets` */
  size_t assignment_count;
} study_source;

/** Parses and validates a study.
 *  @param out   NULL after a refusal
 *  @returns 0, EXIT_USAGE, or EXIT_RUN when out of memory. */
int study_parse(const study_source *from, study **out, message *why);
void study_destroy(study **s);

/** Its kind, "orbits". */
const char *study_kind(const study *s);

/** Its kind, and the type of its model, in the schema. */
const schema_choice *study_kind_choice(const study *s);
const schema_choice *study_model_choice(const study *s);

/** Index of a particle's number in the value of a key: the particle itself in a list, 0 for a single number; -1 if the
 *  single number applies to another particle. The key must have a value. */
long study_item(const study *s, study_key key, size_t particle);

/** Name of the study in messages (study_source). */
const char *study_name(const study *s);

/** Free text of the user; "" when there is none. */
const char *study_title(const study *s);

/** Line of a key in the file, or of the sweep that supplies a key left out; 0 when neither is in the file (default,
 *  or `--set`). */
size_t study_line(const study *s, study_key key);

/** Whether a key is given in the file, by `--set` or by a sweep. */
bool study_gives(const study *s, study_key key);

/** "FILE:LINE: model.gamma" of a key, or "--set model.gamma=3: model.gamma", or "FILE: model.gamma" for a default. */
void study_place(const study *s, study_key key, char *text, size_t size);

/** The YAML text as run: the file's own text, or the tree written out again where `--set` changed it. */
const char *study_text(const study *s);

/** 64-bit digest of every value and sweep (comments and layout do not count): equal for the same study. */
uint64_t study_digest(const study *s);

size_t study_sweeps(const study *s);
const study_sweep *study_sweep_at(const study *s, size_t index);

/** Number of grid points, the product over the sweeps; 1 without a sweep. Less than 2^40. */
uint64_t study_tasks(const study *s);

/** The number that varies while a task runs and that a key such as `branch.parameter` names; NULL if there is none. */
const study_parameter *study_moved(const study *s, study_key by);

/** Value of sweep `index` at a task below study_tasks; the last sweep varies fastest. */
double study_sweep_value(const study *s, size_t index, uint64_t task);

/** A key with what it holds at the first task. */
typedef struct study_entry {
  study_key key;
  bool list, given;      /* given: as study_gives */
  size_t count;          /* elements of a list; 1 for a scalar */
  const double *numbers; /* [count] as value_number has them; NULL: a word or text */
  const char *text;      /* a word or text outside a list */
} study_entry;

/** @returns 0 to go on, or an exit code, with its reason in `why` */
typedef int study_entry_call(void *user, const study_entry *entry, message *why);

/** Calls for every key that the kind and the type of model take and that has a value, given, filled in or default, in
 *  the order of the schema; for the title always. The entry lasts as long as the call.
 *  @returns 0, what a call returned, or EXIT_RUN when out of memory */
int study_each(const study *s, study_entry_call *call, void *user, message *why);

/* The values of one task: the study's values with the swept ones replaced. */

typedef struct study_values study_values;

/** Borrows the study, which must outlive it. Starts at task 0. @returns NULL when out of memory. */
study_values *study_values_create(const study *s);
/** The study. */
const study *study_values_of(const study_values *v);
void study_values_destroy(study_values **v);
/** Moves to a task, below study_tasks. Only swept values are rewritten, nothing is allocated. */
void study_values_at(study_values *v, uint64_t task);

/** Gives the parameter of sweep `index` another value, until study_values_at. */
void study_values_sweep(study_values *v, size_t index, double value);
/** Sets the varying number that a key names (study_moved), until study_values_at; no effect if there is none. */
void study_values_move(study_values *v, study_key by, double value);

/** Whether the key was given (in the file or by --set) or has a default. */
bool value_present(const study_values *v, study_key key);
/** Whether the value is a list. */
bool value_is_list(const study_values *v, study_key key);
/** Elements of a list; 1 for a scalar, 0 when absent. */
size_t value_count(const study_values *v, study_key key);
/** Element `i` of a number, integer or flag value, scalar or list; null reads as -INFINITY; an element of a list of
 *  words reads as its index among the words of the row. */
double value_number(const study_values *v, study_key key, size_t i);
/** The number of a particle: its own in a list, or the one value; minus infinity if that applies to another one. */
double value_of_particle(const study_values *v, study_key key, size_t particle);
bool value_flag(const study_values *v, study_key key);
/** Word or text; "" when absent. */
const char *value_word(const study_values *v, study_key key);

#endif

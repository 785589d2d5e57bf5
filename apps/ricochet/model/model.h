/* Types of model: from the keys of the section `model` to a system of the library. A type is a file; models.c lists
 * them all. */
#ifndef RICOCHET_APP_MODEL_H
#define RICOCHET_APP_MODEL_H

#include "study/check.h"

/** What a type of model has; keys, words and kinds say which of it they need. */
enum {
  MODEL_SYSTEM = 1, /* motions of particles between impacts */
  MODEL_CHAIN = 2,  /* closed forms: it may be a linear chain without damping, a ric_chain */
  MODEL_MAP = 4     /* no motions: a return map */
};

struct lattice_model;

typedef struct model_type {
  schema_choice choice; /* its first member, so that a choice of `models` is a model_type */
  /* Of a lattice. */
  bool lists_springs; /* its springs are a list whatever the study gives */
  /** Sets its springs and its ends for the present task. */
  void (*read_springs)(struct lattice_model *m, const study_values *v);
} model_type;

/** Every type, ended by NULL. */
extern const schema_choice *const models[];

/** The type of a study's model. */
const model_type *model_of(const study *s);
/** Whether it has a feature. */
bool model_has(const study *s, unsigned feature);

/* The keys of the section. */
#define KEY(name, ...) extern const schema_entry name[1];
#include "models.inc"
#undef KEY

#endif

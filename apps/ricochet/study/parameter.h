/* A number of the study that something varies: a key, or an element of its list, by its name as in `model.floor[3]`. */
#ifndef RICOCHET_APP_PARAMETER_H
#define RICOCHET_APP_PARAMETER_H

#include "parts.h"

/** Who asks for a parameter, for messages. */
typedef struct parameter_use {
  const char *label;   /* "sweep[1].parameter", "branch.parameter" */
  const char *noun;    /* "sweep": unknown sweep parameter */
  const char *verb;    /* "sweep": sweep one element by its index */
  const char *done;    /* "cannot be swept" */
  const char *example; /* what it may be */
  int node;            /* of the name in the document */
} parameter_use;

/** Finds the parameter of a name; the values of the study are read already.
 *  @returns 0, or EXIT_USAGE for a name that is not one number that can vary, with the nearest one. */
int parameter_find(const study *s, const document *d, const parameter_use *use, const char *name,
                   study_parameter *parameter, message *why);

/** Gives a key that was left out the value that its use says first, as if it stood in the study.
 *  @param key_node  of the word `parameter`, whose line is kept */
int parameter_supply(study *s, const document *d, const parameter_use *use, int key_node, study_key key, double value,
                     message *why);

#endif

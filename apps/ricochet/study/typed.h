/* Typed values: one node of the document read against one row of the schema. */
#ifndef RICOCHET_APP_TYPED_H
#define RICOCHET_APP_TYPED_H

#include "document.h"
#include "schema.h"

typedef struct typed_value {
  bool present; /* given, or with a default */
  bool list;
  size_t count;    /* elements of a list, 1 for a scalar */
  double *numbers; /* [count] numbers, integers, flags as 0 and 1, words of a list as their places; else NULL */
  char *text;      /* word or text outside a list */
  int node;        /* in the document, while there is one; 0 for a default */
  size_t line;     /* of the key in the file; 0 for a default or an assignment */
  char *assigned;  /* "--set path=value" that gave it, NULL for none */
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

/** Refuses a computed value that does not meet the row, naming it. @param node  where it was given. */
int typed_check(const document *d, int node, study_key row, const char *label, double value, message *why);

#endif

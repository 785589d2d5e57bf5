/* How the rows of keys are written. A file `*.inc` is a list of
 *
 *   KEY(KEY_TIME_SAMPLES, "time.samples", IS_INTEGER, DEFAULT("1001"), RANGE(2, 1e9), SHAPES,
 *       DOC("Number of states ..."))
 *
 * and is the only place that describes a key. KEY_DEFINE and KEY_LIST expand it to definitions and to a list.
 * KEY_GROUP, set in the file, names a group of keys that kinds and types of model accept together. */
#ifndef RICOCHET_APP_KEYS_H
#define RICOCHET_APP_KEYS_H

#include <math.h>

#include "schema.h"

/* A row is an array of one, so that its name is the key. */
#define KEY_DEFINE(name, text, ...) const schema_entry name[1] = {{.path = text, .group = KEY_GROUP, __VA_ARGS__}};
#define KEY_LIST(name, ...)         name,

/* Types. */
#define IS_NUMBER   .type = VALUE_NUMBER, .scalar = true
#define IS_NUMBERS  .type = VALUE_NUMBER, .list = true
#define IS_INTEGER  .type = VALUE_INTEGER, .scalar = true
#define IS_INTEGERS .type = VALUE_INTEGER, .list = true
#define IS_FLAG     .type = VALUE_FLAG, .scalar = true, .no_sweep = "it is a flag, not a number"
#define IS_WORD     .type = VALUE_WORD, .scalar = true, .no_sweep = "it is a word, not a number"
#define IS_WORDS    .type = VALUE_WORD, .list = true, .no_sweep = "it holds words, not numbers"
#define IS_TEXT     .type = VALUE_TEXT, .scalar = true, .no_sweep = "it is text, not a number"
/* A list in place of a single number, one element per particle. */
#define PER_PARTICLE .list = true, .per_particle = true
#define OR_LIST      .list = true
#define OR_NULL      .null = true

/* Defaults. */
#define REQUIRED      .required = true
#define ABSENT        .fallback = ""
#define DEFAULT(text) .fallback = text

/* Ranges. */
#define ANY         .low = -INFINITY, .high = INFINITY
#define FROM(a)     .low = a, .high = INFINITY
#define ABOVE(a)    .low = a, .low_open = true, .high = INFINITY
#define RANGE(a, b) .low = a, .high = b
#define UP_TO(b)    .low = 0, .low_open = true, .high = b
#define BELOW(b)    .low = 0, .high = b, .high_open = true

/* Sweeps. */
#define SWEPT  .sweep = true
#define SHAPES .no_sweep = "it changes the shape of the result"

#define ONE_OF(list) .words = list
#define LATER(list)  .later_words = list
/* Features of the model that a key needs, and each of its words, in their order. */
#define NEEDS(features) .needs = features
#define WORD_NEEDS(...)                                                                                                \
  .word_needs = (const unsigned[]) {                                                                                   \
    __VA_ARGS__                                                                                                        \
  }
#define DOC(text) .doc = text

#endif

/* The chain and the impact pattern that a study's values describe. */
#ifndef RICOCHET_APP_CHAIN_MODEL_H
#define RICOCHET_APP_CHAIN_MODEL_H

#include <ricochet/ricochet.h>

#include "study/study.h"

/** A chain with the storage of its floors. */
typedef struct chain_model {
  ric_chain chain;
  double *floors; /* [particles] when the study lists them, else NULL */
} chain_model;

/** Allocates for the number of particles of the values. @returns 0, or -1 when out of memory. */
int chain_model_init(chain_model *m, const study_values *v);
void chain_model_clear(chain_model *m);

/** Reads the chain of the present task. */
void chain_model_read(chain_model *m, const study_values *v);

/** What is at the ends. */
ric_ends chain_model_ends(const study_values *v);

/** Reads the pattern of the present task; the caller destroys it. */
ric_status chain_model_pattern(const study_values *v, ric_pattern **pattern, ric_error *error);

#endif

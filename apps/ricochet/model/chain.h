/* The linear chain that a study's values describe. */
#ifndef RICOCHET_APP_CHAIN_H
#define RICOCHET_APP_CHAIN_H

#include <ricochet/ricochet.h>

#include "model.h"

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

#endif

/* The files of the schema table: how its rows are written. */
#ifndef RICOCHET_APP_SCHEMA_ROWS_H
#define RICOCHET_APP_SCHEMA_ROWS_H

#include <math.h>

#include "schema.h"

#define ANY  .low = -INFINITY, .high = INFINITY
#define FLAG .type = VALUE_FLAG, .scalar = true, .no_sweep = "it is a flag, not a number"
#define WORD .type = VALUE_WORD, .scalar = true, .no_sweep = "it is a word, not a number"

/** Types of model that are lattices. */
#define LATTICES "chain|duffing_chain"

/** The rows of kind, title and the section `model`, before KEY_ORBIT_PERIOD. */
const schema_entry *schema_model_row(study_key key);
/** The rows of the sections `branch`, `restart` and `grazing`, from KEY_BRANCH_PARAMETER on. */
const schema_entry *schema_branch_row(study_key key);
/** The rows of the section `iterate`, from KEY_ITERATE_TRANSIENT on. */
const schema_entry *schema_iterate_row(study_key key);

#endif

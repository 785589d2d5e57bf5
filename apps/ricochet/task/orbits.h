/* kind: orbits, for its own sources: the columns of its table. */
#ifndef RICOCHET_APP_ORBITS_H
#define RICOCHET_APP_ORBITS_H

#include <ricochet/ricochet.h>

#include "../study/study.h"
#include "table.h"

/** Words of ric_outcome. */
extern const char *const orbit_outcome_names[RIC_OUTCOME_COUNT];

/** Lays out the row. */
void orbits_lay_out(const study_values *v, table *t);

/** Fills the columns of every orbit and of the verifier, and clears the others. */
void orbits_put(const ric_orbit *orbit, const char *reason, const ric_verification *verification, const table *t,
                unsigned char *row);

#endif

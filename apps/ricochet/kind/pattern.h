/* The impact pattern of a periodic orbit: which particles hit at t = 0, which at t = T/2. */
#ifndef RICOCHET_APP_PATTERN_H
#define RICOCHET_APP_PATTERN_H

#include <ricochet/ricochet.h>

#include "study/check.h"

/** Reads the pattern of the present task; the caller destroys it. @returns as ric_pattern_create */
ric_status pattern_read(const study_values *v, ric_pattern **pattern, ric_error *error);

/** Refuses particles that do not exist, have no obstacle, or are named twice. If a swept element has such a value, that
 *  is the outcome of its grid point. */
int pattern_check(const study *s, const document *d, bool may_be_empty, message *why);

/** Refuses keys of the model whose default orbits with a pattern need.
 *  @param closed  the orbit follows in closed form: of a linear chain without damping with floors of restitution 1;
 *                 else it is found by shooting
 *  @param who  needs it, for messages */
int pattern_check_model(const study *s, const document *d, bool closed, const char *who, message *why);

#endif

/* Resonances, singular points and critical parameters along the sweep of an `orbits` study: the table `special`. */
#ifndef RICOCHET_APP_ORBITS_SPECIAL_H
#define RICOCHET_APP_ORBITS_SPECIAL_H

#include "kind/kind.h"

/** Refuses `special_points: true` where the list would be too long. */
int orbits_special_plan(const study *s, const study_values *v, message *why);

/** The list, ordered by parameter; empty unless the study asks for it. */
int orbits_special(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                   message *why);

#endif

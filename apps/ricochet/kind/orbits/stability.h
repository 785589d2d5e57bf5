/* Multipliers of the orbits of a study, and the verdict about their stability. */
#ifndef RICOCHET_APP_STABILITY_H
#define RICOCHET_APP_STABILITY_H

#include <ricochet/ricochet.h>
#include <stdbool.h>

#include "study/study.h"
#include "orbits.h"

typedef struct stability {
  bool wanted; /* without it, nothing else is set */
  ric_orbit_multiplier_options options;
  ric_multipliers found; /* of the present task */
} stability;

/** Whether a study asks for the verdict: `orbit.stable`, or `orbit.multipliers`, which implies it. */
bool stability_wanted(const study_values *v);

/** Refuses `orbit.multipliers` for chains that are too long for it. @returns 0 or EXIT_USAGE */
int stability_check(const study *s, const study_values *v, message *why);

/** Its memory on a rank in bytes; a double, which cannot overflow. */
double stability_bytes(const study_values *v);

/** Attributes that say how the verdict was found. */
void stability_put_tolerances(table *t);

ric_status stability_init(stability *s, const study_values *v, ric_poll poll, ric_error *error);
void stability_clear(stability *s);

/** Multipliers of a solved orbit; a refusal of the library gives `unknown` with its message.
 *  @param pattern  NULL when there is none: then the orbit is `failed`
 *  @returns RIC_OK or RIC_ESTOPPED */
ric_status stability_find(stability *s, ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                          const ric_orbit *orbit);

/** The same of an even motion found by shooting.
 *  @param shooting  NULL when there is none */
ric_status stability_find_motion(stability *s, ric_shooting *shooting, const double *z, const ric_orbit *orbit);

/** Sets its members of a row, which borrows them. */
void stability_put(stability *s, orbits_row *row);

#endif

/* kind: orbits, for its own sources: the columns of its table. */
#ifndef RICOCHET_APP_ORBITS_H
#define RICOCHET_APP_ORBITS_H

#include <ricochet/ricochet.h>

#include "study/study.h"
#include "kind/kind.h"

/** Words of ric_outcome. */
extern const char *const orbit_outcome_names[RIC_OUTCOME_COUNT];
/** Words of ric_stability. */
extern const char *const orbit_stability_names[RIC_STABILITIES];

/** A row: the members that its columns name. */
typedef struct orbits_row {
  const ric_orbit *orbit;
  const char *reason;
  const ric_verification *verification;
  /* of the multipliers */
  int stable;
  const char *stable_reason;
  double multiplier_max;
  const ric_complex *multipliers;
  long long multiplier_outside, multiplier_real_above, multiplier_real_below, multiplier_complex;
  /* of Ritz's method */
  long long ritz_functions;
  double ritz_frequency, ritz_error, ritz_error_v, ritz_defect;
} orbits_row;

/** The columns of its tables (kind.h). */
extern const column_list orbits_lists[], orbits_special_lists[];

/** Lays out the row. */
void orbits_lay_out(const study_values *v, table *t);

/** The result of a verification that could not be run: `run_failed` with the error's message.
 *  @returns RIC_OK or RIC_ESTOPPED */
ric_status orbits_verified(ric_status status, const ric_error *error, ric_verification *verification);

/* Resonances, singular points and critical parameters along the sweep of an `orbits` study: the table `special`. */

/** Refuses `special_points: true` where the list would be too long. */
int orbits_special_plan(const study *s, const study_values *v, message *why);

/** The list, ordered by parameter; empty unless the study asks for it. */
int orbits_special(const study *s, const kind_plan *plan, const row_source *done, ric_poll poll, extra_rows *extra,
                   message *why);

extern const kind kind_orbits, kind_orbits_shooting;

#endif

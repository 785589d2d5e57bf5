/* The verifier: an event-driven run over one period, compared with the predicted impacts of an orbit.
 *
 * However an orbit was found, three questions decide: does the motion return to its initial state (closure), does
 * every predicted impact happen at its time on its obstacle, and is there no other impact? The run does not depend on
 * the method that found the orbit. */
#ifndef RICOCHET_VERIFY_H
#define RICOCHET_VERIFY_H

#include <stddef.h>

#include "orbit.h"
#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

#define RIC_VERIFICATION_LIST(X)                                                                                       \
  X(RIC_VERIFIED, "verified")                                                                                          \
  X(RIC_NOT_CLOSED, "not_closed")                                                                                      \
  X(RIC_IMPACT_MISSING, "impact_missing")                                                                              \
  X(RIC_IMPACT_EXTRA, "impact_extra")                                                                                  \
  X(RIC_RUN_FAILED, "run_failed")                                                                                      \
  X(RIC_NOT_RUN, "not_run") /* the orbit has no state, or is not admissible */

typedef enum ric_verification_result {
#define X(name, text) name,
  RIC_VERIFICATION_LIST(X)
#undef X
      RIC_VERIFICATION_RESULTS
} ric_verification_result;

RIC_API const char *ric_verification_name(ric_verification_result result);

typedef struct ric_verification {
  ric_verification_result result;
  char reason[320];     /* which impact, when, by how much; "" when verified */
  double closure_error; /* largest difference of coordinates and speeds after one period, relative to the largest
                           coordinate and speed; NaN when not run */
  size_t impacts;       /* number that happened */
} ric_verification;

/** A predicted impact of an orbit. */
typedef struct ric_promise {
  double time; /* within (start, start + period) */
  size_t obstacle;
} ric_promise;

typedef struct ric_verify_options {
  double closure_tol; /* 1e-8: larger closure errors are `not_closed`; errors of a strongly unstable orbit grow by its
                         largest multiplier within the period */
  double impact_time_tol;        /* 1e-7, relative to the period */
  ric_trajectory_options motion; /* options of the run */
} ric_verify_options;

RIC_API ric_verify_options ric_verify_options_default(void);

/** Verifies a periodic motion of any system.
 *  @param start  time of the state, not that of an impact
 *  @param q, u  [n], [m] state there
 *  @param promises  [count] predicted impacts, in order of time
 *  @param options  NULL for the defaults
 *  @returns RIC_OK with a result; RIC_EINVAL for a period that is not positive, and predicted impacts of unknown
 *  obstacles or outside the period; errors of ric_trajectory_create and RIC_ESTOPPED. */
RIC_API ric_status ric_verify(const ric_system *system, double start, const double *q, const double *u, double period,
                              const ric_promise *promises, size_t count, const ric_verify_options *options,
                              ric_verification *verification, ric_error *error);

/** Verifies an orbit of a chain with its pattern, from t = T/4 on, halfway between its impacts.
 *  @param solver  provides the state there */
RIC_API ric_status ric_orbit_verify(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                                    const ric_orbit *orbit, const ric_verify_options *options,
                                    ric_verification *verification, ric_error *error);

RIC_END_DECLARATIONS

#endif

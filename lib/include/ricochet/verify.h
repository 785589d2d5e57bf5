/* The verifier: an event-driven run over one period, compared with the predicted impacts of an orbit.
 *
 * However an orbit was found, three questions decide: does the motion return to its initial state (closure), does
 * every predicted impact happen at its time on its obstacle, and is there no other impact? The run does not depend on
 * the method that found the orbit. The orbit provides the period and the predicted impacts with their times and
 * obstacles; the run starts at any time that is not that of an impact. */
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

typedef struct ric_verify_options {
  double closure_tol; /* 1e-8: larger closure errors are `not_closed`; errors of a strongly unstable orbit grow by its
                         largest multiplier within the period */
  double impact_time_tol;        /* 1e-7, relative to the period */
  ric_trajectory_options motion; /* options of the run */
} ric_verify_options;

RIC_API ric_verify_options ric_verify_options_default(void);

/** Verifies a periodic motion of any system. A run that cannot start, or ends early, is `run_failed`; the outcome of
 * the orbit and its arrays of states are not read.
 *  @param orbit  its period, impact_time and impact_obstacle are read
 *  @param start  time of the state, with a distance above impact_time_tol from every impact
 *  @param q, u  [n], [m] state there; u NULL if m = 0
 *  @param options  NULL for the defaults
 *  @returns RIC_OK with a result; RIC_EINVAL for an orbit of other numbers of coordinates or speeds, a period that is
 *           not positive, unknown obstacles, an impact at `start`; RIC_EINVAL for options as ric_trajectory_create,
 *           RIC_ENOMEM, RIC_ESTOPPED. */
RIC_API ric_status ric_verify(const ric_system *system, const ric_orbit *orbit, double start, const double *q,
                              const double *u, const ric_verify_options *options, ric_verification *verification,
                              ric_error *error);

/** Verifies an orbit of a chain, from t = T/4 on, halfway between its impacts; `not_run` unless it is admissible. Those
 *  of shooting: ric_shooting_verify.
 *  @param solver  gives the state there
 *  @param options  NULL for the defaults
 *  @returns as ric_verify, ric_orbit_states. */
RIC_API ric_status ric_orbit_verify(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                                    const ric_verify_options *options, ric_verification *verification,
                                    ric_error *error);

RIC_END_DECLARATIONS

#endif

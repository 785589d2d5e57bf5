/* Monodromy matrices: the derivative of the state after one period by the state before it.
 *
 * The matrix comes from an event-driven run over one period with one tangent vector per number of the state
 * (trajectory.h). So it exists for any system, any flow and all impacts that are differentiable. Its determinant is
 * the product of e^2 over the impacts times the exponential of the integrated divergence; its eigenvalues are the
 * Floquet multipliers (multipliers.h). */
#ifndef RICOCHET_MONODROMY_H
#define RICOCHET_MONODROMY_H

#include "orbit.h"
#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_monodromy {
  ric_run_outcome outcome; /* of the run; the matrix is set if it is `completed` */
  char reason[256];        /* for people; "" when completed */
  double closure_error;    /* largest difference of coordinates and speeds after the period, relative to the largest
                              coordinate and speed; NaN when not completed */
  size_t impacts;          /* events at which the speeds jump or a contact begins to stick */
} ric_monodromy;

/** @param start  time of the state, not that of an impact
 *  @param q, u  [n], [m] state there; u NULL if m = 0
 *  @param period  > 0
 *  @param options  of the run, NULL for the defaults
 *  @param M  [n + m][n + m] row-major, state (q, u)
 *  @returns RIC_EINVAL for a period that is not positive; as ric_trajectory_create and ric_trajectory_run. */
RIC_API ric_status ric_monodromy_find(const ric_system *system, double start, const double *q, const double *u,
                                      double period, const ric_trajectory_options *options, double *M,
                                      ric_monodromy *monodromy, ric_error *error);

/** The monodromy matrix of an orbit of a chain, from t = T/4 on, halfway between its impacts.
 *  @param solver  provides the state there
 *  @param options  of the run, NULL for the defaults
 *  @param M  [2n][2n] row-major, state (q, v)
 *  @returns RIC_EINVAL for an orbit without a state. */
RIC_API ric_status ric_orbit_monodromy(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                                       const ric_trajectory_options *options, double *M, ric_monodromy *monodromy,
                                       ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Newton's method with line search for F(z) = 0, by SUNDIALS KINSOL with exact dense Jacobians: internal to the
 * library.
 */
#ifndef RICOCHET_NEWTON_H
#define RICOCHET_NEWTON_H

#include <stddef.h>

#include "ricochet/status.h"

typedef struct newton_problem {
  const char *name; /* begins the sentence "... does not converge" */
  size_t unknowns;
  /** F [unknowns] and J [unknowns][unknowns] row-major; J is NULL if only F is needed. RIC_ENUMERIC if there is no
   *  value: a shorter step is tried; any other status ends the search. */
  ric_status (*residual)(const double *z, double *F, double *J, void *user, ric_error *error);
  void *user;
} newton_problem;

/** @param z  [unknowns] guess; set to the solution, or to the last iterate
 *  @param tolerance  of the largest residual, relative to 1 + the largest unknown. Residuals up to 10^4 times it that
 *                    no longer decrease count as rounding
 *  @param iterations  set
 *  @returns RIC_ENUMERIC if it does not converge, with the remaining residual; what `residual` returns; RIC_ENOMEM. */
ric_status newton_solve(const newton_problem *problem, double *z, double tolerance, int *iterations, ric_error *error);

#endif

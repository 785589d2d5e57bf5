/* The linear complementarity problem (LCP) of coupled contacts: internal to the room.
 *
 *   w = A z + b,   w >= 0,   z >= 0,   z . w = 0,
 *
 * with A symmetric and positive semidefinite of order k. For impacts z are impulses and b = (1 + e) h'-; for sticking
 * contacts z are forces and b the free gap accelerations; A = G^T M^-1 G. It is the condition for the minimum of z.Az /
 * 2 + b.z over z >= 0. Principal pivoting on sets of positive unknowns finds it: Cholesky's method solves the equations
 * A_SS z_S = -b_S of a set, unknowns that would become negative leave, the one with the most negative w enters. Every
 * exchange decreases the objective, so no set occurs twice.
 *
 * A is singular if contacts are redundant (two obstacles with the same direction, more contacts than speeds). The sets
 * are kept independent: an unknown that depends on the set replaces one of its members. Then z is one of many
 * solutions, and w is unique. */
#ifndef RICOCHET_COMPLEMENTARITY_H
#define RICOCHET_COMPLEMENTARITY_H

#include <stddef.h>

#include "ricochet/status.h"

/** Work arrays; all zero is empty. They grow to the largest size used. */
typedef struct complementarity_work {
  size_t capacity;
  double *values;
  size_t *set;
} complementarity_work;

void complementarity_clear(complementarity_work *work);

/** Finds z [size] for A [size][size] row-major and b [size]. Solving again with no larger size allocates nothing.
 *  Scaling of a contact (row and column of A, entry of b) does not matter.
 *  @returns RIC_ENUMERIC if there is no solution, A is not positive semidefinite, or entries are not finite: z is
 *           unchanged; RIC_ENOMEM. */
ric_status complementarity_solve(complementarity_work *work, size_t size, const double *A, const double *b, double *z,
                                 ric_error *error);

#endif

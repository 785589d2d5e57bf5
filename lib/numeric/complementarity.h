/* The linear complementarity problem of contacts that act together: internal to the room.
 *
 *   w = A z + b,   w >= 0,   z >= 0,   z . w = 0,
 *
 * with A symmetric and positive semidefinite of order k. For impacts z are impulses and b = (1 + e) h'-, for rest z are
 * forces and b the free gap accelerations; A = G^T M^-1 G. It is the condition for the minimum of z.Az / 2 + b.z over
 * z >= 0, which is found by principal pivoting on sets of positive unknowns: the equations A_SS z_S = -b_S of a set are
 * solved by Cholesky's method, unknowns that would turn negative leave, the one with the most negative w enters. Every
 * exchange lowers the minimum, so no set comes twice.
 *
 * A is singular when contacts are redundant (two obstacles that press the same way, more contacts than speeds). The
 * sets are kept independent all the same: an unknown that depends on the set replaces one of it. Then z is one of
 * many, w is unique. */
#ifndef RICOCHET_COMPLEMENTARITY_H
#define RICOCHET_COMPLEMENTARITY_H

#include <stddef.h>

#include "ricochet/status.h"

/** Work arrays; all zero is empty. They grow with the largest size seen. */
typedef struct complementarity_work {
  size_t capacity;
  double *values;
  size_t *set;
} complementarity_work;

void complementarity_clear(complementarity_work *work);

/** Finds z [size] for A [size][size] row-major and b [size]. Solving again with no larger size allocates nothing.
 *  Scaling of a contact (row and column of A, entry of b) does not matter.
 *  @returns RIC_ENUMERIC when there is no solution, A is not positive semidefinite, or entries are not finite: z is
 *           untouched; RIC_ENOMEM. */
ric_status complementarity_solve(complementarity_work *work, size_t size, const double *A, const double *b, double *z,
                                 ric_error *error);

#endif

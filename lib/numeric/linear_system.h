/* Square linear systems that may be singular: internal to the room.
 *
 * The regular way is a QR factorisation with column pivoting, which also estimates the norm of the inverse. Where that
 * is beyond what the caller accepts, linear_least_norm solves a fresh copy of the system on its numerical rank: if the
 * right-hand side is compatible, its solution is the smallest of many. */
#ifndef RICOCHET_LINEAR_SYSTEM_H
#define RICOCHET_LINEAR_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

#include "ricochet/status.h"

/** What became of the equations of an orbit. */
typedef struct linear_outcome {
  double condition;
  bool singular; /* the condition number is beyond the limit */
  bool solvable; /* singular, but compatible: the solution is one of many */
} linear_outcome;

/** Work arrays, borrowed. */
typedef struct linear_work {
  double *tau, *norm; /* [size] */
  double *work;       /* [3 size] */
  size_t *permutation;
} linear_work;

/** Estimates from the triangular factor. */
typedef struct linear_factor {
  double norm, inverse_norm; /* 1-norms; inverse_norm is infinite when there is a zero on the diagonal */
  double last;               /* its last and smallest diagonal entry */
} linear_factor;

/** Solves matrix x = rhs; the matrix [size][size] is overwritten.
 *  @param factor  set to what the triangular factor tells; with an infinite inverse_norm x is left alone */
ric_status linear_solve(double *matrix, size_t size, double *rhs, double *x, const linear_work *w,
                        linear_factor *factor, ric_error *error);

/** Least-norm solution on the numerical rank, allocating what it needs.
 *  @param zero  diagonal entries of the triangular factor up to it count as zero, and at least the last one, `last`
 *  @param residual  set to the Euclidean norm of rhs - matrix x over that of rhs */
ric_status linear_least_norm(double *matrix, size_t size, double *rhs, double *x, double zero, double last,
                             double *residual, ric_error *error);

#endif

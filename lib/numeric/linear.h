/* Linear equations with dense matrices: Cholesky's factorisation, QR with column pivoting, orthonormal vectors.
 * Internal to the library. */
#ifndef RICOCHET_LINEAR_H
#define RICOCHET_LINEAR_H

#include <stdbool.h>
#include <stddef.h>

#include <gsl/gsl_matrix.h>

#include "ricochet/status.h"

/* Cholesky's factorisation of small symmetric matrices, A = L L^T; row-major with rows of any stride; only the lower
 * triangle is read. */

/** A [n][n] becomes L in place. @returns false if A is not positive definite. */
bool cholesky_factor(double *a, size_t n);

/** The same for a positive semidefinite matrix: an unknown whose column depends on the previous ones, to rounding, is
 *  dropped (its column of L is zero with an infinite pivot, so that its solution is zero). */
void cholesky_factor_semidefinite(double *a, size_t n);

/** One row of it: entries 0 ... i of row i of A, after rows 0 ... i - 1 of L, become those of L except for the last.
 *  @returns the reduced diagonal entry, whose root is the last one. */
double cholesky_row(double *a, size_t stride, size_t i);

/** x [n] from L x = x, and from L^T x = x. */
void cholesky_solve_lower(const double *factor, size_t stride, size_t n, double *x);
void cholesky_solve_upper(const double *factor, size_t stride, size_t n, double *x);

/** x [n] from A x = x. */
void cholesky_solve(const double *factor, size_t n, double *x);

/* Square linear systems that may be singular.
 *
 * The regular method is a QR factorisation with column pivoting, which also estimates the norm of the inverse. If that
 * exceeds the limit of the caller, linear_least_norm solves a fresh copy of the system on its numerical rank: if the
 * right-hand side is compatible, its solution is the smallest of many. */

/** Outcome of the equations of an orbit. */
typedef struct linear_outcome {
  double condition;
  bool singular; /* the condition number exceeds the limit */
  bool solvable; /* singular, but compatible: the solution is one of many */
} linear_outcome;

/** Work arrays, borrowed. */
typedef struct linear_work {
  double *tau, *norm; /* [size] */
  double *work;       /* [3 size] */
  size_t *permutation;
  ric_poll poll; /* asked for each column of a matrix for which that is worth while */
} linear_work;

/** Estimates from the triangular factor. */
typedef struct linear_factor {
  double norm, inverse_norm; /* 1-norms; inverse_norm is infinite if there is a zero on the diagonal */
  double last;               /* its last and smallest diagonal entry */
} linear_factor;

/** Eigenvalues of a symmetric matrix [size][size], of which the lower triangle is read; it is overwritten.
 *  @param eigenvalues  [size] rising
 *  @returns also RIC_ESTOPPED */
ric_status linear_eigenvalues(double *matrix, size_t size, double *eigenvalues, ric_poll poll, ric_error *error);

/** Solves matrix x = rhs; the matrix [size][size] is overwritten.
 *  @param factor  set from the triangular factor; with an infinite inverse_norm x is unchanged
 *  @returns also RIC_ESTOPPED */
ric_status linear_solve(double *matrix, size_t size, double *rhs, double *x, const linear_work *w,
                        linear_factor *factor, ric_error *error);

/** Least-norm solution on the numerical rank, allocating what it needs.
 *  @param zero  diagonal entries of the triangular factor up to it count as zero, and at least the last one, `last`
 *  @param residual  set to the Euclidean norm of rhs - matrix x over that of rhs */
ric_status linear_least_norm(double *matrix, size_t size, double *rhs, double *x, double zero, double last,
                             double *residual, ric_error *error);

/* Orthonormal tangent vectors by the QR factorisation of GSL.
 *
 * A vector in the span of the previous ones, to rounding, has lost its direction: it becomes zero, with the growth
 * -INFINITY. */

/** Zeroed is empty. */
typedef struct orthonormal_work {
  gsl_matrix *factors; /* [size][count] */
  gsl_vector *tau;     /* [count] */
  gsl_vector *column;  /* [size] */
} orthonormal_work;

/** @param count  <= size */
ric_status orthonormal_init(orthonormal_work *work, size_t size, size_t count, ric_error *error);
void orthonormal_clear(orthonormal_work *work);

/** Makes the columns of x [size][count] orthonormal, in their order.
 *  @param growth  [count] set to the logarithms of the moduli of R's diagonal, x = Q R */
void orthonormal_make(orthonormal_work *work, double *x, double *growth);

/** Sets x to fixed pseudo-random orthonormal vectors: vectors along the axes could miss growing directions for long.
 *  @param growth  [count] overwritten */
void orthonormal_scatter(orthonormal_work *work, double *x, double *growth);

#endif

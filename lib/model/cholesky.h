/* Cholesky's factorisation of small symmetric matrices, in place; row-major, only the lower triangle is looked at. */
#ifndef RICOCHET_CHOLESKY_H
#define RICOCHET_CHOLESKY_H

#include <stdbool.h>
#include <stddef.h>

/** A [n][n] becomes L, A = L L^T. @returns false when A is not positive definite. */
bool cholesky_factor(double *a, size_t n);

/** The same for a matrix that is at least positive semidefinite: an unknown whose column depends on those before it, to
 *  rounding, is left out (its column of L is zero with an infinite pivot, so that the solution has a zero there). */
void cholesky_factor_semidefinite(double *a, size_t n);

/** x [n] from A x = x. */
void cholesky_solve(const double *factor, size_t n, double *x);

#endif

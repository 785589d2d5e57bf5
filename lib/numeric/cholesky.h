/* Cholesky's factorisation of small symmetric matrices, A = L L^T; row-major with rows of any stride, only the lower
 * triangle is looked at. Internal. */
#ifndef RICOCHET_CHOLESKY_H
#define RICOCHET_CHOLESKY_H

#include <stdbool.h>
#include <stddef.h>

/** A [n][n] becomes L in place. @returns false when A is not positive definite. */
bool cholesky_factor(double *a, size_t n);

/** The same for a matrix that is at least positive semidefinite: an unknown whose column depends on those before it, to
 *  rounding, is left out (its column of L is zero with an infinite pivot, so that the solution has a zero there). */
void cholesky_factor_semidefinite(double *a, size_t n);

/** One row of it: entries 0 ... i of row i of A, behind rows 0 ... i - 1 of L, become those of L but for the last.
 *  @returns what is left of the diagonal entry, whose root is the last one. */
double cholesky_row(double *a, size_t stride, size_t i);

/** x [n] from L x = x, and from L^T x = x. */
void cholesky_solve_lower(const double *factor, size_t stride, size_t n, double *x);
void cholesky_solve_upper(const double *factor, size_t stride, size_t n, double *x);

/** x [n] from A x = x. */
void cholesky_solve(const double *factor, size_t n, double *x);

#endif

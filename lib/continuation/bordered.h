/* The Jacobian of a curve, bordered by one row: internal to the room.
 *
 *   | J    F_p |
 *   | row_u  row_p |
 *
 * is regular at folds for a row along the tangent, and singular at branch points for every row. It is factorised by
 * QR with column pivoting where it is small, by LU where it is large. The determinant with the unit tangent as its row
 * (in the norm of continuation.h) depends on the point and the direction of walk alone; it follows from that with any
 * other row. */
#ifndef RICOCHET_BORDERED_H
#define RICOCHET_BORDERED_H

#include <stdbool.h>

#include "ricochet/continuation.h"

/** A determinant, sign * exp(log), and how near the matrix is to a singular one. */
typedef struct bordered_determinant {
  int sign; /* 0: singular, or not known */
  double log;
  double least; /* diagonal entry of R or U in modulus: proportional to the distance from a branch point */
} bordered_determinant;

typedef struct bordered {
  const ric_curve_problem *problem; /* borrowed */
  ric_poll poll;
  size_t size;           /* n + 1 */
  double *residual;      /* [n + 1] F, and room for a right-hand side */
  double *J, *F_p;       /* [n][n], [n] as the problem gives them */
  double *matrix;        /* [n + 1][n + 1] factors */
  double *tau, *scratch; /* [n + 1] of QR */
  size_t *permutation;
  int signum; /* of the permutation */
  bool singular;
  unsigned long long jacobians;
} bordered;

/** Numbers that the arrays of bordered take, for bordered_place. */
size_t bordered_numbers(size_t unknowns);
/** Lays the arrays into a block. @returns what is behind them */
double *bordered_place(bordered *b, size_t unknowns, double *block);

/** Evaluates the problem at x [n + 1] = (u, p) and factorises.
 *  @returns RIC_ENUMERIC when the matrix is exactly singular, which sets `singular`; what the problem returns */
ric_status bordered_factor(bordered *b, const double *x, const double *row, ric_error *error);

/** Newton's correction z [n + 1], which does not leave the hyperplane of the row. */
void bordered_correction(bordered *b, double *z);

/** The null vector z [n + 1] of (J, F_p) with <row, z> = 1. */
void bordered_null_vector(bordered *b, double *z);

bordered_determinant bordered_det(const bordered *b);

#endif

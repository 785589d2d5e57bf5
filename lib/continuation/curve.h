/* Points of a curve, products of their vectors, and the workspace of a continuation. Internal to the library. */
#ifndef RICOCHET_CURVE_H
#define RICOCHET_CURVE_H

#include <stdbool.h>

#include <gsl/gsl_roots.h>

#include "ricochet/continuation.h"

/* The Jacobian of a curve, bordered by one row.
 *
 *   | J    F_p |
 *   | row_u  row_p |
 *
 * is regular at folds for a row along the tangent, and singular at branch points for every row. It is factorised by QR
 * with column pivoting if it is small, by LU if it is large. The determinant with the unit tangent as its row (in the
 * norm of continuation.h) depends only on the point and the direction; it follows from that with any other row. */

/** A determinant, sign * exp(log), and the distance of the matrix from a singular one. */
typedef struct bordered_determinant {
  int sign; /* 0: singular or unknown */
  double log;
  double least; /* diagonal entry of R or U in modulus: proportional to the distance from a branch point */
} bordered_determinant;

typedef struct bordered {
  const ric_curve_problem *problem; /* borrowed */
  ric_poll poll;
  size_t size;           /* n + 1 */
  double *residual;      /* [n + 1] F, and room for a right-hand side */
  double *J, *F_p;       /* [n][n], [n] from the problem */
  double *matrix;        /* [n + 1][n + 1] factors */
  double *tau, *scratch; /* [n + 1] of QR */
  size_t *permutation;
  int signum; /* of the permutation */
  bool singular;
  unsigned long long jacobians;
} bordered;

/** Size of the arrays of bordered, for bordered_place. */
size_t bordered_numbers(size_t unknowns);

/** Places the arrays in a block. @returns the end of them */
double *bordered_place(bordered *b, size_t unknowns, double *block);

/** Evaluates the problem at x [n + 1] = (u, p) and factorises.
 *  @returns RIC_ENUMERIC if the matrix is exactly singular, which sets `singular`; what the problem returns */
ric_status bordered_factor(bordered *b, const double *x, const double *row, ric_error *error);

bordered_determinant bordered_det(const bordered *b);

/* Workspace of a continuation.
 *
 * Points are x [n + 1] = (u, p). Within a step the curve is a graph over sigma = <row, x - x_from>: the
 * pseudo-arclength with row = (t_u / n, t_p) of the tangent at its beginning, or +-p with row = (0, +-1). */

/** A point of the curve. */
typedef struct curve_node {
  double *x, *t; /* [n + 1] point and unit tangent */
  double *tests; /* [tests] of the problem */
  bordered_determinant det;
  double sigma; /* in the current step */
  double arclength;
  int iterations;
  ric_curve_point_kind kind;
  size_t which;
} curve_node;

enum { CURVE_PAST = 2 }; /* previous points used by predictions */

struct ric_curve {
  ric_curve_problem problem;
  ric_curve_options options;
  bordered linear;
  double *row, *bound_row; /* [n + 1] of the step, and for a given p or the search of a branch point */
  double *z;               /* [n + 1] */
  curve_node start, from, to;
  curve_node past[CURVE_PAST]; /* before `from`, latest first */
  size_t pasts;                /* their number */
  curve_node trial, low, high; /* for locating */
  curve_node *found;           /* [tests + 2] special points of a step */
  gsl_root_fsolver *brent;
  unsigned long long iterations;
  double *block;
};

double curve_norm(const ric_curve *c, const double *a);

/** |a - b| */
double curve_distance(const ric_curve *c, const double *a, const double *b);

/** The plain product of a row and a vector. */
double curve_row_dot(const ric_curve *c, const double *row, const double *x);

/** Progress of x over the row of the step from `from`; uses z. */
double curve_progress(ric_curve *c, const double *x);

/** Row with <row, x> = <t, x> in the norm of the curve. */
void curve_tangent_row(const ric_curve *c, const double *t, double *row);

/** Row of natural steps, (0, sign). */
void curve_parameter_row(const ric_curve *c, double sign, double *row);

/** Copies the contents of a node. */
void curve_node_copy(const ric_curve *c, curve_node *to, const curve_node *from);

/** Values of the problem's test functions at a node; NaN is a value. */
ric_status curve_tests(ric_curve *c, curve_node *node, ric_error *error);

/** Locates the special points between the nodes `from` and `to` of the curve, a step over c->row, in order.
 *  @param count  set to their number; they are in c->found, their arclength from the start of the step
 *  @param missed  increased by the sign changes without a zero
 *  @returns what the problem returns, except RIC_ENUMERIC, which counts as a missed sign change */
ric_status locate_special(ric_curve *c, size_t *count, size_t *missed, ric_error *error);

#endif

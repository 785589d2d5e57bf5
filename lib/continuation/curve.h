/* What a continuation works with: internal to the room.
 *
 * Points are x [n + 1] = (u, p). Within a step the curve is a graph over sigma = <row, x - x_from>: the
 * pseudo-arclength with row = (t_u / n, t_p) of the tangent at its beginning, or +-p with row = (0, +-1). */
#ifndef RICOCHET_CURVE_H
#define RICOCHET_CURVE_H

#include <gsl/gsl_roots.h>

#include "bordered.h"

/** A point of the curve. */
typedef struct curve_node {
  double *x, *t; /* [n + 1] point and unit tangent */
  double *tests; /* [tests] of the problem */
  bordered_determinant det;
  double sigma; /* in the present step */
  double arclength;
  int iterations;
  ric_curve_point_kind kind;
  size_t which;
} curve_node;

enum { CURVE_PAST = 2 }; /* points before the present one that predictions use */

struct ric_curve {
  ric_curve_problem problem;
  ric_curve_options options;
  bordered linear;
  double *row, *bound_row; /* [n + 1] of the step, and where p is given or on the way to a branch point */
  double *z;               /* [n + 1] */
  curve_node start, from, to;
  curve_node past[CURVE_PAST]; /* before `from`, the last first */
  size_t pasts;                /* how many of them there are */
  curve_node trial, low, high; /* for locating */
  curve_node *found;           /* [tests + 2] special points of a step */
  gsl_root_fsolver *brent;
  unsigned long long iterations;
  double *block;
};

/** <a, b> = a_u . b_u / n + a_p b_p of vectors [n + 1]. */
double curve_dot(const ric_curve *c, const double *a, const double *b);
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

/** What the problem's test functions are at a node; NaN is a value. */
ric_status curve_tests(ric_curve *c, curve_node *node, ric_error *error);

#endif

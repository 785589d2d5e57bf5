/* The curve of a cycle along the parameter: points (x, p) that solve its equations. Internal to the room.
 *
 * x and p may span decades: lengths are measured by scales of the unknowns, which the caller renews from point to
 * point,
 *
 *   <a, b> = (1/N) sum_i a_i b_i / scale_i^2 + a_p b_p / scale_p^2. */
#ifndef RICOCHET_CYCLE_CURVE_H
#define RICOCHET_CYCLE_CURVE_H

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_vector.h>

#include "cycle_equations.h"

typedef struct cycle_curve {
  cycle_equations *equations;  /* borrowed */
  size_t size;                 /* N + 1: unknowns and parameter */
  double low, high;            /* the parameter is not asked for beyond them */
  double least_scale, least_y; /* scales of the parameter and the y are not below them: both may pass 0 */
  double difference;           /* step of differences in the parameter, over its scale */
  double *scale;               /* [size] of lengths */
  double *columns;             /* [size] of the linear equations */
  double *beside;              /* [size] residual beside the parameter */
  gsl_matrix *matrix;          /* [size][size] */
  gsl_vector *reflectors, *right;
} cycle_curve;

/** @param step  relative to p, to which differences in it are small
 *  @returns RIC_ENOMEM; always to be cleared */
ric_status cycle_curve_init(cycle_curve *c, cycle_equations *equations, double p, double step, ric_error *error);
void cycle_curve_clear(cycle_curve *c);

/** Scales from a point x [size], the map being that of its parameter. The first point is what others are compared
 *  with where they come to 0. */
void cycle_curve_measure(cycle_curve *c, const double *x);

/** <a, b> */
double cycle_curve_product(const cycle_curve *c, const double *a, const double *b);

/** Newton's method with row (x - x_0) = 0 as the last equation, x_0 where x [size] sets out.
 *  @param row  [size], NULL: p stays
 *  @param moved  set to the length of the way from there; may be NULL
 *  @returns RIC_ENUMERIC where it does not converge; what the line's `at` returns */
ric_status cycle_curve_correct(cycle_curve *c, double *x, const double *row, double *moved, ric_error *error);

/** The tangent of unit length at x [size] with row tangent > 0; the map is that of x then.
 *  @param row  [size], NULL: the parameter grows */
ric_status cycle_curve_tangent(cycle_curve *c, const double *x, const double *row, double *tangent, ric_error *error);

/** Row [size] of the linear form <direction, .> */
void cycle_curve_row(const cycle_curve *c, const double *direction, double *row);

#endif

/* Cycles with a fixed itinerary: their equations, and the curve of cycles along the parameter. Internal to the
 * library. */
#ifndef RICOCHET_CYCLE_EQUATIONS_H
#define RICOCHET_CYCLE_EQUATIONS_H

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_vector.h>

#include "ricochet/cycle_window.h"

/* The equations of a cycle with a fixed itinerary.
 *
 * With y = sqrt(d - eta z) of each impact among the unknowns, all iterates are polynomials,
 *
 *   z -> L z,    or    z -> L z + y s xi + y^2 kappa and y^2 + eta z - d = 0,
 *
 * smooth through the border, which an impact reaches at y = 0 and another iterate at eta z = d: the equations have
 * solutions on both sides. The cycle is cut into pieces, so short that L to the power of their length is not large;
 * unknowns x: the states at the beginnings of the pieces, then the y. The derivative of the n-th iterate follows as
 * L - ((s / 2y) xi + kappa) eta of each impact. */

typedef struct cycle_equations {
  const ric_map_line *line; /* borrowed */
  ric_grazing_map map;      /* at the parameter set last */
  double d, parameter;
  size_t period, impacts, unknowns;
  bool *hits;     /* [period] the itinerary */
  size_t *starts; /* [pieces + 1] first iterate of each piece, then the period */
  size_t pieces;
  double *z, *next;             /* [size] */
  double *slopes, *next_slopes; /* [size][unknowns] of z by the unknowns; [size][size] by the state */
  ric_multipliers multipliers;
} cycle_equations;

/** Sets the itinerary by iterating the state z [size] at the parameter p.
 *  @returns RIC_EINVAL for the period, the line and z; RIC_ELIMIT for too many unknowns; RIC_ENOMEM; always to be
 *  cleared */
ric_status cycle_equations_init(cycle_equations *e, const ric_map_line *line, double p, size_t period, const double *z,
                                ric_error *error);
void cycle_equations_clear(cycle_equations *e);

/** Sets the map of a parameter. @returns the status of the line's `at`; as ric_grazing_map_check */
ric_status cycle_equations_set(cycle_equations *e, double p, ric_error *error);

/** Sets x [unknowns] by iterating z [size], the state of the itinerary, at the parameter set last. */
void cycle_equations_guess(cycle_equations *e, const double *z, double *x);

/** F [unknowns] at x and the parameter set last, and its Jacobian J [unknowns][stride] by x, which may be NULL.
 *  @param clearance  [period] of each iterate the number that is positive while the itinerary is valid: y, or eta z
 *  - d; may be NULL */
void cycle_equations_at(cycle_equations *e, const double *x, double *F, double *J, size_t stride, double *clearance);

/** Multipliers at a solution, into `multipliers`.
 *  @returns RIC_ENUMERIC where the derivative overflows, as at y = 0 */
ric_status cycle_equations_spectrum(cycle_equations *e, const double *x, ric_error *error);

/** The least period of the cycle at a solution: `period`, or a divisor of it. */
size_t cycle_equations_least_period(cycle_equations *e, const double *x);

/* The curve of a cycle along the parameter: points (x, p) that solve its equations.
 *
 * x and p may range over decades: lengths are measured by scales of the unknowns, which the caller updates from
 * point to point,
 *
 *   <a, b> = (1/N) sum_i a_i b_i / scale_i^2 + a_p b_p / scale_p^2. */

typedef struct cycle_curve {
  cycle_equations *equations;  /* borrowed */
  size_t size;                 /* N + 1: unknowns and parameter */
  double low, high;            /* bounds of the parameter for evaluations */
  double least_scale, least_y; /* lower bounds of the scales of the parameter and the y, both of which may pass 0 */
  double difference;           /* step of differences in the parameter, over its scale */
  double *scale;               /* [size] of lengths */
  double *columns;             /* [size] of the linear equations */
  double *beside;              /* [size] residual at a shifted parameter */
  gsl_matrix *matrix;          /* [size][size] */
  gsl_vector *reflectors, *right;
} cycle_curve;

/** @param step  a length in p relative to which differences in p are small
 *  @returns RIC_ENOMEM; always to be cleared */
ric_status cycle_curve_init(cycle_curve *c, cycle_equations *equations, double p, double step, ric_error *error);
void cycle_curve_clear(cycle_curve *c);

/** Sets the scales at a point x [size]; the map must be that of its parameter. The first point gives the sizes to
 *  which numbers are compared when they pass 0. */
void cycle_curve_measure(cycle_curve *c, const double *x);

/** <a, b> */
double cycle_curve_product(const cycle_curve *c, const double *a, const double *b);

/** Newton's method with row (x - x_0) = 0 as the last equation, x_0 the initial x [size].
 *  @param row  [size], NULL: p is constant
 *  @param moved  set to the distance from x_0; may be NULL
 *  @returns RIC_ENUMERIC where it does not converge; the status of the line's `at` */
ric_status cycle_curve_correct(cycle_curve *c, double *x, const double *row, double *moved, ric_error *error);

/** The tangent of unit length at x [size] with row tangent > 0; the map must be that of x.
 *  @param row  [size], NULL: the parameter grows */
ric_status cycle_curve_tangent(cycle_curve *c, const double *x, const double *row, double *tangent, ric_error *error);

/** Row [size] of the linear form <direction, .> */
void cycle_curve_row(const cycle_curve *c, const double *direction, double *row);

#endif

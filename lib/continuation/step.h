/* One step along the curve: prediction, correction, and the cubic through two points. Internal to the library. */
#ifndef RICOCHET_STEP_H
#define RICOCHET_STEP_H

#include "curve.h"

/* The cubic through two points of a curve along their tangents.
 *
 * A graph over sigma = <row, x>, so that x' = t / <row, t>. With the distance L of the points its error is at most L^4
 * / 384 times the fourth derivative. */

typedef struct cubic {
  const ric_curve *c;
  const double *row;
  const curve_node *a, *b; /* a->sigma < b->sigma */
} cubic;

/** @param x  [n + 1] set to the point at sigma */
void cubic_point(const cubic *q, double sigma, double *x);

/** @param t  [n + 1] set to the unit tangent there */
void cubic_tangent(const cubic *q, double sigma, double *t);

/** Its length, by Simpson's rule. */
double cubic_length(const cubic *q);

/* Prediction from the last points of the run. */

/** Makes `to` the start of the next step. @param keep  whether predictions may use the tangent of `from` */
void predictor_advance(ric_curve *c, bool keep);

/* One step along the curve. */

/** Sets c->row for steps that begin at `from`. */
void step_set_row(ric_curve *c);

/** A step of the length h from `from` to `to`, corrected, with tangent and tests; to the bound of p if it would leave
 *  the range.
 *  @param landed  set to whether `to` lies on a bound
 *  @returns RIC_ENUMERIC with the reason if the step has to be shorter */
ric_status step_try(ric_curve *c, double h, bool *landed, ric_error *error);

/** Moves `to` back to the start of the curve if the step passes it in the same direction.
 *  @param closed  set to whether it did */
ric_status step_close(ric_curve *c, bool *closed, ric_error *error);

/** Angle by which the tangent has turned from `from` to `to`. */
double step_turn(const ric_curve *c);

#endif

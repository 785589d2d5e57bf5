/* The cubic through two points of a curve along their tangents: internal to the room.
 *
 * A graph over sigma = <row, x>, so that x' = t / <row, t>. With the points L apart it leaves the curve by at most
 * L^4 / 384 times the fourth derivative. */
#ifndef RICOCHET_CUBIC_H
#define RICOCHET_CUBIC_H

#include "curve.h"

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
/** How far the chord is from the mean of the end tangents: (turn)^2 / 12 of it on a circle, more when the ends lie on
 *  different curves. */
double cubic_mismatch(const cubic *q);

#endif

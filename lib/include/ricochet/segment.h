/* A segment of a motion: one polynomial per coordinate on a time interval.
 *
 * Every flow hands out segments; contacts, minima and states are computed from segments only. With x = (t - start) /
 * length in [0, 1], coordinate i of the segment is q_i(t) = sum_j coef[j * stride + i] x^j. A segment may cover a
 * part of a long chain: `first` is the particle of its coordinate 0. A negative length means integration backwards in
 * time. Speeds that are not derivatives of coordinates have polynomials of their own, after those of the coordinates.
 */
#ifndef RICOCHET_SEGMENT_H
#define RICOCHET_SEGMENT_H

#include <stddef.h>

#include "polynomial.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_segment {
  size_t first;       /* particle of coordinate 0 */
  size_t coordinates; /* number of coordinates */
  size_t speeds;      /* number of speeds with polynomials of their own; 0: speeds are derivatives of coordinates */
  size_t stride;      /* >= coordinates + speeds */
  int degree;         /* <= RIC_POLY_DEGREE */
  double start;       /* time at x = 0 */
  double length;      /* time from x = 0 to x = 1, not 0 */
  const double *coef; /* [degree + 1][stride]. Borrowed from the flow, valid until its next step */
} ric_segment;

/** Coordinates q [coordinates] and speeds at x in [0, 1]; v is [speeds], or [coordinates] if speeds are derivatives of
 *  coordinates; it may be NULL. */
RIC_API void ric_segment_state(const ric_segment *segment, double x, double *q, double *v);

/** Gap of a coordinate over a floor, q_i - b, as a polynomial c [degree + 1]. */
RIC_API void ric_segment_gap(const ric_segment *segment, size_t coordinate, double floor, double *c);

/** Bounds [coordinates] of every coordinate over the segment, from the coefficients; cheap. `upper` may be NULL. */
RIC_API void ric_segment_bounds(const ric_segment *segment, double *lower, double *upper);

RIC_END_DECLARATIONS

#endif

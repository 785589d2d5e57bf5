#include "ricochet/segment.h"

#include <math.h>

#include "numeric/simd.h"

enum { LANES = 8 }; /* columns whose sums stay in registers */

/* Value and derivative in x of `lanes` columns, from the highest coefficient down. */
RIC_INLINE void horner(const double *top, size_t stride, int degree, double x, double *value, double *slope,
                       size_t lanes) {
  double p[LANES], d[LANES] = {0};
  for (size_t i = 0; i < lanes; i++)
    p[i] = top[i];
  for (int j = degree - 1; j >= 0; j--) {
    top -= stride;
    for (size_t i = 0; i < lanes; i++)
      d[i] = d[i] * x + p[i];
    for (size_t i = 0; i < lanes; i++)
      p[i] = p[i] * x + top[i];
  }
  for (size_t i = 0; i < lanes; i++)
    value[i] = p[i];
  for (size_t i = 0; slope && i < lanes; i++)
    slope[i] = d[i];
}

/* The same at the end, x = 1, where most steps are accepted: sums, in the same order. */
RIC_INLINE void horner_at_end(const double *top, size_t stride, int degree, double *value, double *slope) {
  double p = *top, d = 0;
  for (int j = degree - 1; j >= 0; j--) {
    top -= stride;
    d += p;
    p += *top;
  }
  *value = p;
  if (slope)
    *slope = d;
}

/* Values and derivatives in x of the columns [first, first + count); `slope` may be NULL. */
RIC_VECTORISED static void evaluate(const ric_segment *segment, size_t first, size_t count, double x, double *value,
                                    double *slope) {
  const double *top = segment->coef + (size_t)segment->degree * segment->stride + first;
  size_t i = 0;
  for (; i + LANES <= count; i += LANES)
    horner(top + i, segment->stride, segment->degree, x, value + i, slope ? slope + i : NULL, LANES);
  if (i < count && count >= LANES) { /* some columns are computed twice */
    i = count - LANES;
    horner(top + i, segment->stride, segment->degree, x, value + i, slope ? slope + i : NULL, LANES);
  } else if (x == 1)
    for (; i < count; i++)
      horner_at_end(top + i, segment->stride, segment->degree, value + i, slope ? slope + i : NULL);
  else
    for (; i < count; i++)
      horner(top + i, segment->stride, segment->degree, x, value + i, slope ? slope + i : NULL, 1);
}

void ric_segment_state(const ric_segment *segment, double x, double *q, double *v) {
  size_t count = segment->coordinates;
  if (segment->speeds > 0) {
    evaluate(segment, 0, count, x, q, NULL);
    if (v)
      evaluate(segment, count, segment->speeds, x, v, NULL);
    return;
  }
  evaluate(segment, 0, count, x, q, v);
  for (size_t i = 0; v && i < count; i++)
    v[i] /= segment->length;
}

void ric_segment_gap(const ric_segment *segment, size_t coordinate, double floor, double *c) {
  for (int j = 0; j <= segment->degree; j++)
    c[j] = segment->coef[(size_t)j * segment->stride + coordinate];
  c[0] -= floor;
}

void ric_segment_bounds(const ric_segment *segment, double *lower, double *upper) {
  for (size_t i = 0; i < segment->coordinates; i++) {
    lower[i] = segment->coef[i];
    if (upper)
      upper[i] = segment->coef[i];
  }
  for (int j = 1; j <= segment->degree; j++) {
    const double *c = segment->coef + (size_t)j * segment->stride;
    for (size_t i = 0; i < segment->coordinates; i++)
      lower[i] += c[i] < 0 ? c[i] : 0;
    for (size_t i = 0; upper && i < segment->coordinates; i++)
      upper[i] += c[i] > 0 ? c[i] : 0;
  }
}

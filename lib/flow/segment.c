#include "ricochet/segment.h"

#include <math.h>

void ric_segment_state(const ric_segment *segment, double x, double *q, double *v) {
  size_t count = segment->coordinates;
  const double *top = segment->coef + (size_t)segment->degree * segment->stride;
  for (size_t i = 0; i < count; i++)
    q[i] = top[i];
  for (size_t i = 0; v && i < count; i++)
    v[i] = 0;
  for (int j = segment->degree - 1; j >= 0; j--) {
    const double *c = segment->coef + (size_t)j * segment->stride;
    for (size_t i = 0; v && i < count; i++)
      v[i] = v[i] * x + q[i];
    for (size_t i = 0; i < count; i++)
      q[i] = q[i] * x + c[i];
  }
  for (size_t i = 0; v && i < count; i++)
    v[i] /= segment->length;
}

void ric_segment_gap(const ric_segment *segment, size_t coordinate, double floor, double *c) {
  for (int j = 0; j <= segment->degree; j++)
    c[j] = segment->coef[(size_t)j * segment->stride + coordinate];
  c[0] -= floor;
}

void ric_segment_lower_bounds(const ric_segment *segment, double *lower) {
  for (size_t i = 0; i < segment->coordinates; i++)
    lower[i] = segment->coef[i];
  for (int j = 1; j <= segment->degree; j++) {
    const double *c = segment->coef + (size_t)j * segment->stride;
    for (size_t i = 0; i < segment->coordinates; i++)
      lower[i] += c[i] < 0 ? c[i] : 0;
  }
}

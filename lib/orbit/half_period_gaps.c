#include "half_period_gaps.h"

#include <math.h>
#include <stdint.h>

#include "ricochet/polynomial.h"

/* Longest segment, in angles of the fastest mode: its truncation error is 2.2^25 / 25! = 2e-17 of the amplitude. */
static const double longest_angle = 2.2;

typedef struct half_period {
  size_t segments;
  double length;
} half_period;

static half_period cut(ric_impact_modes *m, double period) {
  double segments = ceil(period / 2 * m->fastest / longest_angle);
  half_period h = {.segments = (size_t)segments, .length = period / 2 / segments};
  for (size_t j = 0; j < m->n; j++) {
    double angle = m->frequency[j] * h.length, power = 1;
    for (size_t d = 0; d <= MODES_ORDER; d++) {
      m->series[d * m->n + j] = d / 2 % 2 ? -power : power;
      power *= angle / (double)(d + 1);
    }
  }
  return h;
}

static void begin_segment(ric_impact_modes *m, double period, double start) {
  for (size_t j = 0; j < m->n; j++) {
    double phase = m->frequency[j] * (period / 2 - start);
    m->cosine[j] = cos(phase);
    m->sine[j] = sin(phase);
  }
}

/* cos(phase - angle x) = cos(phase) cos(angle x) + sin(phase) sin(angle x), mode by mode. */
static void expand(const ric_impact_modes *m, const ric_obstacle *o, double *c) {
  size_t n = m->n;
  for (size_t j = 0; j < n; j++) {
    double amplitude = m->amplitude[j] * m->shape[j * n + o->coordinate];
    m->even[j] = amplitude * m->cosine[j];
    m->odd[j] = amplitude * m->sine[j];
  }
  for (size_t d = 0; d <= MODES_ORDER; d++) {
    const double *part = d % 2 ? m->odd : m->even, *series = m->series + d * n;
    double sum = 0;
    for (size_t j = 0; j < n; j++)
      sum += part[j] * series[j];
    c[d] = o->side * sum;
  }
  c[0] -= o->side * o->position;
}

/* Gap of an obstacle as a polynomial; returns its degree. */
static int gap_of(const ric_impact_modes *m, size_t obstacle, size_t segment, double *c) {
  expand(m, &m->obstacles[obstacle], c);
  if (obstacle != m->obstacle || segment > 0)
    return MODES_ORDER;
  for (int d = 0; d < MODES_ORDER; d++)
    c[d] = c[d + 1];
  return MODES_ORDER - 1;
}

/* A bound from below for the whole motion. */
static double bound(const ric_impact_modes *m, size_t obstacle) {
  const ric_obstacle *o = &m->obstacles[obstacle];
  return -o->side * o->position - m->reach[o->coordinate];
}

void half_period_smallest(ric_impact_modes *modes, const periodic_response *response, double tolerance, least_gap *free,
                          least_gap *own) {
  half_period h = cut(modes, response->period);
  *free = *own = (least_gap){.value = INFINITY, .time = NAN, .obstacle = SIZE_MAX};
  for (size_t s = 0; s < h.segments; s++) {
    double start = (double)s * h.length, c[RIC_POLY_DEGREE + 1], x, value;
    begin_segment(modes, response->period, start);
    for (size_t j = 0; j < modes->obstacle_count; j++) {
      least_gap *best = j == modes->obstacle ? own : free;
      if (bound(modes, j) >= best->value)
        continue;
      int degree = gap_of(modes, j, s, c);
      if (ric_poly_minimum(c, degree, best->value - tolerance / 2, tolerance / 2, &x, &value))
        *best = (least_gap){.value = value, .time = start + x * h.length, .obstacle = j};
    }
  }
}

bool half_period_violation(ric_impact_modes *modes, const periodic_response *response, double zero, least_gap *first) {
  half_period h = cut(modes, response->period);
  *first = (least_gap){.value = -zero, .time = INFINITY, .obstacle = SIZE_MAX};
  for (size_t s = 0; s < h.segments && first->obstacle == SIZE_MAX; s++) {
    double start = (double)s * h.length, c[RIC_POLY_DEGREE + 1], x;
    begin_segment(modes, response->period, start);
    for (size_t j = 0; j < modes->obstacle_count; j++) {
      if (bound(modes, j) > -zero)
        continue;
      int degree = gap_of(modes, j, s, c);
      c[0] += zero;
      if (ric_poly_first_root(c, degree, &x) && start + x * h.length < first->time)
        *first = (least_gap){.value = -zero, .time = start + x * h.length, .obstacle = j};
    }
  }
  return first->obstacle != SIZE_MAX;
}

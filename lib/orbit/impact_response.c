/* The motion between the impacts of a linear system with one impact per period: modes, gaps, verdict. */
#include "impact_response.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "numeric/constants.h"
#include "numeric/largest.h"
#include "ricochet/polynomial.h"

/* Term of S; infinite at a resonance. */
static double term(const ric_impact_modes *m, size_t j, double period) {
  double half = m->frequency[j] * period / 2;
  return m->seen[j] == 0 ? 0 : m->seen[j] * m->seen[j] * cos(half) / (2 * m->frequency[j] * sin(half));
}

double response_balance(const ric_impact_modes *modes, double period) {
  double sum = 0, size = 0;
  for (size_t j = 0; j < modes->n; j++) {
    double value = term(modes, j, period);
    sum += value;
    size += fabs(value);
  }
  return sum / size;
}

/* l where w_j T = 2 pi l, otherwise 0. */
static double harmonic_of(const ric_impact_modes *m, size_t j, double period, double tolerance) {
  double turns = m->frequency[j] * period / (2 * pi), l = round(turns);
  bool is = fabs(turns - l) <= tolerance || sin(m->frequency[j] * period / 2) == 0;
  return is ? l : 0;
}

static void find_resonance(const ric_impact_modes *m, double tolerance, periodic_response *r) {
  for (size_t j = 0; j < m->n; j++) {
    double l = harmonic_of(m, j, r->period, tolerance);
    bool moves = m->seen[j] != 0;
    if (l < 1 || (r->carried && !moves))
      continue;
    r->carried = moves;
    r->free = !moves;
    r->mode = j;
    r->harmonic = (unsigned)l;
  }
}

/* The limit: modes at resonance share the way to the obstacle as phi_j(k)^2 / w_j^2, the ratio of the poles of S. */
static void set_carried(ric_impact_modes *m, double tolerance, const periodic_response *r) {
  double reached = 0, position = m->obstacles[m->obstacle].position;
  for (size_t j = 0; j < m->n; j++) {
    bool is = m->seen[j] != 0 && harmonic_of(m, j, r->period, tolerance) >= 1;
    double share = is ? m->seen[j] / (m->frequency[j] * m->frequency[j]) : 0;
    reached += share * m->seen[j];
    m->amplitude[j] = share;
  }
  for (size_t j = 0; j < m->n; j++)
    m->amplitude[j] *= position / reached * copysign(1, cos(m->frequency[j] * r->period / 2));
}

static void set_driven(ric_impact_modes *m, periodic_response *r) {
  double sum = 0;
  for (size_t j = 0; j < m->n; j++)
    sum += term(m, j, r->period);
  r->impulse = m->obstacles[m->obstacle].position / sum;
  for (size_t j = 0; j < m->n; j++)
    m->amplitude[j] =
        m->seen[j] == 0 ? 0 : r->impulse * m->seen[j] / (2 * m->frequency[j] * sin(m->frequency[j] * r->period / 2));
}

void response_find(ric_impact_modes *modes, double period, double resonance_tol, periodic_response *response) {
  size_t n = modes->n;
  double most = 0;
  *response = (periodic_response){.period = period};
  find_resonance(modes, resonance_tol, response);
  if (response->carried)
    set_carried(modes, resonance_tol, response);
  else
    set_driven(modes, response);
  memset(modes->reach, 0, n * sizeof *modes->reach);
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; modes->amplitude[j] != 0 && i < n; i++)
      modes->reach[i] += fabs(modes->amplitude[j] * modes->shape[j * n + i]);
  for (size_t i = 0; i < n; i++)
    most = modes->reach[i] <= most ? most : modes->reach[i]; /* keeps a NaN */
  response->condition = most / fabs(modes->obstacles[modes->obstacle].position);
}

void response_state(const ric_impact_modes *modes, const periodic_response *response, double t, double *q, double *v) {
  size_t n = modes->n;
  memset(q, 0, n * sizeof *q);
  if (v)
    memset(v, 0, n * sizeof *v);
  for (size_t j = 0; j < n; j++) {
    double phase = modes->frequency[j] * (response->period / 2 - t);
    double along = modes->amplitude[j] * cos(phase), rate = modes->amplitude[j] * modes->frequency[j] * sin(phase);
    for (size_t i = 0; modes->amplitude[j] != 0 && i < n; i++) {
      q[i] += along * modes->shape[j * n + i];
      if (v)
        v[i] += rate * modes->shape[j * n + i];
    }
  }
}

double response_gap_rate(const ric_impact_modes *modes, const periodic_response *response) {
  return modes->obstacles[modes->obstacle].side * response->impulse * modes->mobility[modes->hit] / 2;
}

double response_energy(const ric_impact_modes *modes) {
  double twice = 0;
  for (size_t j = 0; j < modes->n; j++) {
    double rate = modes->amplitude[j] * modes->frequency[j];
    twice += rate * rate;
  }
  return twice / 2;
}

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

/** The smallest gap of the obstacles that are not hit, and that of the one that is, divided as said above.
 *  @param tolerance  absolute, on the values */
static void half_period_smallest(ric_impact_modes *modes, const periodic_response *response, double tolerance,
                                 least_gap *free, least_gap *own) {
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

/** The first gap below -zero. @returns whether there is one. */
static bool half_period_violation(ric_impact_modes *modes, const periodic_response *response, double zero,
                                  least_gap *first) {
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

/* On minima, relative: rounding of the polynomials. */
static const double minimum_tol = 1e-14;

/* As orbit.h says: displacements at 0 and T/2, and speeds over the largest frequency for what lies between. */
static double largest_displacement(ric_impact_modes *m, const periodic_response *r) {
  response_state(m, r, r->period / 2, m->q, NULL);
  double at_half = largest(m->q, m->n);
  response_state(m, r, 0, m->q, m->v);
  return fmax(fmax(at_half, largest(m->q, m->n)), largest(m->v, m->n) / m->fastest);
}

static void find_gaps(ric_impact_modes *m, const periodic_response *r, impact_verdict *verdict) {
  verdict->scale = largest_displacement(m, r);
  half_period_smallest(m, r, minimum_tol * verdict->scale, &verdict->free, &verdict->own);
}

static const least_gap *smaller(const impact_verdict *v) {
  return v->free.value <= v->own.value ? &v->free : &v->own;
}

double impact_verdict_margin(ric_impact_modes *modes, double period, periodic_response *response,
                             impact_verdict *verdict) {
  response_find(modes, period, 0, response);
  find_gaps(modes, response, verdict);
  return smaller(verdict)->value / verdict->scale;
}

void impact_verdict_touch(const impact_verdict *verdict, char *text, size_t bytes) {
  const least_gap *touch = smaller(verdict);
  snprintf(text, bytes, "obstacle %zu is touched at t = %.6g, gap %.2g", touch->obstacle, touch->time, touch->value);
}

/* What is violated first in [0, T/2]. */
static void explain_violation(ric_impact_modes *m, const periodic_response *r, double zero, impact_verdict *v) {
  least_gap first;
  if (response_gap_rate(m, r) < -zero * m->fastest)
    snprintf(v->reason, sizeof v->reason, "the impulse of obstacle %zu at t = 0 is %.6g, must be positive", m->obstacle,
             m->obstacles[m->obstacle].side * r->impulse);
  else if (half_period_violation(m, r, zero, &first))
    snprintf(v->reason, sizeof v->reason, "obstacle %zu is passed at t = %.6g; the smallest gap is %.3g",
             first.obstacle, first.time, smaller(v)->value);
}

/* A linear mode, or one orbit of many, need not be admissible: says so. */
static void judge_special(const ric_impact_modes *m, const periodic_response *r, double zero, impact_verdict *v) {
  const least_gap *least = smaller(v);
  v->outcome = r->carried ? RIC_GRAZING : RIC_RESONANT;
  int used = snprintf(v->reason, sizeof v->reason, "mode %zu is at resonance (harmonic %u)%s", r->mode, r->harmonic,
                      r->carried ? ": the impulse vanishes, the orbit is a linear mode"
                                 : " and vanishes at the contact: its amplitude is free");
  if (least->value < -zero)
    snprintf(v->reason + used, sizeof v->reason - (size_t)used, "; inadmissible, gap %.3g of obstacle %zu",
             least->value, least->obstacle);
  else if (response_gap_rate(m, r) < -zero * m->fastest)
    snprintf(v->reason + used, sizeof v->reason - (size_t)used, "; inadmissible, the impulse pulls");
}

static void give_verdict(ric_impact_modes *m, const periodic_response *r, impact_verdict *v) {
  double zero = m->options.grazing_tol * v->scale, rate = response_gap_rate(m, r);
  double left = fabs(m->q[m->hit] - m->obstacles[m->obstacle].position);
  v->reason[0] = '\0';
  if (!(left <= m->options.residual_tol * v->scale)) {
    v->outcome = RIC_FAILED; /* impulses of the shortest periods underflow */
    snprintf(v->reason, sizeof v->reason, "the impulse %.2g keeps coordinate %zu away from obstacle %zu, by %.2g",
             r->impulse, m->hit, m->obstacle, left);
  } else if (r->carried || r->free) {
    judge_special(m, r, zero, v);
  } else if (smaller(v)->value < -zero || rate < -zero * m->fastest) {
    v->outcome = RIC_INADMISSIBLE;
    explain_violation(m, r, zero, v);
  } else if (rate <= zero * m->fastest) {
    v->outcome = RIC_GRAZING;
    snprintf(v->reason, sizeof v->reason, "obstacle %zu is hit with the gap rate %.2g", m->obstacle, -rate);
  } else if (smaller(v)->value <= zero) {
    v->outcome = RIC_GRAZING;
    impact_verdict_touch(v, v->reason, sizeof v->reason);
  } else {
    v->outcome = RIC_ADMISSIBLE;
  }
}

void impact_verdict_find(ric_impact_modes *modes, double period, periodic_response *response, impact_verdict *verdict) {
  response_find(modes, period, modes->options.resonance_tol, response);
  if (response->condition < modes->options.singular_condition) {
    find_gaps(modes, response, verdict);
    give_verdict(modes, response, verdict);
    return;
  }
  verdict->outcome = RIC_SINGULAR;
  snprintf(verdict->reason, sizeof verdict->reason,
           "an impulse does not move coordinate %zu at its contact: amplitudes blow up (condition %.3g)", modes->hit,
           response->condition);
}

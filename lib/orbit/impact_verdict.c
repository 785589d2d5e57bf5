#include "impact_verdict.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "numeric/largest.h"

/* On minima, relative: rounding of the polynomials. */
static const double minimum_tol = 1e-14;

/* As orbit.h says: displacements at 0 and T/2, and speeds over the largest frequency for what lies between. */
static double largest_displacement(ric_impact_modes *m, const periodic_response *r) {
  response_state(m, r, r->period / 2, m->q, NULL);
  double at_half = largest(m->q, m->n);
  response_state(m, r, 0, m->q, m->v);
  return fmax(fmax(at_half, largest(m->q, m->n)), largest(m->v, m->n) / m->fastest);
}

static void look(ric_impact_modes *m, const periodic_response *r, impact_verdict *verdict) {
  verdict->scale = largest_displacement(m, r);
  half_period_smallest(m, r, minimum_tol * verdict->scale, &verdict->free, &verdict->own);
}

static const least_gap *smaller(const impact_verdict *v) {
  return v->free.value <= v->own.value ? &v->free : &v->own;
}

double impact_verdict_margin(ric_impact_modes *modes, double period, periodic_response *response,
                             impact_verdict *verdict) {
  response_find(modes, period, 0, response);
  look(modes, response, verdict);
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

static void judge(ric_impact_modes *m, const periodic_response *r, impact_verdict *v) {
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
    look(modes, response, verdict);
    judge(modes, response, verdict);
    return;
  }
  verdict->outcome = RIC_SINGULAR;
  snprintf(verdict->reason, sizeof verdict->reason,
           "an impulse does not move coordinate %zu at its contact: amplitudes blow up (condition %.3g)", modes->hit,
           response->condition);
}

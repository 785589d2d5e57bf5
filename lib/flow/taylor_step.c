#include "taylor_step.h"

#include <float.h>
#include <math.h>

enum { LEAST_ORDER = 4, MOST_ORDER = 30, MOST_ROUNDS = 30 };

/* A prescribed length is exceeded by so much rather than leaving a step of rounding errors. */
static const double length_slack = 1e-6;

int taylor_order(double tolerance) {
  double order = round(-0.65 * log(tolerance)); /* 24 at 1e-16; tests measure what it brings */
  return order < LEAST_ORDER ? LEAST_ORDER : order > MOST_ORDER ? MOST_ORDER : (int)order;
}

static double size_at(const taylor_decay *d, double theta) {
  double moved = fmax(theta * d->rate, theta * theta * d->bend);
  return fmax(moved, fmax(d->position, d->forcing) * fmin(theta * d->fraction, 1));
}

static double fit(double allowed, double norm, int power) {
  return norm > 0 ? pow(allowed / norm, 1.0 / power) : INFINITY;
}

double taylor_step_factor(const taylor_decay *d, int order, double tolerance, double most) {
  double theta = fmin(1, most);
  for (int round = 0; round < MOST_ROUNDS; round++) { /* contracts by 1 / (order - 1) a round */
    double allowed = tolerance * size_at(d, theta);
    double next = fmin(fit(allowed, d->before_last, order - 1), fit(allowed, d->last, order));
    next = fmin(next, most);
    if (fabs(next - theta) <= 0.001 * theta)
      return next;
    theta = next;
  }
  return theta;
}

double taylor_step_length(double remaining, double longest, bool fixed) {
  double room = fabs(remaining);
  if (room <= longest * (fixed ? 1 + length_slack : 1))
    return remaining;
  if (!fixed && room < 2 * longest)
    return remaining / 2;
  return copysign(longest, remaining);
}

bool taylor_step_vanishes(double time, double length) {
  return !(fabs(length) > 4 * DBL_EPSILON * fabs(time) && fabs(length) >= DBL_MIN);
}

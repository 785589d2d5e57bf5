#include "taylor_step.h"

#include <float.h>
#include <math.h>

#include "numeric/vectorised.h"

enum { LEAST_ORDER = 4, MOST_ORDER = 30, FIRST_COEFFICIENTS = 4 };

/* Series of a motion of frequency w cancel in rounding like exp(w h); beyond 2.2 that costs a digit. */
static const double longest_reach = 2.2;

/* Of the tolerance, what the first term left out of a linear motion may be: truncation has a sign and adds up over 1e6
 * steps. */
static const double share = 0.01;

/* What the first term left out of linear tangent vectors may be, at least. */
static const double carried_error = 1e-14;

/* Of the tolerance, what the last terms may be where they are measured. */
static const double measured_share = 0.1;

/* Steps stay inside the circle in which a branch point does not lie. */
static const double inside = 0.9;

static const double most_growth = 1000;

/* A prescribed length is exceeded by so much rather than leaving a step of rounding errors. */
static const double length_slack = 1e-6;

/* Steps below that part of the time, or of its unit, are so few ulps long that their lengths mean nothing. */
static const double resolution = 1e-12;

/* Series whose first coefficients are larger may overflow where they are evaluated. */
static const double most_size = DBL_MAX * 1e-6;

int taylor_order(double tolerance) {
  int order = LEAST_ORDER;
  double term = pow(longest_reach, 5) / 120; /* of order + 1 */
  while (order < MOST_ORDER && term > share * tolerance) {
    order++;
    term *= longest_reach / (order + 1);
  }
  return order;
}

double taylor_reach(double tolerance, int order) {
  double reach = exp((log(share * tolerance) + lgamma(order + 2.0)) / (order + 1));
  return fmin(reach, longest_reach);
}

double taylor_carried_reach(double tolerance, int order) {
  return exp((log(fmax(carried_error, tolerance)) + lgamma(order + 2.0)) / (order + 1));
}

double taylor_rate_bound(double stiffness, double damping) {
  return damping / 2 + sqrt(damping * damping / 4 + stiffness); /* |s|^2 <= |C| |s| + |K| */
}

double taylor_passive_rate_bound(double stiffness, double softest, double damping) {
  double creeping = damping * damping / 4 - fmax(softest, 0);
  return fmax(sqrt(stiffness), creeping >= 0 ? damping / 2 + sqrt(creeping) : 0);
}

RIC_VECTORISED static double largest(const double *x, size_t count) {
  enum { LANES = 8 };
  double most[LANES] = {0}, finite[LANES] = {0}, found = 0, sum = 0;
  size_t i = 0;
  for (; i + LANES <= count; i += LANES)
    for (size_t lane = 0; lane < LANES; lane++) {
      double a = fabs(x[i + lane]);
      most[lane] = a > most[lane] ? a : most[lane];
      finite[lane] += 0 * a;
    }
  for (; i < count; i++) {
    found = fabs(x[i]) > found ? fabs(x[i]) : found;
    sum += 0 * x[i];
  }
  for (size_t lane = 0; lane < LANES; lane++) {
    found = most[lane] > found ? most[lane] : found;
    sum += finite[lane];
  }
  return found + sum;
}

/* The variants' own names would be exported if they were not static. */
double taylor_largest(const double *x, size_t count) {
  return largest(x, count);
}

taylor_decay taylor_decay_of(const double *coef, size_t stride, size_t count, int order) {
  taylor_decay d = {.nearest_zero = INFINITY};
  for (int k = 0; k < 2; k++)
    d.tail[k] = largest(coef + (size_t)(order - 1 + k) * stride, count);
  for (size_t j = 1; j < FIRST_COEFFICIENTS || (j == FIRST_COEFFICIENTS && d.change == 0); j++) {
    double size = largest(coef + j * stride, count);
    d.change = size > d.change || isnan(size) ? size : d.change;
  }
  if (!(d.change + d.tail[0] + d.tail[1] < most_size))
    d.change = NAN;
  return d;
}

taylor_decay taylor_decay_join(taylor_decay a, taylor_decay b) {
  bool useless = isnan(a.change) || isnan(b.change);
  return (taylor_decay){.change = useless ? NAN : fmax(a.change, b.change),
                        .tail = {fmax(a.tail[0], b.tail[0]), fmax(a.tail[1], b.tail[1])},
                        .nearest_zero = fmin(a.nearest_zero, b.nearest_zero)};
}

/* What changes grows at least with the length, hence one power less. */
double taylor_step_factor(const taylor_decay *d, int order, double tolerance) {
  double allowed = measured_share * tolerance * d->change, factor = most_growth;
  for (int k = 0; k < 2; k++)
    if (d->tail[k] > 0)
      factor = fmin(factor, pow(allowed / d->tail[k], 1.0 / (order - 2 + k)));
  return fmin(factor, inside * d->nearest_zero);
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
  return !(fabs(length) >= resolution * (1 + fabs(time)));
}

double taylor_step_least(double time) {
  return 4 * resolution * (1 + fabs(time)); /* steps after it may be half as long */
}

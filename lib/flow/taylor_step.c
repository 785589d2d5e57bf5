/* Steps of Taylor flows: how order and length are chosen, and how a step is made. */
#define _DEFAULT_SOURCE /* lgamma_r */
#include "taylor_step.h"

#include <float.h>
#include <math.h>

#include "numeric/simd.h"
#include "ricochet/elementary.h"

enum { LEAST_ORDER = 4, MOST_ORDER = 30, FIRST_COEFFICIENTS = 4 };

/* Cancellation in the series of a motion of frequency w grows like exp(w h); beyond 2.2 it costs a digit. */
static const double longest_reach = 2.2;

/* First omitted term of a linear motion, relative to the tolerance: truncation has a sign and accumulates over 1e6
 * steps. */
static const double share = 0.01;

/* Lower limit of the first omitted term of linear tangent vectors. */
static const double carried_error = 1e-14;

/* Last terms relative to the tolerance if the step follows from their measured decay. */
static const double measured_share = 0.1;

/* Steps stay inside this fraction of the circle without branch points. */
static const double inside = 0.9;

static const double most_growth = 1000;

/* A prescribed length may be exceeded by this fraction to avoid a last step of the size of rounding errors. */
static const double length_slack = 1e-6;

/* Steps below this fraction of the time, or of its unit, have lengths of few ulps, dominated by rounding. */
static const double resolution = 1e-12;

/* Series with larger first coefficients may overflow when evaluated. */
static const double most_size = DBL_MAX * 1e-6;

static double log_factorial(int n) {
  double sum = 0;
  for (int k = 2; k <= n; k++)
    sum += ric_log(k);
  return sum;
}

int taylor_order(double tolerance) {
  int order = LEAST_ORDER;
  double term = ric_pow(longest_reach, 5) / 120; /* of order + 1 */
  while (order < MOST_ORDER && term > share * tolerance) {
    order++;
    term *= longest_reach / (order + 1);
  }
  return order;
}

double taylor_reach(double tolerance, int order) {
  double reach = ric_exp((ric_log(share * tolerance) + log_factorial(order + 1)) / (order + 1));
  return fmin(reach, longest_reach);
}

/** Longest step times |s| for tangent vectors of linear motions, independent of the motion itself: 3.3 at order 26. A
 *  motion that does not excite fast modes gives no bound for tangent vectors that do. */
static double taylor_carried_reach(double tolerance, int order) {
  return ric_exp((ric_log(fmax(carried_error, tolerance)) + log_factorial(order + 1)) / (order + 1));
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

/* The variants of a public symbol would be exported, too, so they are static. */
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

/* The change of the state grows at least linearly with the length, hence one power less. */
double taylor_step_factor(const taylor_decay *d, int order, double tolerance) {
  double allowed = measured_share * tolerance * d->change, growth = INFINITY; /* logarithm of the factor */
  for (int k = 0; k < 2; k++)
    if (d->tail[k] > 0)
      growth = fmin(growth, ric_log(allowed / d->tail[k]) / (order - 2 + k));
  return fmin(fmin(most_growth, ric_exp(growth)), inside * d->nearest_zero);
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
  return 4 * resolution * (1 + fabs(time)); /* following steps may be half as long */
}

/* Fraction of measured lengths that is used: most steps then need no shortening. */
static const double caution = 0.97;

/* Growth of the first series after a step without a force: the transient ends soon. */
static const double growth_after_limit = 4;

/* Beyond it a series overflows because of the state, not of the step length. */
static const double most_state = DBL_MAX * 1e-8;

double taylor_stepper_natural(const taylor_stepper *s) {
  return isfinite(s->longest) ? s->longest : 1;
}

void taylor_stepper_plan(taylor_stepper *s, double rate, double frequency) {
  const ric_flow_options *o = &s->flow->options;
  s->order = o->order ? o->order : taylor_order(o->tolerance);
  double reach = taylor_reach(o->tolerance, s->order);
  s->longest = reach / rate;
  s->longest_carried = taylor_carried_reach(o->tolerance, s->order) / rate;
  s->longest_forced = reach / fabs(frequency);
  s->trial = taylor_stepper_natural(s);
}

static ric_status blow_up(const ric_flow *f, const char *what, ric_error *error) {
  size_t n = f->system->coordinates, worst = 0;
  for (size_t i = 1; i < n; i++)
    if (!(fabs(f->q[i]) <= fabs(f->q[worst])))
      worst = i;
  return ric_fail(error, RIC_ENUMERIC, "at t = %.17g: the motion blows up, %s (q[%zu] = %g, u[%zu] = %g)", f->time,
                  what, worst, f->q[worst], worst, f->u[worst]);
}

static ric_status set_step(ric_flow *f, double length, double stop) {
  f->end = length == stop - f->time ? stop : f->time + length;
  f->length = length;
  return RIC_OK;
}

static bool state_is_moderate(const ric_flow *f) {
  size_t n = f->system->coordinates;
  return taylor_largest(f->q, n) + taylor_largest(f->u, n) < most_state;
}

/* The series of the longest finite one of the lengths h, h / 16, h / 256 ... */
static bool expand_finite(taylor_stepper *s, double *length, taylor_decay *decay) {
  *decay = s->expand(s->flow, *length);
  while (!isfinite(decay->change)) {
    *length /= 16;
    if (taylor_step_vanishes(s->flow->time, *length) || !state_is_moderate(s->flow))
      return false;
    *decay = s->expand(s->flow, *length);
  }
  return true;
}

static ric_status by_decay(taylor_stepper *s, double stop, double most, ric_error *error) {
  ric_flow *f = s->flow;
  double remaining = stop - f->time, length = taylor_step_length(remaining, fmin(s->trial, most), false);
  taylor_decay decay;
  if (!expand_finite(s, &length, &decay))
    return blow_up(f, "its series is not finite", error);
  double factor = taylor_step_factor(&decay, s->order, f->options.tolerance), best = fabs(length) * factor;
  s->trial = caution * best;
  if (factor < 1) {
    length = taylor_step_length(remaining, best, false);
    if (taylor_step_vanishes(f->time, length))
      return blow_up(f, "its steps become too short", error);
    s->shorten(f, length);
  }
  return set_step(f, length, stop);
}

ric_status taylor_stepper_choose(taylor_stepper *s, double stop, double limit, bool pressed, ric_error *error) {
  ric_flow *f = s->flow;
  bool fixed = f->options.step > 0;
  double most = fmin(fmin(limit, f->options.longest_step), fixed ? f->options.step : s->longest_forced);
  if (!fixed && f->tangent.columns > 0)
    most = fmin(most, s->longest_carried);
  if (limit < INFINITY)
    s->trial = fmin(s->trial, growth_after_limit * limit);
  if (pressed || !(fixed || s->by_bound))
    return by_decay(s, stop, most, error);
  double length = taylor_step_length(stop - f->time, fixed ? most : fmin(most, s->longest), fixed);
  if (!isfinite(s->expand(f, length).change))
    return blow_up(f, "its series is not finite", error);
  return set_step(f, length, stop);
}

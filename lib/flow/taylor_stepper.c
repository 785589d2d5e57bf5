#include "taylor_stepper.h"

#include <float.h>
#include <math.h>

/* Measured lengths are trusted to that part: most steps then need no shortening. */
static const double caution = 0.97;

/* A first series after a step without a force: what has happened there is over soon. */
static const double growth_after_limit = 4;

/* States beyond it are what makes a series overflow, and not the length of the step. */
static const double most_state = DBL_MAX * 1e-8;

void taylor_stepper_plan(taylor_stepper *s, double rate, double frequency) {
  const ric_flow_options *o = &s->flow->options;
  s->order = o->order ? o->order : taylor_order(o->tolerance);
  double reach = taylor_reach(o->tolerance, s->order);
  s->longest = reach / rate;
  s->longest_carried = taylor_carried_reach(o->tolerance, s->order) / rate;
  s->longest_forced = reach / fabs(frequency);
  s->trial = taylor_stepper_natural(s);
}

double taylor_stepper_natural(const taylor_stepper *s) {
  return isfinite(s->longest) ? s->longest : 1;
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
      return blow_up(f, "its steps shrink to nothing", error);
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

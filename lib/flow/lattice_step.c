/* Length of the steps of the Taylor flow of a lattice. */
#include <math.h>
#include <stdint.h>

#include "lattice_flow_parts.h"

/* Series of a motion of frequency w cancel in rounding like exp(w h); beyond 2.2 that costs a digit. */
static const double longest_reach = 2.2;

/* Of the tolerance, what the first term left out may be: truncation has a sign and adds up over 1e6 steps. */
static const double share = 0.01;

int lattice_flow_order(double tolerance) {
  int order = 4;
  double term = pow(longest_reach, 5) / 120;
  while (order < LATTICE_SERIES_ORDER && term > share * tolerance) {
    order++;
    term *= longest_reach / (order + 1);
  }
  return order;
}

double lattice_flow_reach(double tolerance, int order) {
  double reach = exp((log(share * tolerance) + lgamma(order + 2.0)) / (order + 1));
  return fmin(reach, longest_reach);
}

/* A step of at most `best` towards an end `remaining` ahead: no sliver is left over. */
static double divide(double remaining, double best) {
  if (remaining <= best * (1 + 1e-9))
    return remaining;
  return remaining < 2 * best ? remaining / 2 : best;
}

/* Steps below this do not move the time any more. */
static double shortest(const lattice_flow *f) {
  return 1e-12 * (1 + fabs(f->base.time));
}

static void set_step(lattice_flow *f, double length, double stop) {
  double remaining = stop - f->base.time;
  f->base.length = fabs(length) >= fabs(remaining) ? remaining : length;
  f->base.end = f->base.length == remaining ? stop : f->base.time + f->base.length;
}

static ric_status blow_up(const lattice_flow *f, const char *what, ric_error *error) {
  size_t n = f->base.system->coordinates, worst = 0;
  for (size_t i = 1; i < n; i++)
    if (!(fabs(f->base.q[i]) <= fabs(f->base.q[worst])))
      worst = i;
  return ric_fail(error, RIC_ENUMERIC, "at t = %.17g: the motion blows up, %s (q[%zu] = %g, u[%zu] = %g)", f->base.time,
                  what, worst, f->base.q[worst], worst, f->base.u[worst]);
}

/* Series of all pieces at a length, and how they fall off. */
static lattice_decay survey(lattice_flow *f, double length) {
  lattice_decay all = {.nearest_zero = INFINITY};
  f->ended = 0;
  for (size_t i = 0; i < f->base.pieces; i++) {
    lattice_flow_make(f, i, length);
    lattice_decay d = lattice_series_decay(f->series);
    if (isnan(d.change) || isnan(all.change))
      all.change = NAN;
    else
      all.change = fmax(all.change, d.change);
    all.tail[0] = fmax(all.tail[0], d.tail[0]);
    all.tail[1] = fmax(all.tail[1], d.tail[1]);
    all.nearest_zero = fmin(all.nearest_zero, d.nearest_zero);
  }
  return all;
}

/* By what the length may be multiplied so that the last two terms, in positions and in velocities, stay below their
 * share of what changes in the step; that change grows with the length, hence one power less. */
static double allowed_factor(const lattice_flow *f, const lattice_decay *d) {
  double allowed = 0.1 * f->base.options.tolerance * d->change, factor = 1000;
  for (int k = 0; k < 2; k++)
    if (d->tail[k] > 0)
      factor = fmin(factor, pow(allowed / d->tail[k], 1.0 / (f->order - 2 + k)));
  return fmin(factor, 0.9 * d->nearest_zero);
}

static ric_status step_by_decay(lattice_flow *f, double stop, double most, ric_error *error) {
  double remaining = fabs(stop - f->base.time), sign = stop < f->base.time ? -1 : 1;
  double h = divide(remaining, fmin(f->trial, most));
  lattice_decay d = survey(f, sign * h);
  while (!isfinite(d.change)) {
    h /= 16;
    if (!(h >= shortest(f)))
      return blow_up(f, "its series is not finite", error);
    d = survey(f, sign * h);
  }
  double factor = allowed_factor(f, &d), best = fmin(h * factor, most);
  f->trial = 0.97 * h * factor;
  if (factor < 1) {
    double shorter = divide(remaining, best);
    if (!(shorter >= shortest(f)))
      return blow_up(f, "its steps shrink to nothing", error);
    if (f->base.pieces == 1)
      h = fabs(lattice_series_shorten(f->series, f->base.q, f->base.u, shorter / h).length);
    else {
      h = shorter;
      f->made = SIZE_MAX;
      f->ended = 0;
    }
  }
  set_step(f, sign * h, stop);
  return RIC_OK;
}

/* Linear motions grow by less than exp(2.2) per coefficient in a step of the bound: it is enough to look at the start.
 */
static ric_status check_start(const lattice_flow *f, ric_error *error) {
  size_t n = f->base.system->coordinates;
  double most = 0, bad = 0;
  for (size_t i = 0; i < n; i++) {
    double size = fabs(f->base.q[i]) + fabs(f->base.u[i] * f->base.length);
    most = size > most ? size : most;
    bad += 0 * size;
  }
  return most + bad < 1e290 ? RIC_OK : blow_up(f, "its state grows beyond bounds", error);
}

static ric_status check_series(lattice_flow *f, ric_error *error) {
  return isfinite(survey(f, f->base.length).change) ? RIC_OK : blow_up(f, "its series is not finite", error);
}

ric_status lattice_flow_choose_step(lattice_flow *f, double stop, ric_error *error) {
  const ric_flow_options *o = &f->base.options;
  double remaining = fabs(stop - f->base.time), limit;
  int direction = stop < f->base.time ? -1 : 1;
  RIC_TRY(lattice_flow_take_contacts(f, direction, &limit, error));
  if (limit < INFINITY)
    f->trial = fmin(f->trial, 4 * limit);
  double most = fmin(limit, o->longest_step), free_step = fmin(most, f->longest_forced);
  if (o->step > 0) {
    double length = fmin(o->step, most);
    set_step(f, direction * (remaining <= length * (1 + 1e-12) ? remaining : length), stop);
  } else if (f->linear && f->acting_count == 0)
    set_step(f, direction * divide(remaining, fmin(free_step, f->longest)), stop);
  else
    return step_by_decay(f, stop, free_step, error);
  bool cheap = f->linear && f->acting_count == 0 && f->base.pieces > 1;
  ric_status status = cheap ? check_start(f, error) : check_series(f, error);
  if (status != RIC_OK)
    f->base.length = 0;
  return status;
}

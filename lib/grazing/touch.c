#include "touch.h"

#include <math.h>

#include "shooting/shooting_parts.h"

enum { MOST_STEPS = 30 };

/* Steps below this part of the period no longer move the minimum. */
static const double time_tol = 1e-15;

/* Steps of Newton's method are not to leave the minimum it starts at. */
static const double longest_step = 0.05;

/* Into [0, T): a time below zero by less than rounding at T is zero. */
static double folded(double time, double period) {
  const double t = fmod(time, period), shifted = t < 0 ? t + period : t;
  return shifted < period ? shifted : 0;
}

static ric_status read_gap(const ric_system *s, touch *k, ric_error *error) {
  const size_t n = s->coordinates;
  const double t = k->time;
  RIC_TRY(ric_system_rate(s, t, k->x, k->x + n, k->rates, k->rates + n, error));
  const char *trouble = s->model->gap(s, k->obstacle, t, k->x, &k->gap);
  if (!trouble)
    trouble = s->model->gap_rate(s, k->obstacle, t, k->x, k->x + n, &k->rate);
  if (!trouble)
    trouble = s->model->gap_acceleration(s, k->obstacle, t, k->x, k->x + n, k->rates, k->rates + n, &k->acceleration);
  return trouble ? ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", t, k->obstacle, trouble) : RIC_OK;
}

/* Where the gap is not convex, a step down its slope. */
static double step_of(const touch *k, double period) {
  const double step = -k->rate / fabs(k->acceleration), most = longest_step * period;
  return isnan(step) ? 0 : fmax(-most, fmin(step, most));
}

ric_status touch_find(ric_shooting *s, const double *z, double given, double period, touch *k, ric_error *error) {
  double before = INFINITY;
  k->time = folded(k->time, period);
  for (int i = 0; i < MOST_STEPS; i++) {
    RIC_TRY(ric_shooting_transfer(s, z, given, k->time, k->time, k->x, NULL, error));
    RIC_TRY(read_gap(s->system, k, error));
    const double step = step_of(k, period), size = fabs(step);
    if (k->acceleration > 0 && (size <= time_tol * period || (size < sqrt(time_tol) * period && size > before / 2)))
      return RIC_OK;
    if (k->rate == 0)
      break;
    before = size;
    k->time = folded(k->time + step, period);
  }
  return ric_fail(error, RIC_ENUMERIC, "the gap of obstacle %zu has no minimum near t = %g", k->obstacle, k->time);
}

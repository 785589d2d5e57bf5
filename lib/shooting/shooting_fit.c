#include "shooting_fit.h"

#include <math.h>
#include <string.h>

#include "numeric/largest.h"

/* A part of the period at which no harmonic of low order is zero. */
static const double odd_part = 0.2371;

static bool is_even(const ric_shooting *s) {
  return s->arcs.kind == RIC_MOTION_EVEN;
}

/* The first state, with speeds that no damper leaves alone, in s->x. */
static void set_state(ric_shooting *s, const double *z, double period) {
  size_t n = s->arcs.coordinates;
  (void)shooting_begin(s, 0, z, period, WISH_STATE);
  for (size_t i = 0; i < s->arcs.speeds; i++)
    s->x[n + i] += cos((double)(i + 1));
}

static ric_status rates_at(ric_shooting *s, double t, double *rates, ric_error *error) {
  size_t n = s->arcs.coordinates;
  return ric_system_rate(s->system, t, s->x, s->x + n, rates, rates + n, error);
}

static double difference(const double *a, const double *b, double sign, size_t count) {
  double worst = 0;
  for (size_t i = 0; i < count; i++)
    worst = fmax(worst, fabs(a[i] - sign * b[i]));
  return worst;
}

/* Whether gaps of users move on with a time that passes. */
static bool gaps_move(const ric_shooting *s, double t, double later, double tolerance) {
  const ric_system *system = s->system;
  for (size_t j = 0; !system->obstacles && j < system->obstacle_count; j++) {
    double gap = ric_system_gap(system, j, t, s->x), then = ric_system_gap(system, j, later, s->x);
    if (!(fabs(then - gap) <= tolerance * (1 + fabs(gap))))
      return true;
  }
  return false;
}

ric_status shooting_fit(ric_shooting *s, const double *z, double period, double tolerance, const char **why,
                        ric_error *error) {
  size_t n = s->arcs.coordinates, size = s->arcs.size;
  bool timed = is_even(s) || s->arcs.kind == RIC_MOTION_FORCED;
  double t = odd_part * period, later = t + (timed ? period : t), *rates = s->rates, *other = s->ends;
  *why = NULL;
  set_state(s, z, period);
  RIC_TRY(rates_at(s, t, rates, error));
  double most = tolerance * (1 + largest(rates, size));
  RIC_TRY(rates_at(s, later, other, error));
  if (!(difference(rates, other, 1, size) <= most) || gaps_move(s, t, later, tolerance))
    *why = timed ? "the forcing does not repeat after the period" : "forces or gaps depend on time";
  for (size_t i = n; is_even(s) && i < size; i++)
    s->x[i] = -s->x[i];
  if (*why || !is_even(s))
    return RIC_OK;
  RIC_TRY(rates_at(s, -t, other, error));
  if (!(difference(rates + n, other + n, 1, n) <= most))
    *why = "the system does not run backwards as it runs forwards: damping, or forcing by sines";
  return RIC_OK;
}

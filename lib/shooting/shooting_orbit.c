/* The verdict on a motion that shooting has found. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "numeric/largest.h"
#include "shooting_fit.h"
#include "shooting_gaps.h"
#include "shooting_look.h"

/* Residuals above it, relative to 1 + the largest unknown, are no solution's. */
static const double residual_tol = 1e-6;

/* The impact that comes in slowest. */
static size_t weakest_impact(const ric_orbit *o) {
  size_t weakest = 0;
  for (size_t k = 1; k < o->impacts; k++)
    if (o->gap_rate[k] > o->gap_rate[weakest])
      weakest = k;
  return weakest;
}

static double folded(const ric_orbit *o, double time) {
  double t = fmod(time, o->period);
  return t < 0 ? t + o->period : t;
}

static void judge(const ric_shooting *s, ric_orbit *o) {
  const shooting_gaps *g = s->gaps;
  double zero = s->grazing_tol;
  const gap_found *least = g->free.value <= g->own.value ? &g->free : &g->own;
  size_t weakest = weakest_impact(o);
  double rate = o->impacts > 0 ? o->gap_rate[weakest] : -INFINITY;
  char *reason = o->reason;
  size_t room = sizeof o->reason;
  o->outcome = RIC_INADMISSIBLE;
  if (s->out_of_order)
    snprintf(reason, room, "impacts are out of order");
  else if (rate > zero)
    snprintf(reason, room, "obstacle %zu is left at its impact, t = %.6g, with the gap rate %.3g",
             o->impact_obstacle[weakest], o->impact_time[weakest], rate);
  else if (least->value < -zero)
    snprintf(reason, room, "obstacle %zu is passed at t = %.6g; the smallest gap is %.3g", g->first.obstacle,
             folded(o, g->first.time), least->value);
  else
    o->outcome = RIC_GRAZING;
  if (o->outcome == RIC_INADMISSIBLE)
    return;
  if (rate >= -zero)
    snprintf(reason, room, "obstacle %zu is hit at t = %.6g with the gap rate %.2g", o->impact_obstacle[weakest],
             o->impact_time[weakest], rate);
  else if (least->value <= zero)
    snprintf(reason, room, "obstacle %zu is touched at t = %.6g, gap %.2g", least->obstacle, folded(o, least->time),
             least->value);
  else {
    o->outcome = RIC_ADMISSIBLE;
    reason[0] = '\0';
  }
}

static void keep_clearance(const ric_shooting *s, ric_orbit *o) {
  const gap_found *g = &s->gaps->free;
  bool any = g->obstacle != NO_UNKNOWN;
  const ric_obstacle *obstacles = s->system->obstacles;
  o->clearance = any ? g->value : NAN;
  o->clearance_time = any ? folded(o, g->time) : NAN;
  o->clearance_particle = any ? (long long)(obstacles ? obstacles[g->obstacle].coordinate : g->obstacle) : -1;
}

/* Solutions of the equations that are no motions. */
static ric_status look_for_failure(ric_shooting *s, const double *z, ric_orbit *o, ric_error *error) {
  const arc_plan *a = &s->arcs;
  const char *why;
  double most = residual_tol * (1 + largest(z, a->unknowns));
  double added = a->lambda == NO_UNKNOWN ? 0 : fabs(z[a->lambda]) * largest(s->gradient, a->size);
  RIC_TRY(shooting_fit(s, z, o->period, residual_tol, &why, error));
  if (!why && o->residual <= most && added <= most)
    return RIC_OK;
  o->outcome = RIC_FAILED;
  if (why)
    snprintf(o->reason, sizeof o->reason, "no motion of this kind: %s", why);
  else if (!(o->residual <= most))
    snprintf(o->reason, sizeof o->reason, "equations are violated by %.3g", o->residual);
  else
    snprintf(o->reason, sizeof o->reason, "energy is not conserved: the motion closes but for %.3g", added);
  return RIC_OK;
}

static ric_status set_start(ric_shooting *s, const double *z, double given, ric_orbit *o, ric_error *error) {
  size_t n = s->arcs.coordinates;
  RIC_TRY(shooting_period(s, z, given, &o->period, error));
  piece_run run = shooting_begin(s, 0, z, o->period, WISH_STATE);
  memcpy(o->q, s->x, n * sizeof *s->x);
  if (s->arcs.speeds > 0)
    memcpy(o->v, s->x + n, s->arcs.speeds * sizeof *s->x);
  o->energy = ric_system_energy(s->system, run.begin, o->q, o->v);
  return RIC_OK;
}

ric_status shooting_judge(ric_shooting *s, const double *z, double given, ric_orbit *o, ric_error *error) {
  RIC_TRY(set_start(s, z, given, o, error));
  o->condition = NAN;
  o->mode = -1;
  o->harmonic = 0;
  keep_clearance(s, o);
  judge(s, o);
  return look_for_failure(s, z, o, error);
}

ric_status ric_shooting_orbit(ric_shooting *s, const double *z, double given, ric_orbit *orbit, ric_error *error) {
  RIC_TRY(shooting_look(s, z, given, LOOK_ORBIT, NULL, NULL, NULL, orbit, error));
  return shooting_judge(s, z, given, orbit, error);
}

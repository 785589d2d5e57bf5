/* The orbit of a solution, and what can be said of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/largest.h"
#include "shooting_fit.h"
#include "shooting_gaps.h"

/* Residuals above it, relative to 1 + the largest unknown, are no solution's. */
static const double residual_tol = 1e-6;
/* Impacts this near to half the period, over it, are there: solutions have their times to 1e-13. */
static const double half_tol = 1e-12;

/* A solution being looked at. */
typedef struct look {
  ric_shooting *s;
  const double *z;
  double period, origin; /* time at which the motion begins */
  ric_orbit *orbit;
  size_t impacts; /* filled so far */
  bool out_of_order;
  ric_status status; /* of what the observer asks for */
  ric_error *error;
} look;

/* How much an impulse along the gap of an obstacle changes its rate; NaN for impact maps. */
static double mobility(look *l, size_t obstacle, double t, const double *x) {
  ric_shooting *s = l->s;
  contact_direction d = {.g = s->rates, .w = s->rates + s->arcs.speeds}; /* not in use here, m <= n */
  double sum = 0;
  if (!s->system->model->direction || s->system->model->direction(s->system, obstacle, t, x, &d))
    return NAN;
  for (size_t i = 0; i < d.count; i++)
    sum += d.g[i] * d.w[i];
  return sum;
}

static double folded(const look *l, double time) {
  double t = fmod(time, l->period);
  return t < 0 ? t + l->period : t;
}

/* An impact at a state just before it, or just after it (`sign` -1): elastic ones turn the rate around. */
static void add_impact(look *l, size_t obstacle, double time, const double *x, double sign) {
  const ric_system *system = l->s->system;
  ric_orbit *o = l->orbit;
  double rate = NAN, e = system->model->restitution(system, obstacle);
  size_t k = l->impacts++;
  (void)system->model->gap_rate(system, obstacle, time, x, x + system->coordinates, &rate);
  o->impact_obstacle[k] = obstacle;
  o->impact_time[k] = folded(l, time);
  o->gap_rate[k] = sign * rate;
  o->impulse[k] = -(1 + e) * sign * rate / mobility(l, obstacle, time, x);
}

static bool is_even(const look *l) {
  return l->s->arcs.kind == RIC_MOTION_EVEN;
}

static void begins(const piece_run *run, void *user) {
  look *l = user;
  const ric_shooting *s = l->s;
  shooting_gaps_begin(s->gaps, run);
  if (run->end < run->begin - s->grazing_tol * l->period) /* impacts of one time are in order either way */
    l->out_of_order = true;
  if (run->piece > s->arcs.pieces)
    return;
  l->origin = run->begin;
  memcpy(l->orbit->q, s->x, s->arcs.coordinates * sizeof *s->x);
  if (s->arcs.speeds > 0)
    memcpy(l->orbit->v, s->x + s->arcs.coordinates, s->arcs.speeds * sizeof *s->x);
  for (size_t i = 0; is_even(l) && i < s->arcs.coordinates; i++)
    if (s->arcs.at_start[i] != NO_UNKNOWN)
      add_impact(l, s->arcs.at_start[i], 0, s->x, -1);
  if (is_even(l))
    l->status = shooting_gaps_turn(s->gaps, s->arcs.at_start, 0, l->error);
}

/* State at half the period, of motions that are not even: where a segment passes it. One that ends there has the state
 * before an impact, and the next one has not; rounding must not leave it to neither. */
static void keep_half(look *l, const ric_segment *piece, double end) {
  double x = (l->origin + l->period / 2 - piece->start) / piece->length, slack = half_tol * l->period;
  slack /= fabs(piece->length);
  if (!(x > slack && x <= end + slack))
    return;
  ric_segment_state(piece, fmin(x, end), l->orbit->q_half + piece->first,
                    l->orbit->speeds > 0 ? l->orbit->v_half + piece->first : NULL);
}

static void segment(const ric_segment *piece, double end, void *user) {
  look *l = user;
  shooting_gaps_look(l->s->gaps, piece, end);
  if (!is_even(l))
    keep_half(l, piece, end);
}

static void ends(const piece_run *run, const double *x, void *user) {
  look *l = user;
  const ric_shooting *s = l->s;
  size_t n = s->arcs.coordinates;
  if (run->piece->how == PIECE_IMPACT)
    add_impact(l, run->piece->obstacle, run->end, x, 1);
  if (run->piece->how == PIECE_IMPACT && run->piece->closes)
    shooting_gaps_close(s->gaps, run, x, l->z);
  if (run->piece->how != PIECE_HALF)
    return;
  memcpy(l->orbit->q_half, x, n * sizeof *x);
  memcpy(l->orbit->v_half, x + n, n * sizeof *x);
  for (size_t i = 0; i < n; i++)
    if (s->arcs.at_half[i] != NO_UNKNOWN)
      add_impact(l, s->arcs.at_half[i], run->end, x, 1);
  if (l->status == RIC_OK)
    l->status = shooting_gaps_turn(s->gaps, s->arcs.at_half, run->end, l->error);
}

/* The second half of an even motion mirrors the impacts between. */
static void add_mirrored(look *l) {
  ric_orbit *o = l->orbit;
  size_t first = l->s->arcs.start_count, count = l->s->arcs.sequence_count;
  for (size_t i = first + count; is_even(l) && i-- > first;) {
    size_t k = l->impacts++;
    o->impact_obstacle[k] = o->impact_obstacle[i];
    o->impact_time[k] = folded(l, l->period - o->impact_time[i]);
    o->gap_rate[k] = o->gap_rate[i];
    o->impulse[k] = o->impulse[i];
  }
}

/* --- verdict ------------------------------------------------------------------------------------------------------ */

/* The impact that comes in slowest. */
static size_t weakest_impact(const ric_orbit *o) {
  size_t weakest = 0;
  for (size_t k = 1; k < o->impacts; k++)
    if (o->gap_rate[k] > o->gap_rate[weakest])
      weakest = k;
  return weakest;
}

static void judge(const look *l) {
  ric_orbit *o = l->orbit;
  const shooting_gaps *g = l->s->gaps;
  double zero = l->s->grazing_tol;
  const gap_found *least = g->free.value <= g->own.value ? &g->free : &g->own;
  size_t weakest = weakest_impact(o);
  double rate = o->impacts > 0 ? o->gap_rate[weakest] : -INFINITY;
  char *reason = o->reason;
  size_t room = sizeof o->reason;
  o->outcome = RIC_INADMISSIBLE;
  if (l->out_of_order)
    snprintf(reason, room, "impacts are out of order");
  else if (rate > zero)
    snprintf(reason, room, "obstacle %zu is left at its impact, t = %.6g, with the gap rate %.3g",
             o->impact_obstacle[weakest], o->impact_time[weakest], rate);
  else if (least->value < -zero)
    snprintf(reason, room, "obstacle %zu is passed at t = %.6g; the smallest gap is %.3g", g->first.obstacle,
             folded(l, g->first.time), least->value);
  else
    o->outcome = RIC_GRAZING;
  if (o->outcome == RIC_INADMISSIBLE)
    return;
  if (rate >= -zero)
    snprintf(reason, room, "obstacle %zu is hit at t = %.6g with the gap rate %.2g", o->impact_obstacle[weakest],
             o->impact_time[weakest], rate);
  else if (least->value <= zero)
    snprintf(reason, room, "obstacle %zu is touched at t = %.6g, gap %.2g", least->obstacle, folded(l, least->time),
             least->value);
  else {
    o->outcome = RIC_ADMISSIBLE;
    reason[0] = '\0';
  }
}

static void keep_clearance(const look *l) {
  ric_orbit *o = l->orbit;
  const gap_found *g = &l->s->gaps->free;
  bool any = g->obstacle != NO_UNKNOWN;
  const ric_obstacle *obstacles = l->s->system->obstacles;
  o->clearance = any ? g->value : NAN;
  o->clearance_time = any ? folded(l, g->time) : NAN;
  o->clearance_particle = any ? (long long)(obstacles ? obstacles[g->obstacle].coordinate : g->obstacle) : -1;
}

static ric_status follow(look *l, double given, ric_error *error) {
  ric_shooting *s = l->s;
  const shooting_observer observer = {.begins = begins, .segment = segment, .ends = ends, .user = l};
  shooting_gaps_reset(s->gaps);
  RIC_TRY(shooting_evaluate(s, l->z, given, s->residual, NULL, NULL, &observer, error));
  RIC_TRY(l->status);
  if (s->gaps->trouble)
    return ric_fail(error, RIC_ECALLBACK, "a gap of the motion could not be read: %s", s->gaps->trouble);
  add_mirrored(l);
  return RIC_OK;
}

static ric_status check_room(const ric_shooting *s, const ric_orbit *orbit, ric_error *error) {
  if (orbit->particles == s->arcs.coordinates && orbit->speeds == s->arcs.speeds &&
      orbit->impacts == ric_shooting_impacts(s))
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "orbit with room for %zu coordinates and %zu impacts, expected %zu and %zu",
                  orbit->particles, orbit->impacts, s->arcs.coordinates, ric_shooting_impacts(s));
}

/* Solutions of the equations that are no motions. */
static ric_status look_for_failure(look *l, ric_error *error) {
  ric_shooting *s = l->s;
  ric_orbit *o = l->orbit;
  const arc_plan *a = &s->arcs;
  const char *why;
  double most = residual_tol * (1 + largest(l->z, a->unknowns));
  double added = a->lambda == NO_UNKNOWN ? 0 : fabs(l->z[a->lambda]) * largest(s->gradient, a->size);
  RIC_TRY(shooting_fit(s, l->z, l->period, residual_tol, &why, error));
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

ric_status ric_shooting_orbit(ric_shooting *s, const double *z, double given, ric_orbit *orbit, ric_error *error) {
  look l = {.s = s, .z = z, .orbit = orbit, .error = error};
  RIC_TRY(check_room(s, orbit, error));
  if (!s->gaps)
    RIC_TRY(shooting_gaps_create(s, &s->gaps, error));
  RIC_TRY(shooting_period(s, z, given, &l.period, error));
  RIC_TRY(follow(&l, given, error));
  orbit->period = l.period;
  orbit->residual = largest(s->residual, s->arcs.unknowns);
  orbit->energy = ric_system_energy(s->system, l.origin, orbit->q, orbit->v);
  orbit->condition = NAN;
  orbit->mode = -1;
  orbit->harmonic = 0;
  keep_clearance(&l);
  judge(&l);
  return look_for_failure(&l, error);
}

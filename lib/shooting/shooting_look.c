#include "shooting_look.h"

#include <math.h>
#include <string.h>

#include "numeric/largest.h"
#include "shooting_gaps.h"
#include "shooting_spectrum.h"

/* Impacts this near to half the period, over it, are there: solutions have their times to 1e-13. */
static const double half_tol = 1e-12;

/* A solution being looked at. */
typedef struct look {
  ric_shooting *s;
  const double *z;
  ric_orbit *orbit; /* NULL */
  bool spectrum;
  double period, origin; /* time at which the motion begins */
  size_t impacts;        /* filled so far */
} look;

/* How much an impulse along the gap of an obstacle changes its rate; NaN for impact maps. */
static double mobility(look *l, size_t obstacle, double t, const double *x) {
  ric_shooting *s = l->s;
  contact_direction d = {.g = s->contact, .w = s->contact + s->arcs.speeds};
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

/* Impacts at the first state of even motions. */
static ric_status begin_orbit(look *l, const piece_run *run, ric_error *error) {
  const ric_shooting *s = l->s;
  l->origin = run->begin;
  if (!is_even(l))
    return RIC_OK;
  for (size_t i = 0; i < s->arcs.coordinates; i++)
    if (s->arcs.at_start[i] != NO_UNKNOWN)
      add_impact(l, s->arcs.at_start[i], 0, s->x, -1);
  return shooting_gaps_turn(s->gaps, s->arcs.at_start, 0, error);
}

static ric_status begins(const piece_run *run, void *user, ric_error *error) {
  look *l = user;
  ric_shooting *s = l->s;
  bool first = run->piece == s->arcs.pieces;
  if (l->spectrum && first)
    RIC_TRY(shooting_spectrum_begin(s, error));
  if (!l->orbit)
    return RIC_OK;
  shooting_gaps_begin(s->gaps, run);
  if (run->end < run->begin - s->grazing_tol * l->period) /* impacts of one time are in order either way */
    s->out_of_order = true;
  return first ? begin_orbit(l, run, error) : RIC_OK;
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

/* The state at half the period, and the impacts there. */
static ric_status end_half(look *l, const piece_run *run, ric_error *error) {
  const ric_shooting *s = l->s;
  size_t n = s->arcs.coordinates;
  memcpy(l->orbit->q_half, s->x, n * sizeof *s->x);
  memcpy(l->orbit->v_half, s->x + n, n * sizeof *s->x);
  for (size_t i = 0; i < n; i++)
    if (s->arcs.at_half[i] != NO_UNKNOWN)
      add_impact(l, s->arcs.at_half[i], run->end, s->x, 1);
  return shooting_gaps_turn(s->gaps, s->arcs.at_half, run->end, error);
}

static ric_status ends(const piece_run *run, void *user, ric_error *error) {
  look *l = user;
  const ric_shooting *s = l->s;
  if (l->spectrum)
    RIC_TRY(shooting_spectrum_pass(l->s, run, error));
  if (!l->orbit)
    return RIC_OK;
  if (run->piece->how == PIECE_IMPACT)
    add_impact(l, run->piece->obstacle, run->end, s->x, 1);
  if (run->piece->how == PIECE_IMPACT && run->piece->closes)
    shooting_gaps_close(s->gaps, run, s->x, l->z);
  return run->piece->how == PIECE_HALF ? end_half(l, run, error) : RIC_OK;
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

static ric_status check_room(const ric_shooting *s, const ric_orbit *orbit, ric_error *error) {
  if (orbit->particles == s->arcs.coordinates && orbit->speeds == s->arcs.speeds &&
      orbit->impacts == ric_shooting_impacts(s))
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "orbit with room for %zu coordinates and %zu impacts, expected %zu and %zu",
                  orbit->particles, orbit->impacts, s->arcs.coordinates, ric_shooting_impacts(s));
}

static ric_status reserve(look *l, ric_error *error) {
  ric_shooting *s = l->s;
  if (l->orbit)
    RIC_TRY(check_room(s, l->orbit, error));
  if (l->orbit && !s->gaps)
    RIC_TRY(shooting_gaps_create(s, &s->gaps, error));
  return l->spectrum ? shooting_spectrum_reserve(s, error) : RIC_OK;
}

static ric_status finish_orbit(look *l, const double *F, ric_error *error) {
  const ric_shooting *s = l->s;
  ric_orbit *o = l->orbit;
  if (s->gaps->trouble)
    return ric_fail(error, RIC_ECALLBACK, "a gap of the motion could not be read: %s", s->gaps->trouble);
  add_mirrored(l);
  o->residual = largest(F, s->arcs.unknowns);
  return RIC_OK;
}

ric_status shooting_look(ric_shooting *s, const double *z, double given, int what, double *F, double *J,
                         double *F_given, ric_orbit *orbit, ric_error *error) {
  look l = {.s = s, .z = z, .orbit = what & LOOK_ORBIT ? orbit : NULL, .spectrum = what & LOOK_SPECTRUM};
  const shooting_observer observer = {
      .begins = begins, .segment = l.orbit ? segment : NULL, .ends = ends, .whole = l.spectrum, .user = &l};
  double *residual = F ? F : s->residual;
  RIC_TRY(reserve(&l, error));
  RIC_TRY(shooting_period(s, z, given, &l.period, error));
  if (l.orbit) {
    s->out_of_order = false;
    shooting_gaps_reset(s->gaps);
  }
  RIC_TRY(shooting_evaluate(s, z, given, residual, J, F_given, &observer, error));
  return l.orbit ? finish_orbit(&l, residual, error) : RIC_OK;
}

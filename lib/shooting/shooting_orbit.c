/* The orbit of a solution from one integration: impacts, amplitude, and the verdict on the motion. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "numeric/required.h"
#include "numeric/vector.h"
#include "orbit/admissibility.h"
#include "ricochet/elementary.h"
#include "shooting.h"

/* A part of the period at which no harmonic of low order is zero. */
static const double odd_part = 0.2371;

/* Sets s->x to the first state, with changed speeds, so that every damper has a force. */
static void set_general_state(ric_shooting *s, const double *z, double period) {
  size_t n = s->arcs.coordinates;
  (void)shooting_begin(s, 0, z, period, OUTPUT_STATE);
  for (size_t i = 0; i < s->arcs.speeds; i++)
    s->x[n + i] += ric_cos((double)(i + 1));
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

/* Whether gaps of user-defined systems depend on time explicitly. */
static bool gaps_depend_on_time(const ric_shooting *s, double t, double later, double tolerance) {
  const ric_system *system = s->system;
  for (size_t j = 0; !system->obstacles && j < system->obstacle_count; j++) {
    double gap = ric_system_gap(system, j, t, s->x), then = ric_system_gap(system, j, later, s->x);
    if (!(fabs(then - gap) <= tolerance * (1 + fabs(gap))))
      return true;
  }
  return false;
}

/* Whether a system can have motions of a kind: tests their symmetry at a state with other speeds than the first one.
 *
 * The equations of shooting assume symmetries: for even motions that the system is reversible, for forced ones that
 * the forces repeat after the period, for the others that they do not depend on time. Without its symmetry a system
 * has solutions of the equations that are not motions.
 * @param z  a solution
 * @param why  set to the symmetry that fails, NULL when there is none
 * @returns RIC_ECALLBACK */
static ric_status shooting_fit(ric_shooting *s, const double *z, double period, double tolerance, const char **why,
                               ric_error *error) {
  size_t n = s->arcs.coordinates, size = s->arcs.size;
  bool timed = shooting_is_even(s) || s->arcs.kind == RIC_MOTION_FORCED;
  double t = odd_part * period, later = t + (timed ? period : t), *rates = s->rates, *other = s->ends;
  *why = NULL;
  set_general_state(s, z, period);
  RIC_TRY(rates_at(s, t, rates, error));
  double most = tolerance * (1 + largest(rates, size));
  RIC_TRY(rates_at(s, later, other, error));
  if (!(difference(rates, other, 1, size) <= most) || gaps_depend_on_time(s, t, later, tolerance))
    *why = timed ? "the forcing does not repeat after the period" : "forces or gaps depend on time";
  for (size_t i = n; shooting_is_even(s) && i < size; i++)
    s->x[i] = -s->x[i];
  if (*why || !shooting_is_even(s))
    return RIC_OK;
  RIC_TRY(rates_at(s, -t, other, error));
  if (!(difference(rates + n, other + n, 1, n) <= most))
    *why = "the system is not reversible: damping, gyroscopic forces, or forcing by sines";
  return RIC_OK;
}

/* The largest displacement of a motion over its period. */

/* On the value, relative to it. */
static const double amplitude_tol = 1e-14;

/* A coordinate on a segment used up to `end`, times a sign, as a polynomial on [0, 1]. */
static void coordinate_polynomial(const ric_segment *piece, size_t i, double end, double sign, double *c) {
  double power = sign;
  for (int j = 0; j <= piece->degree; j++, power *= end)
    c[j] = power * piece->coef[(size_t)j * piece->stride + i];
}

static void enlarge_amplitude(const ric_segment *piece, double end, void *user) {
  double *most = user, c[RIC_POLY_DEGREE + 1], at, value;
  for (size_t i = 0; i < piece->coordinates; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      coordinate_polynomial(piece, i, end, sign, c);
      if (ric_poly_minimum(c, piece->degree, -*most, amplitude_tol * *most, &at, &value))
        *most = fmax(*most, -value);
    }
}

ric_status ric_shooting_amplitude(ric_shooting *s, const double *z, double given, double *amplitude, ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"amplitude", amplitude});
  const shooting_observer observer = {.segment = enlarge_amplitude, .user = amplitude};
  *amplitude = 0;
  return shooting_evaluate(s, z, given, s->residual, NULL, NULL, &observer, error);
}

/* Impacts nearer than this to half the period, over it, are at it: the times of solutions have errors of 1e-13. */
static const double half_tol = 1e-12;

/* The evaluation of the orbit of a solution. */
typedef struct examination {
  ric_shooting *s;
  const double *z;
  ric_orbit *orbit; /* NULL */
  bool spectrum;
  double period, origin; /* time at which the motion begins */
  size_t impacts;        /* number of impacts filled in so far */
} examination;

/* Change of the gap rate by a unit impulse along the gap; NaN for impact maps. */
static double mobility(examination *l, size_t obstacle, double t, const double *x) {
  ric_shooting *s = l->s;
  contact_direction d = {.g = s->contact, .w = s->contact + s->arcs.speeds};
  double sum = 0;
  if (!s->system->model->direction || s->system->model->direction(s->system, obstacle, t, x, &d))
    return NAN;
  for (size_t i = 0; i < d.count; i++)
    sum += d.g[i] * d.w[i];
  return sum;
}

static double time_in_period(const examination *l, double time) {
  double t = fmod(time, l->period);
  return t < 0 ? t + l->period : t;
}

/* Adds an impact with its state just before it, or just after it (`sign` -1): elastic impacts reverse the gap rate. */
static void add_impact(examination *l, size_t obstacle, double time, const double *x, double sign) {
  const ric_system *system = l->s->system;
  ric_orbit *o = l->orbit;
  double rate = NAN, e = system->model->restitution(system, obstacle);
  size_t k = l->impacts++;
  (void)system->model->gap_rate(system, obstacle, time, x, x + system->coordinates, &rate);
  o->impact_obstacle[k] = obstacle;
  o->impact_time[k] = time_in_period(l, time);
  o->gap_rate[k] = sign * rate;
  o->impulse[k] = -(1 + e) * sign * rate / mobility(l, obstacle, time, x);
}

static bool is_even_motion(const examination *l) {
  return l->s->arcs.kind == RIC_MOTION_EVEN;
}

/* Gaps at an end of the half period. @param hit  obstacle that each coordinate hits there */
static ric_status set_turning_gaps(ric_shooting *s, const size_t *hit, double time, ric_error *error) {
  size_t n = s->arcs.coordinates;
  RIC_TRY(ric_system_rate(s->system, time, s->x, s->x + n, s->rates, s->rates + n, error));
  system_gaps_turn(&s->gaps, hit, time, s->x, s->rates);
  return RIC_OK;
}

/* Impacts at the first state of even motions. */
static ric_status begin_orbit(examination *l, const piece_run *run, ric_error *error) {
  const ric_shooting *s = l->s;
  l->origin = run->begin;
  if (!is_even_motion(l))
    return RIC_OK;
  for (size_t i = 0; i < s->arcs.coordinates; i++)
    if (s->arcs.at_start[i] != NO_UNKNOWN)
      add_impact(l, s->arcs.at_start[i], 0, s->x, -1);
  return set_turning_gaps(l->s, s->arcs.at_start, 0, error);
}

static ric_status begin_piece(const piece_run *run, void *user, ric_error *error) {
  examination *l = user;
  ric_shooting *s = l->s;
  bool first = run->piece == s->arcs.pieces;
  if (l->spectrum && first)
    RIC_TRY(shooting_spectrum_begin(s, error));
  if (!l->orbit)
    return RIC_OK;
  if (!first && (run->piece - 1)->how == PIECE_IMPACT)
    system_gaps_after(&s->gaps, (run->piece - 1)->obstacle);
  if (run->end < run->begin - s->grazing_tol * l->period) /* the order of simultaneous impacts is free */
    s->out_of_order = true;
  return first ? begin_orbit(l, run, error) : RIC_OK;
}

/* State at half the period, of motions that are not even: on the segment that contains it. At the end of a segment
 * it is the state before an impact, so a segment does not contain its start; the tolerance ensures that one of both
 * contains it. */
static void set_half_state(examination *l, const ric_segment *piece, double end) {
  double x = (l->origin + l->period / 2 - piece->start) / piece->length, slack = half_tol * l->period;
  slack /= fabs(piece->length);
  if (!(x > slack && x <= end + slack))
    return;
  ric_segment_state(piece, fmin(x, end), l->orbit->q_half + piece->first,
                    l->orbit->speeds > 0 ? l->orbit->v_half + piece->first : NULL);
}

static void evaluate_segment(const ric_segment *piece, double end, void *user) {
  examination *l = user;
  system_gaps_segment(&l->s->gaps, piece, end);
  if (!is_even_motion(l))
    set_half_state(l, piece, end);
}

/* The state at half the period, and the impacts there. */
static ric_status end_half(examination *l, const piece_run *run, ric_error *error) {
  const ric_shooting *s = l->s;
  size_t n = s->arcs.coordinates;
  memcpy(l->orbit->q_half, s->x, n * sizeof *s->x);
  memcpy(l->orbit->v_half, s->x + n, n * sizeof *s->x);
  for (size_t i = 0; i < n; i++)
    if (s->arcs.at_half[i] != NO_UNKNOWN)
      add_impact(l, s->arcs.at_half[i], run->end, s->x, 1);
  return set_turning_gaps(l->s, s->arcs.at_half, run->end, error);
}

static ric_status end_piece(const piece_run *run, void *user, ric_error *error) {
  examination *l = user;
  const ric_shooting *s = l->s;
  if (l->spectrum)
    RIC_TRY(shooting_spectrum_pass(l->s, run, error));
  if (!l->orbit)
    return RIC_OK;
  if (run->piece->how == PIECE_IMPACT)
    add_impact(l, run->piece->obstacle, run->end, s->x, 1);
  if (run->piece->how == PIECE_IMPACT && run->piece->closes)
    system_gaps_close(&l->s->gaps, run->piece->obstacle, run->end, s->x, l->z);
  return run->piece->how == PIECE_HALF ? end_half(l, run, error) : RIC_OK;
}

/* Adds the mirror images of the impacts between: those in the second half of an even motion. */
static void add_mirrored(examination *l) {
  ric_orbit *o = l->orbit;
  size_t first = l->s->arcs.start_count, count = l->s->arcs.sequence_count;
  for (size_t i = first + count; is_even_motion(l) && i-- > first;) {
    size_t k = l->impacts++;
    o->impact_obstacle[k] = o->impact_obstacle[i];
    o->impact_time[k] = time_in_period(l, l->period - o->impact_time[i]);
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

/* Marks the obstacles that the motion hits. */
static ric_status reserve_gaps(ric_shooting *s, ric_error *error) {
  const arc_plan *a = &s->arcs;
  system_gaps *g = &s->gaps;
  if (g->system)
    return RIC_OK;
  ric_status status = system_gaps_init(g, arc_runner_flow(&s->runner), error);
  if (status != RIC_OK) {
    system_gaps_clear(g);
    return status;
  }
  for (size_t k = 0; k < a->sequence_count; k++)
    g->hit[a->sequence[k]] = true;
  for (size_t i = 0; a->kind == RIC_MOTION_EVEN && i < a->coordinates; i++) {
    if (a->at_start[i] != NO_UNKNOWN)
      g->hit[a->at_start[i]] = true;
    if (a->at_half[i] != NO_UNKNOWN)
      g->hit[a->at_half[i]] = true;
  }
  return RIC_OK;
}

static ric_status reserve(examination *l, ric_error *error) {
  ric_shooting *s = l->s;
  if (l->orbit)
    RIC_TRY(check_room(s, l->orbit, error));
  if (l->orbit)
    RIC_TRY(reserve_gaps(s, error));
  return l->spectrum ? shooting_spectrum_reserve(s, error) : RIC_OK;
}

static ric_status finish_orbit(examination *l, const double *F, ric_error *error) {
  const ric_shooting *s = l->s;
  ric_orbit *o = l->orbit;
  if (s->gaps.trouble)
    return ric_fail(error, RIC_ECALLBACK, "a gap of the motion could not be evaluated: %s", s->gaps.trouble);
  add_mirrored(l);
  o->residual = largest(F, s->arcs.unknowns);
  return RIC_OK;
}

ric_status shooting_examine(ric_shooting *s, const double *z, double given, int what, double *F, double *J,
                            double *F_given, ric_orbit *orbit, ric_error *error) {
  examination l = {.s = s, .z = z, .orbit = what & EXAMINE_ORBIT ? orbit : NULL, .spectrum = what & EXAMINE_SPECTRUM};
  const shooting_observer observer = {.begins = begin_piece,
                                      .segment = l.orbit ? evaluate_segment : NULL,
                                      .ends = end_piece,
                                      .whole = l.spectrum,
                                      .user = &l};
  double *residual = F ? F : s->residual;
  RIC_TRY(reserve(&l, error));
  RIC_TRY(shooting_period(s, z, given, &l.period, error));
  if (l.orbit) {
    s->out_of_order = false;
    system_gaps_begin(&s->gaps, s->grazing_tol);
  }
  RIC_TRY(shooting_evaluate(s, z, given, residual, J, F_given, &observer, error));
  return l.orbit ? finish_orbit(&l, residual, error) : RIC_OK;
}

/* The verdict on a motion found by shooting. */

/* A motion with a larger residual, relative to 1 + the largest unknown, is no solution. */
static const double residual_tol = 1e-6;

/* Sets `failed` for solutions of the equations that are not motions. */
static ric_status set_failure(ric_shooting *s, const double *z, ric_orbit *o, ric_error *error) {
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
    admissibility_violated(o, o->residual, most);
  else
    snprintf(o->reason, sizeof o->reason, "energy is not conserved: the ends of the motion differ by %.3g", added);
  return RIC_OK;
}

static ric_status set_start(ric_shooting *s, const double *z, double given, ric_orbit *o, ric_error *error) {
  size_t n = s->arcs.coordinates;
  RIC_TRY(shooting_period(s, z, given, &o->period, error));
  piece_run run = shooting_begin(s, 0, z, o->period, OUTPUT_STATE);
  memcpy(o->q, s->x, n * sizeof *s->x);
  if (s->arcs.speeds > 0)
    memcpy(o->v, s->x + n, s->arcs.speeds * sizeof *s->x);
  o->energy = ric_system_energy(s->system, run.begin, o->q, o->v);
  return RIC_OK;
}

ric_status shooting_verdict(ric_shooting *s, const double *z, double given, ric_orbit *o, ric_error *error) {
  RIC_TRY(set_start(s, z, given, o, error));
  o->condition = NAN;
  o->mode = -1;
  o->harmonic = 0;
  const orbit_facts f = {.names = obstacle_names_of(s->system),
                         .gaps = &s->gaps.watch,
                         .slow = s->grazing_tol,
                         .out_of_order = s->out_of_order};
  admissibility_clearance(&f, o);
  admissibility_find(&f, o);
  return set_failure(s, z, o, error);
}

ric_status ric_shooting_orbit(ric_shooting *s, const double *z, double given, ric_orbit *orbit, ric_error *error) {
  REQUIRE(error, {"shooting", s}, {"z", z}, {"orbit", orbit});
  RIC_TRY(shooting_examine(s, z, given, EXAMINE_ORBIT, NULL, NULL, NULL, orbit, error));
  return shooting_verdict(s, z, given, orbit, error);
}

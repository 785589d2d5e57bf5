/* Grazing motions: found along a family, refined, rejected if degenerate; their curves in two parameters. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "family/family.h"
#include "ricochet/grazing.h"
#include "grazing.h"
#include "numeric/required.h"
#include "shooting/shooting.h"

/* Minima of the gap of a motion. */

/** A minimum of a gap along a solution of shooting. */
typedef struct gap_minimum {
  size_t obstacle;
  double time; /* in [0, T) */
  double gap, rate, acceleration;
  double *x;     /* [n + m] state there; owned by the caller */
  double *rates; /* [n + m] of the free motion */
} gap_minimum;

enum { MOST_MINIMUM_STEPS = 30 };

/* Steps below this fraction of the period are rounding. */
static const double minimum_tol = 1e-15;

/* Largest step of Newton's method, so that it does not leave the initial minimum. */
static const double longest_step = 0.05;

/* Into [0, T): a time below zero by less than rounding at T is zero. */
static double folded(double time, double period) {
  const double t = fmod(time, period), shifted = t < 0 ? t + period : t;
  return shifted < period ? shifted : 0;
}

static ric_status read_gap(const ric_system *s, gap_minimum *k, ric_error *error) {
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

/* If the gap is not convex, a step down its slope. */
static double step_of(const gap_minimum *k, double period) {
  const double step = -k->rate / fabs(k->acceleration), most = longest_step * period;
  return isnan(step) ? 0 : fmax(-most, fmin(step, most));
}

/** Moves a grazing contact to the minimum of its gap nearest in time, and sets the other fields.
 *  @returns RIC_ENUMERIC if there is none within a period; as ric_shooting_transfer */
static ric_status gap_minimum_find(ric_shooting *s, const double *z, double given, double period, gap_minimum *k,
                                   ric_error *error) {
  double before = INFINITY;
  k->time = folded(k->time, period);
  for (int i = 0; i < MOST_MINIMUM_STEPS; i++) {
    RIC_TRY(ric_shooting_transfer(s, z, given, k->time, k->time, k->x, NULL, error));
    RIC_TRY(read_gap(s->system, k, error));
    const double step = step_of(k, period), size = fabs(step);
    if (k->acceleration > 0 &&
        (size <= minimum_tol * period || (size < sqrt(minimum_tol) * period && size > before / 2)))
      return RIC_OK;
    if (k->rate == 0)
      break;
    before = size;
    k->time = folded(k->time + step, period);
  }
  return ric_fail(error, RIC_ENUMERIC, "the gap of obstacle %zu has no minimum near t = %g", k->obstacle, k->time);
}

/* Grazing points that the theory excludes. They give RIC_ENUMERIC with the violated condition. */

enum { SAMPLES = 129 };

static const double largest_tol = 1e-2; /* largest grazing_tol of trajectories */

/* Times closer than this, relative to the period, are equal. */
static const double same_time_tol = 1e-5;

static double sample_range(const ric_system *s, size_t obstacle, double period, const double *q) {
  double low = INFINITY, high = -INFINITY;
  for (size_t k = 0; k < SAMPLES; k++) {
    const double gap = ric_system_gap(s, obstacle, period * (double)k / (SAMPLES - 1), q + k * s->coordinates);
    low = fmin(low, gap);
    high = fmax(high, gap);
  }
  return high - low;
}

/** Variation of the gap of an obstacle along a motion: largest minus smallest of samples. */
static ric_status degenerate_size(ric_shooting *s, const double *z, double given, size_t obstacle, double *size,
                                  ric_error *error) {
  const ric_system *system = s->system;
  const double period = arcs_period(&s->arcs, z, given);
  double *q = malloc(SAMPLES * s->arcs.size * sizeof *q);
  if (!q)
    return ric_fail(error, RIC_ENOMEM, "no memory for %d states of %zu numbers", SAMPLES, s->arcs.size);
  const ric_status status = ric_shooting_states(s, z, given, SAMPLES, q, q + SAMPLES * system->coordinates, error);
  if (status == RIC_OK)
    *size = sample_range(system, obstacle, period, q);
  free(q);
  RIC_TRY(status);
  if (*size > 0 && *size < INFINITY)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "the gap of obstacle %zu changes by %g along the motion: it is at rest",
                  obstacle, *size);
}

/** A_g near zero. */
static ric_status degenerate_acceleration(const gap_minimum *k, double period, double size,
                                          const ric_grazing_options *o, ric_error *error) {
  if (k->acceleration * period * period > o->degenerate * size)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "A_g near zero: the gap of obstacle %zu has the second derivative %.3g at t = %g", k->obstacle,
                  k->acceleration, k->time);
}

/* Contacts of an event-driven run other than the grazing contact itself. */
typedef struct contact_record {
  const ric_grazing *g;
  double slowest; /* gap rate of impacts, below which they are grazing contacts */
  char found[160];
} contact_record;

/* An impact whose depth is rounding, or nearly so: it is a grazing contact, too, as which it may be met. */
static bool is_slow(const contact_record *w, const ric_event *e) {
  return (e->kind == RIC_EVENT_TRANSVERSAL || e->kind == RIC_EVENT_SIMULTANEOUS) && -e->gap_rate <= w->slowest;
}

/* A slow impact is that much before the minimum of the gap. */
static bool is_grazing_contact(const contact_record *w, const ric_event *e) {
  const ric_grazing *g = w->g;
  const double early = is_slow(w, e) ? -2 * e->gap_rate / g->local.acceleration : 0;
  const double apart = fabs(remainder(e->time - g->time, g->period));
  return e->obstacle == g->local.obstacle && apart <= same_time_tol * g->period + early;
}

static int on_contact(const ric_event *e, void *user) {
  contact_record *w = user;
  if (is_grazing_contact(w, e))
    return 0;
  if (e->kind == RIC_EVENT_GRAZING)
    snprintf(w->found, sizeof w->found,
             "two grazing points at once: the gap of obstacle %zu has the minimum %.3g at t = %g, too", e->obstacle,
             e->depth, e->time);
  else if (is_slow(w, e))
    snprintf(w->found, sizeof w->found,
             "two grazing points at once: obstacle %zu is touched with the gap rate %.3g at t = %g, too", e->obstacle,
             e->gap_rate, e->time);
  else if (e->kind != RIC_EVENT_CONTACT && e->kind != RIC_EVENT_PARTING && e->kind != RIC_EVENT_TRANSVERSAL)
    snprintf(w->found, sizeof w->found, "an impact that is not transversal: %s, obstacle %zu, at t = %g",
             ric_event_name(e->kind), e->obstacle, e->time);
  return w->found[0] != 0;
}

static ric_status run_trajectory(ric_trajectory *t, const ric_shooting *s, const double *x, double from,
                                 contact_record *w, ric_error *error) {
  const ric_observer observer = {.event = on_contact, .user = w};
  ric_run run;
  RIC_TRY(ric_trajectory_start(t, from, x, x + s->arcs.coordinates, error));
  RIC_TRY(ric_trajectory_run(t, from + w->g->period * (1 - same_time_tol), &observer, &run, error));
  if (run.outcome == RIC_RUN_COMPLETED || run.outcome == RIC_RUN_ENDED)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "%s at t = %g: %s", ric_run_outcome_name(run.outcome), run.time, run.reason);
}

/** Other grazing points, and impacts that are not transversal: by an event-driven run over a period. */
static ric_status degenerate_motion(ric_family *f, const double *z, const ric_grazing *g, double size,
                                    const ric_grazing_options *o, ric_error *error) {
  ric_shooting *s = f->shooting;
  contact_record w = {.g = g, .slowest = o->transversal * size / g->period};
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_trajectory *t = NULL;
  options.flow = f->problem.motion.flow;
  options.grazing_tol = fmin(o->touch_tol * size, largest_tol);
  options.poll = s->poll;
  double *x = malloc(g->numbers * sizeof *x);
  const double from =
      g->time + same_time_tol * g->period; /* just after the grazing contact, which may be an impact by rounding */
  ric_status status = x ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for %zu numbers", g->numbers);
  if (status == RIC_OK)
    status = ric_shooting_transfer(s, z, g->given, from, from, x, NULL, error);
  if (status == RIC_OK)
    status = ric_trajectory_create(s->system, &options, &t, error);
  if (status == RIC_OK)
    status = run_trajectory(t, s, x, from, &w, error);
  ric_trajectory_destroy(&t);
  free(x);
  RIC_TRY(status);
  return w.found[0] ? ric_fail(error, RIC_ENUMERIC, "%s", w.found) : RIC_OK;
}

/* Grazing motions: found along a family, and refined. */

enum { MOST_STEPS = 12, MOST_SHORTER = 12 };

/* Step of the difference for the derivative of the minimum of the gap by the parameter, relative to 1 + |p|; shorter if
 * the minimum changes by more than a fraction of the variation of the gap, or is not found. */
static const double slope_step = 1e-4, longest_change = 1e-3, shorter = 0.125;

/* Minima below this, relative to the variation of the gap, are zero to rounding. */
static const double gap_tol = 4e-16;

/* Largest minimum of the gap of a motion given as grazing, relative to the variation of the gap. */
static const double nearly = 1e-2;

ric_grazing_options ric_grazing_options_default(void) {
  return (ric_grazing_options){.touch_tol = 1e-6, .degenerate = 1e-6, .transversal = 1e-6};
}

void ric_grazing_clear(ric_grazing *g) {
  if (!g)
    return;
  ric_grazing_local_clear(&g->local);
  free(g->x);
  free(g->z);
  *g = (ric_grazing){0};
}

/* --- life --------------------------------------------------------------------------------------------------------- */

ric_status ric_grazing_init(ric_grazing *g, const ric_shooting *s, ric_error *error) {
  REQUIRE(error, {"grazing", g}, {"shooting", s});
  const size_t numbers = s->arcs.size, unknowns = s->arcs.unknowns;
  *g = (ric_grazing){.numbers = numbers, .unknowns = unknowns, .slope = NAN};
  g->x = calloc(numbers, sizeof *g->x);
  g->z = calloc(unknowns, sizeof *g->z);
  if (g->x && g->z && ric_grazing_local_init(&g->local, numbers, NULL) == RIC_OK)
    return RIC_OK;
  ric_grazing_clear(g);
  return ric_fail(error, RIC_ENOMEM, "no memory for a grazing motion of %zu numbers", numbers);
}

/* --- the minimum of the gap as a function of the parameter --- */

/* The motion at a parameter, from one at another. */
typedef struct minimum {
  ric_family *f;
  double *z;     /* [unknowns] */
  double *kept;  /* [unknowns] start of a difference */
  double period; /* of it */
  double size;   /* variation of the gap */
  gap_minimum touch;
} minimum;

static ric_status solve_minimum(minimum *k, double parameter, ric_error *error) {
  ric_family *f = k->f;
  RIC_TRY(family_set(f, parameter, f->problem.second, error));
  RIC_TRY(ric_shooting_solve(f->shooting, k->z, f->given, 0, NULL, error));
  k->period = arcs_period(&f->shooting->arcs, k->z, f->given);
  return gap_minimum_find(f->shooting, k->z, f->given, k->period, &k->touch, error);
}

/* Central difference; afterwards z and the grazing contact are those at the last parameter. */
static ric_status try_slope(minimum *k, double parameter, double h, double *slope, ric_error *error) {
  double gap[2];
  for (int side = 0; side < 2; side++) {
    RIC_TRY(solve_minimum(k, parameter + (side ? h : -h), error));
    gap[side] = k->touch.gap;
  }
  *slope = (gap[1] - gap[0]) / (2 * h);
  if (fabs(gap[1] - gap[0]) > longest_change * k->size)
    return ric_fail(error, RIC_ENUMERIC, "the minimum of the gap of obstacle %zu changes by %.3g near %.9g",
                    k->touch.obstacle, gap[1] - gap[0], parameter);
  return RIC_OK;
}

static ric_status find_slope(minimum *k, double parameter, double *slope, ric_error *error) {
  const size_t unknowns = k->f->unknowns;
  const double time = k->touch.time;
  double h = slope_step * (1 + fabs(parameter));
  memcpy(k->kept, k->z, unknowns * sizeof *k->z);
  ric_status status = try_slope(k, parameter, h, slope, error);
  for (int i = 0; (status == RIC_ENUMERIC || status == RIC_EINVAL) && i < MOST_SHORTER; i++) {
    memcpy(k->z, k->kept, unknowns * sizeof *k->z);
    k->touch.time = time;
    status = try_slope(k, parameter, h *= shorter, slope, error);
  }
  RIC_TRY(status);
  if (*slope != 0 && isfinite(*slope))
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "the minimum of the gap of obstacle %zu does not change with the parameter at %.9g",
                  k->touch.obstacle, parameter);
}

/* Newton's method with fixed slope: each step multiplies the gap by the relative error of the slope. */
static ric_status refine(minimum *k, ric_grazing *g, ric_error *error) {
  double best = INFINITY;
  RIC_TRY(find_slope(k, g->parameter, &g->slope, error));
  for (int i = 0; i < MOST_STEPS; i++) {
    RIC_TRY(solve_minimum(k, g->parameter, error));
    const double gap = fabs(k->touch.gap);
    if (gap <= gap_tol * k->size || (gap >= best / 2 && best < sqrt(gap_tol) * k->size))
      return RIC_OK;
    best = gap;
    g->parameter -= k->touch.gap / g->slope;
  }
  return ric_fail(error, RIC_ENUMERIC, "the grazing point of obstacle %zu does not converge near parameter %.9g",
                  k->touch.obstacle, g->parameter);
}

/** Sets all fields that follow from a grazing point whose z, parameters and state x are set. The family has its
 * parameters. @returns as ric_grazing_local_find */
/* --- from a motion that nearly grazes --- */

static ric_status grazing_keep(const ric_family *f, const gap_minimum *at, double period, ric_grazing *g,
                               ric_error *error) {
  g->given = f->given;
  g->period = period;
  g->time = at->time;
  g->phase = at->time / period;
  return ric_grazing_local_find(f->problem.system, at->obstacle, at->time, at->x, &g->local, error);
}

static ric_status fill(minimum *k, ric_grazing *g, const ric_grazing_options *o, ric_error *error) {
  RIC_TRY(solve_minimum(k, g->parameter, error));
  if (!(fabs(k->touch.gap) <= nearly * k->size))
    return ric_fail(error, RIC_ENUMERIC,
                    "the gap of obstacle %zu is %.3g at its minimum near t = %g, expected 0: no grazing point",
                    k->touch.obstacle, k->touch.gap, k->touch.time);
  RIC_TRY(degenerate_acceleration(&k->touch, k->period, k->size, o, error));
  RIC_TRY(refine(k, g, error));
  RIC_TRY(grazing_keep(k->f, &k->touch, k->period, g, error));
  return degenerate_motion(k->f, k->z, g, k->size, o, error);
}

static ric_status fill_grazing(ric_family *f, double parameter, const gap_minimum *at, const ric_grazing_options *o,
                               ric_grazing *g, ric_error *error) {
  minimum k = {.f = f, .z = g->z, .touch = *at};
  g->parameter = parameter;
  g->second = f->problem.second;
  k.touch.x = g->x;
  RIC_TRY(family_set(f, parameter, f->problem.second, error));
  k.touch.rates = malloc((g->numbers + g->unknowns) * sizeof *k.touch.rates);
  if (!k.touch.rates)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu rates", g->numbers);
  k.kept = k.touch.rates + g->numbers;
  ric_status status = degenerate_size(f->shooting, k.z, f->given, at->obstacle, &k.size, error);
  if (status == RIC_OK)
    status = fill(&k, g, o, error);
  free(k.touch.rates);
  return status;
}

static ric_status check_start(const ric_family *f, const ric_grazing *g, const ric_grazing_options *o,
                              ric_error *error) {
  if (f->problem.motion.kind == RIC_MOTION_EVEN)
    return ric_fail(error, RIC_EINVAL, "motion.kind = even, expected forced, autonomous or conservative");
  if (g->numbers != f->shooting->arcs.size || g->unknowns != f->unknowns)
    return ric_fail(error, RIC_EINVAL, "room for %zu numbers and %zu unknowns, expected %zu and %zu", g->numbers,
                    g->unknowns, f->shooting->arcs.size, f->unknowns);
  const double values[] = {o->touch_tol, o->degenerate, o->transversal};
  static const char *const names[] = {"touch_tol", "degenerate", "transversal"};
  for (int k = 0; k < 3; k++)
    if (!(values[k] > 0 && values[k] < 1))
      return ric_fail(error, RIC_EINVAL, "%s = %g, expected a number between 0 and 1", names[k], values[k]);
  return RIC_OK;
}

ric_status ric_grazing_take(ric_family *f, const double *z, double parameter, size_t obstacle, double time,
                            const ric_grazing_options *options, ric_grazing *g, ric_error *error) {
  REQUIRE(error, {"family", f}, {"z", z}, {"grazing", g});
  const ric_grazing_options o = options ? *options : ric_grazing_options_default();
  const gap_minimum at = {.obstacle = obstacle, .time = time};
  RIC_TRY(check_start(f, g, &o, error));
  if (obstacle >= f->problem.system->obstacle_count)
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected less than %zu", obstacle,
                    f->problem.system->obstacle_count);
  if (!isfinite(time))
    return ric_fail(error, RIC_EINVAL, "time = %g, expected a finite one", time);
  if (z != g->z)
    memcpy(g->z, z, g->unknowns * sizeof *z);
  family_forget(f);
  return fill_grazing(f, parameter, &at, &o, g, error);
}

/* --- along a family ----------------------------------------------------------------------------------------------- */

/* A search along a family, with the first grazing point. */
typedef struct grazing_run {
  ric_grazing *g;
  ric_grazing_search *search;
  bool admissible; /* leave out motions that pass an obstacle elsewhere */
  bool began, found;
} grazing_run;

static int stop_at_grazing(const ric_family_point *point, void *user) {
  grazing_run *r = user;
  ric_grazing_search *s = r->search;
  r->began = true;
  s->reached = point->parameter;
  if (point->kind != RIC_FAMILY_GRAZING || (r->admissible && point->orbit->outcome == RIC_INADMISSIBLE))
    return 0;
  r->found = true;
  s->parameter = point->parameter;
  s->period = point->orbit->period;
  s->time = point->time;
  s->obstacle = point->obstacle;
  memcpy(r->g->z, point->z, r->g->unknowns * sizeof *point->z);
  return 1;
}

/* @returns RIC_OK where it is found; else why not, and the outcome says what that is */
static ric_status search_along(ric_family *f, double *z, double parameter, const ric_grazing_options *o, grazing_run *r,
                               ric_error *error) {
  ric_grazing_search *s = r->search;
  *s = (ric_grazing_search){.reached = parameter, .parameter = NAN, .period = NAN, .time = NAN, .obstacle = SIZE_MAX};
  ric_status status = ric_family_follow(f, z, parameter, NULL, stop_at_grazing, r, &s->run, error);
  if (status != RIC_OK) {
    s->outcome = r->began ? RIC_GRAZING_SEARCH_FAILED : RIC_GRAZING_SEARCH_FAILED_START;
    return status;
  }
  if (!r->found) {
    const ric_curve_end end = s->run.end;
    const bool whole = end == RIC_CURVE_BOUND || end == RIC_CURVE_POINTS || end == RIC_CURVE_CLOSED;
    s->ended = true;
    s->outcome = whole ? RIC_GRAZING_SEARCH_NONE : RIC_GRAZING_SEARCH_FAILED;
    return ric_fail(error, RIC_ENUMERIC, "no obstacle is touched from %.9g to %.9g, where the family ends: %s%s%.100s",
                    parameter, s->reached, ric_curve_end_name(end), s->run.reason[0] ? ": " : "", s->run.reason);
  }
  status = fill_grazing(f, s->parameter, &(gap_minimum){.obstacle = s->obstacle, .time = s->time}, o, r->g, error);
  s->outcome = status == RIC_OK         ? RIC_GRAZING_SEARCH_FOUND
               : status == RIC_ENUMERIC ? RIC_GRAZING_SEARCH_DEGENERATE
                                        : RIC_GRAZING_SEARCH_FAILED;
  return status;
}

ric_status ric_grazing_find(ric_family *f, double *z, double parameter, const ric_grazing_options *options,
                            ric_grazing *g, ric_error *error) {
  REQUIRE(error, {"family", f}, {"z", z}, {"grazing", g});
  const ric_grazing_options o = options ? *options : ric_grazing_options_default();
  ric_grazing_search search;
  grazing_run r = {.g = g, .search = &search};
  RIC_TRY(check_start(f, g, &o, error));
  return search_along(f, z, parameter, &o, &r, error);
}

ric_status ric_grazing_search_along(ric_family *f, double *z, double parameter, const ric_grazing_options *options,
                                    ric_grazing_search *search, ric_grazing *g, ric_error *error) {
  REQUIRE(error, {"family", f}, {"z", z}, {"search", search}, {"grazing", g});
  const ric_grazing_options o = options ? *options : ric_grazing_options_default();
  grazing_run r = {.g = g, .search = search, .admissible = true};
  ric_error why = {0};
  RIC_TRY(check_start(f, g, &o, error));
  const ric_status status = search_along(f, z, parameter, &o, &r, &why);
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    return ric_fail(error, status, "%s", why.message);
  if (status != RIC_OK)
    snprintf(search->reason, sizeof search->reason, "%s", why.message);
  return RIC_OK;
}

/* Curves of grazing in two parameters, with the criterion along them. */

typedef struct tracer {
  ric_family *f;
  ric_grazing grazing; /* of the last point */
  ric_grazing_map map;
  ric_grazing_criterion criterion;
  double coefficients[RIC_GRAZING_CURVE_COEFFICIENTS];
  size_t count;
  double *rates; /* [n + m] */
  int (*seen)(const ric_grazing_curve_point *point, void *user);
  void *user;
  ric_status status; /* of an evaluation that failed in the callback */
  ric_error *error;
} tracer;

static ric_status find_criterion(tracer *t, const ric_family_curve_point *p, ric_error *error) {
  ric_family *f = t->f;
  ric_grazing *g = &t->grazing;
  const size_t obstacle = g->local.obstacle;
  const system_gaps *gaps = &f->shooting->gaps; /* of the point's orbit: where the gap is zero on the curve */
  const gap_found *least = gaps->hit[obstacle] ? &gaps->watch.own : &gaps->watch.free;
  gap_minimum at = {.obstacle = obstacle, .time = least->time, .x = g->x, .rates = t->rates};
  if (least->obstacle != obstacle)
    return ric_fail(error, RIC_ENUMERIC, "obstacle %zu grazes, expected obstacle %zu", least->obstacle, obstacle);
  memcpy(g->z, p->z, g->unknowns * sizeof *g->z);
  g->parameter = p->parameter;
  g->second = p->second;
  RIC_TRY(gap_minimum_find(f->shooting, g->z, p->given, p->orbit->period, &at, error));
  RIC_TRY(grazing_keep(f, &at, p->orbit->period, g, error));
  const ric_grazing_plane plane = {.time = g->time};
  section here;
  const ric_status status = section_open(&here, f, g, &plane, &t->map, error);
  section_close(&here);
  RIC_TRY(status);
  return ric_grazing_criterion_find(&t->map, NULL, &t->criterion, t->coefficients, t->count, NULL, error);
}

static ric_status tests(const ric_family_curve_point *point, double *values, void *user, ric_error *error) {
  tracer *t = user;
  RIC_TRY(find_criterion(t, point, error));
  memcpy(values, t->coefficients, t->count * sizeof *values);
  return RIC_OK;
}

static int report_grazing_point(const ric_family_curve_point *p, void *user) {
  tracer *t = user;
  t->status = find_criterion(t, p, t->error);
  if (t->status != RIC_OK)
    return 1;
  const ric_grazing_curve_point point = {.grazing = &t->grazing,
                                         .criterion = &t->criterion,
                                         .coefficients = t->coefficients,
                                         .count = t->count,
                                         .zero = p->zero};
  return t->seen ? t->seen(&point, t->user) : 0;
}

static ric_status begin_curve(tracer *t, const ric_grazing *from, ric_error *error) {
  RIC_TRY(ric_grazing_init(&t->grazing, t->f->shooting, error));
  t->grazing.time = from->time;
  t->grazing.local.obstacle = from->local.obstacle;
  RIC_TRY(ric_grazing_map_init(&t->map, ric_grazing_coordinates(from, t->f->shooting), error));
  t->rates = malloc(from->numbers * sizeof *t->rates);
  return t->rates ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for %zu rates", from->numbers);
}

ric_status ric_grazing_trace(ric_family *f, const ric_grazing *from, const ric_curve_options *options, size_t count,
                             int (*seen)(const ric_grazing_curve_point *point, void *user), void *user,
                             ric_curve_run *run, ric_error *error) {
  REQUIRE(error, {"family", f}, {"from", from}, {"run", run});
  ric_error own;
  tracer t = {.f = f, .count = count, .seen = seen, .user = user, .error = error ? error : &own};
  const ric_family_point point = {.kind = RIC_FAMILY_GRAZING,
                                  .parameter = from->parameter,
                                  .unknowns = from->unknowns,
                                  .z = from->z,
                                  .given = from->given,
                                  .obstacle = from->local.obstacle,
                                  .time = from->time};
  const ric_family_curve_tests along = {count, tests, &t};
  if (count > RIC_GRAZING_CURVE_COEFFICIENTS)
    return ric_fail(error, RIC_EINVAL, "count = %zu, expected at most %d coefficients", count,
                    RIC_GRAZING_CURVE_COEFFICIENTS);
  ric_status status = begin_curve(&t, from, t.error);
  if (status == RIC_OK)
    status = ric_family_trace(f, &point, options, &along, report_grazing_point, &t, run, t.error);
  if (status == RIC_OK)
    status = t.status;
  ric_grazing_clear(&t.grazing);
  ric_grazing_map_clear(&t.map);
  free(t.rates);
  return status;
}

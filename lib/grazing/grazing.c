/* Grazing motions: found along a family, and made exact. */
#include "ricochet/grazing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "degenerate.h"
#include "grazing_parts.h"

enum { MOST_STEPS = 12, MOST_SHORTER = 12 };

/* Step of the difference that tells how the minimum of the gap changes with the parameter, over 1 + |p|; shorter where
 * that is too long: where the minimum changes by more than a part of the size of the gap's changes, or is not found. */
static const double slope_step = 1e-4, longest_change = 1e-3, shorter = 0.125;

/* Minima this small, over the size of the gap's changes, are zero to rounding. */
static const double gap_tol = 4e-16;

/* A motion given as one that grazes may be this far from it, over the size of the gap's changes. */
static const double nearly = 1e-2;

ric_grazing_options ric_grazing_options_default(void) {
  return (ric_grazing_options){.touch_tol = 1e-6, .degenerate = 1e-6, .transversal = 1e-6};
}

/* --- life --------------------------------------------------------------------------------------------------------- */

ric_status ric_grazing_init(ric_grazing *g, const ric_shooting *s, ric_error *error) {
  const size_t numbers = s->arcs.size, unknowns = s->arcs.unknowns;
  *g = (ric_grazing){.numbers = numbers, .unknowns = unknowns, .slope = NAN};
  g->x = calloc(numbers, sizeof *g->x);
  g->z = calloc(unknowns, sizeof *g->z);
  if (g->x && g->z && ric_grazing_local_init(&g->local, numbers, NULL) == RIC_OK)
    return RIC_OK;
  ric_grazing_clear(g);
  return ric_fail(error, RIC_ENOMEM, "no memory for a grazing motion of %zu numbers", numbers);
}

void ric_grazing_clear(ric_grazing *g) {
  ric_grazing_local_clear(&g->local);
  free(g->x);
  free(g->z);
  *g = (ric_grazing){0};
}

/* --- the minimum of the gap as a function of the parameter --- */

/* The motion at a parameter, from one at another. */
typedef struct minimum {
  ric_family *f;
  double *z;     /* [unknowns] */
  double *kept;  /* [unknowns] where a difference sets out */
  double period; /* of it */
  double size;   /* of the gap's changes */
  touch touch;
} minimum;

static ric_status solve(minimum *k, double parameter, ric_error *error) {
  ric_family *f = k->f;
  RIC_TRY(family_set(f, parameter, f->problem.second, error));
  RIC_TRY(ric_shooting_solve(f->shooting, k->z, f->given, 0, NULL, error));
  k->period = arcs_period(&f->shooting->arcs, k->z, f->given);
  return touch_find(f->shooting, k->z, f->given, k->period, &k->touch, error);
}

/* Central difference; z and the touch are those at the last parameter then. */
static ric_status try_slope(minimum *k, double parameter, double h, double *slope, ric_error *error) {
  double gap[2];
  for (int side = 0; side < 2; side++) {
    RIC_TRY(solve(k, parameter + (side ? h : -h), error));
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

/* Newton's method with a slope that stays: it shrinks the gap by the relative error of the slope each time. */
static ric_status refine(minimum *k, ric_grazing *g, ric_error *error) {
  double best = INFINITY;
  RIC_TRY(find_slope(k, g->parameter, &g->slope, error));
  for (int i = 0; i < MOST_STEPS; i++) {
    RIC_TRY(solve(k, g->parameter, error));
    const double gap = fabs(k->touch.gap);
    if (gap <= gap_tol * k->size || (gap >= best / 2 && best < sqrt(gap_tol) * k->size))
      return RIC_OK;
    best = gap;
    g->parameter -= k->touch.gap / g->slope;
  }
  return ric_fail(error, RIC_ENUMERIC, "the parameter at which obstacle %zu is touched does not converge near %.9g",
                  k->touch.obstacle, g->parameter);
}

/* --- from a motion that nearly grazes --- */

ric_status grazing_keep(const ric_family *f, const touch *at, double period, ric_grazing *g, ric_error *error) {
  g->given = f->given;
  g->period = period;
  g->time = at->time;
  g->phase = at->time / period;
  return ric_grazing_local_find(f->problem.system, at->obstacle, at->time, at->x, &g->local, error);
}

static ric_status fill(minimum *k, ric_grazing *g, const ric_grazing_options *o, ric_error *error) {
  RIC_TRY(solve(k, g->parameter, error));
  if (!(fabs(k->touch.gap) <= nearly * k->size))
    return ric_fail(error, RIC_ENUMERIC,
                    "the gap of obstacle %zu is %.3g at its minimum near t = %g: it is not touched", k->touch.obstacle,
                    k->touch.gap, k->touch.time);
  RIC_TRY(degenerate_acceleration(&k->touch, k->period, k->size, o, error));
  RIC_TRY(refine(k, g, error));
  RIC_TRY(grazing_keep(k->f, &k->touch, k->period, g, error));
  return degenerate_motion(k->f, k->z, g, k->size, o, error);
}

static ric_status take(ric_family *f, double parameter, const touch *at, const ric_grazing_options *o, ric_grazing *g,
                       ric_error *error) {
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

static ric_status check(const ric_family *f, const ric_grazing *g, const ric_grazing_options *o, ric_error *error) {
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
  const ric_grazing_options o = options ? *options : ric_grazing_options_default();
  const touch at = {.obstacle = obstacle, .time = time};
  RIC_TRY(check(f, g, &o, error));
  if (obstacle >= f->problem.system->obstacle_count)
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected less than %zu", obstacle,
                    f->problem.system->obstacle_count);
  if (!isfinite(time))
    return ric_fail(error, RIC_EINVAL, "time = %g, expected a finite one", time);
  if (z != g->z)
    memcpy(g->z, z, g->unknowns * sizeof *z);
  family_forget(f);
  return take(f, parameter, &at, &o, g, error);
}

/* --- along a family ----------------------------------------------------------------------------------------------- */

typedef struct walk {
  ric_grazing *g;
  touch at;
  double parameter, reached;
  bool found;
} walk;

static int see(const ric_family_point *point, void *user) {
  walk *w = user;
  w->reached = point->parameter;
  if (point->kind != RIC_FAMILY_GRAZING)
    return 0;
  w->found = true;
  w->parameter = point->parameter;
  w->at = (touch){.obstacle = point->obstacle, .time = point->time};
  memcpy(w->g->z, point->z, w->g->unknowns * sizeof *point->z);
  return 1;
}

ric_status ric_grazing_find(ric_family *f, double *z, double parameter, const ric_grazing_options *options,
                            ric_grazing *g, ric_error *error) {
  const ric_grazing_options o = options ? *options : ric_grazing_options_default();
  walk w = {.g = g, .reached = parameter};
  ric_curve_run run;
  RIC_TRY(check(f, g, &o, error));
  RIC_TRY(ric_family_follow(f, z, parameter, NULL, see, &w, &run, error));
  if (w.found)
    return take(f, w.parameter, &w.at, &o, g, error);
  return ric_fail(error, RIC_ENUMERIC, "no obstacle is touched from %.9g to %.9g, where the family ends: %s%s%.100s",
                  parameter, w.reached, ric_curve_end_name(run.end), run.reason[0] ? ": " : "", run.reason);
}

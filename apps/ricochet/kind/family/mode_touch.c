#include "mode_touch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Parts of a mode that are smaller are rounding of zero. */
static const double moves_tol = 1e-12;

/* Most steps of the walk in the factor, its first one and its longest one. */
enum { MOST_STEPS = 300 };
static const double first_step = 0.05, longest_step = 0.25;

/* A step along the family that only tells which way the energy goes: near the touch it may have an extreme. */
static const double feeler = 1e-4;

typedef struct search {
  mode_touch *touch;
  const lattice_model *model;
  ric_system *system; /* the lattice, its obstacles rigid */
  ric_family *family; /* along the period and the factor */
  double factor;      /* how far it has come */
} search;

/* The motion of the linear part, where the impact is lost at resonance. */
static ric_status take_mode(search *k, const ric_obstacle *obstacle, ric_error *error) {
  const size_t n = k->model->lattice.particles, mode = k->touch->mode, particle = obstacle->coordinate;
  double *frequency = calloc(n, sizeof *frequency), *shape = calloc(n * n, sizeof *shape);
  ric_status status = frequency && shape ? ric_normal_modes(k->system, frequency, shape, error)
                                         : ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu particles", n);
  const double w = status == RIC_OK ? frequency[mode] : 0, own = status == RIC_OK ? shape[mode * n + particle] : 0;
  if (status == RIC_OK && !(w > 0 && fabs(own) > moves_tol))
    status =
        ric_fail(error, RIC_EINVAL, "mode %zu, of the frequency %g, moves particle %zu by %.3g: it touches nothing",
                 mode, w, particle, own);
  for (size_t i = 0; i < n && status == RIC_OK; i++)
    k->touch->z[i] = i == particle ? 0 : obstacle->position * shape[mode * n + i] / own;
  if (status == RIC_OK)
    k->touch->period = (double)k->touch->swings * 2 * pi / w;
  free(frequency);
  free(shape);
  return status;
}

static ric_status set_both(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  const search *k = user;
  *given = p[0];
  return lattice_model_rescale(k->model, p[1], system, error);
}

static ric_status make_family(search *k, const ric_shooting_problem *motion, ric_error *error) {
  const ric_family_problem problem = {
      .system = k->system, .motion = *motion, .set = set_both, .user = k, .parameters = 2, .given = k->touch->period};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.poll = motion->poll;
  return ric_family_create(&problem, &options, &k->family, error);
}

/* A factor that falls has passed a fold. */
static int keep_last(const ric_family_curve_point *point, void *user) {
  search *k = user;
  if (point->second < k->factor)
    return 1;
  k->factor = point->second;
  k->touch->period = point->parameter;
  memcpy(k->touch->z, point->z, k->model->lattice.particles * sizeof *point->z);
  return 0;
}

static ric_status walk(search *k, const ric_shooting_problem *motion, const double *z, ric_error *error) {
  const ric_family_point touch = {.kind = RIC_FAMILY_IMPACT_LOST,
                                  .parameter = k->touch->period,
                                  .unknowns = k->model->lattice.particles,
                                  .z = z,
                                  .given = k->touch->period,
                                  .obstacle = motion->at_start[0]};
  ric_curve_options options = ric_curve_options_default();
  ric_curve_run run = {0};
  options.p_low = 0;
  options.p_high = 1;
  options.step = first_step;
  options.step_most = longest_step;
  options.points = MOST_STEPS;
  options.newton_tol = 1e-11; /* of an equation whose derivatives are differences */
  options.poll = motion->poll;
  RIC_TRY(ric_family_trace(k->family, &touch, &options, NULL, keep_last, k, &run, error));
  if (run.end == RIC_CURVE_BOUND && k->factor == 1)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "mode %zu touches its obstacle up to %.4g of the nonlinear terms, not with all of them%s%.80s",
                  k->touch->mode, k->factor, run.reason[0] ? ": " : "", run.reason);
}

static ric_status continue_touch(search *k, const ric_shooting_problem *motion, ric_error *error) {
  const size_t n = k->model->lattice.particles;
  double *z = malloc(n * sizeof *z);
  if (!z)
    return ric_fail(error, RIC_ENOMEM, "no memory for a motion of %zu particles", n);
  memcpy(z, k->touch->z, n * sizeof *z);
  const ric_status status = walk(k, motion, z, error);
  free(z);
  return status;
}

/* --- the side on which the impact pushes --- */

/* Two points of the family, at the touch and beside it. */
typedef struct look {
  size_t particle, seen;
  double energy[2], speed[2];
} look;

static int keep_point(const ric_family_point *point, void *user) {
  look *l = user;
  if (point->kind != RIC_FAMILY_REGULAR)
    return 0;
  l->energy[l->seen] = point->orbit->energy;
  l->speed[l->seen] = point->z[l->particle];
  return ++l->seen == 2;
}

/* Along the period, with all nonlinear terms. */
static ric_status look_beside(search *k, const ric_shooting_problem *motion, look *l, ric_error *error) {
  const ric_family_problem problem = {.system = k->system, .motion = *motion, .parameters = 1};
  ric_family_options options = ric_family_options_default();
  ric_curve_run run = {0};
  options.multipliers = false;
  options.curve.step = feeler;
  options.curve.poll = motion->poll;
  ric_family_destroy(&k->family);
  RIC_TRY(ric_family_create(&problem, &options, &k->family, error));
  RIC_TRY(ric_family_follow(k->family, k->touch->z, k->touch->period, NULL, keep_point, l, &run, error));
  if (l->seen == 2)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "no motion with an impact beside that in which mode %zu touches: %.100s",
                  k->touch->mode, run.reason);
}

/* A particle that is thrown back from a floor has a positive speed, from a wall a negative one. */
static ric_status find_rise(search *k, const ric_shooting_problem *motion, const ric_obstacle *obstacle,
                            ric_error *error) {
  look l = {.particle = obstacle->coordinate};
  RIC_TRY(lattice_model_rescale(k->model, 1, k->system, error));
  RIC_TRY(look_beside(k, motion, &l, error));
  const double slope = (l.energy[1] - l.energy[0]) * (l.speed[1] - l.speed[0]) * obstacle->side;
  k->touch->rise = (slope > 0) - (slope < 0);
  return RIC_OK;
}

ric_status mode_touch_find(mode_touch *touch, const lattice_model *model, const ric_shooting_problem *motion,
                           ric_error *error) {
  const ric_obstacle *obstacle = &model->obstacles[motion->at_start[0]];
  search k = {.touch = touch, .model = model};
  ric_status status = lattice_model_scaled(model, 0, &k.system, error);
  if (status == RIC_OK)
    status = take_mode(&k, obstacle, error);
  if (status == RIC_OK && !lattice_model_is_linear(model)) {
    status = make_family(&k, motion, error);
    if (status == RIC_OK)
      status = continue_touch(&k, motion, error);
  }
  if (status == RIC_OK)
    status = find_rise(&k, motion, obstacle, error);
  ric_family_destroy(&k.family);
  ric_system_destroy(&k.system);
  return status;
}

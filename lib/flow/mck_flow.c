/* Taylor flow of M-C-K systems.
 *
 * With q(t + h x) = sum_j c_j x^j, 0 <= x <= 1, and f_j the coefficients of the forces,
 *
 *   c_{j+2} = h^2 / ((j+1)(j+2)) [M^-1 (f_j - K c_j) - M^-1 C (j+1) c_{j+1} / h],
 *
 * where held contacts project the bracket at every level, which gives their forces level by level, too. A step is
 * expanded over the natural time of the system and rescaled to the length that the tolerance allows. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flow_method.h"
#include "hertz_series.h"
#include "model/mck_hold.h"
#include "taylor_step.h"

/* Trial steps grow at most so much: beyond it, rounding errors in the fastest modes would be amplified. */
static const double most_growth = 4;

typedef struct pressed_contact {
  const ric_obstacle *obstacle;
  bool acts; /* its force takes part in this step */
  hertz_series series;
} pressed_contact;

typedef struct mck_flow {
  ric_flow base;
  int order;
  double natural;       /* time in which the fastest linear motion turns by two radians; infinite without forces */
  double forced;        /* size that forcing gives a motion in that time */
  double *coef;         /* [order + 1][n] */
  double *acceleration; /* [n] */
  double *reaction;     /* [held coordinates][order - 1] coefficients of mu */
  mck_hold hold;
  pressed_contact *pressed; /* [pressed_count] */
  size_t pressed_count;
} mck_flow;

static const mck_system *system_of(const mck_flow *f) {
  return mck_of(f->base.system);
}

static double *level(const mck_flow *f, int j) {
  return f->coef + (size_t)j * f->base.system->coordinates;
}

static double largest(const double *x, size_t n) {
  double most = 0;
  for (size_t i = 0; i < n; i++)
    most = fabs(x[i]) > most || isnan(x[i]) ? fabs(x[i]) : most;
  return most;
}

/* --- expansion ------------------------------------------------------------------------------------------------- */

/* Coefficient j of cos and sin of the forcing; the next from the last by differentiation. */
typedef struct harmonic {
  double cosine, sine;
} harmonic;

static void harmonic_next(harmonic *w, double turn, int j) {
  *w = (harmonic){-turn / (j + 1) * w->sine, turn / (j + 1) * w->cosine};
}

static void add_forcing(const mck_system *s, harmonic w, double *restrict a) {
  size_t n = s->base.coordinates;
  for (size_t i = 0; s->force_cos && i < n; i++)
    a[i] += w.cosine * s->force_cos[i];
  for (size_t i = 0; s->force_sin && i < n; i++)
    a[i] += w.sine * s->force_sin[i];
}

static void add_pressure(mck_flow *f, int j) {
  for (size_t k = 0; k < f->pressed_count; k++) {
    pressed_contact *c = &f->pressed[k];
    const ric_obstacle *o = c->obstacle;
    double q = level(f, j)[o->coordinate];
    if (!c->acts)
      continue;
    double p = hertz_series_next(&c->series, j, j == 0 ? -ric_obstacle_gap(o, q) : -o->side * q);
    mck_push(system_of(f), o->coordinate, o->side * o->stiffness * p, f->acceleration);
  }
}

/* Level j of the accelerations, with that of the reactions. */
static void accelerate(mck_flow *f, double h, int j, harmonic w) {
  const mck_system *s = system_of(f);
  memset(f->acceleration, 0, s->base.coordinates * sizeof *f->acceleration);
  add_forcing(s, w, f->acceleration);
  mck_rows_apply(&s->stiffness, -1, level(f, j), f->acceleration);
  mck_rows_apply(&s->damping, -(j + 1) / h, level(f, j + 1), f->acceleration);
  add_pressure(f, j);
  mck_hold_project(&f->hold, s, f->acceleration);
  for (size_t k = 0; k < f->hold.count; k++)
    f->reaction[k * (size_t)(f->order - 1) + (size_t)j] = f->hold.force[k];
}

/* All coefficients over a step h. @returns whether they are finite. */
static bool expand(mck_flow *f, double h) {
  const mck_system *s = system_of(f);
  size_t n = s->base.coordinates;
  harmonic w = {cos(s->frequency * f->base.time), sin(s->frequency * f->base.time)};
  memcpy(level(f, 0), f->base.q, n * sizeof *f->coef);
  for (size_t i = 0; i < n; i++)
    level(f, 1)[i] = h * f->base.u[i];
  for (size_t k = 0; k < f->hold.count; k++)
    level(f, 1)[f->hold.coordinate[k]] = 0; /* a held coordinate must not drift by a rounding error of its rate */
  for (int j = 0; j + 2 <= f->order; j++) {
    double scale = h * h / ((j + 1) * (j + 2)), *restrict next = level(f, j + 2);
    accelerate(f, h, j, w);
    for (size_t i = 0; i < n; i++)
      next[i] = scale * f->acceleration[i];
    harmonic_next(&w, s->frequency * h, j);
  }
  return isfinite(largest(level(f, f->order - 1), n)) && isfinite(largest(level(f, f->order), n));
}

/* The expansion over theta times the step. */
static void rescale(mck_flow *f, double theta) {
  size_t n = f->base.system->coordinates;
  double power = theta;
  for (int j = 1; j <= f->order; j++, power *= theta) {
    double *c = level(f, j);
    for (size_t i = 0; i < n; i++)
      c[i] *= power;
    for (size_t k = 0; j <= f->order - 2 && k < f->hold.count; k++)
      f->reaction[k * (size_t)(f->order - 1) + (size_t)j] *= power;
  }
}

/* --- steps ----------------------------------------------------------------------------------------------------- */

static ric_status blows_up(const mck_flow *f, double length, ric_error *error) {
  return ric_fail(error, RIC_ENUMERIC, "at t = %.17g: the motion blows up, a step of %g is all that accuracy allows",
                  f->base.time, length);
}

static double cap(const mck_flow *f, double length) {
  if (f->base.options.step > 0)
    length = fmin(length, f->base.options.step);
  return fmin(length, f->base.options.longest_step);
}

static ric_status finish(mck_flow *f, double stop, double length, ric_error *error) {
  double remaining = stop - f->base.time, bound = 0; /* of the state anywhere in the step */
  size_t n = f->base.system->coordinates;
  if (length != remaining && taylor_step_vanishes(f->base.time, length))
    return blows_up(f, length, error);
  for (int j = 0; j <= f->order; j++)
    bound += (j + 1) * largest(level(f, j), n);
  if (!isfinite(bound) || !isfinite(bound / length))
    return blows_up(f, length, error);
  f->base.length = length;
  f->base.end = length == remaining ? stop : f->base.time + length;
  return RIC_OK;
}

static ric_status fixed_step(mck_flow *f, double stop, ric_error *error) {
  double length = taylor_step_length(stop - f->base.time, cap(f, INFINITY), true);
  return expand(f, length) ? finish(f, stop, length, error) : blows_up(f, length, error);
}

/* Reactions of one level as the coefficients of two levels higher that they would be without the contacts. */
static double largest_reaction(const mck_flow *f, double trial, int j) {
  double most = 0;
  for (size_t k = 0; k < f->hold.count; k++) {
    double force = f->reaction[k * (size_t)(f->order - 1) + (size_t)j];
    most = fmax(most, fabs(force) * mck_mobility(system_of(f), f->hold.coordinate[k]));
  }
  return most * trial * trial / ((j + 1) * (j + 2));
}

static double largest_of_level(const mck_flow *f, double trial, int j) {
  return fmax(largest(level(f, j), f->base.system->coordinates), largest_reaction(f, trial, j - 2));
}

static taylor_decay decay(const mck_flow *f, double trial) {
  size_t n = f->base.system->coordinates;
  return (taylor_decay){.position = largest(level(f, 0), n),
                        .rate = largest(level(f, 1), n),
                        .bend = largest(level(f, 2), n),
                        .before_last = largest_of_level(f, trial, f->order - 1),
                        .last = largest_of_level(f, trial, f->order),
                        .forcing = f->forced,
                        .fraction = fabs(trial) / f->natural};
}

/* Expands over the natural time, or shorter where that overflows, and rescales to at most `longest`. */
static ric_status measured_step(mck_flow *f, double stop, double longest, ric_error *error) {
  double remaining = stop - f->base.time;
  double trial = copysign(isfinite(f->natural) ? f->natural : fabs(remaining), remaining);
  while (!expand(f, trial)) {
    trial /= 1024;
    if (taylor_step_vanishes(f->base.time, trial))
      return blows_up(f, trial, error);
  }
  taylor_decay d = decay(f, trial);
  double theta = taylor_step_factor(&d, f->order, f->base.options.tolerance, most_growth);
  double length = taylor_step_length(remaining, fmin(longest, cap(f, fabs(trial) * theta)), false);
  rescale(f, length / trial);
  return finish(f, stop, length, error);
}

/* --- Hertz contacts -------------------------------------------------------------------------------------------- */

static double penetration(const mck_flow *f, const pressed_contact *c) {
  return -ric_obstacle_gap(c->obstacle, f->base.q[c->obstacle->coordinate]);
}

/* Accelerations at the start of the step. */
static void accelerate_start(mck_flow *f) {
  size_t n = f->base.system->coordinates;
  double time = system_of(f)->frequency * f->base.time;
  memcpy(level(f, 0), f->base.q, n * sizeof *f->coef);
  memcpy(level(f, 1), f->base.u, n * sizeof *f->coef);
  for (size_t k = 0; k < f->pressed_count; k++)
    f->pressed[k].acts = penetration(f, &f->pressed[k]) > 0;
  accelerate(f, 1, 0, (harmonic){cos(time), sin(time)});
}

/* Takes the forces of contacts that have just begun, or are about to end, out of the step.
 * @returns the longest step for which they do not matter; INFINITY when there are none */
static double set_forces(mck_flow *f, double stop) {
  size_t n = f->base.system->coordinates;
  double room = fmin(fabs(stop - f->base.time), f->natural), shortest = INFINITY;
  double speed = fmax(largest(f->base.u, n), fmax(largest(f->base.q, n), f->forced) / f->natural);
  accelerate_start(f);
  for (size_t k = 0; k < f->pressed_count; k++) {
    pressed_contact *c = &f->pressed[k];
    size_t i = c->obstacle->coordinate;
    hertz_begin b = {.penetration = penetration(f, c),
                     .rate = -c->obstacle->side * f->base.u[i],
                     .acceleration = -c->obstacle->side * f->acceleration[i],
                     .strength = c->obstacle->stiffness * mck_mobility(system_of(f), i)};
    double step = hertz_begin_step(&b, room, f->base.options.tolerance * speed);
    if (!hertz_begins(&b, step))
      continue;
    c->acts = false;
    shortest = fmin(shortest, step);
  }
  return fmax(shortest, 8 * DBL_EPSILON * fabs(f->base.time));
}

/* --- method ---------------------------------------------------------------------------------------------------- */

static ric_status mck_start(ric_flow *flow, ric_error *error) {
  mck_flow *f = (mck_flow *)flow;
  const ric_system *s = flow->system;
  const char *trouble = mck_hold_set(&f->hold, mck_of(s), flow->contact);
  f->pressed_count = 0;
  for (size_t k = 0; k < s->obstacle_count; k++)
    if (flow->contact[k] == CONTACT_PRESSED && isfinite(s->obstacles[k].stiffness))
      f->pressed[f->pressed_count++].obstacle = &s->obstacles[k];
  return trouble ? ric_fail(error, RIC_ENUMERIC, "at t = %g: %s", flow->time, trouble) : RIC_OK;
}

static ric_status mck_step(ric_flow *flow, double stop, ric_error *error) {
  mck_flow *f = (mck_flow *)flow;
  flow->counts.force_evaluations++;
  if (f->pressed_count > 0)
    return measured_step(f, stop, set_forces(f, stop), error);
  return flow->options.step > 0 ? fixed_step(f, stop, error) : measured_step(f, stop, INFINITY, error);
}

static ric_segment mck_piece(ric_flow *flow, size_t index) {
  (void)index;
  const mck_flow *f = (const mck_flow *)flow;
  size_t n = flow->system->coordinates;
  return (ric_segment){
      .coordinates = n, .stride = n, .degree = f->order, .start = flow->time, .length = flow->length, .coef = f->coef};
}

static void mck_accept(ric_flow *flow, double x) {
  ric_segment piece = mck_piece(flow, 0);
  ric_segment_state(&piece, x, flow->q, flow->u);
}

static int mck_reaction(ric_flow *flow, size_t obstacle, double *c) {
  const mck_flow *f = (const mck_flow *)flow;
  const ric_obstacle *o = &flow->system->obstacles[obstacle];
  size_t k = mck_hold_find(&f->hold, o->coordinate), levels = (size_t)f->order - 1;
  c[0] = 0;
  if (k == f->hold.count || flow->contact[obstacle] != CONTACT_HELD)
    return 0;
  for (size_t j = 0; j < levels; j++)
    c[j] = o->side * f->reaction[k * levels + j] / (double)f->hold.sharing[k];
  return f->order - 2;
}

static void mck_flow_destroy(ric_flow *flow) {
  mck_flow *f = (mck_flow *)flow;
  free(f->coef);
  free(f->acceleration);
  free(f->reaction);
  free(f->pressed);
  mck_hold_clear(&f->hold);
  flow_clear(flow);
  free(f);
}

static const flow_method mck_method = {.start = mck_start,
                                       .step = mck_step,
                                       .piece = mck_piece,
                                       .accept = mck_accept,
                                       .reaction = mck_reaction,
                                       .destroy = mck_flow_destroy};

static size_t obstacles_that(const ric_system *s, bool comply) {
  size_t count = 0;
  for (size_t k = 0; k < s->obstacle_count; k++)
    count += comply == (isfinite(s->obstacles[k].stiffness) != 0);
  return count;
}

static bool allocate(mck_flow *f, const mck_system *s) {
  size_t n = s->base.coordinates, levels = (size_t)f->order + 1;
  size_t rigid = obstacles_that(&s->base, false), compliant = obstacles_that(&s->base, true);
  f->coef = calloc(levels * n, sizeof *f->coef);
  f->acceleration = calloc(n, sizeof *f->acceleration);
  f->reaction = calloc(rigid ? levels * rigid : 1, sizeof *f->reaction);
  f->pressed = calloc(compliant ? compliant : 1, sizeof *f->pressed);
  return mck_hold_init(&f->hold, s, NULL) && f->coef && f->acceleration && f->reaction && f->pressed;
}

static void find_scales(mck_flow *f, const mck_system *s) {
  size_t n = s->base.coordinates;
  double cosine = s->force_cos ? largest(s->force_cos, n) : 0, sine = s->force_sin ? largest(s->force_sin, n) : 0;
  double fastest = fmax(sqrt(mck_rows_norm(&s->stiffness)), mck_rows_norm(&s->damping));
  if (cosine + sine > 0)
    fastest = fmax(fastest, fabs(s->frequency));
  f->natural = fastest > 0 ? 2 / fastest : INFINITY;
  f->forced = fastest > 0 ? (cosine + sine) * f->natural * f->natural : 0;
}

ric_status mck_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                           ric_error *error) {
  *flow = NULL;
  mck_flow *f = calloc(1, sizeof *f);
  if (!f)
    return ric_fail(error, RIC_ENOMEM, "no memory for a flow");
  ric_status status = flow_init(&f->base, &mck_method, system, options, error);
  if (status != RIC_OK) {
    free(f);
    return status;
  }
  f->order = options->order ? options->order : taylor_order(options->tolerance);
  find_scales(f, mck_of(system));
  if (!allocate(f, mck_of(system))) {
    mck_flow_destroy(&f->base);
    return ric_fail(error, RIC_ENOMEM, "no memory for a flow of %zu coordinates", system->coordinates);
  }
  *flow = &f->base;
  return RIC_OK;
}

/* The Taylor flow of M-C-K systems, with tangent vectors. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flow_method.h"
#include "hertz_series.h"
#include "model/mck_system.h"
#include "ricochet/elementary.h"
#include "taylor_step.h"

/* The Taylor flow of M-C-K systems, for the files that share it. */

typedef struct pressed_contact {
  const ric_obstacle *obstacle;
  bool acts; /* its force is included in this step */
  hertz_series series;
  double root[HERTZ_LEVELS]; /* u^{1/2} over the accepted part of a step, for tangent vectors */
} pressed_contact;

typedef struct mck_flow {
  ric_flow base;
  taylor_stepper stepper;
  double expanded;      /* length of the series */
  double *coef;         /* [order + 1][n] */
  double *acceleration; /* [n] */
  double *reaction;     /* [held coordinates][order - 1] coefficients of mu */
  mck_hold hold;
  pressed_contact *pressed; /* [pressed_count] */
  size_t pressed_count;
  double *variation; /* [order + 2][n] a tangent vector along the step, and its acceleration; NULL: none */
} mck_flow;

static inline const mck_system *mck_flow_system(const mck_flow *f) {
  return mck_of(f->base.system);
}

/** Coefficient j of the coordinates [n]. */
static inline double *mck_flow_level(const mck_flow *f, int j) {
  return f->coef + (size_t)j * f->base.system->coordinates;
}

/** Of a pressed contact at the start of the step. */
static inline double mck_flow_penetration(const mck_flow *f, const pressed_contact *c) {
  return -ric_obstacle_gap(c->obstacle, f->base.q[c->obstacle->coordinate]);
}

/* Tangent vectors of M-C-K systems along a step: the recurrence of the state without forcing, one vector at a time. */

/** The method's functions for tangent vectors. */
static ric_status mck_flow_carry(ric_flow *flow, ric_error *error) {
  mck_flow *f = (mck_flow *)flow;
  size_t n = flow->system->coordinates, levels = (size_t)f->stepper.order + 2;
  if (f->variation || flow->tangent.columns == 0)
    return RIC_OK;
  f->variation = malloc(levels * n * sizeof *f->variation);
  return f->variation ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for tangent vectors of %zu coordinates", n);
}

static double *level(const mck_flow *f, int j) {
  return f->variation + (size_t)j * f->base.system->coordinates;
}

/* Penetration of a contact after the part x of the step. */
static double penetration_at(const mck_flow *f, const pressed_contact *c, double x) {
  double q = 0;
  for (int j = f->stepper.order; j >= 0; j--)
    q = q * x + mck_flow_level(f, j)[c->obstacle->coordinate];
  return -ric_obstacle_gap(c->obstacle, q);
}

/* u^{1/2} of an acting contact over the part x. */
static void find_root(const mck_flow *f, pressed_contact *c, double x) {
  double u[HERTZ_LEVELS], power = 1;
  for (int j = 0; j <= f->stepper.order; j++, power *= x)
    u[j] = -c->obstacle->side * power * mck_flow_level(f, j)[c->obstacle->coordinate];
  u[0] = mck_flow_penetration(f, c);
  hertz_root_series(u, f->stepper.order, c->root);
}

static void add_pressure_slope(const mck_flow *f, int j, double *acceleration) {
  for (size_t k = 0; k < f->pressed_count; k++) {
    const pressed_contact *c = &f->pressed[k];
    double sum = 0;
    for (int l = 0; c->acts && l <= j; l++)
      sum += c->root[l] * level(f, j - l)[c->obstacle->coordinate];
    if (c->acts)
      mck_push(mck_flow_system(f), c->obstacle->coordinate, -1.5 * c->obstacle->stiffness * sum, acceleration);
  }
}

/* Impulsive jumps of tangent vectors by contacts whose force was omitted from the step. */
static void apply_omitted_forces(const mck_flow *f, double x, double h, const double *q, double *u) {
  for (size_t k = 0; k < f->pressed_count; k++) {
    const pressed_contact *c = &f->pressed[k];
    size_t i = c->obstacle->coordinate;
    if (!c->acts) {
      double change = hertz_left_out(c->obstacle->stiffness, mck_flow_penetration(f, c), penetration_at(f, c, x), h);
      mck_push(mck_flow_system(f), i, -change * q[i], u);
    }
  }
}

static void raise_levels(mck_flow *f, double h) {
  const mck_system *s = mck_flow_system(f);
  size_t n = s->base.coordinates;
  double *acceleration = level(f, f->stepper.order + 1);
  for (int j = 0; j + 2 <= f->stepper.order; j++) {
    memset(acceleration, 0, n * sizeof *acceleration);
    mck_rows_apply(&s->stiffness, -1, level(f, j), acceleration);
    mck_rows_apply(&s->damping, -(j + 1) / h, level(f, j + 1), acceleration);
    add_pressure_slope(f, j, acceleration);
    mck_hold_project(&f->hold, s, acceleration);
    for (size_t i = 0; i < n; i++)
      level(f, j + 2)[i] = h * h * acceleration[i] / ((j + 1) * (j + 2));
  }
}

/* Sums of the levels into q and u [n], which may be the first two. */
static void add_up(const mck_flow *f, double h, double *q, double *u) {
  for (size_t i = 0; i < f->base.system->coordinates; i++) {
    double value = 0, slope = 0;
    for (int j = f->stepper.order; j >= 1; j--) {
      value += level(f, j)[i];
      slope += j * level(f, j)[i];
    }
    q[i] = level(f, 0)[i] + value;
    u[i] = slope / h;
  }
}

static void move(mck_flow *f, double x, size_t k) {
  const tangents *d = &f->base.tangent;
  size_t n = f->base.system->coordinates, columns = d->columns;
  double h = x * f->base.length, *q = level(f, 0), *u = level(f, 1);
  for (size_t i = 0; i < n; i++) {
    q[i] = d->q[i * columns + k];
    u[i] = h * d->u[i * columns + k];
  }
  for (size_t i = 0; i < f->hold.count; i++)
    u[f->hold.coordinate[i]] = 0;
  raise_levels(f, h);
  add_up(f, h, q, u);
  apply_omitted_forces(f, x, h, q, u);
  for (size_t i = 0; i < n; i++) {
    d->q[i * columns + k] = q[i];
    d->u[i * columns + k] = u[i];
  }
}

static void mck_flow_transport(ric_flow *flow, double x) {
  mck_flow *f = (mck_flow *)flow;
  for (size_t k = 0; k < f->pressed_count; k++)
    if (f->pressed[k].acts)
      find_root(f, &f->pressed[k], x);
  for (size_t k = 0; k < flow->tangent.columns; k++)
    move(f, x, k);
}

/* Taylor flow of M-C-K systems.
 *
 * With q(t + h x) = sum_j c_j x^j, 0 <= x <= 1, and f_j the coefficients of the forces,
 *
 *   c_{j+2} = h^2 / ((j+1)(j+2)) [M^-1 (f_j - K c_j) - M^-1 C (j+1) c_{j+1} / h],
 *
 * where held contacts project the bracket at every level, which also gives their forces level by level. The length of a
 * step follows from the decay of the coefficients, at low cost compared with matrix products: row sums of a dense M^-1
 * K overestimate its frequencies, by half for some tens of coordinates. */

/* Coefficients [order - 1] of the force of a held coordinate. */
static double *reaction_of(const mck_flow *f, size_t k) {
  return f->reaction + k * (size_t)(f->stepper.order - 1);
}

/* --- expansion ------------------------------------------------------------------------------------------------- */

/* Coefficient j of cos and sin of the forcing; the next from the last by differentiation. */
typedef struct harmonic {
  double cosine, sine;
} harmonic;

static harmonic harmonic_at(const mck_system *s, double time) {
  if (!s->force_cos && !s->force_sin)
    return (harmonic){0};
  harmonic h;
  ric_sincos(s->frequency * time, &h.sine, &h.cosine);
  return h;
}

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
    double q = mck_flow_level(f, j)[o->coordinate];
    if (!c->acts)
      continue;
    double p = hertz_series_next(&c->series, j, j == 0 ? -ric_obstacle_gap(o, q) : -o->side * q);
    mck_push(mck_flow_system(f), o->coordinate, o->side * o->stiffness * p, f->acceleration);
  }
}

/* Level j of the accelerations, with that of the reactions. */
static void accelerate(mck_flow *f, double h, int j, harmonic w) {
  const mck_system *s = mck_flow_system(f);
  memset(f->acceleration, 0, s->base.coordinates * sizeof *f->acceleration);
  add_forcing(s, w, f->acceleration);
  mck_rows_apply(&s->stiffness, -1, mck_flow_level(f, j), f->acceleration);
  mck_rows_apply(&s->damping, -(j + 1) / h, mck_flow_level(f, j + 1), f->acceleration);
  add_pressure(f, j);
  mck_hold_project(&f->hold, s, f->acceleration);
  for (size_t k = 0; k < f->hold.count; k++)
    reaction_of(f, k)[j] = f->hold.force[k];
}

static void set_start(mck_flow *f, double h) {
  size_t n = f->base.system->coordinates;
  memcpy(mck_flow_level(f, 0), f->base.q, n * sizeof *f->coef);
  for (size_t i = 0; i < n; i++)
    mck_flow_level(f, 1)[i] = h * f->base.u[i];
  for (size_t k = 0; k < f->hold.count; k++)
    mck_flow_level(f, 1)[f->hold.coordinate[k]] =
        0; /* a held coordinate must not drift by a rounding error of its rate */
}

static taylor_decay decay(const mck_flow *f) {
  size_t n = f->base.system->coordinates;
  taylor_decay d = taylor_decay_of(f->coef, n, n, f->stepper.order);
  for (size_t k = 0; k < f->pressed_count; k++)
    if (f->pressed[k].acts)
      d.nearest_zero = fmin(d.nearest_zero, hertz_series_nearest_zero(&f->pressed[k].series));
  return d;
}

/* All coefficients over a step h. */
static taylor_decay mck_expand(ric_flow *flow, double h) {
  mck_flow *f = (mck_flow *)flow;
  const mck_system *s = mck_flow_system(f);
  harmonic w = harmonic_at(s, flow->time);
  set_start(f, h);
  for (int j = 0; j + 2 <= f->stepper.order; j++) {
    double h2 = h * h, divisor = (j + 1) * (j + 2), *restrict next = mck_flow_level(f, j + 2);
    accelerate(f, h, j, w);
    for (size_t i = 0; i < s->base.coordinates; i++)
      next[i] = h2 * f->acceleration[i] / divisor; /* see lattice_block.c for quotients */
    harmonic_next(&w, s->frequency * h, j);
  }
  f->expanded = h;
  return decay(f);
}

static void mck_shorten(ric_flow *flow, double length) {
  mck_flow *f = (mck_flow *)flow;
  double theta = length / f->expanded, power = theta;
  for (int j = 1; j <= f->stepper.order; j++, power *= theta) {
    double *c = mck_flow_level(f, j);
    for (size_t i = 0; i < flow->system->coordinates; i++)
      c[i] *= power;
    for (size_t k = 0; j <= f->stepper.order - 2 && k < f->hold.count; k++)
      reaction_of(f, k)[j] *= power;
  }
  f->expanded = length;
}

/* --- Hertz contacts -------------------------------------------------------------------------------------------- */

/* Accelerations at the start of the step. */
static void accelerate_start(mck_flow *f) {
  set_start(f, 1);
  for (size_t k = 0; k < f->pressed_count; k++)
    f->pressed[k].acts = mck_flow_penetration(f, &f->pressed[k]) > 0;
  accelerate(f, 1, 0, harmonic_at(mck_flow_system(f), f->base.time));
}

/* Decides which pressed contacts act; @returns whether one does. */
static bool choose_acting(mck_flow *f, int direction, double *limit) {
  double natural = taylor_stepper_natural(&f->stepper), least = taylor_step_least(f->base.time);
  bool any = false;
  *limit = INFINITY;
  if (f->pressed_count > 0)
    accelerate_start(f);
  for (size_t k = 0; k < f->pressed_count; k++) {
    pressed_contact *p = &f->pressed[k];
    size_t i = p->obstacle->coordinate;
    hertz_contact c = {.penetration = mck_flow_penetration(f, p),
                       .rate = -p->obstacle->side * direction * f->base.u[i],
                       .bend = fabs(f->acceleration[i]),
                       .strength = p->obstacle->stiffness * mck_mobility(mck_flow_system(f), i)};
    p->acts = hertz_acts(&c, f->base.options.tolerance, natural, least, limit);
    any |= p->acts;
  }
  return any;
}

/* --- method ---------------------------------------------------------------------------------------------------- */

static ric_status mck_start(ric_flow *flow, ric_error *error) {
  mck_flow *f = (mck_flow *)flow;
  const ric_system *s = flow->system;
  const char *trouble = mck_hold_set(&f->hold, mck_of(s), flow->contact);
  f->pressed_count = 0;
  f->stepper.trial = f->stepper.longest; /* previous steps do not predict those after a change of contacts */
  for (size_t k = 0; k < s->obstacle_count; k++)
    if (flow->contact[k] == CONTACT_PRESSED && isfinite(s->obstacles[k].stiffness))
      f->pressed[f->pressed_count++].obstacle = &s->obstacles[k];
  return trouble ? ric_fail(error, RIC_ENUMERIC, "at t = %g: %s", flow->time, trouble) : RIC_OK;
}

static ric_status mck_step(ric_flow *flow, double stop, ric_error *error) {
  mck_flow *f = (mck_flow *)flow;
  double limit;
  flow->counts.force_evaluations++;
  bool pressed = choose_acting(f, stop < flow->time ? -1 : 1, &limit);
  return taylor_stepper_choose(&f->stepper, stop, limit, pressed, error);
}

static ric_segment mck_piece(ric_flow *flow, size_t index) {
  (void)index;
  const mck_flow *f = (const mck_flow *)flow;
  size_t n = flow->system->coordinates;
  return (ric_segment){.coordinates = n,
                       .stride = n,
                       .degree = f->stepper.order,
                       .start = flow->time,
                       .length = flow->length,
                       .coef = f->coef};
}

static void mck_accept(ric_flow *flow, double x) {
  ric_segment piece = mck_piece(flow, 0);
  ric_segment_state(&piece, x, flow->q, flow->u);
}

static int mck_reaction(ric_flow *flow, size_t obstacle, double *c) {
  const mck_flow *f = (const mck_flow *)flow;
  const ric_obstacle *o = &flow->system->obstacles[obstacle];
  size_t k = mck_hold_find(&f->hold, o->coordinate), levels = (size_t)f->stepper.order - 1;
  c[0] = 0;
  if (k == f->hold.count || flow->contact[obstacle] != CONTACT_HELD)
    return 0;
  for (size_t j = 0; j < levels; j++)
    c[j] = o->side * reaction_of(f, k)[j] / (double)f->hold.sharing[k];
  return f->stepper.order - 2;
}

static void mck_flow_destroy(ric_flow *flow) {
  mck_flow *f = (mck_flow *)flow;
  free(f->coef);
  free(f->acceleration);
  free(f->reaction);
  free(f->pressed);
  free(f->variation);
  mck_hold_clear(&f->hold);
  flow_clear(flow);
  free(f);
}

static bool allocate_mck(mck_flow *f, const mck_system *s) {
  size_t n = s->base.coordinates, levels = (size_t)f->stepper.order + 1;
  size_t compliant = system_compliant_obstacles(&s->base), rigid = s->base.obstacle_count - compliant;
  f->coef = calloc(levels * n, sizeof *f->coef);
  f->acceleration = calloc(n, sizeof *f->acceleration);
  f->reaction = calloc(rigid ? levels * rigid : 1, sizeof *f->reaction);
  f->pressed = calloc(compliant ? compliant : 1, sizeof *f->pressed);
  return mck_hold_init(&f->hold, s, NULL) && f->coef && f->acceleration && f->reaction && f->pressed;
}

static void plan(mck_flow *f, const mck_system *s) {
  bool forced = s->force_cos || s->force_sin;
  f->stepper = (taylor_stepper){.flow = &f->base, .expand = mck_expand, .shorten = mck_shorten};
  taylor_stepper_plan(&f->stepper, taylor_rate_bound(mck_rows_norm(&s->stiffness), mck_rows_norm(&s->damping)),
                      forced ? s->frequency : 0);
}

/* A mass matrix that has become dense couples the held coordinates. */
static ric_status mck_begin(ric_flow *flow, bool renewed, ric_error *error) {
  mck_flow *f = (mck_flow *)flow;
  const mck_system *s = mck_flow_system(f);
  if (!renewed)
    return RIC_OK;
  plan(f, s);
  if (s->base.uncoupled || f->hold.factor)
    return RIC_OK;
  mck_hold made, before = f->hold;
  bool room = mck_hold_init(&made, s, NULL);
  if (room)
    f->hold = made;
  mck_hold_clear(room ? &before : &made);
  return room ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for contacts");
}

static const flow_method mck_method = {.begin = mck_begin,
                                       .start = mck_start,
                                       .step = mck_step,
                                       .piece = mck_piece,
                                       .accept = mck_accept,
                                       .reaction = mck_reaction,
                                       .carry = mck_flow_carry,
                                       .transport = mck_flow_transport,
                                       .destroy = mck_flow_destroy};

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
  plan(f, mck_of(system));
  if (!allocate_mck(f, mck_of(system))) {
    mck_flow_destroy(&f->base);
    return ric_fail(error, RIC_ENOMEM, "no memory for a flow of %zu coordinates", system->coordinates);
  }
  *flow = &f->base;
  return RIC_OK;
}

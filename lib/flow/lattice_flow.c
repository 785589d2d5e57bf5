/* The Taylor flow of lattices: creation, pieces and states, and the contacts that act in a step. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "hertz_series.h"
#include "lattice_series.h"
#include "lattice_variation.h"
#include "model/lattice_system.h"
#include "taylor_step.h"

/* The Taylor flow of a lattice, for the files that share it. */

typedef struct lattice_flow {
  ric_flow base;
  taylor_stepper stepper;
  const ric_lattice *lattice;   /* the system's */
  lattice_series *series;       /* of the piece requested last */
  lattice_series *aside;        /* of the neighbourhood of one particle; NULL if there is one piece */
  size_t block;                 /* particles of a piece; the last may have fewer */
  size_t made;                  /* piece that `series` holds, SIZE_MAX: none */
  size_t ended;                 /* the first pieces have their state at the end of the step in q_next, u_next */
  double *q_next, *u_next;      /* [n] */
  lattice_variation *variation; /* NULL until there are tangent vectors */

  /* Contacts, each list in order of coordinates. */
  size_t *held;           /* [held_count], of at most [obstacles] */
  lattice_press *pressed; /* [pressed_count], of at most [compliant obstacles] */
  lattice_press *acting;  /* [acting_count] those of `pressed` whose force has a series at the start of this step */
  size_t held_count, pressed_count, acting_count;
  bool contacts_changed; /* since the contacts of `series` were set */
  bool aside_stale;
} lattice_flow;

/* Contacts of the Taylor flow of a lattice: which act in a step, and the forces of held ones. */

static bool put_held(lattice_flow *f, size_t coordinate) {
  size_t at = f->held_count;
  if (at > 0 && f->held[at - 1] == coordinate)
    return false;
  bool changed = f->held[at] != coordinate;
  f->held[f->held_count++] = coordinate;
  return changed;
}

static bool same_press(const lattice_press *a, const lattice_press *b) {
  return a->coordinate == b->coordinate && a->side == b->side && a->position == b->position &&
         a->stiffness == b->stiffness;
}

static bool put_pressed(lattice_flow *f, const ric_obstacle *o) {
  lattice_press press = {o->coordinate, o->side, o->position, o->stiffness}, *p = &f->pressed[f->pressed_count++];
  bool changed = !same_press(p, &press);
  *p = press;
  return changed;
}

/** Collects held and pressed contacts from the states of the flow's contacts. */
static void lattice_flow_list_contacts(lattice_flow *f) {
  const ric_system *s = f->base.system;
  size_t held_before = f->held_count, pressed_before = f->pressed_count;
  bool held_changed = false, pressed_changed = false;
  f->held_count = f->pressed_count = 0;
  for (size_t k = 0; k < s->obstacle_count; k++) {
    size_t j = s->by_coordinate[k];
    if (f->base.contact[j] == CONTACT_HELD)
      held_changed |= put_held(f, s->obstacles[j].coordinate);
    else if (f->base.contact[j] == CONTACT_PRESSED)
      pressed_changed |= put_pressed(f, &s->obstacles[j]);
  }
  held_changed |= f->held_count != held_before;
  pressed_changed |= f->pressed_count != pressed_before;
  f->contacts_changed |= held_changed || pressed_changed;
  if (pressed_changed) /* steps near the branch points of Hertz's law do not predict those elsewhere */
    f->stepper.trial = taylor_stepper_natural(&f->stepper);
}

static bool acts(const lattice_flow *f, const lattice_press *p, int direction, double *limit) {
  double mass = ric_lattice_mass(f->lattice, p->coordinate), t = f->base.time;
  double force = lattice_force(f->lattice, p->coordinate, t, f->base.q, f->base.u);
  hertz_contact c = {.penetration = p->side * (p->position - f->base.q[p->coordinate]),
                     .rate = -p->side * direction * f->base.u[p->coordinate],
                     .bend = fabs(force) / mass,
                     .strength = p->stiffness / mass};
  return hertz_acts(&c, f->base.options.tolerance, taylor_stepper_natural(&f->stepper), taylor_step_least(t), limit);
}

/** Decides which pressed contacts act. Those that have just closed, or are about to open, have no series; their force
 *  is negligible on a short step and omitted.
 *  @param direction  +1 or -1, the direction of time
 *  @param limit  set to the longest step with that force omitted, INFINITY if all act */
static ric_status lattice_flow_take_contacts(lattice_flow *f, int direction, double *limit, ric_error *error) {
  size_t before = f->acting_count, count = 0;
  bool changed = f->contacts_changed;
  *limit = INFINITY;
  for (size_t k = 0; k < f->pressed_count; k++)
    if (acts(f, &f->pressed[k], direction, limit)) {
      changed |= count >= before || !same_press(&f->acting[count], &f->pressed[k]);
      f->acting[count++] = f->pressed[k];
    }
  f->acting_count = count;
  if (!changed && count == before)
    return RIC_OK;
  lattice_contacts contacts = {f->held, f->held_count, f->acting, count};
  f->contacts_changed = f->aside_stale = true;
  RIC_TRY(lattice_series_begin(f->series, f->lattice, &contacts, error));
  f->contacts_changed = false;
  return RIC_OK;
}

/** Whether a pressed contact acts in this step. */
static bool lattice_flow_acts(const lattice_flow *f, const lattice_press *p) {
  for (size_t k = 0; k < f->acting_count; k++)
    if (same_press(&f->acting[k], p))
      return true;
  return false;
}

/* Force of Hertz contacts on a held coordinate. */
static double constant_push(const lattice_flow *f, size_t coordinate) {
  double force = 0;
  for (size_t k = 0; k < f->pressed_count; k++) {
    const lattice_press *p = &f->pressed[k];
    if (p->coordinate == coordinate)
      force += p->side * hertz_force(p->stiffness, p->side * (f->base.q[coordinate] - p->position));
  }
  return force;
}

/* A segment of a particle and its neighbours, separate from the pieces. */
static bool make_aside(lattice_flow *f, size_t particle) {
  size_t n = f->lattice->particles;
  bool ring = f->lattice->ends == RIC_ENDS_PERIODIC;
  size_t first = particle > 0 ? particle - 1 : ring ? n - 1 : 0;
  size_t count = ring || (particle > 0 && particle + 1 < n) ? 3 : 2;
  if (f->aside_stale) {
    lattice_contacts contacts = {f->held, f->held_count, f->acting, f->acting_count};
    if (lattice_series_begin(f->aside, f->lattice, &contacts, NULL) != RIC_OK)
      return false;
    f->aside_stale = false;
  }
  lattice_series_segment(f->aside, f->base.q, f->base.u, f->base.time, f->base.length, first, count);
  return true;
}

static int lattice_flow_reaction(ric_flow *flow, size_t obstacle, double *c) {
  lattice_flow *f = (lattice_flow *)(void *)flow;
  const ric_obstacle *o = &flow->system->obstacles[obstacle];
  if (flow->pieces == 1)
    flow->method->piece(flow, 0);
  else if (!make_aside(f, o->coordinate))
    return -1;
  int degree = lattice_series_force(flow->pieces == 1 ? f->series : f->aside, o->coordinate, c);
  c[0] += constant_push(f, o->coordinate);
  for (int j = 0; j <= RIC_POLY_DEGREE; j++)
    c[j] *= -o->side;
  return degree;
}

/* The Taylor flow of lattices: creation, pieces and states. */

static lattice_flow *self(ric_flow *flow) {
  return (lattice_flow *)(void *)flow;
}

static ric_status start(ric_flow *flow, ric_error *error) {
  (void)error;
  lattice_flow *f = self(flow);
  f->made = SIZE_MAX;
  f->ended = 0;
  lattice_flow_list_contacts(f);
  return RIC_OK;
}

/* Computes a piece of a step of the given length in the workspace, with its end state if that is cheap. */
static ric_segment make(lattice_flow *f, size_t index, double length) {
  size_t first = index * f->block, rest = f->base.system->coordinates - first;
  ric_segment s = lattice_series_segment(f->series, f->base.q, f->base.u, f->base.time, length, first,
                                         rest < f->block ? rest : f->block);
  f->made = index;
  if (f->base.pieces > 1 && f->ended == index) { /* while it is in the cache: most steps are accepted entirely */
    ric_segment_state(&s, 1, f->q_next + first, f->u_next + first);
    f->ended++;
  }
  return s;
}

static ric_segment piece(ric_flow *flow, size_t index) {
  lattice_flow *f = self(flow);
  return f->made == index ? lattice_series_last(f->series) : make(f, index, flow->length);
}

/* A linear motion grows by less than exp(2.2) per coefficient in a step of the bound: the start suffices. */
static taylor_decay evaluate_start(const lattice_flow *f, double length) {
  double size = taylor_largest(f->base.q, f->lattice->particles);
  size += fabs(length) * taylor_largest(f->base.u, f->lattice->particles);
  return (taylor_decay){.change = size < 1e290 ? size : NAN, .nearest_zero = INFINITY};
}

/* Series of all pieces. In steps of a linear lattice within the bound they are computed on request. */
static taylor_decay expand(ric_flow *flow, double length) {
  lattice_flow *f = self(flow);
  f->made = SIZE_MAX;
  f->ended = 0;
  if (f->stepper.by_bound && f->acting_count == 0 && fabs(length) <= f->stepper.longest)
    return evaluate_start(f, length);
  taylor_decay all = {.nearest_zero = INFINITY};
  for (size_t i = 0; i < flow->pieces; i++) {
    make(f, i, length);
    all = taylor_decay_join(all, lattice_series_decay(f->series));
  }
  return all;
}

static void shorten(ric_flow *flow, double length) {
  lattice_flow *f = self(flow);
  if (flow->pieces == 1)
    lattice_series_shorten(f->series, flow->q, flow->u, length);
  else
    f->made = SIZE_MAX;
  f->ended = 0;
}

static ric_status lattice_step(ric_flow *flow, double stop, ric_error *error) {
  lattice_flow *f = self(flow);
  double limit;
  flow->counts.force_evaluations++;
  RIC_TRY(lattice_flow_take_contacts(f, stop < flow->time ? -1 : 1, &limit, error));
  return taylor_stepper_choose(&f->stepper, stop, limit, f->acting_count > 0, error);
}

static void swap(double **a, double **b) {
  double *c = *a;
  *a = *b;
  *b = c;
}

static void accept(ric_flow *flow, double x) {
  lattice_flow *f = self(flow);
  for (size_t i = x == 1 ? f->ended : 0; i < flow->pieces; i++) {
    ric_segment s = piece(flow, i);
    ric_segment_state(&s, x, f->q_next + s.first, f->u_next + s.first);
  }
  swap(&flow->q, &f->q_next);
  swap(&flow->u, &f->u_next);
  f->made = SIZE_MAX;
  f->ended = 0;
}

static ric_status carry(ric_flow *flow, ric_error *error) {
  lattice_flow *f = self(flow);
  if (f->variation || flow->tangent.columns == 0)
    return RIC_OK;
  return lattice_variation_create(f->lattice, f->stepper.order, system_compliant_obstacles(flow->system), &f->variation,
                                  error);
}

static double coordinate_at(ric_flow *flow, size_t i, double x) {
  ric_segment s = piece(flow, i / self(flow)->block);
  double q = 0;
  for (int j = s.degree; j >= 0; j--)
    q = q * x + s.coef[(size_t)j * s.stride + i - s.first];
  return q;
}

/* Impulsive jumps of the tangent vectors by contacts whose force was omitted from the step. */
static void apply_omitted_forces(ric_flow *flow, const lattice_press *p, double x) {
  const lattice_flow *f = self(flow);
  size_t i = p->coordinate, columns = flow->tangent.columns;
  double start = p->side * (p->position - flow->q[i]), end = p->side * (p->position - coordinate_at(flow, i, x));
  double change = hertz_left_out(p->stiffness, start, end, x * flow->length) / ric_lattice_mass(f->lattice, i);
  for (size_t k = 0; k < columns; k++)
    flow->tangent.u[i * columns + k] -= change * flow->tangent.q[i * columns + k];
}

static void transport(ric_flow *flow, double x) {
  lattice_flow *f = self(flow);
  lattice_contacts contacts = {f->held, f->held_count, f->acting, f->acting_count};
  lattice_variation_begin(f->variation, x * flow->length);
  if (lattice_variation_varies(f->variation, &contacts)) {
    for (size_t i = 0; i < flow->pieces; i++) {
      ric_segment s = piece(flow, i);
      lattice_variation_take(f->variation, &s, x);
    }
    lattice_variation_stiffen(f->variation, &contacts);
  }
  lattice_variation_transport(f->variation, &contacts, &flow->tangent);
  for (size_t k = 0; k < f->pressed_count; k++)
    if (!lattice_flow_acts(f, &f->pressed[k]))
      apply_omitted_forces(flow, &f->pressed[k], x);
}

static void destroy(ric_flow *flow) {
  lattice_flow *f = self(flow);
  lattice_series_destroy(&f->series);
  lattice_series_destroy(&f->aside);
  lattice_variation_destroy(&f->variation);
  free(f->q_next);
  free(f->u_next);
  free(f->held);
  free(f->pressed);
  flow_clear(flow);
  free(f);
}

/* Creates a series with the terms of the lattice, unless it has them. */
static ric_status fit(const lattice_flow *f, size_t block, lattice_series **series, ric_error *error) {
  lattice_series *made = NULL;
  if (*series && lattice_series_fits(*series, f->lattice))
    return RIC_OK;
  RIC_TRY(lattice_series_create(f->lattice, f->stepper.order, block, &made, error));
  lattice_series_destroy(series);
  *series = made;
  return RIC_OK;
}

static ric_status fit_series(lattice_flow *f, ric_error *error) {
  bool beside = f->base.pieces > 1 && f->base.system->obstacle_count > 0;
  RIC_TRY(fit(f, f->block, &f->series, error));
  return beside ? fit(f, 3, &f->aside, error) : RIC_OK;
}

static ric_status allocate_lattice(lattice_flow *f, ric_error *error) {
  size_t n = f->base.system->coordinates, obstacles = f->base.system->obstacle_count;
  size_t compliant = system_compliant_obstacles(f->base.system);
  f->q_next = malloc(n * sizeof *f->q_next);
  f->u_next = malloc(n * sizeof *f->u_next);
  f->held = calloc(obstacles + 1, sizeof *f->held);
  f->pressed = calloc(2 * compliant + 1, sizeof *f->pressed);
  if (!f->q_next || !f->u_next || !f->held || !f->pressed)
    return ric_fail(error, RIC_ENOMEM, "no memory for a flow of %zu coordinates", n);
  f->acting = f->pressed + compliant;
  return fit_series(f, error);
}

static bool spring_is_linear(const ric_spring *s) {
  return s->quadratic == 0 && s->cubic == 0;
}

static bool spring_is_passive(const ric_spring *s) {
  return s->linear >= 0 && s->damping >= 0;
}

/* Whether all springs and links have a property. */
static bool all_springs(const ric_lattice *l, bool (*is)(const ric_spring *spring)) {
  bool all = true;
  for (size_t i = 0; i < (l->on_sites ? l->particles : 1); i++)
    all &= is(l->on_sites ? &l->on_sites[i] : &l->on_site);
  for (size_t i = 0; i < (l->links ? l->particles + 1 : 1); i++)
    all &= is(l->links ? &l->links[i] : &l->link);
  return all;
}

static double rate_bound(const ric_lattice *l) {
  lattice_rows_bound b = lattice_row_bounds(l);
  return all_springs(l, spring_is_passive) ? taylor_passive_rate_bound(b.stiffness, b.softest, b.damping)
                                           : taylor_rate_bound(b.stiffness, b.damping);
}

/* Order, step and blocks. */
static void plan(lattice_flow *f) {
  const ric_lattice *l = f->lattice;
  size_t n = l->particles, pieces = (n + LATTICE_SERIES_BLOCK - 1) / LATTICE_SERIES_BLOCK;
  bool forced = l->force_cos || l->force_sin;
  bool linear = all_springs(l, spring_is_linear);
  f->stepper = (taylor_stepper){.flow = &f->base, .expand = expand, .shorten = shorten, .by_bound = linear};
  taylor_stepper_plan(&f->stepper, rate_bound(l), forced ? l->frequency : 0);
  f->block = (n + pieces - 1) / pieces;
  f->base.pieces = (n + f->block - 1) / f->block;
}

static ric_status lattice_begin(ric_flow *flow, bool renewed, ric_error *error) {
  lattice_flow *f = self(flow);
  f->stepper.trial = taylor_stepper_natural(&f->stepper);
  if (!renewed)
    return RIC_OK;
  plan(f);
  f->contacts_changed = true; /* and with them the rows of the series */
  if (f->variation && !lattice_variation_renew(f->variation))
    lattice_variation_destroy(&f->variation); /* created again for the next tangent vectors */
  return fit_series(f, error);
}

static const flow_method method = {.begin = lattice_begin,
                                   .start = start,
                                   .step = lattice_step,
                                   .piece = piece,
                                   .accept = accept,
                                   .reaction = lattice_flow_reaction,
                                   .carry = carry,
                                   .transport = transport,
                                   .destroy = destroy};

ric_status lattice_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                               ric_error *error) {
  lattice_flow *f = calloc(1, sizeof *f);
  if (!f)
    return ric_fail(error, RIC_ENOMEM, "no memory for a flow");
  ric_status status = flow_init(&f->base, &method, system, options, error);
  if (status != RIC_OK) {
    free(f);
    return status;
  }
  f->lattice = lattice_system_lattice(system);
  f->made = SIZE_MAX;
  f->contacts_changed = f->aside_stale = true;
  plan(f);
  status = allocate_lattice(f, error);
  if (status != RIC_OK)
    destroy(&f->base);
  else
    *flow = &f->base;
  return status;
}

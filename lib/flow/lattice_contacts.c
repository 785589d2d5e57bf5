/* Contacts of the Taylor flow of a lattice: which act in a step, and the force of those that hold. */
#include <math.h>
#include <string.h>

#include "hertz_series.h"
#include "lattice_flow_parts.h"
#include "model/lattice_force.h"

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

void lattice_flow_list_contacts(lattice_flow *f) {
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
  if (pressed_changed) /* steps near the branch points of Hertz's law say nothing about those elsewhere */
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

ric_status lattice_flow_take_contacts(lattice_flow *f, int direction, double *limit, ric_error *error) {
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

bool lattice_flow_acts(const lattice_flow *f, const lattice_press *p) {
  for (size_t k = 0; k < f->acting_count; k++)
    if (same_press(&f->acting[k], p))
      return true;
  return false;
}

/* Force of Hertz contacts on a coordinate that stays where it is. */
static double constant_push(const lattice_flow *f, size_t coordinate) {
  double force = 0;
  for (size_t k = 0; k < f->pressed_count; k++) {
    const lattice_press *p = &f->pressed[k];
    if (p->coordinate == coordinate)
      force += p->side * hertz_force(p->stiffness, p->side * (f->base.q[coordinate] - p->position));
  }
  return force;
}

/* A segment of a particle and its neighbours, beside the pieces. */
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

int lattice_flow_reaction(ric_flow *flow, size_t obstacle, double *c) {
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

/* Tangent vectors of M-C-K systems along a step: the recurrence of the state without forcing, one vector at a time. */
#include <stdlib.h>
#include <string.h>

#include "mck_flow_parts.h"

ric_status mck_flow_carry(ric_flow *flow, ric_error *error) {
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

static void add_pressure(const mck_flow *f, int j, double *acceleration) {
  for (size_t k = 0; k < f->pressed_count; k++) {
    const pressed_contact *c = &f->pressed[k];
    double sum = 0;
    for (int l = 0; c->acts && l <= j; l++)
      sum += c->root[l] * level(f, j - l)[c->obstacle->coordinate];
    if (c->acts)
      mck_push(mck_flow_system(f), c->obstacle->coordinate, -1.5 * c->obstacle->stiffness * sum, acceleration);
  }
}

/* What contacts do whose force was left out of the step. */
static void kick(const mck_flow *f, double x, double h, const double *q, double *u) {
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
    add_pressure(f, j, acceleration);
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
  kick(f, x, h, q, u);
  for (size_t i = 0; i < n; i++) {
    d->q[i * columns + k] = q[i];
    d->u[i * columns + k] = u[i];
  }
}

void mck_flow_transport(ric_flow *flow, double x) {
  mck_flow *f = (mck_flow *)flow;
  for (size_t k = 0; k < f->pressed_count; k++)
    if (f->pressed[k].acts)
      find_root(f, &f->pressed[k], x);
  for (size_t k = 0; k < flow->tangent.columns; k++)
    move(f, x, k);
}

#include "mck_tangent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mck_hold.h"

/* Accelerations [n] along one tangent vector, contacts not held. */
static void accelerate(const mck_system *s, const unsigned char *contact, const double *q, const double *d_q,
                       const double *d_u, double *acceleration) {
  memset(acceleration, 0, s->base.coordinates * sizeof *acceleration);
  mck_rows_apply(&s->stiffness, -1, d_q, acceleration);
  mck_rows_apply(&s->damping, -1, d_u, acceleration);
  for (size_t j = 0; j < s->base.obstacle_count; j++) {
    const ric_obstacle *o = &s->base.obstacles[j];
    size_t i = o->coordinate;
    if (isfinite(o->stiffness) && (!contact || contact[j] == CONTACT_PRESSED))
      mck_push(s, i, -hertz_stiffness(o->stiffness, ric_obstacle_gap(o, q[i])) * d_q[i], acceleration);
  }
}

/* @param work  [3][n] */
static void column(const mck_system *s, const unsigned char *contact, mck_hold *hold, const double *q,
                   const tangents *d, size_t k, const tangents *d_rate, double *work) {
  size_t n = s->base.coordinates, columns = d->columns;
  double *d_q = work, *d_u = work + n, *acceleration = work + 2 * n;
  for (size_t i = 0; i < n; i++) {
    d_q[i] = d->q[i * columns + k];
    d_u[i] = d->u[i * columns + k];
  }
  accelerate(s, contact, q, d_q, d_u, acceleration);
  mck_hold_project(hold, s, acceleration);
  for (size_t i = 0; i < n; i++) {
    d_rate->q[i * columns + k] = d_u[i];
    d_rate->u[i * columns + k] = acceleration[i];
  }
}

const char *mck_tangent(const ric_system *base, const unsigned char *contact, double t, const double *q,
                        const double *u, const tangents *d, const tangents *d_rate) {
  (void)t;
  (void)u;
  const mck_system *s = mck_of(base);
  mck_hold hold = {0};
  double *work = malloc(3 * base->coordinates * sizeof *work);
  bool held = contact && base->obstacle_count && memchr(contact, CONTACT_HELD, base->obstacle_count);
  const char *trouble = work && (!held || mck_hold_init(&hold, s, contact)) ? NULL : "no memory for contacts";
  if (!trouble && held)
    trouble = mck_hold_set(&hold, s, contact);
  for (size_t k = 0; !trouble && k < d->columns; k++)
    column(s, contact, &hold, q, d, k, d_rate, work);
  mck_hold_clear(&hold);
  free(work);
  return trouble;
}

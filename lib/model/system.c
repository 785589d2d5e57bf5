/* Common part of all systems: creation, obstacles, tangent vectors by differences. */
#include "system_model.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/path_derivative.h"
#include "ricochet/system.h"

void ric_system_destroy(ric_system **system) {
  if (!system || !*system)
    return;
  free((*system)->obstacles);
  free((*system)->by_coordinate);
  (*system)->model->destroy(*system);
  *system = NULL;
}

size_t ric_system_coordinates(const ric_system *system) {
  return system->coordinates;
}

size_t ric_system_speeds(const ric_system *system) {
  return system->speeds;
}

size_t ric_system_obstacles(const ric_system *system) {
  return system->obstacle_count;
}

double ric_system_gap(const ric_system *system, size_t obstacle, double t, const double *q) {
  double gap;
  return system->model->gap(system, obstacle, t, q, &gap) == NULL ? gap : NAN;
}

double ric_system_gap_rate(const ric_system *system, size_t obstacle, double t, const double *q, const double *u) {
  double rate;
  return system->model->gap_rate(system, obstacle, t, q, u, &rate) == NULL ? rate : NAN;
}

double ric_system_energy(const ric_system *system, double t, const double *q, const double *u) {
  double energy;
  return system->model->energy(system, t, q, u, &energy) == NULL ? energy : NAN;
}

ric_status ric_system_rate(const ric_system *system, double t, const double *q, const double *u, double *q_rate,
                           double *u_rate, ric_error *error) {
  REQUIRE(error, {"system", system}, {"q", q}, {"q_rate", q_rate});
  REQUIRE(error, {"u", unless_empty(system->speeds, u)}, {"u_rate", unless_empty(system->speeds, u_rate)});
  const char *trouble = system->model->rate(system, NULL, t, q, u, q_rate, u_rate);
  return trouble ? ric_fail(error, RIC_ECALLBACK, "at t = %g: %s", t, trouble) : RIC_OK;
}

const char *system_list_held(const ric_system *s, const unsigned char *contact, size_t most, size_t *held,
                             size_t *count) {
  *count = 0;
  for (size_t j = 0; contact && j < s->obstacle_count; j++) {
    if (contact[j] != CONTACT_HELD)
      continue;
    if (*count == most)
      return "more contacts persist than the motion has directions";
    held[(*count)++] = j;
  }
  return NULL;
}

size_t system_tangent_work(const ric_system *s) {
  return 4 * (s->coordinates + s->speeds);
}

double system_tangent_step(double place, double pace, double speed) {
  double reach = fmax(place, pace / fmax(1, speed));
  return reach > 0 ? 2e-3 / reach : 1;
}

/* A straight line of states through (q, u) along one tangent vector. */
typedef struct state_line {
  const ric_system *s;
  const unsigned char *contact;
  double t;
  const double *q, *u;
  const tangents *d;
  size_t column;
  double *point; /* [n + m] */
} state_line;

static const char *rate_on_line(void *user, double x, double *rate) {
  const state_line *l = user;
  size_t n = l->s->coordinates, m = l->s->speeds, columns = l->d->columns;
  for (size_t i = 0; i < n; i++)
    l->point[i] = l->q[i] + x * l->d->q[i * columns + l->column];
  for (size_t i = 0; i < m; i++)
    l->point[n + i] = l->u[i] + x * l->d->u[i * columns + l->column];
  return l->s->model->rate(l->s, l->contact, l->t, l->point, l->point + n, rate, rate + n);
}

/* Of a column. */
static double largest_of(const double *x, size_t count, size_t stride) {
  double most = 0;
  for (size_t i = 0; i < count; i++)
    most = fmax(most, fabs(x[i * stride]));
  return most;
}

static double step_of(const state_line *l) {
  size_t n = l->s->coordinates, m = l->s->speeds, columns = l->d->columns;
  double place = largest_of(l->d->q + l->column, n, columns);
  double pace = m ? largest_of(l->d->u + l->column, m, columns) : 0;
  return system_tangent_step(place, pace, m ? largest(l->u, m) : 0);
}

const char *system_tangent(const ric_system *s, const unsigned char *contact, double t, const double *q,
                           const double *u, const tangents *d, const tangents *d_rate, double *work) {
  if (s->model->tangent)
    return s->model->tangent(s, contact, t, q, u, d, d_rate);
  size_t n = s->coordinates, size = n + s->speeds;
  double *derivative = work;
  state_line line = {.s = s, .contact = contact, .t = t, .q = q, .u = u, .d = d, .point = work + size};
  for (line.column = 0; line.column < d->columns; line.column++) {
    const char *trouble = path_derivative(rate_on_line, &line, step_of(&line), size, derivative, work + 2 * size);
    if (trouble)
      return trouble;
    for (size_t i = 0; i < size; i++)
      (i < n ? d_rate->q + i * d->columns : d_rate->u + (i - n) * d->columns)[line.column] = derivative[i];
  }
  return NULL;
}

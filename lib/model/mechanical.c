#include "mechanical.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/cholesky.h"
#include "numeric/number_block.h"
#include "user_callback.h"

static const mechanical *mechanical_of(const ric_system *system) {
  return (const mechanical *)system;
}

const char *mechanical_kinematics(const mechanical *s, double t, const double *q) {
  size_t n = s->model.coordinates, m = s->model.speeds;
  if (!s->model.kinematics)
    return NULL;
  int code = s->model.kinematics(t, q, s->B, s->b, s->model.user);
  TRY_TEXT(callback_check(code, s->B, n * m, CALLBACK_TEXTS("kinematics")));
  return callback_check(0, s->b, n, CALLBACK_TEXTS("kinematics"));
}

void mechanical_velocity(const mechanical *s, const double *u, double *q_rate) {
  size_t n = s->model.coordinates, m = s->model.speeds;
  if (!s->model.kinematics) {
    memcpy(q_rate, u, n * sizeof *u);
    return;
  }
  for (size_t i = 0; i < n; i++) { /* [FN97] (2.4) */
    q_rate[i] = s->b[i];
    for (size_t k = 0; k < m; k++)
      q_rate[i] += s->B[i * m + k] * u[k];
  }
}

const char *mechanical_normal(const mechanical *s, size_t obstacle, double t, const double *q, double *g,
                              double *offset) {
  size_t n = s->model.coordinates, m = s->model.speeds;
  TRY_TEXT(user_gap_gradient(&s->gap, obstacle, t, q, s->gradient, offset));
  if (!s->model.kinematics) {
    memcpy(g, s->gradient, n * sizeof *g);
    return NULL;
  }
  memset(g, 0, m * sizeof *g);
  for (size_t i = 0; i < n; i++) {
    *offset += s->gradient[i] * s->b[i];
    for (size_t k = 0; k < m; k++)
      g[k] += s->B[i * m + k] * s->gradient[i];
  }
  return NULL;
}

const char *mechanical_mass(const mechanical *s, double t, const double *q) {
  size_t m = s->model.speeds;
  if (!s->model.mass)
    return NULL;
  int code = s->model.mass(t, q, s->mass, s->model.user);
  TRY_TEXT(callback_check(code, s->mass, m * m, CALLBACK_TEXTS("mass")));
  return cholesky_factor(s->mass, m) ? NULL : "the mass matrix of the mass callback is not positive definite";
}

void mechanical_mass_solve(const mechanical *s, double *x) {
  if (s->model.mass)
    cholesky_solve(s->mass, s->model.speeds, x);
}

const char *mechanical_free_rate(const mechanical *s, double t, const double *q, const double *u, double *q_rate,
                                 double *u_rate) {
  TRY_TEXT(mechanical_kinematics(s, t, q));
  mechanical_velocity(s, u, q_rate);
  int code = s->model.force(t, q, u, u_rate, s->model.user);
  TRY_TEXT(callback_check(code, u_rate, s->model.speeds, CALLBACK_TEXTS("force")));
  TRY_TEXT(mechanical_mass(s, t, q));
  mechanical_mass_solve(s, u_rate); /* [FN97] (2.3) */
  return NULL;
}

static const char *rate(const ric_system *system, const unsigned char *contact, double t, const double *q,
                        const double *u, double *q_rate, double *u_rate) {
  const mechanical *s = mechanical_of(system);
  size_t count;
  TRY_TEXT(mechanical_free_rate(s, t, q, u, q_rate, u_rate));
  return mechanical_hold(s, contact, t, q, u, q_rate, u_rate, &count);
}

static const char *gap(const ric_system *system, size_t obstacle, double t, const double *q, double *h) {
  return user_gap_value(&mechanical_of(system)->gap, obstacle, t, q, h);
}

static const char *direction(const ric_system *system, size_t obstacle, double t, const double *q,
                             contact_direction *d) {
  const mechanical *s = mechanical_of(system);
  d->first = 0;
  d->count = s->model.speeds;
  TRY_TEXT(mechanical_kinematics(s, t, q));
  TRY_TEXT(mechanical_normal(s, obstacle, t, q, d->g, &d->offset));
  TRY_TEXT(mechanical_mass(s, t, q));
  memcpy(d->w, d->g, d->count * sizeof *d->w);
  mechanical_mass_solve(s, d->w);
  return NULL;
}

static const char *energy(const ric_system *system, double t, const double *q, const double *u, double *value) {
  const ric_mechanical *model = &mechanical_of(system)->model;
  *value = NAN;
  if (!model->energy)
    return NULL;
  return callback_check(model->energy(t, q, u, value, model->user), value, 1, CALLBACK_TEXTS("energy"));
}

static double restitution(const ric_system *system, size_t obstacle) {
  return mechanical_of(system)->restitution[obstacle];
}

static void destroy(ric_system *system) {
  mechanical *s = (mechanical *)system;
  free(s->restitution);
  free(s->numbers);
  free(s->held);
  free(s);
}

static const char *gap_derivative(const ric_system *system, size_t obstacle, double t, const double *q,
                                  const tangents *d, double *derivative) {
  const mechanical *s = (const mechanical *)system;
  return user_gap_derivative(&s->gap, obstacle, t, q, d, s->gradient, derivative);
}

static const system_model table = {.rate = rate,
                                   .gap = gap,
                                   .gap_derivative = gap_derivative,
                                   .gap_rate = mechanical_gap_rate,
                                   .gap_acceleration = mechanical_gap_acceleration,
                                   .direction = direction,
                                   .reaction = mechanical_reaction,
                                   .energy = energy,
                                   .restitution = restitution,
                                   .destroy = destroy};

static ric_status check(const ric_mechanical *model, ric_error *error) {
  if (!(model->coordinates >= 1 && model->coordinates <= UINT32_MAX / 16))
    return ric_fail(error, RIC_EINVAL, "coordinates = %zu, expected 1 to %u", model->coordinates, UINT32_MAX / 16);
  if (!(model->speeds >= 1 && model->speeds <= model->coordinates))
    return ric_fail(error, RIC_EINVAL, "speeds = %zu, expected 1 to coordinates = %zu", model->speeds,
                    model->coordinates);
  if (!model->force)
    return ric_fail(error, RIC_EINVAL, "force = NULL, expected a callback");
  if (!model->kinematics && model->speeds != model->coordinates)
    return ric_fail(error, RIC_EINVAL, "kinematics = NULL, expected a callback: speeds = %zu, coordinates = %zu",
                    model->speeds, model->coordinates);
  if (!model->gap && model->obstacles > 0)
    return ric_fail(error, RIC_EINVAL, "gap = NULL, expected a callback: obstacles = %zu", model->obstacles);
  for (size_t j = 0; j < model->obstacles && model->restitution; j++)
    if (!(model->restitution[j] >= 0 && model->restitution[j] <= 1))
      return ric_fail(error, RIC_EINVAL, "restitution[%zu] = %g, expected 0 <= e <= 1", j, model->restitution[j]);
  return RIC_OK;
}

static size_t lay_out(mechanical *s, double *block) {
  size_t n = s->model.coordinates, m = s->model.speeds, k = s->held_most, used = 0;
  s->mass = number_block_take(block, &used, m * m);
  s->B = number_block_take(block, &used, n * m);
  s->b = number_block_take(block, &used, n);
  s->gradient = number_block_take(block, &used, n);
  s->gap.point = number_block_take(block, &used, n);
  s->normal = number_block_take(block, &used, m);
  s->path_q = number_block_take(block, &used, n);
  s->path_u = number_block_take(block, &used, m);
  s->rate_q = number_block_take(block, &used, n);
  s->rate_u = number_block_take(block, &used, m);
  s->held_g = number_block_take(block, &used, k * m);
  s->held_w = number_block_take(block, &used, k * m);
  s->held_matrix = number_block_take(block, &used, k * k);
  s->lambda = number_block_take(block, &used, k);
  return used;
}

static bool allocate(mechanical *s) {
  size_t count = s->model.obstacles;
  s->held_most = count < s->model.speeds ? count : s->model.speeds;
  s->numbers = calloc(lay_out(s, NULL), sizeof *s->numbers);
  s->restitution = calloc(count ? count : 1, sizeof *s->restitution);
  s->held = calloc(s->held_most ? s->held_most : 1, sizeof *s->held);
  if (!s->numbers || !s->restitution || !s->held)
    return false;
  lay_out(s, s->numbers);
  return true;
}

ric_status ric_system_create_mechanical(const ric_mechanical *model, ric_system **system, ric_error *error) {
  *system = NULL;
  RIC_TRY(check(model, error));
  mechanical *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a system");
  s->base = (ric_system){.model = &table,
                         .coordinates = model->coordinates,
                         .speeds = model->speeds,
                         .obstacle_count = model->obstacles,
                         .uncoupled = model->obstacles <= 1};
  s->model = *model;
  s->gap = (user_gap){model->coordinates, model->gap, model->gap_gradient, model->user, NULL};
  if (!allocate(s)) {
    destroy(&s->base);
    return ric_fail(error, RIC_ENOMEM, "no memory for a mechanical system of %zu coordinates", model->coordinates);
  }
  for (size_t j = 0; j < model->obstacles; j++)
    s->restitution[j] = model->restitution ? model->restitution[j] : 1;
  s->model.restitution = s->restitution;
  *system = &s->base;
  return RIC_OK;
}

/* Mechanical systems of a user: rates, gaps, impulses, and the forces of contacts that stick. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/linear.h"
#include "numeric/number_block.h"
#include "numeric/path_derivative.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "system_model.h"
#include "user_gap.h"

typedef struct mechanical {
  ric_system base;
  ric_mechanical model;
  user_gap gap;
  double *restitution;                       /* [obstacles] */
  double *numbers;                           /* one block of memory for all the following and for `gap` */
  double *mass;                              /* [m][m], factorised */
  double *B, *b;                             /* [n][m], [n] of the last kinematics */
  double *gradient;                          /* [n] of the last gap */
  double *normal;                            /* [m] g of gap_rate */
  double *path_q, *path_u, *rate_q, *rate_u; /* [n], [m]: points of a path, and free rates */
  size_t *held;                              /* [held_most] indices of the contacts that are held */
  size_t held_most;
  double *held_g, *held_w, *held_matrix, *lambda; /* [held_most][m] twice, [held_most][held_most], [held_most] */
} mechanical;

static const mechanical *mechanical_of(const ric_system *system) {
  return (const mechanical *)system;
}

/** B and b at (t, q), for mechanical_velocity and mechanical_normal. */
static const char *mechanical_kinematics(const mechanical *s, double t, const double *q) {
  size_t n = s->model.coordinates, m = s->model.speeds;
  if (!s->model.kinematics)
    return NULL;
  int code = s->model.kinematics(t, q, s->B, s->b, s->model.user);
  TRY_TEXT(callback_check(code, s->B, n * m, CALLBACK_TEXTS("kinematics")));
  return callback_check(0, s->b, n, CALLBACK_TEXTS("kinematics"));
}

/** q' = B u + b. */
static void mechanical_velocity(const mechanical *s, const double *u, double *q_rate) {
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

/** g = B^T grad h [m] and the part of the gap rate that does not depend on the speeds. */
static const char *mechanical_normal(const mechanical *s, size_t obstacle, double t, const double *q, double *g,
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

/** M, factorised in s->mass. */
static const char *mechanical_mass(const mechanical *s, double t, const double *q) {
  size_t m = s->model.speeds;
  if (!s->model.mass)
    return NULL;
  int code = s->model.mass(t, q, s->mass, s->model.user);
  TRY_TEXT(callback_check(code, s->mass, m * m, CALLBACK_TEXTS("mass")));
  return cholesky_factor(s->mass, m) ? NULL : "the mass matrix of the mass callback is not positive definite";
}

/** x [m] from M x = x. */
static void mechanical_mass_solve(const mechanical *s, double *x) {
  if (s->model.mass)
    cholesky_solve(s->mass, s->model.speeds, x);
}

/** Rates of the free motion; leaves kinematics and mass at (t, q). */
static const char *mechanical_free_rate(const mechanical *s, double t, const double *q, const double *u, double *q_rate,
                                        double *u_rate) {
  TRY_TEXT(mechanical_kinematics(s, t, q));
  mechanical_velocity(s, u, q_rate);
  int code = s->model.force(t, q, u, u_rate, s->model.user);
  TRY_TEXT(callback_check(code, u_rate, s->model.speeds, CALLBACK_TEXTS("force")));
  TRY_TEXT(mechanical_mass(s, t, q));
  mechanical_mass_solve(s, u_rate); /* [FN97] (2.3) */
  return NULL;
}

/* Contacts of mechanical systems: gap rates and accelerations along a motion, and the forces of contacts that stick. */

/* g and w = M^-1 g of contact k of the list, and its row of g^T M^-1 g. */
static const char *held_row(const mechanical *s, size_t k, size_t count, double t, const double *q) {
  size_t m = s->model.speeds;
  double *g = s->held_g + k * m, *w = s->held_w + k * m, offset;
  TRY_TEXT(mechanical_normal(s, s->held[k], t, q, g, &offset));
  memcpy(w, g, m * sizeof *w);
  mechanical_mass_solve(s, w);
  for (size_t l = 0; l <= k; l++)
    s->held_matrix[k * count + l] = dot(s->held_g + l * m, w, m);
  return NULL;
}

typedef struct motion_path {
  const mechanical *s;
  size_t obstacle;
  double t;
  const double *q, *u, *q_rate, *u_rate;
} motion_path;

/* Step in time for the derivative of a gap rate; coordinates move by at most as much. */
static const double path_step = 1.0 / 512;

static const char *mechanical_gap_rate(const ric_system *system, size_t obstacle, double t, const double *q,
                                       const double *u, double *rate) {
  const mechanical *s = (const mechanical *)system;
  double offset;
  TRY_TEXT(mechanical_kinematics(s, t, q));
  TRY_TEXT(mechanical_normal(s, obstacle, t, q, s->normal, &offset));
  *rate = dot(s->normal, u, s->model.speeds) + offset;
  return NULL;
}

static const char *gap_rate_on(void *user, double step, double *rate) {
  const motion_path *p = user;
  const mechanical *s = p->s;
  for (size_t i = 0; i < s->model.coordinates; i++)
    s->path_q[i] = p->q[i] + step * p->q_rate[i];
  for (size_t k = 0; k < s->model.speeds; k++)
    s->path_u[k] = p->u[k] + step * p->u_rate[k];
  return mechanical_gap_rate(&s->base, p->obstacle, p->t + step, s->path_q, s->path_u, rate);
}

static const char *mechanical_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *q,
                                               const double *u, const double *q_rate, const double *u_rate,
                                               double *acceleration) {
  const mechanical *s = (const mechanical *)system;
  motion_path path = {s, obstacle, t, q, u, q_rate, u_rate};
  double step = path_step / fmax(1, largest(q_rate, s->model.coordinates));
  return path_derivative(gap_rate_on, &path, step, 1, acceleration, NULL);
}

/** Adds the forces of the held contacts to free rates, with kinematics and mass at (t, q); s->held lists the contacts,
 *  s->lambda their forces, `count` how many. @param contact  NULL: none */
/* The forces make the second derivatives of the held gaps vanish: (g^T M^-1 g) lambda = -h'' of the free motion. A
 * contact whose gradient depends on the previous ones is held by them and gets no force. */
static const char *mechanical_hold(const mechanical *s, const unsigned char *contact, double t, const double *q,
                                   const double *u, const double *q_rate, double *u_rate, size_t *count) {
  size_t m = s->model.speeds;
  TRY_TEXT(system_list_held(&s->base, contact, s->held_most, s->held, count));
  for (size_t k = 0; k < *count; k++) /* all of them first: accelerations overwrite the kinematics */
    TRY_TEXT(held_row(s, k, *count, t, q));
  for (size_t k = 0; k < *count; k++) {
    TRY_TEXT(mechanical_gap_acceleration(&s->base, s->held[k], t, q, u, q_rate, u_rate, &s->lambda[k]));
    s->lambda[k] = -s->lambda[k];
  }
  cholesky_factor_semidefinite(s->held_matrix, *count);
  cholesky_solve(s->held_matrix, *count, s->lambda);
  for (size_t k = 0; k < *count; k++)
    for (size_t i = 0; i < m; i++)
      u_rate[i] += s->lambda[k] * s->held_w[k * m + i];
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

static const char *mechanical_reaction(const ric_system *system, const unsigned char *contact, size_t obstacle,
                                       double t, const double *q, const double *u, double *lambda) {
  const mechanical *s = (const mechanical *)system;
  size_t count;
  TRY_TEXT(mechanical_free_rate(s, t, q, u, s->rate_q, s->rate_u));
  TRY_TEXT(mechanical_hold(s, contact, t, q, u, s->rate_q, s->rate_u, &count));
  *lambda = 0;
  for (size_t k = 0; k < count; k++)
    if (s->held[k] == obstacle)
      *lambda = s->lambda[k];
  return NULL;
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

static ric_status check_model(const ric_mechanical *model, ric_error *error) {
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

static size_t lay_out_mechanical(mechanical *s, double *block) {
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

static bool allocate_mechanical(mechanical *s) {
  size_t count = s->model.obstacles;
  s->held_most = count < s->model.speeds ? count : s->model.speeds;
  s->numbers = calloc(lay_out_mechanical(s, NULL), sizeof *s->numbers);
  s->restitution = calloc(count ? count : 1, sizeof *s->restitution);
  s->held = calloc(s->held_most ? s->held_most : 1, sizeof *s->held);
  if (!s->numbers || !s->restitution || !s->held)
    return false;
  lay_out_mechanical(s, s->numbers);
  return true;
}

ric_status ric_system_create_mechanical(const ric_mechanical *model, ric_system **system, ric_error *error) {
  REQUIRE(error, {"model", model}, {"system", system});
  *system = NULL;
  RIC_TRY(check_model(model, error));
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
  if (!allocate_mechanical(s)) {
    destroy(&s->base);
    return ric_fail(error, RIC_ENOMEM, "no memory for a mechanical system of %zu coordinates", model->coordinates);
  }
  for (size_t j = 0; j < model->obstacles; j++)
    s->restitution[j] = model->restitution ? model->restitution[j] : 1;
  s->model.restitution = s->restitution;
  *system = &s->base;
  return RIC_OK;
}

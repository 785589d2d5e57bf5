/* Contacts of mechanical systems: how gaps change along a motion, and the forces that hold them. */
#include <math.h>
#include <string.h>

#include "numeric/cholesky.h"
#include "numeric/largest.h"
#include "mechanical.h"
#include "numeric/path_derivative.h"
#include "user_callback.h"

/* Step in time of the derivative of a gap rate, for coordinates that move by at most it. */
static const double path_step = 1.0 / 512;

static double dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t k = 0; k < count; k++)
    sum += a[k] * b[k];
  return sum;
}

const char *mechanical_gap_rate(const ric_system *system, size_t obstacle, double t, const double *q, const double *u,
                                double *rate) {
  const mechanical *s = (const mechanical *)system;
  double offset;
  TRY_TEXT(mechanical_kinematics(s, t, q));
  TRY_TEXT(mechanical_normal(s, obstacle, t, q, s->normal, &offset));
  *rate = dot(s->normal, u, s->model.speeds) + offset;
  return NULL;
}

typedef struct motion_path {
  const mechanical *s;
  size_t obstacle;
  double t;
  const double *q, *u, *q_rate, *u_rate;
} motion_path;

static const char *gap_rate_on(void *user, double step, double *rate) {
  const motion_path *p = user;
  const mechanical *s = p->s;
  for (size_t i = 0; i < s->model.coordinates; i++)
    s->path_q[i] = p->q[i] + step * p->q_rate[i];
  for (size_t k = 0; k < s->model.speeds; k++)
    s->path_u[k] = p->u[k] + step * p->u_rate[k];
  return mechanical_gap_rate(&s->base, p->obstacle, p->t + step, s->path_q, s->path_u, rate);
}

const char *mechanical_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *q,
                                        const double *u, const double *q_rate, const double *u_rate,
                                        double *acceleration) {
  const mechanical *s = (const mechanical *)system;
  motion_path path = {s, obstacle, t, q, u, q_rate, u_rate};
  double step = path_step / fmax(1, largest(q_rate, s->model.coordinates));
  return path_derivative(gap_rate_on, &path, step, 1, acceleration, NULL);
}

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

/* The forces make the second derivatives of the held gaps vanish: (g^T M^-1 g) lambda = -h'' of the free motion. A
 * contact whose gradient depends on those before it is held by them and gets no force. */
const char *mechanical_hold(const mechanical *s, const unsigned char *contact, double t, const double *q,
                            const double *u, const double *q_rate, double *u_rate, size_t *count) {
  size_t m = s->model.speeds;
  TRY_TEXT(system_list_held(&s->base, contact, s->held_most, s->held, count));
  for (size_t k = 0; k < *count; k++) /* all of them first: accelerations use the place of the kinematics */
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

const char *mechanical_reaction(const ric_system *system, const unsigned char *contact, size_t obstacle, double t,
                                const double *q, const double *u, double *lambda) {
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

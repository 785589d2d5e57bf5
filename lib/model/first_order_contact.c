/* Contacts of first-order systems: how gaps change along a motion, and the forces that hold them.
 *
 * A held contact pushes along the direction D in which the impact map moves states that are about to leave the surface
 * of zero gap rate, D = lim (G(x - s p) - (x - s p)) / s, normalised so that the gap rate changes at unit rate along
 * D. */
#include <math.h>
#include <string.h>

#include "first_order.h"
#include "largest.h"
#include "path_derivative.h"
#include "user_callback.h"

static const double path_step = 1.0 / 512;  /* largest shift of a state in the derivative of a gap rate */
static const double trial_step = 1.0 / 128; /* largest shift before a trial impact; halved for extrapolation */

const char *first_order_gap_rate(const ric_system *system, size_t obstacle, double t, const double *x, const double *u,
                                 double *rate) {
  const first_order *s = (const first_order *)system;
  double sum;
  (void)u;
  TRY_TEXT(first_order_free_rate(s, t, x, s->rate));
  TRY_TEXT(user_gap_gradient(&s->gap, obstacle, t, x, s->gradient, &sum));
  for (size_t i = 0; i < s->model.states; i++)
    sum += s->gradient[i] * s->rate[i];
  *rate = sum;
  return NULL;
}

/* A straight path of states through x; time runs along with speed `time_rate`. */
typedef struct state_path {
  const first_order *s;
  size_t obstacle;
  double t, time_rate;
  const double *x, *x_rate;
} state_path;

static const char *gap_rate_on(void *user, double step, double *rate) {
  const state_path *p = user;
  for (size_t i = 0; i < p->s->model.states; i++)
    p->s->path[i] = p->x[i] + step * p->x_rate[i];
  return first_order_gap_rate(&p->s->base, p->obstacle, p->t + step * p->time_rate, p->s->path, NULL, rate);
}

static const char *gap_rate_along(const first_order *s, size_t obstacle, double t, double time_rate, const double *x,
                                  const double *x_rate, double *slope) {
  state_path path = {s, obstacle, t, time_rate, x, x_rate};
  return path_derivative(gap_rate_on, &path, path_step / fmax(1, largest(x_rate, s->model.states)), 1, slope, NULL);
}

const char *first_order_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *x,
                                         const double *u, const double *x_rate, const double *u_rate,
                                         double *acceleration) {
  (void)u;
  (void)u_rate;
  return gap_rate_along((const first_order *)system, obstacle, t, 1, x, x_rate, acceleration);
}

/* d [n] scaled so that the gap rate changes at unit rate along it. */
static const char *normalise(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  double slope;
  TRY_TEXT(gap_rate_along(s, obstacle, t, 0, x, d, &slope));
  for (size_t i = 0; i < s->model.states; i++)
    d[i] /= slope;
  return all_finite(d, s->model.states) ? NULL
                                        : "the impact map of a contact that persists leaves the gap rate as it is";
}

/* Gradient of the gap rate over its square: it only has to lead to states with a gap rate below zero. */
static const char *steepest(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  size_t n = s->model.states;
  for (size_t i = 0; i < n; i++) {
    memset(s->before, 0, n * sizeof *s->before);
    s->before[i] = 1;
    TRY_TEXT(gap_rate_along(s, obstacle, t, 0, x, s->before, &d[i]));
  }
  return normalise(s, obstacle, t, x, d);
}

/* (G(x - s d) - (x - s d)) / s. */
static const char *trial(const first_order *s, size_t obstacle, double t, const double *x, const double *d, double step,
                         double *moved) {
  for (size_t i = 0; i < s->model.states; i++)
    s->before[i] = x[i] - step * d[i];
  TRY_TEXT(first_order_map(s, obstacle, t, s->before, s->after));
  for (size_t i = 0; i < s->model.states; i++)
    moved[i] = (s->after[i] - s->before[i]) / step;
  return NULL;
}

/* Limit of the trial for vanishing steps by Neville's scheme, from one side: G may do nothing on the other. */
static const char *limit(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  size_t n = s->model.states;
  double step = trial_step / fmax(1, largest(d, n));
  for (size_t k = 0; k < FIRST_ORDER_TRIALS; k++)
    TRY_TEXT(trial(s, obstacle, t, x, d, ldexp(step, -(int)k), s->table + k * n));
  for (size_t order = 1; order < FIRST_ORDER_TRIALS; order++)
    for (size_t k = FIRST_ORDER_TRIALS - 1; k >= order; k--)
      for (size_t i = 0; i < n; i++) {
        double *fine = s->table + k * n + i, coarse = s->table[(k - 1) * n + i];
        *fine += (*fine - coarse) / (ldexp(1, (int)order) - 1);
      }
  memcpy(d, s->table + (FIRST_ORDER_TRIALS - 1) * n, n * sizeof *d);
  return normalise(s, obstacle, t, x, d);
}

/* D of a contact. The trial along the gradient leads roughly there; along D itself the gap does not change. */
static const char *contact_push(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  TRY_TEXT(steepest(s, obstacle, t, x, d));
  TRY_TEXT(limit(s, obstacle, t, x, d));
  return limit(s, obstacle, t, x, d);
}

static void swap_rows(double *a, double *b, size_t n, size_t i, size_t j) {
  for (size_t k = 0; k < n && i != j; k++) {
    double value = a[i * n + k];
    a[i * n + k] = a[j * n + k];
    a[j * n + k] = value;
  }
  double value = b[i];
  b[i] = b[j];
  b[j] = value;
}

/* b from a b = b by elimination with pivots; a singular matrix gives numbers that are not finite. */
static void eliminate(double *a, double *b, size_t n) {
  for (size_t i = 0; i < n; i++) {
    size_t pivot = i;
    for (size_t r = i + 1; r < n; r++)
      if (fabs(a[r * n + i]) > fabs(a[pivot * n + i]))
        pivot = r;
    swap_rows(a, b, n, i, pivot);
    for (size_t r = i + 1; r < n; r++) {
      double factor = a[r * n + i] / a[i * n + i];
      for (size_t k = i; k < n; k++)
        a[r * n + k] -= factor * a[i * n + k];
      b[r] -= factor * b[i];
    }
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; k++)
      b[i] -= a[i * n + k] * b[k];
    b[i] /= a[i * n + i];
  }
}

/* Row k of the equations for the forces: how each of them changes gap rate k, and -h'' of the free motion. */
static const char *held_row(const first_order *s, size_t k, size_t count, double t, const double *x,
                            const double *x_rate) {
  size_t n = s->model.states;
  for (size_t l = 0; l < count; l++) {
    double *entry = &s->matrix[k * count + l];
    *entry = 1;
    if (l != k)
      TRY_TEXT(gap_rate_along(s, s->held[k], t, 0, x, s->direction + l * n, entry));
  }
  TRY_TEXT(gap_rate_along(s, s->held[k], t, 1, x, x_rate, &s->lambda[k]));
  s->lambda[k] = -s->lambda[k];
  return NULL;
}

const char *first_order_hold(const first_order *s, const unsigned char *contact, double t, const double *x,
                             double *x_rate, size_t *count) {
  size_t n = s->model.states;
  TRY_TEXT(system_list_held(&s->base, contact, s->held_most, s->held, count));
  for (size_t k = 0; k < *count; k++)
    TRY_TEXT(contact_push(s, s->held[k], t, x, s->direction + k * n));
  for (size_t k = 0; k < *count; k++)
    TRY_TEXT(held_row(s, k, *count, t, x, x_rate));
  eliminate(s->matrix, s->lambda, *count);
  if (!all_finite(s->lambda, *count))
    return "contacts that persist together do not determine their forces";
  for (size_t k = 0; k < *count; k++)
    for (size_t i = 0; i < n; i++)
      x_rate[i] += s->lambda[k] * s->direction[k * n + i];
  return NULL;
}

const char *first_order_reaction(const ric_system *system, const unsigned char *contact, size_t obstacle, double t,
                                 const double *x, const double *u, double *lambda) {
  const first_order *s = (const first_order *)system;
  size_t count;
  (void)u;
  TRY_TEXT(first_order_free_rate(s, t, x, s->free_rate));
  TRY_TEXT(first_order_hold(s, contact, t, x, s->free_rate, &count));
  *lambda = 0;
  for (size_t k = 0; k < count; k++)
    if (s->held[k] == obstacle)
      *lambda = s->lambda[k];
  return NULL;
}

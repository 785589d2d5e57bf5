/* The impact map of a first-order system where the gap rate vanishes.
 *
 * States that are about to leave the surface of zero gap rate are x - s p, where the gap rate changes at unit rate
 * along p and s > 0 is small. The map moves them by s xi + O(s^2), whatever p is: xi = lim (G(x - s p) - (x - s p)) /
 * s, by extrapolation from one side, since G may do nothing on the other. A contact that persists pushes along xi. */
#include <math.h>
#include <string.h>

#include "first_order.h"
#include "numeric/largest.h"
#include "numeric/path_derivative.h"
#include "user_callback.h"

static const double path_step = 1.0 / 512;  /* largest shift of a state in the derivative of a gap rate */
static const double trial_step = 1.0 / 128; /* largest shift before a trial impact; halved for extrapolation */

enum {
  SCALES = 4,     /* of trial steps: where the map bends within the first one the next is tried */
  SCALE_BITS = 5, /* the next one is so many times halved */
  FOOT_STEPS = 3  /* of Newton's method to the surface of zero gap rate, along a line */
};

/* Of the extrapolations against 1 + the size of xi: what smooth maps leave is 1e-8 or less, what others leave is of
 * order one at every scale. */
static const double limit_tol = 1e-6;
static const double fine_limit = 1e-10; /* the same, absolute: no other scale can do much better */

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

const char *first_order_rate_slope(const first_order *s, size_t obstacle, double t, double time_rate, const double *x,
                                   const double *x_rate, double *slope) {
  state_path path = {s, obstacle, t, time_rate, x, x_rate};
  return path_derivative(gap_rate_on, &path, path_step / fmax(1, largest(x_rate, s->model.states)), 1, slope, NULL);
}

/* d [n] scaled so that the gap rate changes at unit rate along it; `slope`: at which rate it did. */
static const char *normalise(const first_order *s, size_t obstacle, double t, const double *x, double *d,
                             double *slope) {
  TRY_TEXT(first_order_rate_slope(s, obstacle, t, 0, x, d, slope));
  for (size_t i = 0; i < s->model.states; i++)
    d[i] /= *slope;
  return all_finite(d, s->model.states) ? NULL
                                        : "the impact map of a contact that persists leaves the gap rate as it is";
}

/* Gradient of the gap rate over its square: it only has to lead to states with a gap rate below zero. */
static const char *steepest(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  size_t n = s->model.states;
  double slope;
  for (size_t i = 0; i < n; i++) {
    memset(s->before, 0, n * sizeof *s->before);
    s->before[i] = 1;
    TRY_TEXT(first_order_rate_slope(s, obstacle, t, 0, x, s->before, &d[i]));
  }
  return normalise(s, obstacle, t, x, d, &slope);
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

/* Limit of the trial for vanishing steps by Neville's scheme, from `step` on. `error`: what the last order changed */
static const char *extrapolate(const first_order *s, size_t obstacle, double t, const double *x, const double *d,
                               double step, double *limit, double *error) {
  size_t n = s->model.states;
  const double *last = s->table + (FIRST_ORDER_TRIALS - 1) * n;
  for (size_t k = 0; k < FIRST_ORDER_TRIALS; k++)
    TRY_TEXT(trial(s, obstacle, t, x, d, ldexp(step, -(int)k), s->table + k * n));
  *error = 0;
  for (size_t order = 1; order < FIRST_ORDER_TRIALS; order++)
    for (size_t k = FIRST_ORDER_TRIALS - 1; k >= order; k--)
      for (size_t i = 0; i < n; i++) {
        double *fine = s->table + k * n + i, coarse = s->table[(k - 1) * n + i];
        double change = (*fine - coarse) / (ldexp(1, (int)order) - 1);
        *fine += change;
        if (order == FIRST_ORDER_TRIALS - 1)
          *error = fmax(*error, fabs(change));
      }
  memcpy(limit, last, n * sizeof *limit);
  return NULL;
}

static double first_step(const first_order *s, const double *d) {
  return trial_step / fmax(1, largest(d, s->model.states));
}

static const char *push_along(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  double error, slope;
  TRY_TEXT(extrapolate(s, obstacle, t, x, d, first_step(s, d), d, &error));
  return normalise(s, obstacle, t, x, d, &slope);
}

/* The trial along the gradient leads roughly there; along D itself the gap does not change. */
const char *first_order_push(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  TRY_TEXT(steepest(s, obstacle, t, x, d));
  TRY_TEXT(push_along(s, obstacle, t, x, d));
  return push_along(s, obstacle, t, x, d);
}

/* The state on the line x + s d where the gap rate vanishes, in s->foot. */
static const char *find_foot(const first_order *s, size_t obstacle, double t, const double *x, const double *d) {
  double rate;
  memcpy(s->foot, x, s->model.states * sizeof *x);
  for (int k = 0; k < FOOT_STEPS; k++) {
    TRY_TEXT(first_order_gap_rate(&s->base, obstacle, t, s->foot, NULL, &rate));
    for (size_t i = 0; i < s->model.states; i++)
      s->foot[i] -= rate * d[i];
  }
  return NULL;
}

/* The limit along d from the scale that gives it best. */
static const char *best_limit(const first_order *s, size_t obstacle, double t, const double *d, double *xi,
                              double *error) {
  double step = first_step(s, d), now;
  *error = INFINITY;
  for (int k = 0; k < SCALES && !(*error <= fine_limit); k++) {
    TRY_TEXT(extrapolate(s, obstacle, t, s->foot, d, ldexp(step, -SCALE_BITS * k), s->limit, &now));
    if (now < *error) {
      *error = now;
      memcpy(xi, s->limit, s->model.states * sizeof *xi);
    }
  }
  return NULL;
}

/* By how much the map moves a state of gap rate -step, and the power of the rate with which that vanishes. */
static const char *follow_down(const first_order *s, size_t obstacle, double t, const double *d, impact_slope *found) {
  double coarse, step = first_step(s, d), far = ldexp(step, -SCALE_BITS * SCALES);
  TRY_TEXT(trial(s, obstacle, t, s->foot, d, step, s->limit));
  coarse = step * largest(s->limit, s->model.states);
  TRY_TEXT(trial(s, obstacle, t, s->foot, d, far, s->limit));
  found->moved = far * largest(s->limit, s->model.states);
  found->rate = -far;
  found->power = log(coarse / found->moved) / log(step / far);
  return NULL;
}

const char *first_order_impact_slope(const ric_system *system, size_t obstacle, double t, const double *x, double *xi,
                                     impact_slope *found) {
  const first_order *s = (const first_order *)system;
  double *d = s->approach, error;
  TRY_TEXT(steepest(s, obstacle, t, x, d));
  TRY_TEXT(find_foot(s, obstacle, t, x, d));
  TRY_TEXT(best_limit(s, obstacle, t, d, xi, &error));
  TRY_TEXT(follow_down(s, obstacle, t, d, found));
  found->exists = error <= limit_tol * (1 + largest(xi, s->model.states));
  return first_order_rate_slope(s, obstacle, t, 0, s->foot, xi, &found->turn);
}

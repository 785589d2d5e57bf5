/* First-order systems of a user: rates, impact maps and their limit at grazing, and the forces of contacts that stick.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/number_block.h"
#include "numeric/path_derivative.h"
#include "ricochet/elementary.h"
#include "system_model.h"
#include "user_gap.h"

typedef struct first_order {
  ric_system base;
  ric_first_order model;
  user_gap gap;
  double *ratio;                 /* [obstacles] restitution of the last impact; written by impact */
  double *numbers;               /* one block of memory for all the following and for `gap` */
  double *gradient, *rate;       /* [n] of the last gap rate */
  double *path, *before, *after; /* [n] points of a path; states before and after a trial impact */
  double *free_rate, *table;     /* [n] free rate of the reaction; [FIRST_ORDER_TRIALS][n] extrapolation */
  double *foot, *approach; /* [n] a state of zero gap rate, and the line along which impact maps are evaluated there */
  double *limit;           /* [n] of an extrapolation */
  size_t *held;            /* [held_most] indices of the contacts that are held */
  size_t held_most;
  double *direction, *matrix, *lambda; /* [held_most][n], [held_most][held_most], [held_most] */
} first_order;

enum { FIRST_ORDER_TRIALS = 4 };

static const first_order *first_order_of(const ric_system *system) {
  return (const first_order *)system;
}

/** F at (t, x). */
static const char *first_order_free_rate(const first_order *s, double t, const double *x, double *rate) {
  return callback_check(s->model.rate(t, x, rate, s->model.user), rate, s->model.states, CALLBACK_TEXTS("rate"));
}

/** G at (t, x). */
static const char *first_order_map(const first_order *s, size_t obstacle, double t, const double *x, double *x_after) {
  int code = s->model.impact(t, x, obstacle, x_after, s->model.user);
  return callback_check(code, x_after, s->model.states, CALLBACK_TEXTS("impact"));
}

/* The impact map of a first-order system where the gap rate vanishes.
 *
 * States near the surface of zero gap rate are x - s p, where the gap rate changes at unit rate along p and s > 0 is
 * small. The map moves them by s xi + O(s^2) for every p: xi = lim (G(x - s p) - (x - s p)) / s, by one-sided
 * extrapolation, since G may be the identity on the other side. The force of a contact that sticks acts along xi. */

/* A straight path of states through x; time runs along with speed `time_rate`. */
typedef struct state_path {
  const first_order *s;
  size_t obstacle;
  double t, time_rate;
  const double *x, *x_rate;
} state_path;

static const char *first_order_gap_rate(const ric_system *system, size_t obstacle, double t, const double *x,
                                        const double *u, double *rate) {
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

static const char *gap_rate_on(void *user, double step, double *rate) {
  const state_path *p = user;
  for (size_t i = 0; i < p->s->model.states; i++)
    p->s->path[i] = p->x[i] + step * p->x_rate[i];
  return first_order_gap_rate(&p->s->base, p->obstacle, p->t + step * p->time_rate, p->s->path, NULL, rate);
}

static const double path_step = 1.0 / 512; /* largest shift of a state in the derivative of a gap rate */

/** How fast the gap rate changes along a line of states x + s x_rate, on which time runs at time_rate. */
static const char *first_order_rate_slope(const first_order *s, size_t obstacle, double t, double time_rate,
                                          const double *x, const double *x_rate, double *slope) {
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

/* Gradient of the gap rate divided by its square: any direction to states with a negative gap rate suffices. */
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

/* Limit of the trial for vanishing steps by Neville's scheme, from `step` on. `error`: change by the last order */
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

static const double trial_step = 1.0 / 128; /* largest shift before a trial impact; halved for extrapolation */

static double first_step(const first_order *s, const double *d) {
  return trial_step / fmax(1, largest(d, s->model.states));
}

static const char *push_along(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  double error, slope;
  TRY_TEXT(extrapolate(s, obstacle, t, x, d, first_step(s, d), d, &error));
  return normalise(s, obstacle, t, x, d, &slope);
}

/** The direction d [n] in which the impact map moves states of small gap rate, scaled so that the gap rate changes at
 *  unit rate along it. */
/* The trial along the gradient gives D roughly; along D itself the gap does not change. */
static const char *first_order_push(const first_order *s, size_t obstacle, double t, const double *x, double *d) {
  TRY_TEXT(steepest(s, obstacle, t, x, d));
  TRY_TEXT(push_along(s, obstacle, t, x, d));
  return push_along(s, obstacle, t, x, d);
}

/* Contacts of first-order systems: gap rates and accelerations along a motion, and the forces of contacts that stick.
 */

/* Row k of the equations for the forces: how each of them changes gap rate k, and -h'' of the free motion. */
static const char *held_row(const first_order *s, size_t k, size_t count, double t, const double *x,
                            const double *x_rate) {
  size_t n = s->model.states;
  for (size_t l = 0; l < count; l++) {
    double *entry = &s->matrix[k * count + l];
    *entry = 1;
    if (l != k)
      TRY_TEXT(first_order_rate_slope(s, s->held[k], t, 0, x, s->direction + l * n, entry));
  }
  TRY_TEXT(first_order_rate_slope(s, s->held[k], t, 1, x, x_rate, &s->lambda[k]));
  s->lambda[k] = -s->lambda[k];
  return NULL;
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

/** Adds the forces of the held contacts to a free rate; s->held lists the contacts, s->lambda their forces, `count` how
 *  many. @param contact  NULL: none */
static const char *first_order_hold(const first_order *s, const unsigned char *contact, double t, const double *x,
                                    double *x_rate, size_t *count) {
  size_t n = s->model.states;
  TRY_TEXT(system_list_held(&s->base, contact, s->held_most, s->held, count));
  for (size_t k = 0; k < *count; k++)
    TRY_TEXT(first_order_push(s, s->held[k], t, x, s->direction + k * n));
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

static const char *rate(const ric_system *system, const unsigned char *contact, double t, const double *x,
                        const double *u, double *x_rate, double *u_rate) {
  (void)u;
  (void)u_rate;
  size_t count;
  TRY_TEXT(first_order_free_rate(first_order_of(system), t, x, x_rate));
  return first_order_hold(first_order_of(system), contact, t, x, x_rate, &count);
}

static const char *gap(const ric_system *system, size_t obstacle, double t, const double *x, double *h) {
  return user_gap_value(&first_order_of(system)->gap, obstacle, t, x, h);
}

/* The effective restitution of an impact. Gap rates that are unavailable, or not negative, do not determine it. */
static void remember_ratio(const first_order *s, size_t obstacle, double t, const double *x, const double *x_after) {
  double before, after;
  if (first_order_gap_rate(&s->base, obstacle, t, x, NULL, &before) ||
      first_order_gap_rate(&s->base, obstacle, t, x_after, NULL, &after))
    return;
  double ratio = -after / before;
  if (before < 0 && isfinite(ratio))
    s->ratio[obstacle] = fmin(fmax(ratio, 0), 1);
}

static const char *impact(const ric_system *system, size_t obstacle, double t, const double *x, double *x_after) {
  const first_order *s = first_order_of(system);
  TRY_TEXT(first_order_map(s, obstacle, t, x, x_after));
  remember_ratio(s, obstacle, t, x, x_after);
  return NULL;
}

static const char *energy(const ric_system *system, double t, const double *x, const double *u, double *value) {
  const ric_first_order *model = &first_order_of(system)->model;
  (void)u;
  *value = NAN;
  if (!model->energy)
    return NULL;
  return callback_check(model->energy(t, x, value, model->user), value, 1, CALLBACK_TEXTS("energy"));
}

static double restitution(const ric_system *system, size_t obstacle) {
  return first_order_of(system)->ratio[obstacle];
}

static void destroy(ric_system *system) {
  first_order *s = (first_order *)system;
  free(s->ratio);
  free(s->numbers);
  free(s->held);
  free(s);
}

static const char *gap_derivative(const ric_system *system, size_t obstacle, double t, const double *q,
                                  const tangents *d, double *derivative) {
  const first_order *s = (const first_order *)system;
  return user_gap_derivative(&s->gap, obstacle, t, q, d, s->gradient, derivative);
}

static const char *first_order_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *x,
                                                const double *u, const double *x_rate, const double *u_rate,
                                                double *acceleration) {
  (void)u;
  (void)u_rate;
  return first_order_rate_slope((const first_order *)system, obstacle, t, 1, x, x_rate, acceleration);
}

enum {
  SCALES = 4,     /* of trial steps: if the map is curved within the first one, the next is tried */
  SCALE_BITS = 5, /* the next one is so many times halved */
  FOOT_STEPS = 3  /* of Newton's method to the surface of zero gap rate, along a line */
};

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

static const double fine_limit = 1e-10; /* the same, absolute: other scales cannot be much more accurate */

/* The limit along d from the most accurate scale. */
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

/* Change of a state of gap rate -step by the map, and the power of the gap rate with which it vanishes. */
static const char *follow_down(const first_order *s, size_t obstacle, double t, const double *d, impact_slope *found) {
  double coarse, step = first_step(s, d), far = ldexp(step, -SCALE_BITS * SCALES);
  TRY_TEXT(trial(s, obstacle, t, s->foot, d, step, s->limit));
  coarse = step * largest(s->limit, s->model.states);
  TRY_TEXT(trial(s, obstacle, t, s->foot, d, far, s->limit));
  found->moved = far * largest(s->limit, s->model.states);
  found->rate = -far;
  found->power = ric_log(coarse / found->moved) / ric_log(step / far);
  return NULL;
}

/* Error of the extrapolation relative to 1 + the size of xi: 1e-8 or less for smooth maps, of order one at every scale
 * for others. */
static const double limit_tol = 1e-6;

/** See system_model. */
static const char *first_order_impact_slope(const ric_system *system, size_t obstacle, double t, const double *x,
                                            double *xi, impact_slope *found) {
  const first_order *s = (const first_order *)system;
  double *d = s->approach, error;
  TRY_TEXT(steepest(s, obstacle, t, x, d));
  TRY_TEXT(find_foot(s, obstacle, t, x, d));
  TRY_TEXT(best_limit(s, obstacle, t, d, xi, &error));
  TRY_TEXT(follow_down(s, obstacle, t, d, found));
  found->exists = error <= limit_tol * (1 + largest(xi, s->model.states));
  return first_order_rate_slope(s, obstacle, t, 0, s->foot, xi, &found->turn);
}

static const char *first_order_reaction(const ric_system *system, const unsigned char *contact, size_t obstacle,
                                        double t, const double *x, const double *u, double *lambda) {
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

static const system_model model_table = {.rate = rate,
                                         .gap = gap,
                                         .gap_derivative = gap_derivative,
                                         .gap_rate = first_order_gap_rate,
                                         .gap_acceleration = first_order_gap_acceleration,
                                         .impact = impact,
                                         .impact_slope = first_order_impact_slope,
                                         .reaction = first_order_reaction,
                                         .energy = energy,
                                         .restitution = restitution,
                                         .destroy = destroy};

static ric_status check_model(const ric_first_order *model, ric_error *error) {
  if (!(model->states >= 1 && model->states <= UINT32_MAX / 16))
    return ric_fail(error, RIC_EINVAL, "states = %zu, expected 1 to %u", model->states, UINT32_MAX / 16);
  if (!model->rate)
    return ric_fail(error, RIC_EINVAL, "rate = NULL, expected a callback");
  if (!model->gap && model->obstacles > 0)
    return ric_fail(error, RIC_EINVAL, "gap = NULL, expected a callback: obstacles = %zu", model->obstacles);
  if (!model->impact && model->obstacles > 0)
    return ric_fail(error, RIC_EINVAL, "impact = NULL, expected a callback: obstacles = %zu", model->obstacles);
  return RIC_OK;
}

static size_t lay_out_first_order(first_order *s, double *block) {
  size_t n = s->model.states, k = s->held_most, used = 0;
  s->gap.point = number_block_take(block, &used, n);
  s->gradient = number_block_take(block, &used, n);
  s->rate = number_block_take(block, &used, n);
  s->path = number_block_take(block, &used, n);
  s->before = number_block_take(block, &used, n);
  s->after = number_block_take(block, &used, n);
  s->free_rate = number_block_take(block, &used, n);
  s->table = number_block_take(block, &used, FIRST_ORDER_TRIALS * n);
  s->foot = number_block_take(block, &used, n);
  s->approach = number_block_take(block, &used, n);
  s->limit = number_block_take(block, &used, n);
  s->direction = number_block_take(block, &used, k * n);
  s->matrix = number_block_take(block, &used, k * k);
  s->lambda = number_block_take(block, &used, k);
  return used;
}

static bool allocate_first_order(first_order *s) {
  size_t count = s->model.obstacles;
  s->held_most = count < s->model.states ? count : s->model.states;
  s->numbers = calloc(lay_out_first_order(s, NULL), sizeof *s->numbers);
  s->ratio = calloc(count ? count : 1, sizeof *s->ratio);
  s->held = calloc(s->held_most ? s->held_most : 1, sizeof *s->held);
  if (!s->numbers || !s->ratio || !s->held)
    return false;
  lay_out_first_order(s, s->numbers);
  return true;
}

ric_status ric_system_create_first_order(const ric_first_order *model, ric_system **system, ric_error *error) {
  REQUIRE(error, {"model", model}, {"system", system});
  *system = NULL;
  RIC_TRY(check_model(model, error));
  first_order *s = calloc(1, sizeof *s);
  if (!s)
    return ric_fail(error, RIC_ENOMEM, "no memory for a system");
  s->base = (ric_system){.model = &model_table,
                         .coordinates = model->states,
                         .obstacle_count = model->obstacles,
                         .uncoupled = model->obstacles <= 1};
  s->model = *model;
  s->gap = (user_gap){model->states, model->gap, model->gap_gradient, model->user, NULL};
  if (!allocate_first_order(s)) {
    destroy(&s->base);
    return ric_fail(error, RIC_ENOMEM, "no memory for a system of %zu states", model->states);
  }
  for (size_t j = 0; j < model->obstacles; j++)
    s->ratio[j] = 1;
  *system = &s->base;
  return RIC_OK;
}

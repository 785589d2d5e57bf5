/* Contacts of first-order systems: how gaps change along a motion, and the forces that hold them. */
#include <math.h>

#include "first_order.h"
#include "user_callback.h"

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

const char *first_order_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *x,
                                         const double *u, const double *x_rate, const double *u_rate,
                                         double *acceleration) {
  (void)u;
  (void)u_rate;
  return first_order_rate_slope((const first_order *)system, obstacle, t, 1, x, x_rate, acceleration);
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
      TRY_TEXT(first_order_rate_slope(s, s->held[k], t, 0, x, s->direction + l * n, entry));
  }
  TRY_TEXT(first_order_rate_slope(s, s->held[k], t, 1, x, x_rate, &s->lambda[k]));
  s->lambda[k] = -s->lambda[k];
  return NULL;
}

const char *first_order_hold(const first_order *s, const unsigned char *contact, double t, const double *x,
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

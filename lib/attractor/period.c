#include "period.h"

#include <math.h>
#include <stdbool.h>

/* Not fmax, which is a call. */
static double larger(double a, double b) {
  return a > b ? a : b;
}

/* By how much a number differs at most. @param x  [count][stride] */
static double extent_of(const double *x, size_t stride, size_t count, double *largest) {
  double low = x[0], high = x[0];
  for (size_t k = 1; k < count; k++) {
    low = x[k * stride] < low ? x[k * stride] : low;
    high = x[k * stride] > high ? x[k * stride] : high;
  }
  *largest = larger(*largest, larger(fabs(low), fabs(high)));
  return high - low;
}

/* Whether one number is back within `near` after `period`, wherever it sets out. */
static bool near_again(const double *x, size_t stride, size_t pairs, size_t period, double near) {
  for (size_t k = 0; k < pairs; k++)
    if (!(fabs(x[k * stride] - x[(k + period) * stride]) <= near))
      return false;
  return true;
}

/* Whether what one number is off after `period` grows: from the first to the last pairs, whole periods later, so that
 * the same places of the cycle are compared. */
static bool parts(const double *x, size_t stride, size_t pairs, size_t period, double noise) {
  size_t whole = pairs / (2 * period), shift = (whole > 0 ? whole : 1) * period;
  double first = 0, last = 0;
  for (size_t k = 0; k + shift < pairs; k++) {
    const double *y = x + (k + shift) * stride;
    first = larger(first, fabs(x[k * stride] - x[(k + period) * stride]));
    last = larger(last, fabs(y[0] - y[period * stride]));
  }
  return last > larger(first, noise);
}

/* States in a row, and what is known of them. */
typedef struct row {
  const double *states; /* [count][stride] */
  size_t size, stride, count;
  double tolerance, floor; /* differences below the floor are noise, in all numbers: they come from each other */
} row;

static double near_of(const row *r, size_t i) {
  double largest = 0;
  return larger(r->tolerance * extent_of(r->states + i, r->stride, r->count, &largest), r->floor);
}

static bool returns(const row *r, size_t period) {
  size_t pairs = r->count - period;
  for (size_t i = 0; i < r->size; i++) {
    const double *x = r->states + i;
    if (!near_again(x, r->stride, pairs, period, near_of(r, i)) || parts(x, r->stride, pairs, period, r->floor))
      return false;
  }
  return true;
}

/* The largest difference of a number `lag` iterates later, in one of three parts of the row, whole lags apart. */
static double lag_of(const row *r, size_t i, size_t lag, size_t part) {
  const size_t pairs = r->count - lag, shift = pairs / (3 * lag) * lag;
  double most = 0;
  for (size_t k = part * shift; k < pairs - (2 - part) * shift; k++)
    most = larger(most, fabs(r->states[k * r->stride + i] - r->states[(k + lag) * r->stride + i]));
  return most;
}

/* Whether what one number is off after `lag` tends to zero: by Aitken's extrapolation of the three parts. */
static bool tends_to_zero(const row *r, size_t i, size_t lag) {
  const double a = lag_of(r, i, lag, 0), b = lag_of(r, i, lag, 1), c = lag_of(r, i, lag, 2);
  const double first = a - b, second = b - c;
  if (c <= near_of(r, i))
    return true;
  return first > second && second > r->floor && fabs(c - second * second / (first - second)) <= 0.1 * c;
}

/* A motion that comes to its cycle slowly, from alternating sides, has returned after two of its periods before it has
 * after one: the least part of a period towards which it tends. */
static size_t settle(const row *r, size_t period) {
  for (size_t lag = 1; lag < period; lag++) {
    bool tends = period % lag == 0;
    for (size_t i = 0; i < r->size && tends; i++)
      tends = tends_to_zero(r, i, lag);
    if (tends)
      return lag;
  }
  return period;
}

size_t period_find(const double *states, size_t size, size_t stride, size_t limit, double tolerance, double noise) {
  double extent = 0, largest = 0;
  for (size_t i = 0; i < size; i++)
    extent = larger(extent, extent_of(states + i, stride, 2 * limit + 1, &largest));
  if (!isfinite(extent))
    return 0;
  const row r = {states, size, stride, 2 * limit + 1, tolerance, noise * largest};
  const double near = larger(tolerance * extent, r.floor);
  for (size_t p = 1; p <= limit; p++)
    if (near_again(states, stride, 2 * limit + 1 - p, p, near) && /* at once where there is none */
        returns(&r, p))
      return settle(&r, p);
  return 0;
}

size_t period_lowest(const double *states, size_t stride, size_t count, size_t observe) {
  size_t lowest = 0;
  for (size_t k = 1; k < count; k++)
    if (states[k * stride + observe] < states[lowest * stride + observe])
      lowest = k;
  return lowest;
}

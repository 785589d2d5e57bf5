/* Attractors: names, defaults, the period of iterates, and the distance of two attractors. */
#include "attractor.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "ricochet/attractor.h"
#include "numeric/required.h"

ric_attractor_options ric_attractor_options_default(void) {
  return (ric_attractor_options){
      .transient = 9000, .keep = 1000, .measure = 1000, .period_limit = 64, .period_tol = 1e-6, .bound = 1e100};
}

enum { MOST_PERIOD = 100000 };
static const double most_iterates = 0x1p52; /* the sum of two is exact in every type of number */

ric_status ric_attractor_options_check(const ric_attractor_options *o, size_t size, ric_error *error) {
  REQUIRE(error, {"options", o});
  if (!((double)o->transient <= most_iterates))
    return ric_fail(error, RIC_EINVAL, "transient = %zu, expected at most %.0f", o->transient, most_iterates);
  if (!(o->measure >= 1 && (double)o->measure <= most_iterates))
    return ric_fail(error, RIC_EINVAL, "measure = %zu, expected 1 to %.0f", o->measure, most_iterates);
  if (o->keep > o->measure)
    return ric_fail(error, RIC_EINVAL, "keep = %zu, expected at most measure = %zu", o->keep, o->measure);
  if (o->observe >= size)
    return ric_fail(error, RIC_EINVAL, "observe = %zu, expected a number of a state of %zu", o->observe, size);
  if (o->exponents > size)
    return ric_fail(error, RIC_EINVAL, "exponents = %zu, expected at most %zu, the size of the state", o->exponents,
                    size);
  if (o->period_limit < 1 || o->period_limit > MOST_PERIOD)
    return ric_fail(error, RIC_EINVAL, "period_limit = %zu, expected 1 to %d", o->period_limit, MOST_PERIOD);
  if (!(o->period_tol > 0 && o->period_tol < 1))
    return ric_fail(error, RIC_EINVAL, "period_tol = %g, expected 0 < period_tol < 1", o->period_tol);
  if (!(o->bound > 0 && isfinite(o->bound)))
    return ric_fail(error, RIC_EINVAL, "bound = %g, expected a finite number > 0", o->bound);
  return RIC_OK;
}

const char *ric_attractor_kind_name(ric_attractor_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_ATTRACTOR_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_ATTRACTOR_KINDS ? names[kind] : "unknown";
}

const char *ric_map_lanes_name(ric_map_lanes lanes) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_MAP_LANES_LIST(X)
#undef X
  };
  return (unsigned)lanes < RIC_MAP_LANES_KINDS ? names[lanes] : "unknown";
}

/* Not fmax, which is a function call. */
static double larger(double a, double b) {
  return a > b ? a : b;
}

/* The largest difference of two values of a number. @param x  [count][stride] */
static double extent_of(const double *x, size_t stride, size_t count, double *largest) {
  double low = x[0], high = x[0];
  for (size_t k = 1; k < count; k++) {
    low = x[k * stride] < low ? x[k * stride] : low;
    high = x[k * stride] > high ? x[k * stride] : high;
  }
  *largest = larger(*largest, larger(fabs(low), fabs(high)));
  return high - low;
}

/* Whether one number returns to within `near` after `period`, from every start. */
static bool returns_within(const double *x, size_t stride, size_t pairs, size_t period, double near) {
  for (size_t k = 0; k < pairs; k++)
    if (!(fabs(x[k * stride] - x[(k + period) * stride]) <= near))
      return false;
  return true;
}

/* Whether the difference of one number after `period` grows: from the first pairs to the last, whole periods later,
 * so that equal places of the cycle are compared. */
static bool diverges_from_cycle(const double *x, size_t stride, size_t pairs, size_t period, double noise) {
  size_t whole = pairs / (2 * period), shift = (whole > 0 ? whole : 1) * period;
  double first = 0, last = 0;
  for (size_t k = 0; k + shift < pairs; k++) {
    const double *y = x + (k + shift) * stride;
    first = larger(first, fabs(x[k * stride] - x[(k + period) * stride]));
    last = larger(last, fabs(y[0] - y[period * stride]));
  }
  return last > larger(first, noise);
}

/* Consecutive states, and the tolerances of their comparison. */
typedef struct row {
  const double *states; /* [count][stride] */
  size_t size, stride, count;
  double tolerance, floor; /* differences below the floor are noise; one floor for all numbers, since they depend on
                            * each other */
} row;

static double near_of(const row *r, size_t i) {
  double largest = 0;
  return larger(r->tolerance * extent_of(r->states + i, r->stride, r->count, &largest), r->floor);
}

static bool returns(const row *r, size_t period) {
  size_t pairs = r->count - period;
  for (size_t i = 0; i < r->size; i++) {
    const double *x = r->states + i;
    if (!returns_within(x, r->stride, pairs, period, near_of(r, i)) ||
        diverges_from_cycle(x, r->stride, pairs, period, r->floor))
      return false;
  }
  return true;
}

/* The largest difference of a number and its value `lag` iterates later, from iterate `from` on. */
static double difference_after(const row *r, size_t i, size_t lag, size_t from, size_t count) {
  double most = 0;
  for (size_t k = from; k < from + count; k++)
    most = larger(most, fabs(r->states[k * r->stride + i] - r->states[(k + lag) * r->stride + i]));
  return most;
}

/* Whether a number converges to a cycle of half the period: near a flip it converges slowly and alternates between
 * two sides, and it returns to the same side, within the tolerance, long before it has converged. The limit of its
 * difference after half the period is extrapolated, since that decays by the same factor as the difference after the
 * whole period. At the flip itself it decays as the inverse square root of time, and loses a third here. */
static bool converges_to_half(const row *r, size_t i, size_t period) {
  const size_t shift = (r->count - period) / period * (period / 2), count = r->count - period - shift;
  const double whole = difference_after(r, i, period, 0, count),
               shrunk = whole - difference_after(r, i, period, shift, count);
  const double half = difference_after(r, i, period / 2, 0, count),
               fallen = half - difference_after(r, i, period / 2, shift, count);
  if (half <= near_of(r, i))
    return true;
  return whole > r->floor && shrunk > 0 && fallen * whole > half / 4 * shrunk;
}

static bool has_half_period(const row *r, size_t period) {
  bool half = period % 2 == 0;
  for (size_t i = 0; i < r->size && half; i++)
    half = converges_to_half(r, i, period);
  return half;
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
    if (returns_within(states, stride, 2 * limit + 1 - p, p, near) && /* fails at once for most periods */
        returns(&r, p))
      return has_half_period(&r, p) ? p / 2 : p;
  return 0;
}

size_t period_lowest(const double *states, size_t stride, size_t count, size_t observe) {
  size_t lowest = 0;
  for (size_t k = 1; k < count; k++)
    if (states[k * stride + observe] < states[lowest * stride + observe])
      lowest = k;
  return lowest;
}

ric_status fill_unknown(double *numbers, size_t count, ric_poll poll, ric_error *error) {
  enum { STEP = 1 << 20 };
  for (size_t i = 0; numbers && i < count; i++) {
    if (i % STEP == 0 && ric_poll_stops(poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped by the poll callback");
    numbers[i] = NAN;
  }
  return RIC_OK;
}

/* --- two attractors ----------------------------------------------------------------------------------------------- */

static int compare_values(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The largest distance of a number of sorted a from the nearest of sorted b. */
static double one_sided_distance(const double *a, const double *b, size_t count) {
  double most = 0;
  for (size_t i = 0, k = 0; i < count; i++) {
    while (k + 1 < count && b[k + 1] <= a[i])
      k++;
    const double next = k + 1 < count ? fabs(b[k + 1] - a[i]) : INFINITY;
    most = fmax(most, fmin(fabs(b[k] - a[i]), next));
  }
  return most;
}

double ric_attractor_distance(double *a, double *b, size_t count) {
  if (count == 0)
    return NAN;
  for (size_t i = 0; i < count; i++)
    if (!isfinite(a[i]) || !isfinite(b[i]))
      return NAN;
  qsort(a, count, sizeof *a, compare_values);
  qsort(b, count, sizeof *b, compare_values);
  return fmax(one_sided_distance(a, b, count), one_sided_distance(b, a, count)) / (b[count - 1] - b[0]);
}

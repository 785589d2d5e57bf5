/* Multipliers outside the unit circle: counted by winding numbers, and located. */
#include "determinant.h"

#include <math.h>

#include "numeric/constants.h"
#include "ricochet/elementary.h"

/* Bisections of a step of length 1/2: 2^-40 is far below all relevant distances. */
enum { MOST_HALVINGS = 40 };

/* Distance of zeta from the nearest pole of g, at +- i angle + 2 pi i k. */
static double pole_distance(const secular *s, double complex zeta) {
  double angle = fabs(remainder(cimag(zeta), 2 * pi)), gap = INFINITY;
  size_t low = 0, high = s->particles;
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (s->poles[middle].angle < angle)
      low = middle + 1;
    else
      high = middle;
  }
  for (size_t j = low; j < s->particles && j < low + 1; j++)
    gap = s->poles[j].angle - angle;
  if (low > 0)
    gap = fmin(gap, angle - s->poles[low - 1].angle);
  return ric_hypot(creal(zeta), gap);
}

/* Change of log g, with the phase in half a turn. */
static double complex change(double complex from, double complex to) {
  return CMPLX(creal(to) - creal(from), remainder(cimag(to) - cimag(from), 2 * pi));
}

/* Whether log g is nearly linear between three points, so that no turn of its phase is missed. */
static bool straight(double complex first, double complex second) {
  double quarter = pi / 4;
  return complex_modulus(first) < quarter && complex_modulus(second) < quarter &&
         complex_modulus(first - second) < quarter / 2;
}

/* Phase from a to b, with the logarithms of g there. */
static double phase(secular *s, double complex a, double complex log_a, double complex b, double complex log_b,
                    int halvings) {
  double complex middle = (a + b) / 2, log_middle = secular_log(s, middle);
  double complex first = change(log_a, log_middle), second = change(log_middle, log_b);
  if (complex_modulus(b - a) <= 0.7 * pole_distance(s, middle) && straight(first, second))
    return cimag(first) + cimag(second);
  if (halvings == 0 || !isfinite(creal(first + second)))
    return NAN;
  return phase(s, a, log_a, middle, log_middle, halvings - 1) + phase(s, middle, log_middle, b, log_b, halvings - 1);
}

/** Phase of g along a straight line between two zeta; NaN if it passes through a zero. */
static double winding_phase(secular *s, double complex from, double complex to) {
  double sum = 0;
  int steps = (int)ceil(complex_modulus(to - from) / 0.5);
  double complex here = from, log_here = secular_log(s, from);
  for (int i = 1; i <= steps && isfinite(sum); i++) {
    double complex next = from + (to - from) * ((double)i / steps), log_next = secular_log(s, next);
    sum += phase(s, here, log_here, next, log_next, MOST_HALVINGS);
    here = next;
    log_here = log_next;
  }
  return sum;
}

/* A number of whole turns that must not be negative. */
static bool whole(double turns, size_t *count) {
  if (!(fabs(turns - nearbyint(turns)) < 0.1 && turns > -0.5))
    return false;
  *count = (size_t)llrint(turns);
  return true;
}

bool winding_outside(secular *s, double radius, size_t *outside) {
  return whole(-1 - winding_phase(s, radius, CMPLX(radius, pi)) / pi, outside);
}

bool winding_box(secular *s, double complex low, double complex high, size_t *zeros) {
  double complex right = CMPLX(creal(high), cimag(low)), left = CMPLX(creal(low), cimag(high));
  double sum = winding_phase(s, low, right);
  sum += winding_phase(s, right, high);
  sum += winding_phase(s, high, left);
  sum += winding_phase(s, left, low);
  return whole(sum / (2 * pi), zeros);
}

/* In rectangles smaller than `small` a cluster of zeros is located together; those smaller than `smallest` are not
 * divided. */
static const double small = 1e-2, smallest = 1e-8;

/* Zeros of a variance below that of the rounding of log g, over the square of the circle's radius, coincide. */
static const double coincidence = 1e-12;

/* A single zero this close to the real axis of mu is real: its conjugate would be as close. */
static const double real_axis = 1e-7;

typedef struct box {
  double complex low, high;
} box;

typedef struct found {
  secular *s;
  ric_complex *mu;
  size_t room, count;
  size_t attempt; /* another attempt divides elsewhere */
} found;

static bool inside(const box *b, double complex z) {
  double slack = 1e-9;
  return creal(z) >= creal(b->low) - slack && creal(z) <= creal(b->high) + slack && cimag(z) >= cimag(b->low) - slack &&
         cimag(z) <= cimag(b->high) + slack;
}

static void put(found *x, double re, double im) {
  if (x->count < x->room)
    x->mu[x->count++] = (ric_complex){re, im};
}

/* The search covers slightly more than the upper half plane; zeros below are conjugates of others. */
static void accept(found *x, double complex zeta, size_t times) {
  double angle = cimag(zeta), size = ric_exp(creal(zeta));
  for (size_t i = 0; i < times; i++)
    if (fabs(angle) < real_axis) {
      put(x, size, 0);
    } else if (fabs(angle - pi) < real_axis) {
      put(x, -size, 0);
    } else if (angle > 0 && angle < pi) {
      const double complex mu = complex_exp(zeta);
      put(x, creal(mu), cimag(mu));
      put(x, creal(mu), -cimag(mu));
    }
}

/* Secant method on g, scaled by its first value. @returns whether it converged to a point of the rectangle */
static bool polish(secular *s, const box *b, double complex *zero) {
  double complex before = (b->low + b->high) / 2, x = before + (b->high - b->low) / 50;
  double complex unit = secular_log(s, before), value_before = 1;
  for (int i = 0; i < 60 && creal(x) > 0; i++) {
    double complex value = complex_exp(secular_log(s, x) - unit), step = value * (x - before) / (value - value_before);
    if (value == 0 || complex_modulus(x - before) <= 1e-14 * (1 + complex_modulus(x))) {
      *zero = x;
      return inside(b, x);
    }
    if (!isfinite(creal(step)) || !isfinite(cimag(step)))
      return false;
    before = x;
    value_before = value;
    x -= step;
  }
  return false;
}

static double circle_around(const box *b) {
  return 2 * complex_modulus(b->high - b->low);
}

/* Points on the circle, and the tolerated difference of the sums over all and over every second one: zeros outside the
 * circle contribute with the power POINTS / 2 of their distance. */
enum { POINTS = 32 };
static const double settled = 1e-9;

/* Logarithms of g on the circle minus those of `count` zeros at its centre. @returns whether it has `count` zeros */
static bool sample(secular *s, double complex centre, double radius, size_t count, double complex rest[POINTS]) {
  double argument = 0, began = 0;
  for (int i = 0; i <= POINTS; i++) {
    double angle = 2 * pi * i / POINTS;
    double complex value = secular_log(s, centre + radius * complex_exp(CMPLX(0, angle)));
    argument = i == 0 ? cimag(value) : argument + remainder(cimag(value) - argument, 2 * pi);
    if (i == 0)
      began = argument;
    if (i < POINTS)
      rest[i] = CMPLX(creal(value), argument - (double)count * angle);
  }
  return fabs(argument - began - 2 * pi * (double)count) < 1;
}

/* -power times the mean of rest (z - c)^power over every so many points: sum of the powers of the zeros' distances. */
static double complex power_sum(const double complex rest[POINTS], int power, int every) {
  double complex sum = 0;
  for (int i = 0; i < POINTS; i += every)
    sum -= rest[i] * complex_exp(CMPLX(0, 2 * pi * i * power / POINTS));
  return sum * power * every / POINTS;
}

/* Mean of the zeros in a small rectangle, and their variance, from log g on a circle around it: a zero at c + d adds
 * log(z - c) - d / (z - c) - d^2 / (2 (z - c)^2) - ... @returns false when there are other zeros in it or close to it
 */
static bool moments(secular *s, const box *b, size_t count, double complex *mean, double complex *variance) {
  double complex centre = (b->low + b->high) / 2, rest[POINTS];
  double radius = circle_around(b), k = (double)count;
  if (!sample(s, centre, radius, count, rest))
    return false;
  double complex first = power_sum(rest, 1, 1) / k, second = power_sum(rest, 2, 1) / k;
  *mean = centre + radius * first;
  *variance = radius * radius * (second - first * first);
  return complex_modulus(power_sum(rest, 1, 2) / k - first) < settled &&
         complex_modulus(power_sum(rest, 2, 2) / k - second) < settled;
}

/* Zeros close to one another: one or two follow from their moments, more when they coincide.
 *  @returns false when the rectangle has to be divided */
static bool accept_cluster(found *x, const box *b, size_t count) {
  double complex mean, variance;
  if (circle_around(b) > (creal(b->low) + creal(b->high)) / 2 || !moments(x->s, b, count, &mean, &variance))
    return false; /* it would contain poles or other zeros */
  bool coincide = count == 1 || complex_modulus(variance) < coincidence * circle_around(b) * circle_around(b);
  if (!coincide && count > 2 && complex_modulus(b->high - b->low) > smallest)
    return false;
  double complex apart = coincide || count > 2 ? 0 : complex_sqrt(variance);
  accept(x, mean + apart, apart == 0 ? count : 1);
  if (apart != 0)
    accept(x, mean - apart, 1);
  return true;
}

static void halves(const box *b, double part, box *first, box *second) {
  double width = creal(b->high) - creal(b->low), height = cimag(b->high) - cimag(b->low);
  *first = *second = *b;
  if (width > height) {
    double at = creal(b->low) + part * width;
    first->high = CMPLX(at, cimag(b->high));
    second->low = CMPLX(at, cimag(b->low));
  } else {
    double at = cimag(b->low) + part * height;
    first->high = CMPLX(creal(b->high), at);
    second->low = CMPLX(creal(b->low), at);
  }
}

/* Divides a rectangle along a line without zeros; the other half has the other zeros. */
static bool divide(found *x, const box *b, size_t count, box parts[2], size_t counts[2]) {
  static const double places[] = {0.4871, 0.5313, 0.4439, 0.5687, 0.4151, 0.5977};
  const size_t choices = sizeof places / sizeof *places;
  for (size_t i = 0; i < choices; i++) {
    halves(b, places[(i + x->attempt) % choices], &parts[0], &parts[1]);
    if (winding_box(x->s, parts[0].low, parts[0].high, &counts[0]) && counts[0] <= count) {
      counts[1] = count - counts[0];
      return true;
    }
  }
  return false;
}

static void search(found *x, const box *b, size_t count) {
  double complex zero;
  box parts[2];
  size_t counts[2];
  if (count == 0 || x->s->stopped)
    return;
  if (count == 1 && polish(x->s, b, &zero)) {
    accept(x, zero, 1);
    return;
  }
  double size = complex_modulus(b->high - b->low);
  if (size < small && (accept_cluster(x, b, count) || size < smallest))
    return;
  if (!divide(x, b, count, parts, counts))
    return;
  search(x, &parts[0], counts[0]);
  search(x, &parts[1], counts[1]);
}

/* Log of a modulus beyond which there is no multiplier. */
static double far_away(secular *s, double radius) {
  double far = fmax(2, 2 * radius);
  size_t beyond = 1;
  while (far < 600 && !s->stopped && (!winding_outside(s, far, &beyond) || beyond > 0))
    far *= 1.7;
  return far;
}

void multipliers_outside_find(secular *s, double low, double high, size_t expected, ric_complex *mu, size_t room,
                              size_t *count) {
  found x = {.s = s, .mu = mu, .room = room};
  double far = high < INFINITY ? high : far_away(s, low);
  for (x.attempt = 0; x.attempt < 3; x.attempt++) {
    double shift = 0.0517 * (double)x.attempt;
    box all = {CMPLX(low, -0.2713 - shift), CMPLX(far, pi + 0.1917 + shift)};
    size_t zeros;
    x.count = 0;
    if (winding_box(s, all.low, all.high, &zeros))
      search(&x, &all, zeros);
    if (x.count == expected)
      break;
  }
  *count = x.count;
}

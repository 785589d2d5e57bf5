/* Polynomials on [0, 1]: Chebyshev interpolation, certified minima and first roots, cheap tests before them. */
#include "polynomial.h"

#include <math.h>
#include <stddef.h>

#include "constants.h"
#include "ricochet/elementary.h"
#include "ricochet/polynomial.h"
#include "simd.h"

enum {
  CHEBYSHEV_DEGREE = 14 /* largest: conversion to powers loses about as many digits as the last terms are small */
};

double chebyshev_point(int k, int degree) {
  return (1 - ric_cos(pi * k / degree)) / 2;
}

void chebyshev_coefficients(const double *values, int degree, double *a) {
  for (int j = 0; j <= degree; j++) {
    double sum = 0;
    for (int k = 0; k <= degree; k++) {
      double weight = k == 0 || k == degree ? 0.5 : 1;
      sum += weight * values[k] * ric_cos(pi * j * (degree - k) / degree); /* x = 0 is the angle pi */
    }
    a[j] = sum * (j == 0 || j == degree ? 1 : 2) / degree;
  }
}

/* By T_{j+1} = 2 (2 x - 1) T_j - T_{j-1}. */
void chebyshev_to_powers(const double *a, int degree, double *c) {
  double before[CHEBYSHEV_DEGREE + 1] = {1}, now[CHEBYSHEV_DEGREE + 1] = {-1, 2};
  for (int i = 0; i <= degree; i++)
    c[i] = a[0] * before[i] + a[1] * now[i];
  for (int j = 2; j <= degree; j++)
    for (int i = j; i >= 0; i--) {
      double next = (i > 0 ? 4 * now[i - 1] : 0) - 2 * now[i] - before[i];
      before[i] = now[i];
      now[i] = next;
      c[i] += a[j] * next;
    }
}

enum {
  SIZE = RIC_POLY_DEGREE + 1,
  DEPTH = 52 /* halvings of [0, 1] that doubles resolve */
};

double ric_poly_value(const double *c, int degree, double x, double *slope) {
  double value = c[degree], derivative = 0;
  for (int j = degree - 1; j >= 0; j--) {
    derivative = derivative * x + value;
    value = value * x + c[j];
  }
  if (slope)
    *slope = derivative;
  return value;
}

double ric_poly_lower_bound(const double *c, int degree) {
  double bound = c[0];
  for (int j = 1; j <= degree; j++)
    bound += (c[j] < 0 ? c[j] : 0);
  return bound;
}

/* The scaled coefficients c_j / binomial(d, j) are the forward differences of b at 0; summing them up gives b. */
void ric_poly_bernstein(const double *c, int degree, double *b) {
  double inverse_binomial = 1;
  for (int j = 0; j <= degree; j++) {
    b[j] = c[j] * inverse_binomial;
    inverse_binomial *= (double)(j + 1) / (double)(degree - j);
  }
  for (int r = 0; r < degree; r++)
    for (int j = degree; j > r; j--)
      b[j] += b[j - 1];
}

void ric_poly_reflect(const double *c, int degree, double *r) {
  for (int j = 0; j <= degree; j++)
    r[j] = c[j];
  for (int k = 0; k < degree; k++) /* Taylor shift to 1 by repeated division */
    for (int j = degree - 1; j >= k; j--)
      r[j] += r[j + 1];
  for (int j = 1; j <= degree; j += 2)
    r[j] = -r[j];
}

/* A piece [start, start + width] of the unit interval with its Bernstein coefficients. */
typedef struct piece {
  double start, width;
  double b[SIZE];
} piece;

/* de Casteljau at 1/2: `left` takes the first half, `p` keeps the second. */
static void halve(piece *p, piece *left, int degree) {
  p->width /= 2;
  left->start = p->start;
  left->width = p->width;
  p->start += p->width;
  for (int r = 0; r < degree; r++) {
    left->b[r] = p->b[0];
    for (int j = 0; j < degree - r; j++)
      p->b[j] = (p->b[j] + p->b[j + 1]) / 2;
  }
  left->b[degree] = p->b[0];
}

static double smallest(const double *b, int degree) {
  double least = b[0];
  for (int j = 1; j <= degree; j++)
    least = b[j] < least ? b[j] : least;
  return least;
}

/* Number of sign changes of the Bernstein coefficients of the polynomial (order 0) or of its derivative (order 1): at
 * least the number of roots, and equal to it when 0 or 1. `first` is set to the first sign. */
static int sign_changes(const double *b, int degree, int order, int *first) {
  int changes = 0, last = 0;
  *first = 0;
  for (int j = 0; j <= degree - order; j++) {
    double x = order ? b[j + 1] - b[j] : b[j];
    int sign = (x > 0) - (x < 0);
    if (sign == 0)
      continue;
    changes += last == -sign;
    *first = last ? *first : sign;
    last = sign;
  }
  return changes;
}

/* Whether Newton's method has converged: extrapolating the decrease of steps, the next one is below rounding, or they
 * no longer shrink. `last` is the size of the previous step, 0 if that was no Newton step. */
static int has_converged(double change, double last) {
  return change <= 1e-16 || (last > 0 && (change * change <= 1e-17 * last || (change <= 1e-9 && change >= 0.9 * last)));
}

/** The only root of the polynomial (order 0, decreasing) or of its derivative (order 1, increasing) in [low, high],
 *  from a first guess inside. */
/* Newton's method inside a shrinking bracket. */
static double poly_bracketed_root(const double *c, int degree, int order, double low, double high, double guess) {
  double d[SIZE], x = guess, last = 0;
  for (int j = 0; j <= degree - order; j++)
    d[j] = order ? (j + 1) * c[j + 1] : -c[j];
  for (int i = 0; i < 2 * DEPTH; i++) {
    double slope, value = ric_poly_value(d, degree - order, x, &slope);
    if (value > 0)
      high = x;
    else
      low = x;
    double next = x - value / slope;
    int inside = next > low && next < high;
    if (!inside)
      next = (low + high) / 2;
    double change = fabs(next - x);
    if (has_converged(change, inside ? last : 0))
      return next;
    last = inside ? change : 0;
    x = next;
  }
  return x;
}

static double root_in(const double *c, int degree, int order, const piece *p) {
  return poly_bracketed_root(c, degree, order, p->start, p->start + p->width, p->start + p->width / 2);
}

static void improve(double *best, double *best_at, double value, double at) {
  if (value < *best) {
    *best = value;
    *best_at = at;
  }
}

/* What a test asks: is the polynomial above a value; otherwise, where does it fall below the floor? */
typedef struct question {
  double value, floor;
  bool first; /* where it first falls below, not only whether */
} question;

/* A polynomial with bounds on [0, 1] of the sum of its high powers, of their slope and of their second derivative. */
typedef struct bounded_polynomial {
  const double *c;
  int degree;
  double fall, rise, steep, bend;
  double rounding;
} bounded_polynomial;

enum {
  LOW_POWERS = 10, /* the dominant ones in segments of flows */
  LOW_SIZE = 12,   /* their coefficients, in whole lanes */
  LOW_VECTORS = LOW_SIZE / RIC_LANES,
  LOW_DEPTH = 6, /* halvings after which tests give up */
  VALLEY_STEPS = 3
};

/* A piece of the Bernstein form of the low powers. */
typedef struct low_piece {
  double start, width;
  double b[LOW_SIZE];
} low_piece;

/* A lower bound on [0, 1]: c_0 and the negative coefficients, in independent partial sums. */
static double least_by_signs(const double *c, int degree) {
  enum { SUMS = 4 };
  double sum[SUMS] = {0}, rest = c[0];
  int j = 1;
  for (; j + SUMS <= degree + 1; j += SUMS)
    for (int k = 0; k < SUMS; k++)
      sum[k] += (c[j + k] - fabs(c[j + k])) / 2;
  for (; j <= degree; j++)
    rest += (c[j] - fabs(c[j])) / 2;
  return rest + ((sum[0] + sum[1]) + (sum[2] + sum[3]));
}

/* Relative to the sum of the (j + 1) |c_j|, which bounds all values and slopes: rounding of values, of slopes, of the
 * Bernstein form and its halves; and the powers that are negligible in the search for a minimum. */
static const double rounding_share = 1e-14, left_out = 1e-8;

/* Computes the bounds of a polynomial. @returns whether its coefficients alone prove that it is above the value */
static bool measure(bounded_polynomial *l, const double *c, int degree, double value) {
  double size = fabs(c[0]);
  if (least_by_signs(c, degree) > value)
    return true;
  *l = (bounded_polynomial){.c = c, .degree = degree};
  for (int j = 1; j <= degree && j <= LOW_POWERS; j++)
    size += (j + 1) * fabs(c[j]);
  for (int j = LOW_POWERS + 1; j <= degree; j++) {
    double modulus = fabs(c[j]);
    l->fall += (c[j] - modulus) / 2;
    l->rise += (c[j] + modulus) / 2;
    l->steep += j * modulus;
    l->bend += j * (j - 1) * modulus;
  }
  l->rounding = rounding_share * (size + 2 * l->steep);
  return false;
}

/* b = sum_i x[i * step] matrix[i], summed in parallel over the entries of b. */
RIC_INLINE void transform(const double (*matrix)[LOW_SIZE], const double *x, int step, int count, double *b) {
  ric_lanes sum[LOW_VECTORS] = {0};
  for (int i = 0; i < count; i++)
    for (int k = 0; k < LOW_VECTORS; k++)
      sum[k] += x[i * step] * ((const ric_lanes *)matrix[i])[k];
  for (int k = 0; k < LOW_VECTORS; k++)
    ((ric_lanes *)b)[k] = sum[k];
}

/* Of power i to coefficient j: binomial(j, i) / binomial(10, i). */
static const double of_powers[LOW_POWERS + 1][LOW_SIZE] = {
    {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1},
    {0, 1 / 10., 2 / 10., 3 / 10., 4 / 10., 5 / 10., 6 / 10., 7 / 10., 8 / 10., 9 / 10., 1},
    {0, 0, 1 / 45., 3 / 45., 6 / 45., 10 / 45., 15 / 45., 21 / 45., 28 / 45., 36 / 45., 1},
    {0, 0, 0, 1 / 120., 4 / 120., 10 / 120., 20 / 120., 35 / 120., 56 / 120., 84 / 120., 1},
    {0, 0, 0, 0, 1 / 210., 5 / 210., 15 / 210., 35 / 210., 70 / 210., 126 / 210., 1},
    {0, 0, 0, 0, 0, 1 / 252., 6 / 252., 21 / 252., 56 / 252., 126 / 252., 1},
    {0, 0, 0, 0, 0, 0, 1 / 210., 7 / 210., 28 / 210., 84 / 210., 1},
    {0, 0, 0, 0, 0, 0, 0, 1 / 120., 8 / 120., 36 / 120., 1},
    {0, 0, 0, 0, 0, 0, 0, 0, 1 / 45., 9 / 45., 1},
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 1 / 10., 1},
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1},
};

RIC_VECTORISED static void low_form(const double *c, int degree, double *b) {
  transform(of_powers, c, 1, degree < LOW_POWERS ? degree + 1 : LOW_POWERS + 1, b);
}

/* Factor on a piece of the bounds on [0, 1] of the high powers, their slope and second derivative. */
static double share_of(const low_piece *p) {
  double end = p->start + p->width, square = end * end, fourth = square * square;
  return fourth * fourth * end; /* the second derivative of power 11 */
}

static double smallest_low(const double *b) {
  double least = b[0];
  for (int j = 1; j <= LOW_POWERS; j++)
    least = b[j] < least ? b[j] : least;
  return least;
}

static bool is_convex(const bounded_polynomial *l, const low_piece *p) {
  double least = INFINITY;
  for (int j = 2; j <= LOW_POWERS; j++) {
    double second = p->b[j] - 2 * p->b[j - 1] + p->b[j - 2];
    least = second < least ? second : least;
  }
  return LOW_POWERS * (LOW_POWERS - 1) * (least - 4 * l->rounding) > share_of(p) * l->bend * p->width * p->width;
}

static bool is_falling(const bounded_polynomial *l, const low_piece *p) {
  double most = -INFINITY;
  for (int j = 1; j <= LOW_POWERS; j++)
    most = p->b[j] - p->b[j - 1] > most ? p->b[j] - p->b[j - 1] : most;
  return LOW_POWERS * (most + 2 * l->rounding) < -share_of(p) * l->steep * p->width;
}

/* Powers used in the search for a minimum; the bound of the others is added to `missing`. */
static int powers_that_matter(const bounded_polynomial *l, double *missing) {
  double most = left_out / rounding_share * l->rounding, sum = 0;
  int degree = l->degree;
  for (; degree > LOW_POWERS && sum + fabs(l->c[degree]) <= most; degree--)
    sum += fabs(l->c[degree]);
  *missing += sum;
  return degree;
}

/* Value and slope; `bend` is half of the second derivative. */
RIC_INLINE double value_at(const double *c, int degree, double x, double *slope, double *bend) {
  double y = c[degree];
  *slope = *bend = 0;
  for (int j = degree - 1; j >= 0; j--) {
    *bend = *bend * x + *slope;
    *slope = *slope * x + y;
    y = y * x + c[j];
  }
  return y;
}

/* On a piece where the polynomial is convex: it is above the value if its tangent near the minimum is. Newton's method,
 * first with the low powers, makes the slope nearly zero. @param reach  set to a place below the floor */
static poly_look test_valley(const bounded_polynomial *l, const low_piece *p, const question *q, double *reach) {
  double missing = l->rounding, end = p->start + p->width, slope, bend;
  double fall = p->b[0] - p->b[1], rise = p->b[LOW_POWERS] - p->b[LOW_POWERS - 1];
  double x = p->start + p->width * (fall > 0 ? rise > 0 ? fall / (fall + rise) : 1 : 0);
  int degree = powers_that_matter(l, &missing);
  if (l->degree > LOW_POWERS) {
    value_at(l->c, LOW_POWERS, x, &slope, &bend);
    x = fmin(fmax(x - slope / (2 * bend), p->start), end);
  }
  for (int i = 0; i < VALLEY_STEPS; i++) {
    double y = value_at(l->c, degree, x, &slope, &bend);
    if (y - (slope > 0 ? slope * (x - p->start) : -slope * (end - x)) - missing > q->value)
      return POLY_ABOVE;
    *reach = x;
    if (y + missing < q->floor)
      return POLY_FALLS;
    x = fmin(fmax(x - slope / (2 * bend), p->start), end);
  }
  return POLY_UNDECIDED;
}

/* A convex polynomial crosses the floor once from above to below, and so does a decreasing one. */
static poly_look test_piece(const bounded_polynomial *l, const low_piece *p, const question *q, double *reach) {
  double start = p->b[0], end = p->b[LOW_POWERS], share = share_of(p);
  double high = share * l->rise + l->rounding, low = share * l->fall - l->rounding;
  bool ends_below = end + high < q->floor;
  *reach = p->start + p->width;
  if (smallest_low(p->b) + low > q->value)
    return POLY_ABOVE;
  if (!q->first && (start + high < q->floor || ends_below))
    return POLY_FALLS;
  if (q->first && !(start + low > q->floor))
    return POLY_UNDECIDED;
  bool convex = is_convex(l, p);
  if (ends_below)
    return convex || is_falling(l, p) ? POLY_FALLS : POLY_UNDECIDED;
  return convex ? test_valley(l, p, q, reach) : POLY_UNDECIDED;
}

/* De Casteljau at 1/2, of coefficient i to coefficient j of the first half: binomial(j, i) / 2^j. */
static const double of_half[LOW_POWERS + 1][LOW_SIZE] = {
    {1, 1 / 2., 1 / 4., 1 / 8., 1 / 16., 1 / 32., 1 / 64., 1 / 128., 1 / 256., 1 / 512., 1 / 1024.},
    {0, 1 / 2., 2 / 4., 3 / 8., 4 / 16., 5 / 32., 6 / 64., 7 / 128., 8 / 256., 9 / 512., 10 / 1024.},
    {0, 0, 1 / 4., 3 / 8., 6 / 16., 10 / 32., 15 / 64., 21 / 128., 28 / 256., 36 / 512., 45 / 1024.},
    {0, 0, 0, 1 / 8., 4 / 16., 10 / 32., 20 / 64., 35 / 128., 56 / 256., 84 / 512., 120 / 1024.},
    {0, 0, 0, 0, 1 / 16., 5 / 32., 15 / 64., 35 / 128., 70 / 256., 126 / 512., 210 / 1024.},
    {0, 0, 0, 0, 0, 1 / 32., 6 / 64., 21 / 128., 56 / 256., 126 / 512., 252 / 1024.},
    {0, 0, 0, 0, 0, 0, 1 / 64., 7 / 128., 28 / 256., 84 / 512., 210 / 1024.},
    {0, 0, 0, 0, 0, 0, 0, 1 / 128., 8 / 256., 36 / 512., 120 / 1024.},
    {0, 0, 0, 0, 0, 0, 0, 0, 1 / 256., 9 / 512., 45 / 1024.},
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 1 / 512., 10 / 1024.},
    {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1 / 1024.},
};

/* The first half goes to `left`, the second stays. */
RIC_VECTORISED static void halve_low(low_piece *p, low_piece *left) {
  double right[LOW_SIZE];
  p->width /= 2;
  left->start = p->start;
  left->width = p->width;
  p->start += p->width;
  transform(of_half, p->b, 1, LOW_POWERS + 1, left->b);
  transform(of_half, p->b + LOW_POWERS, -1, LOW_POWERS + 1, right);
  for (int j = 0; j <= LOW_POWERS; j++)
    p->b[j] = right[LOW_POWERS - j];
}

/* Tests the pieces in order, up to the first on which the polynomial is not above the value. @param found, reach  that
 * piece, and a place below the floor on it */
static poly_look test_pieces(const bounded_polynomial *l, const question *q, low_piece *found, double *reach) {
  low_piece stack[LOW_DEPTH + 1];
  int depth = 1;
  stack[0].start = 0, stack[0].width = 1;
  low_form(l->c, l->degree, stack[0].b);
  while (depth > 0) {
    low_piece *p = &stack[--depth];
    poly_look answer = test_piece(l, p, q, reach);
    if (answer == POLY_ABOVE)
      continue;
    if (answer == POLY_FALLS || p->width < 1.5 / (1 << LOW_DEPTH)) {
      *found = *p;
      return answer;
    }
    halve_low(p, p + 1); /* the first half is on top of the stack and comes first */
    depth += 2;
  }
  return POLY_ABOVE;
}

poly_look poly_look_above(const double *c, int degree, double value) {
  question q = {.value = value, .floor = value};
  bounded_polynomial l;
  low_piece found;
  double reach;
  return measure(&l, c, degree, value) ? POLY_ABOVE : test_pieces(&l, &q, &found, &reach);
}

int ric_poly_minimum(const double *c, int degree, double cutoff, double tolerance, double *at, double *value) {
  if (poly_look_above(c, degree, cutoff) == POLY_ABOVE)
    return 0;
  piece stack[DEPTH + 1];
  double best = INFINITY, best_at = 0;
  int depth = 1;
  stack[0].start = 0, stack[0].width = 1;
  ric_poly_bernstein(c, degree, stack[0].b);
  while (depth > 0) {
    piece *p = &stack[--depth];
    improve(&best, &best_at, p->b[0], p->start);
    improve(&best, &best_at, p->b[degree], p->start + p->width);
    double least = smallest(p->b, degree);
    if (least >= best - tolerance || least > cutoff)
      continue;
    int first, changes = sign_changes(p->b, degree, 1, &first);
    if (changes == 1 && first < 0) {
      double x = root_in(c, degree, 1, p);
      improve(&best, &best_at, ric_poly_value(c, degree, x, NULL), x);
    } else if (changes > 1 && depth < DEPTH) {
      halve(p, p + 1, degree);
      depth += 2;
    }
  }
  if (!(best <= cutoff))
    return 0;
  *at = best_at;
  *value = best;
  return 1;
}

static const double slope_rounding = 2e-15; /* of the bounds below, relative to the sum of the coefficients' sizes */

/* Whether cheap bounds exclude a minimum inside: the slope keeps its sign, or it decreases everywhere.
 */
static int excludes_minimum(const double *c, int degree) {
  double low = degree > 0 ? c[1] : 0, high = low, curvature = degree > 1 ? 2 * c[2] : 0, size = fabs(low);
  for (int j = 2; j <= degree; j++) {
    double slope = j * c[j];
    size += fabs(slope);
    low += slope < 0 ? slope : 0;
    high += slope > 0 ? slope : 0;
    curvature += j > 2 && slope > 0 ? (j - 1) * slope : 0;
  }
  double rounding = slope_rounding * size;
  return low > rounding || high < -rounding || curvature < -rounding * degree;
}

int ric_poly_first_minimum(const double *c, int degree, double cutoff, double *at, double *value) {
  if (excludes_minimum(c, degree) || poly_look_above(c, degree, cutoff) == POLY_ABOVE)
    return 0;
  piece stack[DEPTH + 1];
  int depth = 1, before = 0; /* sign of the slope at the end of the processed pieces */
  stack[0].start = 0, stack[0].width = 1;
  ric_poly_bernstein(c, degree, stack[0].b);
  while (depth > 0) {
    piece *p = &stack[--depth];
    int first, changes = sign_changes(p->b, degree, 1, &first), inside = changes == 1 && first < 0;
    int low = smallest(p->b, degree) <= cutoff, between = before < 0 && first > 0;
    if (low && changes > 1 && depth < DEPTH) {
      halve(p, p + 1, degree); /* the first half is on top of the stack and comes first */
      depth += 2;
      continue;
    }
    if (low && (inside || between)) {
      *at = between ? p->start : root_in(c, degree, 1, p);
      *value = ric_poly_value(c, degree, *at, NULL);
      if (*value <= cutoff)
        return 1;
    }
    if (first != 0)
      before = changes % 2 ? -first : first;
  }
  return 0;
}

/* First piece that holds a root: its first point is not positive, or it has exactly one root. Returns its number of
 * sign changes, -1 if there is none. */
static int piece_of_first_root(const double *c, int degree, piece *stack) {
  int depth = 1;
  stack[0].start = 0, stack[0].width = 1;
  ric_poly_bernstein(c, degree, stack[0].b);
  while (depth > 0) {
    piece *p = &stack[--depth];
    int first, changes = sign_changes(p->b, degree, 0, &first);
    if (p->b[0] > 0 && changes == 0 && p->b[degree] > 0)
      continue;
    if (p->b[0] > 0 && changes > 1 && depth < DEPTH) {
      halve(p, p + 1, degree); /* the first half is on top of the stack and comes first */
      depth += 2;
      continue;
    }
    stack[0] = *p;
    return changes;
  }
  return -1;
}

int ric_poly_first_root(const double *c, int degree, double *at) {
  piece stack[DEPTH + 1], *p = stack;
  if (poly_look_above(c, degree, 0) == POLY_ABOVE)
    return 0;
  int changes = piece_of_first_root(c, degree, stack);
  if (changes < 0)
    return 0;
  if (p->b[0] > 0 && changes == 0) /* positive up to its end, where it is zero */
    *at = p->start + p->width;
  else if (p->b[0] > 0 && changes == 1)
    *at = root_in(c, degree, 0, p);
  else
    *at = p->start;
  return 1;
}

int ric_poly_is_positive(const double *c, int degree) {
  piece stack[DEPTH + 1];
  poly_look answer = poly_look_above(c, degree, 0);
  return answer == POLY_UNDECIDED ? piece_of_first_root(c, degree, stack) < 0 : answer == POLY_ABOVE;
}

poly_look poly_look_fall(const double *c, int degree, double value, double *at) {
  question q = {.value = value, .floor = 0, .first = true};
  bounded_polynomial l;
  low_piece p;
  double reach;
  if (measure(&l, c, degree, value))
    return POLY_ABOVE;
  poly_look answer = test_pieces(&l, &q, &p, &reach);
  if (answer == POLY_FALLS)
    *at = poly_bracketed_root(c, degree, 0, p.start, reach, p.start + (reach - p.start) / 2);
  return answer;
}

/* p = c_0 + x r with r > low: p <= value at x <= (value - c_0) / low only, where its slope is above low minus that
 * times the sum of the j (j - 1) |c_j|. */
bool poly_look_leaves(const double *c, int degree, double value) {
  double bend = 0;
  for (int j = 2; j <= degree; j++)
    bend += j * (j - 1) * fabs(c[j]);
  double low = sqrt(2 * (value + fabs(c[0])) * bend);
  return degree > 1 && low < c[1] && poly_look_above(c + 1, degree - 1, low) == POLY_ABOVE;
}

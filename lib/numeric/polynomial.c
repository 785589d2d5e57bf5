#include "ricochet/polynomial.h"

#include <math.h>
#include <stddef.h>

#include "poly_look.h"

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

/* Whether Newton's method has arrived: the next step would be below rounding by the rate at which steps shrink, or they
 * have stopped shrinking. `last` is the size of the step before, 0 when that was none of Newton's. */
static int has_settled(double change, double last) {
  return change <= 1e-16 || (last > 0 && (change * change <= 1e-17 * last || (change <= 1e-9 && change >= 0.9 * last)));
}

/* Newton's method inside a shrinking bracket. */
double poly_bracketed_root(const double *c, int degree, int order, double low, double high, double guess) {
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
    if (has_settled(change, inside ? last : 0))
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

/* Whether there is no minimum inside, as far as cheap bounds can say: the slope keeps its sign, or it falls everywhere.
 */
static int has_no_valley(const double *c, int degree) {
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
  if (has_no_valley(c, degree) || poly_look_above(c, degree, cutoff) == POLY_ABOVE)
    return 0;
  piece stack[DEPTH + 1];
  int depth = 1, before = 0; /* sign of the slope at the end of the pieces done */
  stack[0].start = 0, stack[0].width = 1;
  ric_poly_bernstein(c, degree, stack[0].b);
  while (depth > 0) {
    piece *p = &stack[--depth];
    int first, changes = sign_changes(p->b, degree, 1, &first), inside = changes == 1 && first < 0;
    int low = smallest(p->b, degree) <= cutoff, between = before < 0 && first > 0;
    if (low && changes > 1 && depth < DEPTH) {
      halve(p, p + 1, degree); /* the first half lands on top and is looked at first */
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
 * sign changes, -1 when there is none. */
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
      halve(p, p + 1, degree); /* the first half lands on top and is looked at first */
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

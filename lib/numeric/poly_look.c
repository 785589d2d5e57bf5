#include "poly_look.h"

#include <math.h>

#include "ricochet/polynomial.h"
#include "vectorised.h"

enum {
  LOW_POWERS = 10, /* those that matter most in the segments of flows */
  LOW_SIZE = 12,   /* their coefficients, in whole lanes */
  LOW_VECTORS = LOW_SIZE / RIC_LANES,
  LOW_DEPTH = 6, /* halvings after which looks give up */
  VALLEY_STEPS = 3
};

/* Relative to the sum of the (j + 1) |c_j|, which bounds all values and slopes: rounding of values, of slopes, of the
 * Bernstein form and its halves; and powers whose sum does not matter where a valley is sought. */
static const double rounding_share = 1e-14, left_out = 1e-8;

/* A polynomial, and what its high powers are good for on [0, 1]: bounds of their sum, of the size of its slope and of
 * its second derivative. */
typedef struct looked {
  const double *c;
  int degree;
  double fall, rise, steep, bend;
  double rounding;
} looked;

/* A piece of the Bernstein form of the low powers. */
typedef struct low_piece {
  double start, width;
  double b[LOW_SIZE];
} low_piece;

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

/* b = sum_i x[i * step] matrix[i]; side by side, where sums along b would wait for each other. */
RIC_INLINE void transform(const double (*matrix)[LOW_SIZE], const double *x, int step, int count, double *b) {
  ric_lanes sum[LOW_VECTORS] = {0};
  for (int i = 0; i < count; i++)
    for (int k = 0; k < LOW_VECTORS; k++)
      sum[k] += x[i * step] * ((const ric_lanes *)matrix[i])[k];
  for (int k = 0; k < LOW_VECTORS; k++)
    ((ric_lanes *)b)[k] = sum[k];
}

RIC_VECTORISED static void low_form(const double *c, int degree, double *b) {
  transform(of_powers, c, 1, degree < LOW_POWERS ? degree + 1 : LOW_POWERS + 1, b);
}

/* The first half goes to `left`, the second stays. */
RIC_VECTORISED static void halve(low_piece *p, low_piece *left) {
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

/* A lower bound on [0, 1]: c_0 and the negative coefficients, in sums that do not wait for each other. */
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

/* Takes the measure of a polynomial. @returns whether its coefficients alone keep it above the value */
static bool measure(looked *l, const double *c, int degree, double value) {
  double size = fabs(c[0]);
  if (least_by_signs(c, degree) > value)
    return true;
  *l = (looked){.c = c, .degree = degree};
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

static double smallest(const double *b) {
  double least = b[0];
  for (int j = 1; j <= LOW_POWERS; j++)
    least = b[j] < least ? b[j] : least;
  return least;
}

/* What bounds on [0, 1] of the high powers, of their slope and bend are to be multiplied by on a piece. */
static double share_of(const low_piece *p) {
  double end = p->start + p->width, square = end * end, fourth = square * square;
  return fourth * fourth * end; /* the second derivative of power 11 */
}

static bool is_convex(const looked *l, const low_piece *p) {
  double least = INFINITY;
  for (int j = 2; j <= LOW_POWERS; j++) {
    double second = p->b[j] - 2 * p->b[j - 1] + p->b[j - 2];
    least = second < least ? second : least;
  }
  return LOW_POWERS * (LOW_POWERS - 1) * (least - 4 * l->rounding) > share_of(p) * l->bend * p->width * p->width;
}

static bool is_falling(const looked *l, const low_piece *p) {
  double most = -INFINITY;
  for (int j = 1; j <= LOW_POWERS; j++)
    most = p->b[j] - p->b[j - 1] > most ? p->b[j] - p->b[j - 1] : most;
  return LOW_POWERS * (most + 2 * l->rounding) < -share_of(p) * l->steep * p->width;
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

/* Powers with which a valley is looked at; what the others may take away is added to `missing`. */
static int powers_that_matter(const looked *l, double *missing) {
  double most = left_out / rounding_share * l->rounding, sum = 0;
  int degree = l->degree;
  for (; degree > LOW_POWERS && sum + fabs(l->c[degree]) <= most; degree--)
    sum += fabs(l->c[degree]);
  *missing += sum;
  return degree;
}

/* What a look asks: is the polynomial above a value; else, where has it fallen below the floor? */
typedef struct question {
  double value, floor;
  bool first; /* where it first falls, and not just whether */
} question;

/* On a piece where the polynomial is convex: it is above the value when the tangent is where Newton's method, first
 * with the low powers, has taken the slope to nearly zero. @param reach  set to where it is below the floor */
static poly_look look_at_valley(const looked *l, const low_piece *p, const question *q, double *reach) {
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

/* A convex polynomial meets the floor once on its way from above to below, and so does a falling one. */
static poly_look look_at_piece(const looked *l, const low_piece *p, const question *q, double *reach) {
  double start = p->b[0], end = p->b[LOW_POWERS], share = share_of(p);
  double high = share * l->rise + l->rounding, low = share * l->fall - l->rounding;
  bool ends_below = end + high < q->floor;
  *reach = p->start + p->width;
  if (smallest(p->b) + low > q->value)
    return POLY_ABOVE;
  if (!q->first && (start + high < q->floor || ends_below))
    return POLY_FALLS;
  if (q->first && !(start + low > q->floor))
    return POLY_UNDECIDED;
  bool convex = is_convex(l, p);
  if (ends_below)
    return convex || is_falling(l, p) ? POLY_FALLS : POLY_UNDECIDED;
  return convex ? look_at_valley(l, p, q, reach) : POLY_UNDECIDED;
}

/* Looks along the pieces, up to the first on which the polynomial is not above the value.
 * @param found, reach  that piece, and where it is below the floor on it */
static poly_look look_along(const looked *l, const question *q, low_piece *found, double *reach) {
  low_piece stack[LOW_DEPTH + 1];
  int depth = 1;
  stack[0].start = 0, stack[0].width = 1;
  low_form(l->c, l->degree, stack[0].b);
  while (depth > 0) {
    low_piece *p = &stack[--depth];
    poly_look answer = look_at_piece(l, p, q, reach);
    if (answer == POLY_ABOVE)
      continue;
    if (answer == POLY_FALLS || p->width < 1.5 / (1 << LOW_DEPTH)) {
      *found = *p;
      return answer;
    }
    halve(p, p + 1); /* the first half lands on top and is looked at first */
    depth += 2;
  }
  return POLY_ABOVE;
}

poly_look poly_look_above(const double *c, int degree, double value) {
  question q = {.value = value, .floor = value};
  looked l;
  low_piece found;
  double reach;
  return measure(&l, c, degree, value) ? POLY_ABOVE : look_along(&l, &q, &found, &reach);
}

poly_look poly_look_fall(const double *c, int degree, double value, double *at) {
  question q = {.value = value, .floor = 0, .first = true};
  looked l;
  low_piece p;
  double reach;
  if (measure(&l, c, degree, value))
    return POLY_ABOVE;
  poly_look answer = look_along(&l, &q, &p, &reach);
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

/* What is read off a series: how it falls off, and the force on one of its particles. */
#include <math.h>

#include "lattice_series_parts.h"
#include "vectorised.h"

/* Largest magnitude of a row; NaN when one is not finite. */
RIC_VECTORISED static double largest(const double *c, size_t count) {
  enum { LANES = 8 };
  double most[LANES] = {0}, finite[LANES] = {0}, found = 0, sum = 0;
  size_t i = 0;
  for (; i + LANES <= count; i += LANES)
    for (size_t lane = 0; lane < LANES; lane++) {
      double a = fabs(c[i + lane]);
      most[lane] = a > most[lane] ? a : most[lane];
      finite[lane] += 0 * a;
    }
  for (; i < count; i++) {
    found = fabs(c[i]) > found ? fabs(c[i]) : found;
    sum += 0 * c[i];
  }
  for (size_t lane = 0; lane < LANES; lane++) {
    found = most[lane] > found ? most[lane] : found;
    sum += finite[lane];
  }
  return found + sum;
}

lattice_decay lattice_series_decay(const lattice_series *s) {
  const lattice_block *b = &s->block;
  const block_presses *p = &b->presses;
  int order = b->order;
  const double *c = s->segment.coef;
  lattice_decay d = {.nearest_zero = INFINITY};
  for (int k = 0; k < 2; k++)
    d.tail[k] = largest(c + (size_t)(order - 1 + k) * b->stride, b->count);
  for (int j = 1; j <= 3; j++)
    d.change = fmax(d.change, largest(c + (size_t)j * b->stride, b->count));
  if (!isfinite(d.tail[0] + d.tail[1]))
    d.change = NAN;
  for (size_t k = 0; k < p->count; k++) {
    double u0 = p->u[k], u1 = fabs(p->u[p->capacity + k]), u2 = fabs(p->u[2 * p->capacity + k]);
    if (p->column[k] >= b->ghosts && p->column[k] - b->ghosts < b->count) /* others are their own piece's */
      d.nearest_zero = fmin(d.nearest_zero, u0 / (u1 + sqrt(u0 * u2)));   /* u_1 x + u_2 x^2 is below u_0 there */
  }
  return d;
}

/* Subtracts factor times the force series of a spring with the extension x; all series have degree RIC_POLY_DEGREE. */
static void subtract_spring(const ric_spring *s, const double *x, double length, double factor, double *c) {
  double square[RIC_POLY_DEGREE + 1];
  for (int j = 0; j <= RIC_POLY_DEGREE; j++) {
    double cube = 0;
    square[j] = 0;
    for (int i = 0; i <= j; i++)
      square[j] += x[i] * x[j - i];
    for (int i = 0; i <= j; i++)
      cube += x[i] * square[j - i];
    double rate = j < RIC_POLY_DEGREE ? (j + 1) * x[j + 1] / length : 0;
    c[j] -= factor * (s->linear * x[j] + s->quadratic * square[j] + s->cubic * cube + s->damping * rate);
  }
}

/* Series of a column minus that of another; the second may be left out. */
static void difference(const lattice_block *b, size_t column, size_t other, double *x) {
  for (int j = 0; j <= RIC_POLY_DEGREE; j++)
    x[j] = j > b->order ? 0 : b->c[(size_t)j * b->stride + column];
  for (int j = 0; other != column && j <= b->order; j++)
    x[j] -= b->c[(size_t)j * b->stride + other];
}

int lattice_series_force(const lattice_series *s, size_t particle, double *c) {
  const lattice_block *b = &s->block;
  const ric_lattice *l = s->lattice;
  size_t n = l->particles, from_first = (particle + n - s->segment.first % n) % n, i = b->ghosts + from_first;
  ric_spring own = ric_lattice_on_site(l, particle), left = ric_lattice_link(l, particle);
  ric_spring right = ric_lattice_link(l, particle + 1);
  double x[RIC_POLY_DEGREE + 1];
  for (int j = 0; j <= RIC_POLY_DEGREE; j++) {
    c[j] = 0;
    if (l->force_cos)
      c[j] += l->force_cos[particle] * s->cosine[j];
    if (l->force_sin)
      c[j] += l->force_sin[particle] * s->sine[j];
  }
  difference(b, i, i, x);
  subtract_spring(&own, x, s->segment.length, 1, c);
  difference(b, i, i - 1, x);
  subtract_spring(&left, x, s->segment.length, 1, c);
  difference(b, i + 1, i, x);
  subtract_spring(&right, x, s->segment.length, -1, c);
  unsigned longer = BLOCK_SITE_NONLINEAR | BLOCK_LINK_NONLINEAR | BLOCK_FORCED;
  return b->terms & longer ? RIC_POLY_DEGREE : b->order;
}

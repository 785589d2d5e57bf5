/* What is read off a series: how it falls off, and the force on one of its particles. */
#include <math.h>

#include "lattice_series_parts.h"

taylor_decay lattice_series_decay(const lattice_series *s) {
  const lattice_block *b = &s->block;
  taylor_decay d = taylor_decay_of(s->segment.coef, b->stride, b->count, b->order);
  for (size_t k = 0; k < b->presses.count; k++) {
    const block_press *p = &b->presses.press[k];
    if (p->column >= b->ghosts && p->column - b->ghosts < b->count) /* others are their own piece's */
      d.nearest_zero = fmin(d.nearest_zero, hertz_series_nearest_zero(&p->series));
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

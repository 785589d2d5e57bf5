#include "lattice_block.h"

#include <string.h>

#include "numeric/vectorised.h"

/* Columns that level `level` has lost at each side of a block with a halo. */
RIC_INLINE size_t lost(unsigned terms, int level) {
  if (level < 2)
    return 0;
  return (size_t)(terms & BLOCK_LINK_DAMPED ? level - 1 : level / 2);
}

size_t lattice_block_halo(int order, unsigned terms) {
  return lost(terms, order);
}

RIC_INLINE void linear_level(const double *restrict c, double *restrict next, const double *restrict own,
                             const double *restrict left, const double *restrict right, size_t low, size_t high,
                             double h2, int divisor) {
  double d = divisor, scale = h2 / d;
  if (divisor <= LAST_DIVIDED)
    for (size_t i = low; i < high; i++)
      next[i] = h2 * (own[i] * c[i] + (left[i] * c[i - 1] + right[i] * c[i + 1])) / d;
  else
    for (size_t i = low; i < high; i++)
      next[i] = scale * (own[i] * c[i] + (left[i] * c[i - 1] + right[i] * c[i + 1]));
}

/* The same stencil added to what is in `sum`. */
RIC_INLINE void add_stencil(const double *restrict c, double *restrict sum, const double *restrict own,
                            const double *restrict left, const double *restrict right, size_t low, size_t high,
                            double scale) {
  for (size_t i = low; i < high; i++)
    sum[i] += scale * (own[i] * c[i] + (left[i] * c[i - 1] + right[i] * c[i + 1]));
}

/* Coefficient j of the product of two series, for the columns [low, high). */
RIC_INLINE void product(const double *restrict a, const double *restrict b, double *restrict out, size_t stride, int j,
                        size_t low, size_t high) {
  enum { LANES = 8 };
  size_t i = low;
  for (; i + LANES <= high; i += LANES) {
    double sum[LANES] = {0};
    for (int k = 0; k <= j; k++) {
      const double *x = a + (size_t)k * stride + i, *y = b + (size_t)(j - k) * stride + i;
      for (size_t lane = 0; lane < LANES; lane++)
        sum[lane] += x[lane] * y[lane];
    }
    memcpy(out + i, sum, sizeof sum);
  }
  for (; i < high; i++) {
    double sum = 0;
    for (int k = 0; k <= j; k++)
      sum += a[(size_t)k * stride + i] * b[(size_t)(j - k) * stride + i];
    out[i] = sum;
  }
}

RIC_INLINE void add_sites(lattice_block *b, int j, size_t low, size_t high) {
  double *restrict force = b->force, *square = b->square + (size_t)j * b->stride;
  const double *restrict second = b->row[ROW_SITE_SQUARE], *restrict third = b->row[ROW_SITE_CUBE];
  double *restrict cube = b->row[ROW_SITE_CUBE] + b->stride; /* scratch behind the row */
  product(b->c, b->c, square, b->stride, j, low, high);
  product(b->c, b->square, cube, b->stride, j, low, high);
  for (size_t i = low; i < high; i++)
    force[i] -= second[i] * square[i] + third[i] * cube[i];
}

RIC_INLINE void add_links(lattice_block *b, int j, size_t low, size_t high) {
  size_t at = (size_t)j * b->stride;
  const double *restrict c = b->c + at, *restrict inverse_mass = b->row[ROW_INVERSE_MASS];
  const double *restrict second = b->row[ROW_LINK_SQUARE], *restrict third = b->row[ROW_LINK_CUBE];
  double *restrict force = b->force, *extension = b->extension + at, *square = b->extension_square + at;
  double *restrict link = b->row[ROW_LINK_CUBE] + b->stride; /* scratch behind the row */
  for (size_t i = low; i <= high; i++)
    extension[i] = c[i] - c[i - 1];
  product(b->extension, b->extension, square, b->stride, j, low, high + 1);
  product(b->extension, b->extension_square, link, b->stride, j, low, high + 1);
  for (size_t i = low; i <= high; i++)
    link[i] = second[i] * square[i] + third[i] * link[i];
  for (size_t i = low; i < high; i++)
    force[i] += inverse_mass[i] * (link[i + 1] - link[i]);
}

RIC_INLINE void general_level(lattice_block *b, int j, size_t low, size_t high, double h, double cosine, double sine) {
  const double *c = b->c + (size_t)j * b->stride;
  double *restrict force = b->force, *restrict next = b->c + (size_t)(j + 2) * b->stride;
  double h2 = h * h, divisor = (double)((j + 1) * (j + 2));
  for (size_t i = low; i < high; i++)
    force[i] = 0;
  if (b->terms & BLOCK_FORCED)
    for (size_t i = low; i < high; i++)
      force[i] = b->row[ROW_COS][i] * cosine + b->row[ROW_SIN][i] * sine;
  if (b->terms & BLOCK_SITE_NONLINEAR)
    add_sites(b, j, low, high);
  if (b->terms & BLOCK_LINK_NONLINEAR)
    add_links(b, j, low, high);
  if (b->terms & BLOCK_DAMPED)
    add_stencil(c + b->stride, force, b->row[ROW_DAMP_OWN], b->row[ROW_DAMP_LEFT], b->row[ROW_DAMP_RIGHT], low, high,
                (j + 1) / h);
  add_stencil(c, force, b->row[ROW_OWN], b->row[ROW_LEFT], b->row[ROW_RIGHT], low, high, 1);
  for (size_t i = low; i < high; i++)
    next[i] = h2 * force[i] / divisor;
}

void lattice_block_press(lattice_block *b, int j, double h) {
  double scale = h * h / ((j + 1) * (j + 2));
  const double *c = b->c + (size_t)j * b->stride;
  double *next = b->c + (size_t)(j + 2) * b->stride;
  for (size_t k = 0; k < b->presses.count; k++) {
    block_press *p = &b->presses.press[k];
    double u = j == 0 ? p->start : -p->side * c[p->column];
    next[p->column] += scale * p->strength * hertz_series_next(&p->series, j, u);
  }
}

RIC_VECTORISED static void raise_levels(lattice_block *b, double h, const double *cosine, const double *sine) {
  size_t width = b->count + 2 * b->ghosts;
  for (int j = 0; j + 2 <= b->order; j++) {
    size_t low = b->whole ? 1 : lost(b->terms, j + 2), high = width - low;
    int divisor = (j + 1) * (j + 2);
    if (b->terms == 0) {
      const double *c = b->c + (size_t)j * b->stride;
      double *next = b->c + (size_t)(j + 2) * b->stride;
      linear_level(c, next, b->row[ROW_OWN], b->row[ROW_LEFT], b->row[ROW_RIGHT], low, high, h * h, divisor);
    } else
      general_level(b, j, low, high, h, cosine[j], sine[j]);
    if (b->presses.count > 0)
      lattice_block_press(b, j, h);
    lattice_block_close_ring(b, j + 2);
  }
}

/* The variants' own names would be exported if they were not static. */
void lattice_block_raise(lattice_block *block, double h, const double *cosine, const double *sine) {
  raise_levels(block, h, cosine, sine);
}

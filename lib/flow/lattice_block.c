/* The Taylor recurrence of a piece of a lattice: for loops over columns, and for a few particles. */
#include "lattice_series.h"

#include <string.h>

#include "numeric/simd.h"

/** Below this divisor a rounded reciprocal would change the amplitude of a mode by the same 1e-17 at every step, which
 *  accumulates; the rounding of a quotient depends on the motion and does not. Later coefficients are negligible. */
enum { LAST_DIVIDED = 56 };

/* Columns at each side of a block with a halo that are invalid at level `level`. */
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

/* The same stencil added to `sum`. */
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

/** Adds the j-th coefficient of the pressed contacts' forces to c_{j+2}, in a step of length h. */
static void lattice_block_press(lattice_block *b, int j, double h) {
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

/* The variants of a public symbol would be exported, too, so they are static. */
void lattice_block_raise(lattice_block *block, double h, const double *cosine, const double *sine) {
  raise_levels(block, h, cosine, sine);
}

enum { NARROW = 4 /* particles for which half of a row suffices */ };

bool lattice_few_takes(size_t count, unsigned terms) {
  return count <= (terms & (BLOCK_SITE_NONLINEAR | BLOCK_LINK_NONLINEAR) ? FEW : NARROW);
}

size_t lattice_few_columns(size_t count) {
  return (count <= NARROW ? NARROW : FEW) + 2;
}

/* --- constants ---------------------------------------------------------------------------------------------------- */

/* Particle of a column, FEW for a wall. */
static size_t particle_at(const lattice_block *b, size_t column) {
  if (column == 0 || column == b->count + 1)
    return !b->ring ? FEW : column == 0 ? b->count - 1 : 0;
  return column - 1;
}

static void load_stencil(const lattice_block *b, block_row own, block_row left, block_row right, few_matrix matrix) {
  double *entry = (double *)matrix;
  for (size_t i = 0; i < b->count && b->row[own]; i++) {
    size_t before = particle_at(b, i), after = particle_at(b, i + 2);
    entry[i * FEW + i] += b->row[own][i + 1];
    if (before < FEW)
      entry[before * FEW + i] += b->row[left][i + 1];
    if (after < FEW)
      entry[after * FEW + i] += b->row[right][i + 1];
  }
}

/* A spring from particle `from` to particle `to`, with the accelerations of both by a unit of its force. */
typedef struct few_spring {
  size_t from, to; /* FEW: a wall */
  double pull_from, pull_to;
  double quadratic, cubic;
} few_spring;

static void add_spring(lattice_few *few, const few_spring *spring) {
  if (spring->quadratic == 0 && spring->cubic == 0)
    return;
  if (few->groups == 0 || few->group[few->groups - 1].count == RIC_LANES)
    few->group[few->groups++].count = 0;
  few_springs *g = &few->group[few->groups - 1];
  size_t lane = g->count++;
  double *stretch = (double *)g->stretch, *pull = (double *)g->pull[lane];
  ((double *)&g->quadratic)[lane] = spring->quadratic;
  ((double *)&g->cubic)[lane] = spring->cubic;
  if (spring->to < FEW) {
    stretch[spring->to * RIC_LANES + lane] += 1;
    pull[spring->to] -= spring->pull_to;
  }
  if (spring->from < FEW) {
    stretch[spring->from * RIC_LANES + lane] -= 1;
    pull[spring->from] += spring->pull_from;
  }
}

static void load_sites(lattice_few *few, const lattice_block *b) {
  for (size_t i = 0; i < b->count && b->row[ROW_SITE_CUBE]; i++) {
    few_spring site = {FEW, i, 0, 1, b->row[ROW_SITE_SQUARE][i + 1], b->row[ROW_SITE_CUBE][i + 1]};
    add_spring(few, &site);
  }
}

static void load_links(lattice_few *few, const lattice_block *b) {
  size_t end = b->ring ? b->count : b->count + 1; /* the last link of a ring is its first */
  for (size_t i = 0; i < end && b->row[ROW_LINK_CUBE]; i++) {
    size_t from = particle_at(b, i), to = particle_at(b, i + 1);
    few_spring link = {.from = from,
                       .to = to,
                       .pull_from = from < FEW ? b->row[ROW_INVERSE_MASS][from + 1] : 0,
                       .pull_to = to < FEW ? b->row[ROW_INVERSE_MASS][to + 1] : 0,
                       .quadratic = b->row[ROW_LINK_SQUARE][i + 1],
                       .cubic = b->row[ROW_LINK_CUBE][i + 1]};
    add_spring(few, &link);
  }
}

void lattice_few_load(lattice_few *few, const lattice_block *b) {
  memset(few, 0, sizeof *few);
  load_stencil(b, ROW_OWN, ROW_LEFT, ROW_RIGHT, few->stiffness);
  load_stencil(b, ROW_DAMP_OWN, ROW_DAMP_LEFT, ROW_DAMP_RIGHT, few->damping);
  load_sites(few, b);
  load_links(few, b);
}

/* --- recurrence --------------------------------------------------------------------------------------------------- */

/* Coefficients j and j + 1 of a series, springs in SIMD lanes. */
typedef struct few_pair {
  ric_lanes low, high;
} few_pair;

/* Of the coefficients j and j + 1 of a product of two series the terms x_k y_{j-k} and x_{k+1} y_{j-k}, 1 <= k <= last.
 */
RIC_INLINE few_pair products(const ric_lanes *x, const ric_lanes *y, int j, int last) {
  few_pair odd = {{0}, {0}}, even = {{0}, {0}};
  int k = 1;
  for (; k < last; k += 2) {
    odd.low += x[k] * y[j - k];
    odd.high += x[k + 1] * y[j - k];
    even.low += x[k + 1] * y[j - k - 1];
    even.high += x[k + 2] * y[j - k - 1];
  }
  if (k == last) {
    odd.low += x[k] * y[j - k];
    odd.high += x[k + 1] * y[j - k];
  }
  return (few_pair){odd.low + even.low, odd.high + even.high};
}

/* Coefficients of x^2, j even: each product of two different factors once. Here and below the newest factors come last,
 * to shorten the chain of dependences. */
RIC_INLINE few_pair square_of(const ric_lanes *x, const few_pair *newest, int j) {
  int half = j / 2;
  ric_lanes middle = x[half], twice = 2 * x[0];
  few_pair sum = products(x, x, j, half - 1);
  sum.low = 2 * sum.low + middle * middle;
  sum.high = 2 * (sum.high + x[1] * newest->low);
  return (few_pair){sum.low + twice * newest->low, sum.high + twice * newest->high};
}

/* The same for the first two. */
RIC_INLINE few_pair first_square(const few_pair *x) {
  return (few_pair){x->low * x->low, 2 * x->low * x->high};
}

/* Coefficients of the springs' forces. */
RIC_INLINE few_pair force_of(const few_springs *g, const few_pair *newest, const few_pair *square, int j) {
  ric_lanes last = g->quadratic + g->cubic * g->x[0];
  few_pair cube = products(g->x, g->square, j, j - 1);
  cube.low += newest->low * g->square[0];
  cube.high += newest->high * g->square[0] + g->x[1] * square->low;
  return (few_pair){g->cubic * cube.low + last * square->low, g->cubic * cube.high + last * square->high};
}

RIC_INLINE few_pair first_force(const few_springs *g, const few_pair *x, const few_pair *square) {
  ric_lanes last = g->quadratic + g->cubic * x->low;
  return (few_pair){last * square->low, last * square->high + g->cubic * (x->high * square->low)};
}

/* Levels j and j + 1 of the springs, from those of the coordinates. */
RIC_INLINE few_pair raise_springs(few_springs *g, const double *c, size_t stride, size_t count, int j) {
  few_pair x = {c[0] * g->stretch[0], c[stride] * g->stretch[0]};
  for (size_t i = 1; i < count; i++) {
    x.low += c[i] * g->stretch[i];
    x.high += c[stride + i] * g->stretch[i];
  }
  g->x[j] = x.low;
  g->x[j + 1] = x.high;
  few_pair square = j == 0 ? first_square(&x) : square_of(g->x, &x, j);
  g->square[j] = square.low;
  g->square[j + 1] = square.high;
  return j == 0 ? first_force(g, &x, &square) : force_of(g, &x, &square, j);
}

RIC_INLINE void add_matrix(const ric_lanes (*matrix)[FEW_VECTORS], const double *c, size_t count, double scale,
                           ric_lanes *force, size_t vectors) {
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < vectors; k++)
      force[k] += scale * c[i] * matrix[i][k];
}

/* Level j + 2, with the forces of the springs. */
RIC_INLINE void finish_level(const lattice_few *few, lattice_block *b, int j, double h, double cosine, double sine,
                             const few_pair *spring, bool high, size_t vectors) {
  const double *c = b->c + (size_t)j * b->stride + 1;
  ric_lanes force[FEW_VECTORS] = {0}, *next = (ric_lanes *)(b->c + (size_t)(j + 2) * b->stride + 1);
  double h2 = h * h, divisor = (double)((j + 1) * (j + 2));
  if (b->terms & BLOCK_FORCED)
    for (size_t k = 0; k < vectors; k++)
      force[k] =
          cosine * ((const ric_lanes *)(b->row[ROW_COS] + 1))[k] + sine * ((const ric_lanes *)(b->row[ROW_SIN] + 1))[k];
  add_matrix((const ric_lanes(*)[FEW_VECTORS])few->stiffness, c, b->count, 1, force, vectors);
  if (b->terms & BLOCK_DAMPED)
    add_matrix((const ric_lanes(*)[FEW_VECTORS])few->damping, c + b->stride, b->count, (j + 1) / h, force, vectors);
  for (size_t g = 0; g < few->groups; g++) {
    const double *pulls = (const double *)(high ? &spring[g].high : &spring[g].low);
    for (size_t s = 0; s < few->group[g].count; s++)
      for (size_t k = 0; k < vectors; k++)
        force[k] += pulls[s] * few->group[g].pull[s][k];
  }
  if (divisor <= LAST_DIVIDED)
    for (size_t k = 0; k < vectors; k++)
      next[k] = h2 * force[k] / divisor;
  else
    for (size_t k = 0; k < vectors; k++)
      next[k] = h2 / divisor * force[k];
}

RIC_INLINE void raise_pairs(lattice_few *few, lattice_block *b, double h, const double *cosine, const double *sine,
                            size_t vectors) {
  few_pair force[FEW_GROUPS];
  for (int j = 0; j + 2 <= b->order; j += 2) {
    const double *c = b->c + (size_t)j * b->stride + 1;
    for (size_t g = 0; g < few->groups; g++)
      force[g] = raise_springs(&few->group[g], c, b->stride, b->count, j);
    for (int k = j; k < j + 2 && k + 2 <= b->order; k++) {
      finish_level(few, b, k, h, cosine[k], sine[k], force, k > j, vectors);
      if (b->presses.count > 0)
        lattice_block_press(b, k, h);
      lattice_block_close_ring(b, k + 2);
    }
  }
}

/* --- linear particles --------------------------------------------------------------------------------------------- */

static void set_scales(few_scales *s, double h) {
  if (s->h == h)
    return;
  s->h = h;
  for (int j = 0; j < FEW_LEVELS; j++) {
    double divisor = (j + 1) * (j + 2);
    s->divisor[j] = divisor <= LAST_DIVIDED ? divisor : 1;
    s->low[j] = divisor <= LAST_DIVIDED ? h * h : h * h / divisor;
    s->high[j] = divisor <= LAST_DIVIDED ? h * (j + 1) : h / (j + 2);
  }
}

/* sum += scale matrix x; the newest number, x, comes last. */
RIC_INLINE void add_columns(const few_matrix matrix, double scale, const double *x, double *sum, size_t count,
                            size_t width) {
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < width; k++)
      sum[k] += scale * ((const double *)matrix[i])[k] * x[i];
}

/* Level j + 2 from levels j and j + 1. */
RIC_INLINE void linear_level_of_few(const lattice_few *few, const lattice_block *b, int j, const double *low,
                                    const double *high, double cosine, double sine, double *next, size_t count,
                                    size_t width) {
  const few_scales *s = &few->scales;
  double sum[FEW] = {0};
  for (size_t k = 0; k < width && b->terms & BLOCK_FORCED; k++)
    sum[k] = cosine * b->row[ROW_COS][k + 1] + sine * b->row[ROW_SIN][k + 1];
  add_columns(few->stiffness, 1, low, sum, count, width);
  for (size_t k = 0; k < width; k++)
    sum[k] *= s->low[j];
  if (b->terms & BLOCK_DAMPED)
    add_columns(few->damping, s->high[j], high, sum, count, width);
  for (size_t k = 0; k < width; k++)
    next[k] = (j + 1) * (j + 2) <= LAST_DIVIDED ? sum[k] / s->divisor[j] : sum[k];
}

RIC_INLINE void raise_linear(lattice_few *few, lattice_block *b, double h, const double *cosine, const double *sine,
                             size_t count, size_t width) {
  double low[FEW], high[FEW], next[FEW];
  set_scales(&few->scales, h);
  memcpy(low, b->c + 1, width * sizeof *low);
  memcpy(high, b->c + b->stride + 1, width * sizeof *high);
  for (int j = 0; j + 2 <= b->order; j++) {
    double *c = b->c + (size_t)(j + 2) * b->stride + 1;
    linear_level_of_few(few, b, j, low, high, cosine[j], sine[j], next, count, width);
    memcpy(c, next, width * sizeof *c);
    if (b->presses.count > 0) {
      lattice_block_press(b, j, h);
      memcpy(next, c, width * sizeof *c);
    }
    lattice_block_close_ring(b, j + 2);
    memcpy(low, high, width * sizeof *low);
    memcpy(high, next, width * sizeof *high);
  }
}

RIC_VECTORISED static void raise(lattice_few *few, lattice_block *b, double h, const double *cosine,
                                 const double *sine) {
  if (few->groups == 0 && b->count == 1)
    raise_linear(few, b, h, cosine, sine, 1, 1);
  else if (few->groups == 0 && b->count <= NARROW)
    raise_linear(few, b, h, cosine, sine, b->count, NARROW);
  else if (b->count <= NARROW)
    raise_pairs(few, b, h, cosine, sine, NARROW / RIC_LANES);
  else
    raise_pairs(few, b, h, cosine, sine, FEW_VECTORS);
}

/* The variants of a public symbol would be exported, too, so they are static. */
void lattice_few_raise(lattice_few *few, lattice_block *b, double h, const double *cosine, const double *sine) {
  raise(few, b, h, cosine, sine);
}

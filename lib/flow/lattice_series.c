/* The Taylor series of a lattice over a step, block by block. */
#include "lattice_series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/elementary.h"

/** Columns of a block that hold consecutive particles. */
typedef struct series_run {
  size_t column, particle, count;
} series_run;

/* Constants of the columns of a block, from the lattice and its contacts. */

/* All constants of one particle. */
typedef struct site {
  double inverse_mass, cosine, sine;
  ric_spring own, left, right;
} site;

static site site_of(const ric_lattice *lattice, size_t particle) {
  return (site){.inverse_mass = 1 / ric_lattice_mass(lattice, particle),
                .own = ric_lattice_on_site(lattice, particle),
                .left = ric_lattice_link(lattice, particle),
                .right = ric_lattice_link(lattice, particle + 1),
                .cosine = lattice->force_cos ? lattice->force_cos[particle] : 0,
                .sine = lattice->force_sin ? lattice->force_sin[particle] : 0};
}

static void set(const lattice_block *b, block_row row, size_t column, double value) {
  if (b->row[row])
    b->row[row][column] = value;
}

static void set_column(lattice_block *b, size_t i, const site *s) {
  double w = s->inverse_mass;
  set(b, ROW_INVERSE_MASS, i, w);
  set(b, ROW_OWN, i, -(s->own.linear + s->left.linear + s->right.linear) * w);
  set(b, ROW_LEFT, i, s->left.linear * w);
  set(b, ROW_RIGHT, i, s->right.linear * w);
  if (b->terms == 0)
    return;
  set(b, ROW_DAMP_OWN, i, -(s->own.damping + s->left.damping + s->right.damping) * w);
  set(b, ROW_DAMP_LEFT, i, s->left.damping * w);
  set(b, ROW_DAMP_RIGHT, i, s->right.damping * w);
  set(b, ROW_SITE_SQUARE, i, s->own.quadratic * w);
  set(b, ROW_SITE_CUBE, i, s->own.cubic * w);
  set(b, ROW_COS, i, s->cosine * w);
  set(b, ROW_SIN, i, s->sine * w);
}

static void set_link(lattice_block *b, size_t column, const ric_spring *link) {
  set(b, ROW_LINK_SQUARE, column, link->quadratic);
  set(b, ROW_LINK_CUBE, column, link->cubic);
}

static bool same_everywhere(const ric_lattice *l) {
  return !l->masses && !l->on_sites && !l->links && !l->force_cos && !l->force_sin;
}

/* Repeats the constants of the column `from` up to the column `to`. */
static void repeat(lattice_block *b, size_t from, size_t to) {
  for (int row = 0; row < BLOCK_ROWS; row++)
    for (size_t i = from + 1; b->row[row] && i < to; i++)
      b->row[row][i] = b->row[row][from];
}

static void load_particle(lattice_series *s, const series_run *run, size_t i) {
  site here = site_of(s->lattice, run->particle + i);
  set_column(&s->block, run->column + i, &here);
  set_link(&s->block, run->column + i, &here.left);
  set_link(&s->block, run->column + i + 1, &here.right); /* the next column may be a wall */
}

static void load_run(lattice_series *s, const series_run *run) {
  size_t to_last = s->lattice->particles - 1 - run->particle;
  size_t inner = run->particle == 0 ? 1 : 0, inner_end = to_last < run->count ? to_last : run->count;
  if (!same_everywhere(s->lattice) || inner >= inner_end)
    inner = inner_end = run->count;
  for (size_t i = 0; i < inner; i++)
    load_particle(s, run, i);
  if (inner < inner_end) {
    load_particle(s, run, inner);
    repeat(&s->block, run->column + inner, run->column + inner_end);
    set_link(&s->block, run->column + inner_end, &s->lattice->link);
  }
  for (size_t i = inner_end; i < run->count; i++)
    load_particle(s, run, i);
}

/* First of the sorted contacts at or after a particle. */
static size_t first_held(const lattice_contacts *c, size_t particle) {
  size_t low = 0, high = c->held_count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (c->held[middle] < particle)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static size_t first_pressed(const lattice_contacts *c, size_t particle) {
  size_t low = 0, high = c->pressed_count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (c->pressed[middle].coordinate < particle)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* A held particle has infinite mass; its links still act on its neighbours. */
static void hold(lattice_series *s, size_t column) {
  static const block_row rows[] = {ROW_OWN,       ROW_LEFT,       ROW_RIGHT,       ROW_DAMP_OWN,
                                   ROW_DAMP_LEFT, ROW_DAMP_RIGHT, ROW_SITE_SQUARE, ROW_SITE_CUBE,
                                   ROW_COS,       ROW_SIN,        ROW_INVERSE_MASS};
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
    set(&s->block, rows[r], column, 0);
  s->held_column[s->held_count++] = column;
}

static void load_contacts(lattice_series *s, const series_run *run) {
  const lattice_contacts *c = &s->contacts;
  lattice_block *b = &s->block;
  size_t end = run->particle + run->count, shift = run->column - run->particle; /* may wrap; so does the sum */
  for (size_t k = first_held(c, run->particle); k < c->held_count && c->held[k] < end; k++)
    hold(s, c->held[k] + shift);
  for (size_t k = first_pressed(c, run->particle); k < c->pressed_count && c->pressed[k].coordinate < end; k++) {
    const lattice_press *p = &c->pressed[k];
    size_t column = p->coordinate + shift;
    block_press *press = &b->presses.press[b->presses.count++];
    press->column = column;
    press->side = p->side;
    press->position = p->position;
    press->strength = p->side * p->stiffness * b->row[ROW_INVERSE_MASS][column];
  }
}

/** Next run of columns, from left to right; starts with a run of zeros, returns false after the last. */
static bool series_next_run(const lattice_series *s, series_run *run) {
  const lattice_block *b = &s->block;
  if (b->whole) { /* one run between two ghosts */
    bool first = run->count == 0;
    *run = (series_run){.column = 1, .count = b->count};
    return first;
  }
  size_t n = s->lattice->particles, width = b->count + 2 * b->ghosts;
  ptrdiff_t begin = (ptrdiff_t)s->segment.first - (ptrdiff_t)b->ghosts, whole = (ptrdiff_t)n;
  size_t column = run->column + run->count; /* after the last run */
  if (column == 0 && begin < 0 && !s->ring)
    column = (size_t)-begin;
  ptrdiff_t particle = begin + (ptrdiff_t)column;
  if (column >= width || (particle >= whole && !s->ring))
    return false;
  size_t wrapped = (size_t)((particle % whole + whole) % whole);
  size_t rest = n - wrapped, left = width - column;
  *run = (series_run){.column = column, .particle = wrapped, .count = rest < left ? rest : left};
  return true;
}

/** Loads the constants of the block's columns, and its contacts. */
static void series_load_rows(lattice_series *s) {
  lattice_block *b = &s->block;
  size_t width = b->count + 2 * b->ghosts;
  for (int row = 0; row < BLOCK_ROWS; row++)
    if (b->row[row])
      memset(b->row[row], 0, width * sizeof *b->row[row]);
  if (b->whole) /* ghosts of walls and of rings start as zeros */
    for (int j = 0; j <= b->order; j++)
      b->c[(size_t)j * b->stride] = b->c[(size_t)j * b->stride + b->count + 1] = 0;
  b->presses.count = s->held_count = 0;
  for (series_run run = {0}; series_next_run(s, &run);)
    load_run(s, &run);
  for (series_run run = {0}; series_next_run(s, &run);)
    load_contacts(s, &run);
  if (s->few)
    lattice_few_load(s->few, b);
}

/* Results of a series: the decay of its coefficients, and the force on one of its particles. */

taylor_decay lattice_series_decay(const lattice_series *s) {
  const lattice_block *b = &s->block;
  taylor_decay d = taylor_decay_of(s->segment.coef, b->stride, b->count, b->order);
  for (size_t k = 0; k < b->presses.count; k++) {
    const block_press *p = &b->presses.press[k];
    if (p->column >= b->ghosts && p->column - b->ghosts < b->count) /* others belong to another piece */
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

/* Series of a column minus that of another; the second may be missing. */
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

static unsigned terms_of_spring(const ric_spring *s, unsigned damped, unsigned nonlinear) {
  return (s->damping != 0 ? damped : 0) | (s->quadratic != 0 || s->cubic != 0 ? nonlinear : 0);
}

static unsigned terms_of(const ric_lattice *lattice) {
  unsigned terms = lattice->force_cos || lattice->force_sin ? BLOCK_FORCED : 0;
  for (size_t i = 0; i < (lattice->on_sites ? lattice->particles : 1); i++) {
    ric_spring s = ric_lattice_on_site(lattice, i);
    terms |= terms_of_spring(&s, BLOCK_DAMPED, BLOCK_SITE_NONLINEAR);
  }
  for (size_t i = 0; i < (lattice->links ? lattice->particles + 1 : 1); i++)
    terms |= terms_of_spring(lattice->links ? &lattice->links[i] : &lattice->link, BLOCK_DAMPED | BLOCK_LINK_DAMPED,
                             BLOCK_LINK_NONLINEAR);
  return terms;
}

/* Number of columns of the rows that the terms need. Two rows are followed by scratch of the same size. */
static size_t columns_of_row(block_row row, unsigned terms, size_t stride) {
  switch (row) {
  case ROW_OWN:
  case ROW_LEFT:
  case ROW_RIGHT:
  case ROW_INVERSE_MASS:
    return stride;
  case ROW_DAMP_OWN:
  case ROW_DAMP_LEFT:
  case ROW_DAMP_RIGHT:
    return terms & BLOCK_DAMPED ? stride : 0;
  case ROW_SITE_SQUARE:
  case ROW_SITE_CUBE:
    return terms & BLOCK_SITE_NONLINEAR ? 2 * stride : 0;
  case ROW_LINK_SQUARE:
  case ROW_LINK_CUBE:
    return terms & BLOCK_LINK_NONLINEAR ? 2 * stride : 0;
  case ROW_COS:
  case ROW_SIN:
    return terms & BLOCK_FORCED ? stride : 0;
  case BLOCK_ROWS:
    break;
  }
  return 0;
}

/* Allocates `size` doubles of the store; without a store only counts them. */
static double *take(double *store, size_t *used, size_t size) {
  double *taken = store && size > 0 ? store + *used : NULL;
  *used += size;
  return taken;
}

/* Lays the arrays of a block out in the store and returns its size. */
static size_t lay_out_block(lattice_block *b, double *store) {
  size_t used = 0, levels = (size_t)(b->order + 1) * b->stride;
  b->c = take(store, &used, levels);
  for (int row = 0; row < BLOCK_ROWS; row++)
    b->row[row] = take(store, &used, columns_of_row((block_row)row, b->terms, b->stride));
  b->square = take(store, &used, b->terms & BLOCK_SITE_NONLINEAR ? levels : 0);
  b->extension = take(store, &used, b->terms & BLOCK_LINK_NONLINEAR ? levels : 0);
  b->extension_square = take(store, &used, b->terms & BLOCK_LINK_NONLINEAR ? levels : 0);
  b->force = take(store, &used, b->terms ? b->stride : 0);
  return used;
}

/* Columns in whole cache lines, and an odd number of those, so that levels do not share sets of the cache. */
static size_t padded(size_t columns) {
  return ((columns + 7) / 8 | 1) * 8;
}

void lattice_series_destroy(lattice_series **series) {
  if (!series || !*series)
    return;
  block_presses *p = &(*series)->block.presses;
  free(p->press);
  free((*series)->held_column);
  free((*series)->few);
  free((*series)->store);
  free(*series);
  *series = NULL;
}

ric_status lattice_series_create(const ric_lattice *lattice, int order, size_t block, lattice_series **series,
                                 ric_error *error) {
  lattice_series *s = *series = calloc(1, sizeof *s);
  bool few = false;
  if (s) {
    s->block = (lattice_block){.order = order, .terms = terms_of(lattice)};
    s->halo = lattice_block_halo(order, s->block.terms);
    s->block.stride = padded(block + 2 * (s->halo > 0 ? s->halo : 1));
    few = block == lattice->particles && lattice_few_takes(block, s->block.terms);
    if (few) {
      s->few = malloc(sizeof *s->few);
      s->block.stride = padded(lattice_few_columns(block));
    }
    s->store = calloc(lay_out_block(&s->block, NULL), sizeof *s->store);
    s->held_column = malloc(s->block.stride * sizeof *s->held_column);
  }
  if (!s || !s->store || !s->held_column || (few && !s->few)) {
    lattice_series_destroy(series);
    return ric_fail(error, RIC_ENOMEM, "no memory for the Taylor coefficients of %zu particles", block);
  }
  lay_out_block(&s->block, s->store);
  s->turn = NAN;
  return RIC_OK;
}

bool lattice_series_fits(const lattice_series *s, const ric_lattice *lattice) {
  return s->block.terms == terms_of(lattice);
}

/* Largest number of pressed contacts in a block with its halo. */
static size_t most_presses(const lattice_series *s, const lattice_contacts *contacts) {
  size_t most = 0, first = 0, span = s->block.stride;
  if (contacts->pressed_count > 0 && s->lattice->particles <= 2 * span)
    return 3 * contacts->pressed_count; /* the halo may contain a contact of a small ring twice */
  for (size_t k = 0; k < contacts->pressed_count; k++) {
    while (contacts->pressed[k].coordinate - contacts->pressed[first].coordinate >= span)
      first++;
    if (k - first + 1 > most)
      most = k - first + 1;
  }
  return 2 * most; /* one block may contain both ends of a ring */
}

static ric_status reserve_presses(lattice_series *s, size_t count, ric_error *error) {
  block_presses *p = &s->block.presses;
  p->count = 0;
  if (count <= p->capacity)
    return RIC_OK;
  free(p->press);
  p->capacity = 0;
  p->press = malloc(count * sizeof *p->press);
  if (!p->press)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu pressed contacts", count);
  p->capacity = count;
  return RIC_OK;
}

ric_status lattice_series_begin(lattice_series *s, const ric_lattice *lattice, const lattice_contacts *contacts,
                                ric_error *error) {
  s->lattice = lattice;
  s->contacts = contacts ? *contacts : (lattice_contacts){0};
  s->ring = lattice->ends == RIC_ENDS_PERIODIC && lattice->particles >= 3;
  s->loaded_count = 0;
  return reserve_presses(s, most_presses(s, &s->contacts), error);
}

static void load_state(lattice_series *s, const double *q, const double *v, double length) {
  lattice_block *b = &s->block;
  double *c0 = b->c, *c1 = b->c + b->stride;
  size_t width = b->count + 2 * b->ghosts, done = 0;
  series_run run = {0};
  while (series_next_run(s, &run)) {
    for (; done < run.column; done++)
      c0[done] = c1[done] = 0;
    memcpy(c0 + run.column, q + run.particle, run.count * sizeof *q);
    for (size_t i = 0; i < run.count; i++)
      c1[run.column + i] = length * v[run.particle + i];
    done = run.column + run.count;
  }
  for (; done < width; done++)
    c0[done] = c1[done] = 0;
  for (size_t k = 0; k < s->held_count; k++)
    c1[s->held_column[k]] = 0;
  for (size_t k = 0; k < b->presses.count; k++) {
    block_press *p = &b->presses.press[k];
    p->start = p->side * (p->position - c0[p->column]);
  }
  lattice_block_close_ring(b, 0);
  lattice_block_close_ring(b, 1);
}

static void set_powers(lattice_series *s, double turn) {
  double power = 1;
  if (s->turn == turn)
    return;
  s->turn = turn;
  for (int j = 0; j < SERIES_POWERS; j++) {
    s->power[j] = power;
    power *= turn / (j + 1);
  }
}

/* Series of cos(w t) and sin(w t) in x: their derivatives are the same four numbers again and again. Forces of held
 * contacts need terms beyond the order. */
static void forcing_series(lattice_series *s, double start, double length) {
  double c, d;
  ric_sincos(s->lattice->frequency * start, &d, &c);
  const double cosine[4] = {c, -d, -c, d}, sine[4] = {d, c, -d, -c};
  int degree = s->held_count > 0 ? RIC_POLY_DEGREE : s->block.order;
  set_powers(s, s->lattice->frequency * length);
  for (int j = 0; j <= degree; j += 4)
    for (int k = 0; k < 4; k++) {
      s->cosine[j + k] = s->power[j + k] * cosine[k];
      s->sine[j + k] = s->power[j + k] * sine[k];
    }
}

ric_segment lattice_series_segment(lattice_series *s, const double *q, const double *v, double start, double length,
                                   size_t first, size_t count) {
  lattice_block *b = &s->block;
  if (s->loaded_count != count || s->segment.first != first) {
    b->count = count;
    b->whole = count == s->lattice->particles;
    b->ring = s->ring;
    b->ghosts = b->whole ? 1 : s->halo;
    s->segment = (ric_segment){.first = first, .coordinates = count, .stride = b->stride, .degree = b->order};
    series_load_rows(s);
    s->loaded_count = count;
  }
  load_state(s, q, v, length);
  if (b->terms & BLOCK_FORCED)
    forcing_series(s, start, length);
  if (s->few)
    lattice_few_raise(s->few, b, length, s->cosine, s->sine);
  else
    lattice_block_raise(b, length, s->cosine, s->sine);
  s->segment.start = start;
  s->segment.length = length;
  s->segment.coef = b->c + b->ghosts;
  return s->segment;
}

ric_segment lattice_series_shorten(lattice_series *s, const double *q, const double *v, double length) {
  lattice_block *b = &s->block;
  double r = length / s->segment.length, factor = r;
  s->segment.length = length;
  load_state(s, q, v, length);
  for (int j = 2; j <= b->order; j++) {
    double *c = b->c + (size_t)j * b->stride;
    factor *= r;
    for (size_t i = 0; i < b->count + 2 * b->ghosts; i++)
      c[i] *= factor;
  }
  if (b->terms & BLOCK_FORCED)
    forcing_series(s, s->segment.start, s->segment.length);
  return s->segment;
}

ric_segment lattice_series_last(const lattice_series *s) {
  return s->segment;
}

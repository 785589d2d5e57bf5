#include "lattice_series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lattice_series_parts.h"

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

/* Rows that the terms need. Two have as much scratch behind them. */
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

/* Takes `size` doubles of the store; with no store, only counts them. */
static double *take(double *store, size_t *used, size_t size) {
  double *taken = store && size > 0 ? store + *used : NULL;
  *used += size;
  return taken;
}

/* Lays the arrays of a block out in the store and returns its size. */
static size_t lay_out(lattice_block *b, double *store) {
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
    s->store = calloc(lay_out(&s->block, NULL), sizeof *s->store);
    s->held_column = malloc(s->block.stride * sizeof *s->held_column);
  }
  if (!s || !s->store || !s->held_column || (few && !s->few)) {
    lattice_series_destroy(series);
    return ric_fail(error, RIC_ENOMEM, "no memory for the Taylor coefficients of %zu particles", block);
  }
  lay_out(&s->block, s->store);
  s->turn = NAN;
  return RIC_OK;
}

bool lattice_series_fits(const lattice_series *s, const ric_lattice *lattice) {
  return s->block.terms == terms_of(lattice);
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

/* Most pressed contacts that a block with its halo may see. */
static size_t most_presses(const lattice_series *s, const lattice_contacts *contacts) {
  size_t most = 0, first = 0, span = s->block.stride;
  if (contacts->pressed_count > 0 && s->lattice->particles <= 2 * span)
    return 3 * contacts->pressed_count; /* a halo may see a contact of a small ring again */
  for (size_t k = 0; k < contacts->pressed_count; k++) {
    while (contacts->pressed[k].coordinate - contacts->pressed[first].coordinate >= span)
      first++;
    if (k - first + 1 > most)
      most = k - first + 1;
  }
  return 2 * most; /* both ends of a ring meet in one block */
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

bool series_next_run(const lattice_series *s, series_run *run) {
  const lattice_block *b = &s->block;
  if (b->whole) { /* one run between two ghosts */
    bool first = run->count == 0;
    *run = (series_run){.column = 1, .count = b->count};
    return first;
  }
  size_t n = s->lattice->particles, width = b->count + 2 * b->ghosts;
  ptrdiff_t begin = (ptrdiff_t)s->segment.first - (ptrdiff_t)b->ghosts, whole = (ptrdiff_t)n;
  size_t column = run->column + run->count; /* behind the last run */
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
 * contacts go beyond the order. */
static void forcing_series(lattice_series *s, double start, double length) {
  double phase = s->lattice->frequency * start, c = cos(phase), d = sin(phase);
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

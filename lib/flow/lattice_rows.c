/* Constants of the columns of a block, from the lattice and its contacts. */
#include <string.h>

#include "lattice_series_parts.h"

/* Everything about one particle. */
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

/* First of the sorted contacts at or behind a particle. */
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

/* A held particle is one of infinite mass; its links still pull at its neighbours. */
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

void series_load_rows(lattice_series *s) {
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

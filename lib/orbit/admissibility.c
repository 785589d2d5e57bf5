#include "admissibility.h"

#include <math.h>
#include <stdint.h>

/* Gap of a site over a piece as a polynomial; returns its degree. At its own contact the gap is x times the result. */
static int gap_of(const motion_piece *piece, const unit_cell *cell, size_t i, double *c) {
  size_t site = piece->segment.first + i;
  ric_role role = unit_cell_role(cell, site);
  ric_segment_gap(&piece->segment, i, ric_chain_floor(&cell->chain, site), c);
  if (!piece->at_contact || role != (piece->from_half ? RIC_ROLE_HALF : RIC_ROLE_START))
    return piece->segment.degree;
  for (int j = 0; j < piece->segment.degree; j++)
    c[j] = c[j + 1];
  return piece->segment.degree - 1;
}

static double time_at(const motion_piece *piece, double x) {
  return piece->segment.start + x * piece->segment.length;
}

typedef struct search {
  const unit_cell *cell;
  double tolerance, small;
  gaps *found;
} search;

/* Ties within half the tolerance go to the first in time, then to the first particle. */
static void look(const search *s, const motion_piece *piece, size_t i) {
  size_t site = piece->segment.first + i;
  int is_free = unit_cell_role(s->cell, site) == RIC_ROLE_FREE;
  located *best = is_free ? &s->found->free : &s->found->impact;
  double c[RIC_POLY_DEGREE + 1], x, value, cutoff = best->value - s->tolerance / 2;
  if (!is_free)
    cutoff = fmin(cutoff, s->small);
  int degree = gap_of(piece, s->cell, i, c);
  if (ric_poly_minimum(c, degree, cutoff, s->tolerance / 2, &x, &value))
    *best = (located){.value = value, .time = time_at(piece, x), .site = site};
}

static void search_piece(const motion_piece *piece, void *user) {
  const search *s = user;
  double lower[LATTICE_SERIES_BLOCK];
  ric_segment_bounds(&piece->segment, lower, NULL);
  for (size_t i = 0; i < piece->segment.coordinates; i++) {
    size_t site = piece->segment.first + i;
    double gap = lower[i] - ric_chain_floor(&s->cell->chain, site); /* infinite without a floor */
    double interesting =
        unit_cell_role(s->cell, site) == RIC_ROLE_FREE ? s->found->free.value - s->tolerance / 2 : s->small;
    if (gap <= interesting && gap < INFINITY)
      look(s, piece, i);
  }
}

ric_status gaps_find(motion *m, const unit_cell *cell, double period, const boundary_state *state, double tolerance,
                     double small, gaps *found, double *mismatch, ric_poll poll, ric_error *error) {
  search s = {.cell = cell, .tolerance = tolerance, .small = small, .found = found};
  found->free = found->impact = (located){.value = INFINITY, .time = NAN, .site = SIZE_MAX};
  return motion_run(m, &cell->chain, period, state, search_piece, &s, mismatch, poll, error);
}

typedef struct violation {
  const unit_cell *cell;
  double tolerance;
  located *first;
} violation;

static void violation_in_piece(const motion_piece *piece, void *user) {
  const violation *s = user;
  for (size_t i = 0; i < piece->segment.coordinates; i++) {
    size_t site = piece->segment.first + i;
    if (ric_chain_floor(&s->cell->chain, site) == -INFINITY)
      continue;
    double c[RIC_POLY_DEGREE + 1], r[RIC_POLY_DEGREE + 1], x;
    int degree = gap_of(piece, s->cell, i, c);
    c[0] += s->tolerance;
    if (ric_poly_lower_bound(c, degree) > 0)
      continue;
    if (piece->from_half) /* the segment runs back in time: first in time is last in x */
      ric_poly_reflect(c, degree, r);
    if (!ric_poly_first_root(piece->from_half ? r : c, degree, &x))
      continue;
    double time = time_at(piece, piece->from_half ? 1 - x : x);
    if (time < s->first->time)
      *s->first = (located){.value = 0, .time = time, .site = site};
  }
}

ric_status gaps_first_violation(motion *m, const unit_cell *cell, double period, const boundary_state *state,
                                double tolerance, located *first, ric_poll poll, ric_error *error) {
  violation s = {.cell = cell, .tolerance = tolerance, .first = first};
  *first = (located){.value = NAN, .time = INFINITY, .site = SIZE_MAX};
  return motion_run(m, &cell->chain, period, state, violation_in_piece, &s, NULL, poll, error);
}

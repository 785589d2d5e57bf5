#include "lattice_variation.h"

#include <stdlib.h>
#include <string.h>

#include "lattice_variation_parts.h"
#include "vectorised.h"

/* --- recurrence ------------------------------------------------------------------------------------------------ */

/* Levels are [n + 2][lanes]: row 0 and row n + 1 are the neighbours of the ends. */
static double *level(const lattice_variation *v, int j) {
  return v->levels + (size_t)(v->varies ? j : j % 3) * (v->n + 2) * LANES;
}

RIC_INLINE void close_ring(const lattice_variation *v, double *c, size_t lanes) {
  if (!v->ring)
    return;
  memcpy(c, c + v->n * lanes, lanes * sizeof *c);
  memcpy(c + (v->n + 1) * lanes, c + lanes, lanes * sizeof *c);
}

/* next = scale (own, left, right) c */
RIC_INLINE void set_stencil(const stencil *s, const double *restrict c, double *restrict next, size_t n, double scale,
                            size_t lanes) {
  for (size_t i = 0; i < n; i++) {
    double own = scale * s->own[i], left = scale * s->left[i], right = scale * s->right[i];
    const double *here = c + (i + 1) * lanes;
    for (size_t k = 0; k < lanes; k++)
      next[(i + 1) * lanes + k] = own * here[k] + (left * (here - lanes)[k] + right * here[lanes + k]);
  }
}

RIC_INLINE void add_stencil(const stencil *s, const double *restrict c, double *restrict next, size_t n, double scale,
                            size_t lanes) {
  for (size_t i = 0; i < n; i++) {
    double own = scale * s->own[i], left = scale * s->left[i], right = scale * s->right[i];
    const double *here = c + (i + 1) * lanes;
    for (size_t k = 0; k < lanes; k++)
      next[(i + 1) * lanes + k] += own * here[k] + (left * (here - lanes)[k] + right * here[lanes + k]);
  }
}

/* One term of the sum over the varying stiffness, coefficients [n] of sites and [n + 1] of links. */
RIC_INLINE void add_varying(const lattice_variation *v, const double *site, const double *link,
                            const double *restrict c, double *restrict next, double scale, size_t lanes) {
  for (size_t i = 0; i < v->n; i++) {
    double w = scale * v->inverse_mass[i], left = w * link[i], right = w * link[i + 1];
    double own = -(w * site[i] + left + right);
    const double *here = c + (i + 1) * lanes;
    for (size_t k = 0; k < lanes; k++)
      next[(i + 1) * lanes + k] += own * here[k] + (left * (here - lanes)[k] + right * here[lanes + k]);
  }
}

RIC_INLINE void raise_lanes(lattice_variation *v, size_t lanes) {
  size_t n = v->n, size = n * lanes;
  double h = v->length;
  for (int j = 0; j + 2 <= v->order; j++) {
    double *next = level(v, j + 2), scale = h * h / ((j + 1) * (j + 2));
    set_stencil(&v->springs, level(v, j), next, n, scale, lanes);
    if (v->damped)
      add_stencil(&v->dampers, level(v, j + 1), next, n, scale * (j + 1) / h, lanes);
    for (int l = 0; l <= j && v->varies; l++)
      add_varying(v, v->site + (size_t)l * n, v->link + (size_t)l * (n + 1), level(v, j - l), next, scale, lanes);
    for (size_t i = 0; i < v->held_count; i++)
      memset(next + (v->held[i] + 1) * lanes, 0, lanes * sizeof *next);
    close_ring(v, next, lanes);
    for (size_t i = 0; i < size; i++)
      v->sum_q[i] += next[lanes + i];
    for (size_t i = 0; i < size; i++)
      v->sum_u[i] += (j + 2) * next[lanes + i];
  }
}

/* Some columns of the tangents through the step: `count` of them in lanes, the others zero. */
RIC_INLINE void move_lanes(lattice_variation *v, const tangents *d, size_t first, size_t count, size_t lanes) {
  size_t n = v->n, columns = d->columns;
  double *c0 = level(v, 0) + lanes, *c1 = level(v, 1) + lanes, h = v->length;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < lanes; k++) {
      c0[i * lanes + k] = k < count ? d->q[i * columns + first + k] : 0;
      c1[i * lanes + k] = k < count ? h * d->u[i * columns + first + k] : 0;
    }
  for (size_t i = 0; i < v->held_count; i++)
    memset(c1 + v->held[i] * lanes, 0, lanes * sizeof *c1);
  for (size_t i = 0; i < n * lanes; i++) {
    v->sum_q[i] = c0[i] + c1[i];
    v->sum_u[i] = c1[i];
  }
  close_ring(v, c0 - lanes, lanes);
  close_ring(v, c1 - lanes, lanes);
  raise_lanes(v, lanes);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < count; k++) {
      d->q[i * columns + first + k] = v->sum_q[i * lanes + k];
      d->u[i * columns + first + k] = v->sum_u[i * lanes + k] / h;
    }
}

/* The ends of levels of one width are walls; those of the other width lie elsewhere. */
static void raise_walls(lattice_variation *v, size_t lanes) {
  if (v->ring || v->lanes == lanes)
    return;
  for (int j = 0; j < (v->keeps ? v->order + 1 : 3); j++) {
    double *c = v->levels + (size_t)j * (v->n + 2) * LANES;
    memset(c, 0, lanes * sizeof *c);
    memset(c + (v->n + 1) * lanes, 0, lanes * sizeof *c);
  }
  v->lanes = lanes;
}

RIC_VECTORISED static void transport(lattice_variation *v, const tangents *d) {
  size_t first = 0;
  raise_walls(v, LANES);
  for (; first + LANES / 2 < d->columns; first += LANES)
    move_lanes(v, d, first, d->columns - first < LANES ? d->columns - first : LANES, LANES);
  if (first < d->columns)
    raise_walls(v, 1);
  for (; first < d->columns; first++)
    move_lanes(v, d, first, 1, 1);
}

void lattice_variation_transport(lattice_variation *v, const lattice_contacts *held, const tangents *d) {
  v->held = held->held;
  v->held_count = held->held_count;
  transport(v, d);
}

/* --- life ------------------------------------------------------------------------------------------------------ */

static void load_particle(lattice_variation *v, const ric_lattice *l, size_t i) {
  double w = v->inverse_mass[i] = 1 / ric_lattice_mass(l, i);
  ric_spring own = ric_lattice_on_site(l, i), left = ric_lattice_link(l, i), right = ric_lattice_link(l, i + 1);
  v->springs.own[i] = -(own.linear + left.linear + right.linear) * w;
  v->springs.left[i] = left.linear * w;
  v->springs.right[i] = right.linear * w;
  v->dampers.own[i] = -(own.damping + left.damping + right.damping) * w;
  v->dampers.left[i] = left.damping * w;
  v->dampers.right[i] = right.damping * w;
  v->damped |= v->dampers.own[i] != 0;
  v->nonlinear |= own.quadratic != 0 || own.cubic != 0 || left.quadratic != 0 || left.cubic != 0 ||
                  right.quadratic != 0 || right.cubic != 0;
}

static double *take(double **store, size_t count) {
  double *taken = *store;
  *store += count;
  return taken;
}

static bool allocate_constants(lattice_variation *v) {
  size_t n = v->n;
  double *store = v->constants = malloc((7 + 2 * LANES) * n * sizeof *store);
  if (!store)
    return false;
  v->inverse_mass = take(&store, n);
  v->springs = (stencil){take(&store, n), take(&store, n), take(&store, n)};
  v->dampers = (stencil){take(&store, n), take(&store, n), take(&store, n)};
  v->sum_q = take(&store, n * LANES);
  v->sum_u = take(&store, n * LANES);
  return true;
}

static bool allocate_levels(lattice_variation *v) {
  size_t n = v->n, levels = (size_t)v->order + 1;
  v->levels = calloc((v->keeps ? levels : 3) * (n + 2) * LANES, sizeof *v->levels);
  if (!v->keeps)
    return v->levels != NULL;
  double *store = v->series = malloc(levels * (3 * n + 1) * sizeof *store);
  if (!v->levels || !store)
    return false;
  v->q = take(&store, levels * n);
  v->site = take(&store, levels * n);
  v->link = take(&store, levels * (n + 1));
  return true;
}

ric_status lattice_variation_create(const ric_lattice *lattice, int order, bool compliant,
                                    lattice_variation **variation, ric_error *error) {
  lattice_variation *v = *variation = calloc(1, sizeof *v);
  bool made = v != NULL;
  if (made) {
    v->lattice = lattice;
    v->n = lattice->particles;
    v->order = order;
    v->ring = lattice->ends == RIC_ENDS_PERIODIC && v->n >= 3;
    v->lanes = LANES;
    made = allocate_constants(v);
  }
  for (size_t i = 0; made && i < v->n; i++)
    load_particle(v, lattice, i);
  if (made) {
    v->keeps = v->nonlinear || compliant;
    made = allocate_levels(v);
  }
  if (made)
    return RIC_OK;
  lattice_variation_destroy(variation);
  return ric_fail(error, RIC_ENOMEM, "no memory for tangent vectors of %zu particles", lattice->particles);
}

void lattice_variation_destroy(lattice_variation **variation) {
  if (!variation || !*variation)
    return;
  free((*variation)->constants);
  free((*variation)->levels);
  free((*variation)->series);
  free(*variation);
  *variation = NULL;
}

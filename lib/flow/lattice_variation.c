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

/* One row of a stencil times a scale. */
typedef struct weights {
  double own, left, right;
} weights;

RIC_INLINE weights weights_of(const stencil *s, size_t i, double scale) {
  return (weights){scale * s->own[i], scale * s->left[i], scale * s->right[i]};
}

/* Loops over lanes read all before they write: so they become vector instructions. */
RIC_INLINE void weigh(weights w, const double *c, double *value, size_t lanes) {
  for (size_t k = 0; k < lanes; k++)
    value[k] = w.own * c[k] + (w.left * *(c + k - lanes) + w.right * c[k + lanes]);
}

RIC_INLINE void add(const double *value, double *sum, size_t lanes) {
  double old[LANES];
  for (size_t k = 0; k < lanes; k++)
    old[k] = sum[k] + value[k];
  for (size_t k = 0; k < lanes; k++)
    sum[k] = old[k];
}

/* Level j + 2 of the constant part. */
RIC_INLINE void set_level(const lattice_variation *v, int j, size_t lanes) {
  const double *restrict c = level(v, j) + lanes, *restrict d = level(v, j + 1) + lanes;
  double *restrict next = level(v, j + 2) + lanes, h = v->length, scale = h * h / ((j + 1) * (j + 2));
  for (size_t i = 0; i < v->n; i++) {
    double value[LANES], damping[LANES];
    weigh(weights_of(&v->springs, i, scale), c + i * lanes, value, lanes);
    if (v->damped) {
      weigh(weights_of(&v->dampers, i, scale * (j + 1) / h), d + i * lanes, damping, lanes);
      add(damping, value, lanes);
    }
    for (size_t k = 0; k < lanes; k++)
      next[i * lanes + k] = value[k];
  }
}

RIC_INLINE void add_up(const lattice_variation *v, int j, size_t lanes) {
  const double *restrict c = level(v, j) + lanes;
  double *restrict q = v->sum_q, *restrict u = v->sum_u, factor = j;
  for (size_t i = 0; i < v->n * lanes; i++) {
    q[i] += c[i];
    u[i] += factor * c[i];
  }
}

/* Both in one pass, where nothing else adds to the level. */
RIC_INLINE void set_and_add_up(const lattice_variation *v, int j, size_t lanes) {
  const double *restrict c = level(v, j) + lanes;
  double *restrict next = level(v, j + 2) + lanes, *restrict q = v->sum_q, *restrict u = v->sum_u;
  double scale = v->length * v->length / ((j + 1) * (j + 2)), factor = j + 2;
  for (size_t i = 0; i < v->n; i++) {
    double value[LANES], slope[LANES];
    weigh(weights_of(&v->springs, i, scale), c + i * lanes, value, lanes);
    for (size_t k = 0; k < lanes; k++)
      next[i * lanes + k] = value[k];
    for (size_t k = 0; k < lanes; k++)
      slope[k] = factor * value[k];
    add(value, q + i * lanes, lanes);
    add(slope, u + i * lanes, lanes);
  }
}

/* One term of the sum over the varying stiffness, coefficients [n] of sites and [n + 1] of links. */
RIC_INLINE void add_varying(const lattice_variation *v, const double *site, const double *link,
                            const double *restrict c, double *restrict next, double scale, size_t lanes) {
  for (size_t i = 0; i < v->n; i++) {
    double value[LANES], w = scale * v->inverse_mass[i], left = w * link[i], right = w * link[i + 1];
    weigh((weights){-(w * site[i] + left + right), left, right}, c + (i + 1) * lanes, value, lanes);
    add(value, next + (i + 1) * lanes, lanes);
  }
}

/* Level j + 2 with all that acts. */
RIC_INLINE void raise_level(const lattice_variation *v, int j, size_t lanes) {
  double *next = level(v, j + 2), scale = v->length * v->length / ((j + 1) * (j + 2));
  set_level(v, j, lanes);
  for (int l = 0; l <= j && v->varies; l++)
    add_varying(v, v->site + (size_t)l * v->n, v->link + (size_t)l * (v->n + 1), level(v, j - l), next, scale, lanes);
  for (size_t i = 0; i < v->held_count; i++)
    memset(next + (v->held[i] + 1) * lanes, 0, lanes * sizeof *next);
  add_up(v, j + 2, lanes);
}

RIC_INLINE void raise_lanes(const lattice_variation *v, size_t lanes) {
  bool plain = !v->damped && !v->varies && v->held_count == 0;
  for (int j = 0; j + 2 <= v->order; j++) {
    if (plain)
      set_and_add_up(v, j, lanes);
    else
      raise_level(v, j, lanes);
    close_ring(v, level(v, j + 2), lanes);
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

static void load(lattice_variation *v) {
  v->damped = v->nonlinear = false;
  for (size_t i = 0; i < v->n; i++)
    load_particle(v, v->lattice, i);
}

bool lattice_variation_renew(lattice_variation *v) {
  load(v);
  return v->keeps || !v->nonlinear;
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
  if (made) {
    load(v);
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

#include "lattice_variation.h"

#include <stdlib.h>
#include <string.h>

#include "lattice_variation_parts.h"

/* --- recurrence ------------------------------------------------------------------------------------------------ */

/* Levels are [n + 2][lanes]: row 0 and row n + 1 are the neighbours of the ends. */
static double *level(const lattice_variation *v, int j) {
  return v->levels + (size_t)(j % 3) * (v->n + 2) * LANES;
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
  for (size_t i = 0; i < v->n * lanes; i += lanes) {
    double slope[LANES];
    for (size_t k = 0; k < lanes; k++)
      slope[k] = factor * c[i + k];
    add(c + i, q + i, lanes);
    add(slope, u + i, lanes);
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

/* Coefficients j and j + 1 of a spring's varying force, of some lanes. */
typedef struct force_pair {
  ric_lanes low, high;
} force_pair;

/* Sums of k_{j-l} e_l and k_{j+1-l} e_l, l < count, for levels `apart` from each other. */
RIC_INLINE force_pair products(const double *k, const ric_lanes *e, size_t apart, int j, int count) {
  force_pair even = {{0}, {0}}, odd = {{0}, {0}};
  int l = 0;
  for (; l + 1 < count; l += 2) {
    const ric_lanes *level = e + (size_t)l * apart;
    even.low += k[j - l] * level[0];
    even.high += k[j + 1 - l] * level[0];
    odd.low += k[j - l - 1] * level[apart];
    odd.high += k[j - l] * level[apart];
  }
  if (l < count) {
    even.low += k[j - l] * e[(size_t)l * apart];
    even.high += k[j + 1 - l] * e[(size_t)l * apart];
  }
  return (force_pair){even.low + odd.low, even.high + odd.high};
}

/* Extensions of level j. */
RIC_INLINE void stretch(const lattice_variation *v, const varying_spring *s, int j, double *restrict e, size_t lanes) {
  const double *c = level(v, j) + lanes;
  ric_lanes *all = (ric_lanes *)e;
  const ric_lanes *to = (const ric_lanes *)(s->to != NO_PARTICLE ? c + s->to * lanes : v->nothing);
  const ric_lanes *from = (const ric_lanes *)(s->from != NO_PARTICLE ? c + s->from * lanes : v->nothing);
  for (size_t k = 0; k < lanes / RIC_LANES; k++)
    all[k] = to[k] - from[k];
}

/* Varying forces j and j + 1; what the last levels bring is added last, so that little waits for them. */
RIC_INLINE void raise_springs(const lattice_variation *v, int j, size_t lanes) {
  size_t levels = (size_t)v->order + 1, vectors = lanes / RIC_LANES;
  for (size_t i = 0; i < v->count; i++) {
    const double *k = v->k + i * levels;
    double *e = v->stretch + i * levels * LANES;
    ric_lanes *all = (ric_lanes *)e, *newest = (ric_lanes *)(e + (size_t)j * lanes);
    ric_lanes *force = (ric_lanes *)(v->force + i * 2 * LANES);
    stretch(v, &v->varying[i], j, e + (size_t)j * lanes, lanes);
    stretch(v, &v->varying[i], j + 1, e + (size_t)(j + 1) * lanes, lanes);
    for (size_t lane = 0; lane < vectors; lane++) {
      force_pair sum = products(k, all + lane, vectors, j, j);
      force[lane] = sum.low + k[0] * newest[lane];
      force[vectors + lane] = sum.high + (k[1] * newest[lane] + k[0] * newest[vectors + lane]);
    }
  }
}

/* Adds a multiple of a force to a row of a level. */
RIC_INLINE void pull(double scale, const double *force, double *row, size_t lanes) {
  const ric_lanes *from = (const ric_lanes *)force;
  ric_lanes *to = (ric_lanes *)row;
  for (size_t k = 0; k < lanes / RIC_LANES; k++)
    to[k] += scale * from[k];
}

/* Adds the varying forces, the second of two with `high`, to the level that they make. */
RIC_INLINE void pull_springs(const lattice_variation *v, double *next, double scale, bool high, size_t lanes) {
  for (size_t i = 0; i < v->count; i++) {
    const varying_spring *s = &v->varying[i];
    const double *force = v->force + i * 2 * LANES + (high ? lanes : 0);
    if (s->to != NO_PARTICLE)
      pull(-scale * v->inverse_mass[s->to], force, next + (s->to + 1) * lanes, lanes);
    if (s->from != NO_PARTICLE)
      pull(scale * v->inverse_mass[s->from], force, next + (s->from + 1) * lanes, lanes);
  }
}

/* Level j + 2 with all that acts. */
RIC_INLINE void raise_level(const lattice_variation *v, int j, bool high, size_t lanes) {
  double *next = level(v, j + 2), scale = v->length * v->length / ((j + 1) * (j + 2));
  set_level(v, j, lanes);
  if (lanes >= HALF) /* else nothing varies */
    pull_springs(v, next, scale, high, lanes);
  for (size_t i = 0; i < v->held_count; i++)
    memset(next + (v->held[i] + 1) * lanes, 0, lanes * sizeof *next);
  add_up(v, j + 2, lanes);
  close_ring(v, next, lanes);
}

/* Two levels at a time, since the varying forces of both are known: see lattice_few.h. */
RIC_INLINE void raise_pairs(const lattice_variation *v, size_t lanes) {
  for (int j = 0; j + 2 <= v->order; j += 2) {
    if (lanes >= HALF)
      raise_springs(v, j, lanes);
    raise_level(v, j, false, lanes);
    if (j + 3 <= v->order)
      raise_level(v, j + 1, true, lanes);
  }
}

RIC_INLINE void raise_lanes(const lattice_variation *v, size_t lanes) {
  if (v->damped || v->count > 0 || v->held_count > 0) {
    raise_pairs(v, lanes);
    return;
  }
  for (int j = 0; j + 2 <= v->order; j++) {
    set_and_add_up(v, j, lanes);
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
  for (int j = 0; j < 3; j++) {
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
  size_t rest = first < d->columns ? d->columns - first : 0;
  if (rest > 0 && v->count > 0) {
    raise_walls(v, HALF);
    move_lanes(v, d, first, rest, HALF);
    return;
  }
  if (rest > 0)
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
}

/* Counts the nonlinear springs, and lists them where there is a list. */
static void take_spring(const ric_spring *spring, size_t from, size_t to, varying_spring *list, size_t *count) {
  if (spring->quadratic == 0 && spring->cubic == 0)
    return;
  if (list)
    list[*count] = (varying_spring){from, to, spring->quadratic, spring->cubic};
  ++*count;
}

static size_t list_nonlinear(const ric_lattice *l, bool ring, varying_spring *list) {
  size_t n = l->particles, count = 0;
  for (size_t i = 0; i < n; i++) {
    ric_spring own = ric_lattice_on_site(l, i);
    take_spring(&own, NO_PARTICLE, i, list, &count);
  }
  for (size_t i = 0; i < (ring ? n : n + 1); i++) {
    ric_spring link = ric_lattice_link(l, i);
    size_t from = i > 0 ? i - 1 : ring ? n - 1 : NO_PARTICLE;
    take_spring(&link, from, i < n ? i : NO_PARTICLE, list, &count);
  }
  return count;
}

static void load(lattice_variation *v) {
  v->damped = false;
  for (size_t i = 0; i < v->n; i++)
    load_particle(v, v->lattice, i);
  v->nonlinear = list_nonlinear(v->lattice, v->ring, v->varying);
}

bool lattice_variation_renew(lattice_variation *v) {
  if (list_nonlinear(v->lattice, v->ring, NULL) + v->compliant > v->capacity)
    return false;
  load(v);
  return true;
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
  v->levels = calloc(3 * (v->n + 2) * LANES, sizeof *v->levels);
  return v->levels != NULL;
}

static bool allocate_springs(lattice_variation *v) {
  size_t levels = (size_t)v->order + 1, count = v->capacity;
  if (count == 0)
    return true;
  v->varying = malloc(count * sizeof *v->varying);
  double *store = v->series = malloc((levels * (v->n + count * (1 + LANES)) + count * 2 * LANES) * sizeof *store);
  if (!v->varying || !store)
    return false;
  v->q = take(&store, levels * v->n);
  v->k = take(&store, levels * count);
  v->stretch = take(&store, levels * count * LANES);
  v->force = take(&store, count * 2 * LANES);
  return true;
}

ric_status lattice_variation_create(const ric_lattice *lattice, int order, size_t compliant,
                                    lattice_variation **variation, ric_error *error) {
  lattice_variation *v = *variation = calloc(1, sizeof *v);
  if (v) {
    v->lattice = lattice;
    v->n = lattice->particles;
    v->order = order;
    v->ring = lattice->ends == RIC_ENDS_PERIODIC && v->n >= 3;
    v->lanes = LANES;
    v->compliant = compliant;
    v->capacity = list_nonlinear(lattice, v->ring, NULL) + compliant;
  }
  if (v && allocate_constants(v) && allocate_levels(v) && allocate_springs(v)) {
    load(v);
    return RIC_OK;
  }
  lattice_variation_destroy(variation);
  return ric_fail(error, RIC_ENOMEM, "no memory for tangent vectors of %zu particles", lattice->particles);
}

void lattice_variation_destroy(lattice_variation **variation) {
  if (!variation || !*variation)
    return;
  free((*variation)->constants);
  free((*variation)->levels);
  free((*variation)->varying);
  free((*variation)->series);
  free(*variation);
  *variation = NULL;
}

/* Tangent vectors of a lattice along a step: its stiffness as series, and the recurrence. */
#include "lattice_variation.h"

#include <stdlib.h>
#include <string.h>

#include "hertz_series.h"
#include "numeric/number_block.h"

/* SIMD lanes of tangent vectors. */
#if defined(__GNUC__)
typedef double wide_lanes __attribute__((vector_size(64), aligned(8), may_alias));
enum { WIDE = 8 };
#else
typedef double wide_lanes;
enum { WIDE = 1 };
#endif

/* The stiffness of a lattice along a step, as series. */

bool lattice_variation_varies(const lattice_variation *v, const lattice_contacts *acting) {
  return v->nonlinear > 0 || acting->pressed_count > 0;
}

void lattice_variation_begin(lattice_variation *v, double length) {
  v->length = length;
  v->count = 0;
  memset(v->first_pull, 0, (v->n + 1) * sizeof *v->first_pull);
}

void lattice_variation_take(lattice_variation *v, const ric_segment *piece, double x) {
  double power = 1;
  for (int j = 0; j <= v->order; j++, power *= x) {
    const double *c = piece->coef + (size_t)j * piece->stride;
    double *q = v->q + (size_t)j * v->n + piece->first;
    for (size_t i = 0; i < piece->coordinates; i++)
      q[i] = power * c[i];
  }
}

/* Coefficients of an extension. */
RIC_INLINE void extension(const lattice_variation *v, const varying_spring *s, double *e) {
  for (int j = 0; j <= v->order; j++) {
    const double *q = v->q + (size_t)j * v->n;
    e[j] = (s->to != NO_PARTICLE ? q[s->to] : 0) - (s->from != NO_PARTICLE ? q[s->from] : 0);
  }
}

enum { PADDED = (LATTICE_SERIES_ORDER / RIC_LANES + 1) * RIC_LANES };

/* Coefficients of e^2 up to the order, several at a time; e is preceded by as many zeros. */
RIC_INLINE void square(const double *e, int order, double *out) {
  for (int j = 0; j <= order; j += RIC_LANES) {
    ric_lanes even = {0}, odd = {0};
    for (int i = 0; i < j + RIC_LANES; i += 2) {
      even += e[i] * *(const ric_lanes *)(e + j - i);
      odd += e[i + 1] * *(const ric_lanes *)(e + j - i - 1);
    }
    *(ric_lanes *)(out + j) = even + odd;
  }
}

/* 2 a e + 3 b e^2. */
RIC_VECTORISED static void stiffen_springs(const lattice_variation *v) {
  double zeros_and_e[2 * PADDED + 2] = {0}, *e = zeros_and_e + PADDED, squares[PADDED];
  for (size_t k = 0; k < v->nonlinear; k++) {
    const varying_spring *s = &v->varying[k];
    double *stiffness = v->k + k * ((size_t)v->order + 1), twice = 2 * s->quadratic, thrice = 3 * s->cubic;
    extension(v, s, e);
    square(e, v->order, squares);
    for (int j = 0; j <= v->order; j++)
      stiffness[j] = twice * e[j] + thrice * squares[j];
  }
}

static void stiffen_press(const lattice_variation *v, const lattice_press *p, double *k) {
  double u[LATTICE_SERIES_ORDER + 1];
  for (int j = 0; j <= v->order; j++)
    u[j] = -p->side * v->q[(size_t)j * v->n + p->coordinate];
  u[0] += p->side * p->position;
  hertz_root_series(u, v->order, k);
  for (int j = 0; j <= v->order; j++)
    k[j] *= 1.5 * p->stiffness;
}

/* Lists the actions of the springs by particle: counts, partial sums, then filling from the last to the first. */
static void list_pulls(lattice_variation *v) {
  size_t *first = v->first_pull; /* zeros */
  for (size_t k = 0; k < v->count; k++) {
    if (v->varying[k].to != NO_PARTICLE)
      first[v->varying[k].to]++;
    if (v->varying[k].from != NO_PARTICLE)
      first[v->varying[k].from]++;
  }
  for (size_t i = 1; i <= v->n; i++)
    first[i] += first[i - 1];
  for (size_t k = v->count; k-- > 0;) {
    size_t to = v->varying[k].to, from = v->varying[k].from;
    if (to != NO_PARTICLE)
      v->pulls[--first[to]] = (spring_pull){k, -v->inverse_mass[to]};
    if (from != NO_PARTICLE)
      v->pulls[--first[from]] = (spring_pull){k, v->inverse_mass[from]};
  }
}

void lattice_variation_stiffen(lattice_variation *v, const lattice_contacts *acting) {
  size_t levels = (size_t)v->order + 1;
  v->count = v->nonlinear + acting->pressed_count;
  stiffen_springs(v);
  for (size_t i = 0; i < acting->pressed_count; i++) {
    v->varying[v->nonlinear + i] = (varying_spring){.from = NO_PARTICLE, .to = acting->pressed[i].coordinate};
    stiffen_press(v, &acting->pressed[i], v->k + (v->nonlinear + i) * levels);
  }
  list_pulls(v);
}

/* --- recurrence ------------------------------------------------------------------------------------------------ */

#ifdef RIC_WIDE
#define LANE     wide_lanes
#define LANES    WIDE
#define NAMED(f) f##_wide
#include "lattice_simd.inc"
#undef LANE
#undef LANES
#undef NAMED
#endif

#define LANE     ric_lanes
#define LANES    RIC_LANES
#define NAMED(f) f##_half
#include "lattice_simd.inc"
#undef LANE
#undef LANES
#undef NAMED

#define LANE     double
#define LANES    1
#define NAMED(f) f##_one
#include "lattice_simd.inc"
#undef LANE
#undef LANES
#undef NAMED

/* The columns from `first` on. The operations of a lane do not depend on the width. */
RIC_VECTORISED static void move_by_four(lattice_variation *v, const tangents *d, size_t first) {
  while (first + 1 < d->columns) {
    const size_t left = d->columns - first, count = left < RIC_LANES ? left : RIC_LANES;
    move_half(v, d, first, count);
    first += count;
  }
  for (; first < d->columns; first++)
    move_one(v, d, first, 1);
}

#ifdef RIC_WIDE
/* As many columns as fill more than half of the lanes. @returns the first remaining one */
RIC_WIDE static size_t move_by_eight(lattice_variation *v, const tangents *d, size_t first) {
  while (first + RIC_LANES < d->columns) {
    const size_t left = d->columns - first, count = left < WIDE ? left : WIDE;
    move_wide(v, d, first, count);
    first += count;
  }
  return first;
}
#endif

static void transport(lattice_variation *v, const tangents *d) {
  size_t first = 0;
#ifdef RIC_WIDE
  if (ric_has_wide())
    first = move_by_eight(v, d, first);
#endif
  move_by_four(v, d, first);
}

static void set_still(lattice_variation *v, const lattice_contacts *held, bool still) {
  for (size_t i = 0; i < held->held_count; i++)
    v->still[held->held[i]] = still;
}

void lattice_variation_transport(lattice_variation *v, const lattice_contacts *held, const tangents *d) {
  set_still(v, held, true);
  transport(v, d);
  set_still(v, held, false);
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

/* Counts the nonlinear springs, and lists them if there is a list. */
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

static bool allocate_constants(lattice_variation *v) {
  size_t n = v->n;
  double *store = v->constants = malloc(7 * n * sizeof *store);
  v->still = calloc(n, sizeof *v->still);
  v->first_pull = calloc(n + 1, sizeof *v->first_pull);
  if (!store || !v->still || !v->first_pull)
    return false;
  v->inverse_mass = number_store_take(&store, n);
  v->springs = (stencil){number_store_take(&store, n), number_store_take(&store, n), number_store_take(&store, n)};
  v->dampers = (stencil){number_store_take(&store, n), number_store_take(&store, n), number_store_take(&store, n)};
  return true;
}

/* All lane arrays are aligned to cache lines. */
static bool allocate_lanes(lattice_variation *v) {
  size_t n = v->n, levels = (size_t)v->order + 1, count = v->capacity;
  size_t rows = LEVELS * (n + 2) + 2 * n + count * (levels + 2);
  double *store = v->lanes = aligned_alloc(WIDE * sizeof *store, rows * WIDE * sizeof *store);
  if (!store)
    return false;
  v->levels = number_store_take(&store, LEVELS * (n + 2) * WIDE);
  v->sum_q = number_store_take(&store, n * WIDE);
  v->sum_u = number_store_take(&store, n * WIDE);
  v->stretch = number_store_take(&store, levels * count * WIDE);
  v->force = number_store_take(&store, count * 2 * WIDE);
  return true;
}

static bool allocate_springs(lattice_variation *v) {
  size_t levels = (size_t)v->order + 1, count = v->capacity;
  if (count == 0)
    return true;
  v->varying = malloc(count * sizeof *v->varying);
  v->pulls = malloc(2 * count * sizeof *v->pulls);
  double *store = v->series = malloc(levels * (v->n + count) * sizeof *store);
  if (!v->varying || !v->pulls || !store)
    return false;
  v->q = number_store_take(&store, levels * v->n);
  v->k = number_store_take(&store, levels * count);
  return true;
}

void lattice_variation_destroy(lattice_variation **variation) {
  if (!variation || !*variation)
    return;
  free((*variation)->constants);
  free((*variation)->lanes);
  free((*variation)->still);
  free((*variation)->first_pull);
  free((*variation)->varying);
  free((*variation)->pulls);
  free((*variation)->series);
  free(*variation);
  *variation = NULL;
}

ric_status lattice_variation_create(const ric_lattice *lattice, int order, size_t compliant,
                                    lattice_variation **variation, ric_error *error) {
  lattice_variation *v = *variation = calloc(1, sizeof *v);
  if (v) {
    v->lattice = lattice;
    v->n = lattice->particles;
    v->order = order;
    v->ring = lattice->ends == RIC_ENDS_PERIODIC && v->n >= 3;
    v->compliant = compliant;
    v->capacity = list_nonlinear(lattice, v->ring, NULL) + compliant;
  }
  if (v && allocate_constants(v) && allocate_lanes(v) && allocate_springs(v)) {
    load(v);
    return RIC_OK;
  }
  lattice_variation_destroy(variation);
  return ric_fail(error, RIC_ENOMEM, "no memory for tangent vectors of %zu particles", lattice->particles);
}

/* The block of an even orbit of a chain: slopes of its saltation matrices, kernels of the free flow, the matrix. */
#include "reduced.h"

#include <math.h>
#include <stdlib.h>

#include "model/image_ring.h"
#include "numeric/constants.h"
#include "ricochet/elementary.h"

void orbit_impacts_clear(orbit_impacts *list) {
  free(list->items);
  *list = (orbit_impacts){0};
}

static ric_status reserve_impacts(orbit_impacts *list, size_t count, ric_error *error) {
  if (count > list->capacity) {
    orbit_impact *more = realloc(list->items, count * sizeof *more);
    if (!more)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", count);
    list->items = more;
    list->capacity = count;
  }
  list->count = count;
  return RIC_OK;
}

/* As ric_chain_acceleration, for one particle. */
static double acceleration(const ric_chain *chain, const double *q, size_t particle) {
  ptrdiff_t i = (ptrdiff_t)particle;
  double bend = image_ring_value(chain, q, i - 1) - 2 * q[i] + image_ring_value(chain, q, i + 1);
  return -q[i] + image_ring_gamma(chain) * bend;
}

static double largest_displacement(const ric_orbit *orbit) {
  double largest = 0;
  for (size_t i = 0; i < orbit->particles; i++)
    largest = fmax(largest, fmax(fabs(orbit->q[i]), fabs(orbit->q_half[i])));
  return largest;
}

ric_status orbit_impacts_find(orbit_impacts *list, const ric_chain *chain, const ric_pattern *pattern,
                              const ric_orbit *orbit, double grazing_tol, size_t *grazing, ric_error *error) {
  double tiny = grazing_tol * largest_displacement(orbit);
  RIC_TRY(reserve_impacts(list, orbit->impacts, error));
  *grazing = list->count;
  for (size_t r = 0; r < list->count; r++) {
    orbit_impact *k = &list->items[r];
    k->particle = ric_pattern_impact(pattern, r);
    k->at_half = ric_pattern_role(pattern, k->particle) == RIC_ROLE_HALF;
    k->impulse = orbit->impulse[r];
    if (!(fabs(k->impulse) > tiny) && *grazing == list->count)
      *grazing = r;
    k->slope = -4 * acceleration(chain, k->at_half ? orbit->q_half : orbit->q, k->particle) / k->impulse;
  }
  return RIC_OK;
}

static void flow_kernels_clear(flow_kernels *f) {
  flow_kernel *kernels[] = {&f->full, &f->half};
  for (size_t i = 0; i < 2; i++) {
    lattice_transform_free(kernels[i]->cosine);
    lattice_transform_free(kernels[i]->sine);
    lattice_transform_free(kernels[i]->fall);
  }
  lattice_transform_destroy(&f->transform);
  *f = (flow_kernels){0};
}

static int alloc_kernel(flow_kernel *k, const lattice_transform *t) {
  k->cosine = lattice_transform_alloc(t);
  k->sine = lattice_transform_alloc(t);
  k->fall = lattice_transform_alloc(t);
  return k->cosine && k->sine && k->fall;
}

static ric_status prepare_kernels(flow_kernels *f, const ric_chain *chain, ric_error *error) {
  if (f->transform && f->shape.particles == chain->particles && f->shape.ends == chain->ends)
    return RIC_OK;
  flow_kernels_clear(f);
  RIC_TRY(lattice_transform_create(chain, &f->transform, error));
  f->shape = *chain;
  if (alloc_kernel(&f->full, f->transform) && alloc_kernel(&f->half, f->transform))
    return RIC_OK;
  flow_kernels_clear(f);
  return ric_fail(error, RIC_ENOMEM, "no memory for the flow of %zu particles", chain->particles);
}

static void compute(flow_kernel *k, const lattice_transform *t, const ric_chain *chain, double time) {
  size_t sites = image_ring_sites(chain);
  double gamma = image_ring_gamma(chain);
  for (size_t j = 0; j <= sites / 2; j++) {
    double omega = ric_dispersion(gamma, 2 * pi * (double)j / (double)sites);
    ric_sincos(omega * time, &k->sine[j], &k->cosine[j]);
    k->fall[j] = -omega * k->sine[j];
    k->sine[j] /= omega;
  }
  lattice_transform_kernel(t, k->cosine);
  lattice_transform_kernel(t, k->sine);
  lattice_transform_kernel(t, k->fall);
}

/** Fills the kernels; plans are kept for chains of the same particles and ends. */
static ric_status flow_kernels_compute(flow_kernels *f, const ric_chain *chain, double period, ric_error *error) {
  RIC_TRY(prepare_kernels(f, chain, error));
  compute(&f->full, f->transform, chain, period);
  compute(&f->half, f->transform, chain, period / 2);
  return RIC_OK;
}

/** Entry of a flow: row (i, displacement or speed), column (j, displacement or speed). */
static double flow_kernel_entry(const flow_kernel *kernel, const ric_chain *chain, bool speed_row, size_t i,
                                bool speed_column, size_t j) {
  const double *block = speed_row == speed_column ? kernel->cosine : speed_row ? kernel->fall : kernel->sine;
  return image_ring_entry(chain, block, i, j);
}

void reduced_clear(reduced *r) {
  flow_kernels_clear(&r->kernels);
  even_spectrum_clear(&r->spectrum);
  free(r->rows);
  free(r->impact_of);
  *r = (reduced){0};
}

static ric_status prepare_reduced(reduced *r, size_t n, ric_error *error) {
  if (r->particles == n)
    return RIC_OK;
  reduced_clear(r);
  r->rows = malloc(2 * n * sizeof *r->rows);
  r->impact_of = malloc(n * sizeof *r->impact_of);
  ric_status status = r->rows && r->impact_of
                          ? even_spectrum_reserve(&r->spectrum, n, error)
                          : ric_fail(error, RIC_ENOMEM, "no memory for the reduced matrix of %zu particles", n);
  if (status == RIC_OK)
    r->particles = n;
  else
    reduced_clear(r);
  return status;
}

static void place_impacts(reduced *r, const orbit_impacts *impacts) {
  for (size_t i = 0; i < r->particles; i++)
    r->impact_of[i] = NULL;
  for (size_t i = 0; i < impacts->count; i++)
    if (!impacts->items[i].at_half)
      r->impact_of[impacts->items[i].particle] = &impacts->items[i];
}

/* Row i of the block of P2 K2 times a flow: a displacement, or the speed of an impacting particle after its half jump,
 * reversed. K2 on the right does not change the columns of the block. */
static double row_entry(const reduced *r, const flow_kernel *f, const ric_chain *chain, size_t i, bool speed_column,
                        size_t j) {
  const orbit_impact *k = r->impact_of[i];
  double displacement = flow_kernel_entry(f, chain, false, i, speed_column, j);
  if (!k)
    return displacement;
  return k->slope / 2 * displacement - flow_kernel_entry(f, chain, true, i, speed_column, j);
}

static void free_flow(reduced *r, const ric_chain *chain) {
  for (size_t i = 0; i < r->particles; i++)
    for (size_t j = 0; j < r->particles; j++)
      r->spectrum.block->data[i * r->spectrum.block->tda + j] =
          row_entry(r, &r->kernels.full, chain, i, r->impact_of[j] != NULL, j);
}

/* An impact at T/2 adds F (S - 1) F, of rank two: S - 1 = -2 on (q_k, v_k), and s from q_k to v_k. */
static void add_impact(reduced *r, const ric_chain *chain, const orbit_impact *k) {
  size_t n = r->particles;
  const flow_kernel *half = &r->kernels.half;
  double *to_displacement = r->rows, *to_speed = r->rows + n;
  for (size_t j = 0; j < n; j++) {
    bool speed = r->impact_of[j] != NULL;
    double q = flow_kernel_entry(half, chain, false, k->particle, speed, j);
    to_displacement[j] = -2 * q;
    to_speed[j] = k->slope * q - 2 * flow_kernel_entry(half, chain, true, k->particle, speed, j);
  }
  for (size_t i = 0; i < n; i++) {
    double from_displacement = row_entry(r, half, chain, i, false, k->particle);
    double from_speed = row_entry(r, half, chain, i, true, k->particle);
    double *row = r->spectrum.block->data + i * r->spectrum.block->tda;
    for (size_t j = 0; j < n; j++)
      row[j] += from_displacement * to_displacement[j] + from_speed * to_speed[j];
  }
}

/* l: the symplectic product with the velocity of the orbit in the middle of its impacts at t = 0. */
static void energy_gradient(reduced *r, const ric_chain *chain, const ric_orbit *orbit) {
  ric_chain_acceleration(chain, orbit->q, r->rows);
  for (size_t i = 0; i < r->particles; i++)
    r->spectrum.left->data[i * r->spectrum.left->stride] = r->impact_of[i] ? orbit->v[i] : -r->rows[i];
}

ric_status reduced_compute(reduced *r, const ric_chain *chain, const orbit_impacts *impacts, const ric_orbit *orbit,
                           ric_error *error) {
  RIC_TRY(prepare_reduced(r, chain->particles, error));
  RIC_TRY(flow_kernels_compute(&r->kernels, chain, orbit->period, error));
  place_impacts(r, impacts);
  free_flow(r, chain);
  for (size_t i = 0; i < impacts->count; i++)
    if (impacts->items[i].at_half)
      add_impact(r, chain, &impacts->items[i]);
  energy_gradient(r, chain, orbit);
  return even_spectrum_find(&r->spectrum, true, error);
}

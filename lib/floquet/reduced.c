#include "reduced.h"

#include <stdlib.h>

void reduced_clear(reduced *r) {
  flow_kernels_clear(&r->kernels);
  even_spectrum_clear(&r->spectrum);
  free(r->rows);
  free(r->kick_of);
  *r = (reduced){0};
}

static ric_status prepare(reduced *r, size_t n, ric_error *error) {
  if (r->particles == n)
    return RIC_OK;
  reduced_clear(r);
  r->rows = malloc(2 * n * sizeof *r->rows);
  r->kick_of = malloc(n * sizeof *r->kick_of);
  ric_status status = r->rows && r->kick_of
                          ? even_spectrum_reserve(&r->spectrum, n, error)
                          : ric_fail(error, RIC_ENOMEM, "no memory for the reduced matrix of %zu particles", n);
  if (status == RIC_OK)
    r->particles = n;
  else
    reduced_clear(r);
  return status;
}

static void find_kicks(reduced *r, const kick_list *kicks) {
  for (size_t i = 0; i < r->particles; i++)
    r->kick_of[i] = NULL;
  for (size_t i = 0; i < kicks->count; i++)
    if (!kicks->kicks[i].at_half)
      r->kick_of[kicks->kicks[i].particle] = &kicks->kicks[i];
}

/* Row i of the block of P2 K2 times a flow: a displacement, or the speed of an impacting particle after its half kick,
 * reversed. K2 on the right leaves the columns of the block alone. */
static double row_entry(const reduced *r, const flow_kernel *f, const ric_chain *chain, size_t i, bool speed_column,
                        size_t j) {
  const kick *k = r->kick_of[i];
  double displacement = flow_kernel_entry(f, chain, false, i, speed_column, j);
  if (!k)
    return displacement;
  return k->slope / 2 * displacement - flow_kernel_entry(f, chain, true, i, speed_column, j);
}

static void free_flow(reduced *r, const ric_chain *chain) {
  for (size_t i = 0; i < r->particles; i++)
    for (size_t j = 0; j < r->particles; j++)
      r->spectrum.block->data[i * r->spectrum.block->tda + j] =
          row_entry(r, &r->kernels.full, chain, i, r->kick_of[j] != NULL, j);
}

/* An impact at T/2 adds F (S - 1) F, of rank two: S - 1 = -2 on (q_k, v_k), and s from q_k to v_k. */
static void add_impact(reduced *r, const ric_chain *chain, const kick *k) {
  size_t n = r->particles;
  const flow_kernel *half = &r->kernels.half;
  double *to_displacement = r->rows, *to_speed = r->rows + n;
  for (size_t j = 0; j < n; j++) {
    bool speed = r->kick_of[j] != NULL;
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
    r->spectrum.left->data[i * r->spectrum.left->stride] = r->kick_of[i] ? orbit->v[i] : -r->rows[i];
}

ric_status reduced_compute(reduced *r, const ric_chain *chain, const kick_list *kicks, const ric_orbit *orbit,
                           ric_error *error) {
  RIC_TRY(prepare(r, chain->particles, error));
  RIC_TRY(flow_kernels_compute(&r->kernels, chain, orbit->period, error));
  find_kicks(r, kicks);
  free_flow(r, chain);
  for (size_t i = 0; i < kicks->count; i++)
    if (kicks->kicks[i].at_half)
      add_impact(r, chain, &kicks->kicks[i]);
  energy_gradient(r, chain, orbit);
  return even_spectrum_find(&r->spectrum, true, error);
}

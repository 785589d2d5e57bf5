#include "flow_kernels.h"

#include <math.h>

#include "model/image_ring.h"
#include "numeric/constants.h"

void flow_kernels_clear(flow_kernels *f) {
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

static ric_status prepare(flow_kernels *f, const ric_chain *chain, ric_error *error) {
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
    k->cosine[j] = cos(omega * time);
    k->sine[j] = sin(omega * time) / omega;
    k->fall[j] = -omega * sin(omega * time);
  }
  lattice_transform_kernel(t, k->cosine);
  lattice_transform_kernel(t, k->sine);
  lattice_transform_kernel(t, k->fall);
}

ric_status flow_kernels_compute(flow_kernels *f, const ric_chain *chain, double period, ric_error *error) {
  RIC_TRY(prepare(f, chain, error));
  compute(&f->full, f->transform, chain, period);
  compute(&f->half, f->transform, chain, period / 2);
  return RIC_OK;
}

double flow_kernel_entry(const flow_kernel *kernel, const ric_chain *chain, bool speed_row, size_t i, bool speed_column,
                         size_t j) {
  const double *block = speed_row == speed_column ? kernel->cosine : speed_row ? kernel->fall : kernel->sine;
  return image_ring_entry(chain, block, i, j);
}

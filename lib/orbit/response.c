#include "response.h"

#include <math.h>
#include <string.h>

#include "model/image_ring.h"
#include "numeric/constants.h"

/* Waves with n |sin d| below it are set apart. What they leave in the contact matrix, 2 / n times 1 / (2 omega |sin
 * d|), is then of order one, so that no digits cancel there unless the matrix is singular. */
static const double closeness = 0.5;

/* Wave numbers [first, last] that belong to modes: the odd part of the image ring has no constant and no alternating
 * mode, the even part no alternating one. */
static size_t first_wave(const ric_chain *chain) {
  return chain->ends == RIC_ENDS_FIXED ? 1 : 0;
}
static size_t last_wave(const ric_chain *chain) {
  return chain->ends == RIC_ENDS_PERIODIC ? chain->particles / 2
                                          : chain->particles - (chain->ends == RIC_ENDS_FREE ? 1 : 0);
}

static void tabulate(response *r, const ric_chain *chain) {
  size_t sites = image_ring_sites(chain);
  for (size_t j = 0; j <= sites / 2; j++) {
    double s = sin(pi * (double)j / (double)sites);
    r->sine2[j] = 4 * s * s;
  }
}

ric_status response_prepare(response *r, const ric_chain *chain, ric_error *error) {
  if (r->transform && r->shape.particles == chain->particles && r->shape.ends == chain->ends)
    return RIC_OK;
  response_clear(r);
  double **arrays[] = {&r->sine2,       &r->start,       &r->half,      &r->start_kernel,
                       &r->half_kernel, &r->modal_start, &r->modal_half};
  RIC_TRY(lattice_transform_create(chain, &r->transform, error));
  r->shape = *chain;
  int complete = 1;
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
    complete = complete && (*arrays[i] = lattice_transform_alloc(r->transform));
  if (!complete) {
    response_clear(r);
    return ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu particles", chain->particles);
  }
  tabulate(r, chain);
  return RIC_OK;
}

void response_clear(response *r) {
  lattice_transform_free(r->sine2);
  lattice_transform_free(r->start);
  lattice_transform_free(r->half);
  lattice_transform_free(r->start_kernel);
  lattice_transform_free(r->half_kernel);
  lattice_transform_free(r->modal_start);
  lattice_transform_free(r->modal_half);
  lattice_transform_destroy(&r->transform);
  *r = (response){0};
}

size_t response_modes(const ric_chain *chain, size_t wave, size_t modes[2]) {
  modes[0] = chain->ends == RIC_ENDS_FIXED ? wave - 1 : wave;
  modes[1] = chain->particles - wave;
  return chain->ends == RIC_ENDS_PERIODIC && wave > 0 && 2 * wave < chain->particles ? 2 : 1;
}

/* Keeps the waves closest to resonance. */
static void remember(response *r, near_wave wave) {
  if (r->near_count < RESPONSE_NEAR) {
    r->near[r->near_count++] = wave;
    return;
  }
  size_t farthest = 0;
  r->near_dropped++;
  for (size_t i = 1; i < RESPONSE_NEAR; i++)
    if (fabs(r->near[i].distance) > fabs(r->near[farthest].distance))
      farthest = i;
  if (fabs(wave.distance) < fabs(r->near[farthest].distance))
    r->near[farthest] = wave;
}

/* Takes the near waves out of the response; what remains of them is bounded. */
static void set_apart(response *r) {
  for (size_t i = 0; i < r->near_count; i++) {
    const near_wave *w = &r->near[i];
    r->start[w->wave] = -tan(w->distance / 2) / (2 * w->omega);
    r->half[w->wave] = 0;
  }
}

void response_compute(response *r, const ric_chain *chain, double period, int apart) {
  double gamma = image_ring_gamma(chain), n = (double)chain->particles, near = apart ? closeness / n : 0;
  size_t pair[2];
  r->near_count = r->near_dropped = 0;
  r->scale = 0;
  for (size_t j = 0; j <= image_ring_sites(chain) / 2; j++)
    r->start[j] = r->half[j] = 0;
  for (size_t j = first_wave(chain); j <= last_wave(chain); j++) {
    double omega = sqrt(1 + gamma * r->sine2[j]); /* (12) */
    double x = omega * period / 2, l = nearbyint(x / pi), d = x - pi * l;
    double s = sin(d), sign = fmod(l, 2) == 0 ? 1 : -1;
    r->half[j] = sign / (2 * omega * s);
    r->start[j] = cos(d) / (2 * omega * s);
    int close = l >= 1 && fabs(s) < near;
    if (close)
      remember(r, (near_wave){.wave = j, .harmonic = (unsigned)l, .omega = omega, .distance = d});
    double largest = close ? 1 / (2 * omega) : fabs(r->half[j]);
    r->scale += largest * (double)response_modes(chain, j, pair) / n;
  }
  set_apart(r);
}

void response_kernels(response *r, int with_half) {
  size_t bytes = lattice_transform_length(r->transform) * sizeof *r->start;
  memcpy(r->start_kernel, r->start, bytes);
  lattice_transform_kernel(r->transform, r->start_kernel);
  if (!with_half)
    return;
  memcpy(r->half_kernel, r->half, bytes);
  lattice_transform_kernel(r->transform, r->half_kernel);
}

/* The ring with images, and the modal transform of a chain on it. Internal to the library. */
#ifndef RICOCHET_IMAGE_RING_H
#define RICOCHET_IMAGE_RING_H

#include <stddef.h>

#include "ricochet/chain.h"

/* The ring with images of which every chain is a piece (chain.h).
 *
 * periodic: the chain itself. fixed: N = 2 (n + 1), odd about -1 and n. free: N = 2 n, even about -1/2 and n - 1/2.
 * A function of the stiffness matrix has the entries f(K)_kl = R(k - l) (periodic), R(k - l) - R(k + l + 2) (fixed),
 * R(k - l) + R(k + l + 1) (free), with R(d) = (1/N) sum_j f(p_j) cos(p_j d), p_j = 2 pi j / N. */

/** Sites N of the image ring. */
size_t image_ring_sites(const ric_chain *chain);

/** Coupling on the image ring: that of the chain, halved for the ring of two, whose one spring stands for two. */
double image_ring_gamma(const ric_chain *chain);

/** Value at ring position -N < i < 2 N of a function x [n] on the chain, continued by its images. */
double image_ring_value(const ric_chain *chain, const double *x, ptrdiff_t i);

/** Entry f(K)_kl from the kernel R [N / 2 + 1]. */
double image_ring_entry(const ric_chain *chain, const double *kernel, size_t k, size_t l);

/* Modal transform of a chain by FFTW.
 *
 * forward maps a function on the chain to its (unnormalised) modal coefficients, inverse maps them back with the factor
 * N, the number of sites of the image ring (image_ring.h). Coefficient s belongs to the wave number 2 pi j / N with j =
 * lattice_transform_wave(s). Plans are made without timing, so that equal problems run equal code. */

typedef struct lattice_transform lattice_transform;

/** For chains with these particles and ends; O(n log n) for any n. */
ric_status lattice_transform_create(const ric_chain *chain, lattice_transform **out, ric_error *error);
void lattice_transform_destroy(lattice_transform **t);

/** Bytes that FFTW takes at most for transforms of a length: plans, and buffers while it works; 0 of short ones. */
size_t lattice_transform_bytes(size_t length);

/** Both work on arrays [n] from lattice_transform_alloc, in place. */
void lattice_transform_forward(const lattice_transform *t, double *x);
void lattice_transform_inverse(const lattice_transform *t, double *x);

/** Kernel R [N/2 + 1] of a function of the stiffness matrix from its values f [N/2 + 1] at the wave numbers; in place,
 *  on an array from lattice_transform_alloc. Overwrites up to N values of it. */
void lattice_transform_kernel(const lattice_transform *t, double *f);

/** Coefficient s of the forward transform of mode s of unit length (ric_chain_mode_shape). */
double lattice_transform_unit(const ric_chain *chain, size_t s);

/** Length of the arrays: room for a function on the chain and for a kernel. */
size_t lattice_transform_length(const lattice_transform *t);

/** Aligned array of that length, zeroed; NULL when out of memory. */
double *lattice_transform_alloc(const lattice_transform *t);
void lattice_transform_free(double *x);

/** Index j of the wave number 2 pi j / N of coefficient s. */
static inline size_t lattice_transform_wave(const ric_chain *chain, size_t s) {
  size_t n = chain->particles;
  switch (chain->ends) {
  case RIC_ENDS_FIXED:
    return s + 1;
  case RIC_ENDS_FREE:
    return s;
  case RIC_ENDS_PERIODIC:
    break;
  }
  return 2 * s <= n ? s : n - s;
}

#endif

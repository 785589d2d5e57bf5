/* The ring with images of which every chain is a piece (chain.h): internal to the library.
 *
 * periodic: the chain itself. fixed: N = 2 (n + 1), odd about -1 and n. free: N = 2 n, even about -1/2 and n - 1/2.
 * A function of the stiffness matrix has the entries f(K)_kl = R(k - l) (periodic), R(k - l) - R(k + l + 2) (fixed),
 * R(k - l) + R(k + l + 1) (free), with R(d) = (1/N) sum_j f(p_j) cos(p_j d), p_j = 2 pi j / N. */
#ifndef RICOCHET_IMAGE_RING_H
#define RICOCHET_IMAGE_RING_H

#include <stddef.h>

#include "ricochet/chain.h"

/** Sites N of the image ring. */
size_t image_ring_sites(const ric_chain *chain);

/** Coupling on the image ring: that of the chain, halved for the ring of two, whose one spring stands for two. */
double image_ring_gamma(const ric_chain *chain);

/** Value at ring position -N < i < 2 N of a function x [n] on the chain, continued by its images. */
double image_ring_value(const ric_chain *chain, const double *x, ptrdiff_t i);

/** Entry f(K)_kl from the kernel R [N / 2 + 1]. */
double image_ring_entry(const ric_chain *chain, const double *kernel, size_t k, size_t l);

#endif

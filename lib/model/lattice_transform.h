/* Modal transform of a chain by FFTW: internal to the library.
 *
 * forward takes a function on the chain to its (unnormalised) modal coefficients, inverse takes them back with the
 * factor N, the number of sites of the image ring (image_ring.h). Coefficient s belongs to the wave number 2 pi j / N
 * with j = lattice_transform_wave(s). Plans are made without measuring, so that equal problems run equal code. */
#ifndef RICOCHET_LATTICE_TRANSFORM_H
#define RICOCHET_LATTICE_TRANSFORM_H

#include <stddef.h>

#include "ricochet/chain.h"

typedef struct lattice_transform lattice_transform;

/** For chains with these particles and ends; O(n log n) for any n. */
ric_status lattice_transform_create(const ric_chain *chain, lattice_transform **out, ric_error *error);
void lattice_transform_destroy(lattice_transform **t);

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

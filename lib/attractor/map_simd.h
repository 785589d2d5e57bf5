/* A block of maps beside grazing side by side in lanes: internal to the room.
 *
 * Arrays hold a number of all lanes together: [..][width], width = lanes of a vector times vectors that go together,
 * whose chains of operations hide how long one takes. Coefficients that are zero in all maps of a block are left out,
 * those of L on the diagonal never: so a number that is not finite stays, and what is left out changes the sign of
 * zeros at most, on which no other number depends. */
#ifndef RICOCHET_MAP_SIMD_H
#define RICOCHET_MAP_SIMD_H

#include <stddef.h>
#include <stdint.h>

#include "numeric/simd.h"
#include "ricochet/attractor.h"

typedef struct map_block {
  size_t size, width;
  double *numbers;    /* holds the arrays below */
  uint32_t pattern;   /* of a small map, a bit for each coefficient that one of the maps has: [size][size] of L, then
                         [size] of eta */
  double *d;          /* [width] */
  double *eta, *L;    /* [size], [size][size] */
  double *xi, *kappa; /* [size], xi with the stretch */
  double *impacts;    /* [width] counted */
  size_t vectors;     /* tangent vectors that are carried, orthogonal to one another */
  double *v, *next_v; /* [vectors][size] */
  double *weight;     /* [vectors] eta v */
  double *norm;       /* [vectors] squares of the lengths: in [1, 4), or zero */
  int64_t *power;     /* [vectors] of two, taken out of the lengths */
} map_block;

/** Room for maps. Zeroed is empty. @param vectors  most that may be carried */
ric_status map_block_init(map_block *block, size_t size, size_t width, size_t vectors, ric_error *error);
void map_block_clear(map_block *block);

/** Takes maps, not carrying vectors; the last one again where there are fewer than lanes. @param count  1 to width */
void map_block_load(map_block *block, const ric_grazing_map *const *maps, const double *d, size_t count);

/** Sets vectors on their way. @param directions  [vectors][size] orthonormal */
void map_block_carry(map_block *block, const double *directions, size_t vectors);

enum { MAP_SMALL = 4 }; /* sizes with code of their own */

/** Iterates the maps of a block.
 *  @param trace  [count + 1][size][width], of which the first state is the start; the others are set */
typedef void map_advance(map_block *block, double *trace, size_t count);

typedef struct map_kernel {
  map_advance *advance;
  size_t width;
} map_kernel;

/** @returns one without functions for a variant that this processor has not */
map_kernel map_kernel_of(ric_map_lanes lanes);

#endif

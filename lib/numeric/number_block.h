/* One block of memory for the work arrays of a model. */
#ifndef RICOCHET_NUMBER_BLOCK_H
#define RICOCHET_NUMBER_BLOCK_H

#include <stddef.h>

/** The next `count` numbers of a block of which `used` are allocated; NULL while the size of a block is being counted.
 */
static inline double *number_block_take(double *block, size_t *used, size_t count) {
  double *part = block ? block + *used : NULL;
  *used += count;
  return part;
}

/** The next `count` numbers of a store, whose pointer advances past them. */
static inline double *number_store_take(double **store, size_t count) {
  double *part = *store;
  *store += count;
  return part;
}

#endif

/* Orthonormal tangent vectors, by Gram and Schmidt's method done twice: internal to the room.
 *
 * A vector that lies in the span of those before it, to rounding, has been put out by the motion: it becomes zero, with
 * the growth -INFINITY. */
#ifndef RICOCHET_ORTHONORMAL_H
#define RICOCHET_ORTHONORMAL_H

#include <stddef.h>

#include "ricochet/status.h"

typedef struct orthonormal_work {
  size_t size, count;
  double *columns; /* [count][size] */
} orthonormal_work;

ric_status orthonormal_init(orthonormal_work *work, size_t size, size_t count, ric_error *error);
void orthonormal_clear(orthonormal_work *work);

/** Makes the columns of x [size][count] orthonormal, in their order.
 *  @param growth  [count] set to the logarithms of the diagonal of R, x = Q R */
void orthonormal_make(orthonormal_work *work, double *x, double *growth);

#endif

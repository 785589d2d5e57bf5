/* Orthonormal tangent vectors by the QR factorisation of GSL: internal to the room.
 *
 * A vector that lies in the span of those before it, to rounding, has been put out by the motion: it becomes zero, with
 * the growth -INFINITY. */
#ifndef RICOCHET_ORTHONORMAL_H
#define RICOCHET_ORTHONORMAL_H

#include <gsl/gsl_matrix.h>

#include "ricochet/status.h"

/** Zeroed is empty. */
typedef struct orthonormal_work {
  gsl_matrix *factors; /* [size][count] */
  gsl_vector *tau;     /* [count] */
  gsl_vector *column;  /* [size] */
} orthonormal_work;

/** @param count  <= size */
ric_status orthonormal_init(orthonormal_work *work, size_t size, size_t count, ric_error *error);
void orthonormal_clear(orthonormal_work *work);

/** Makes the columns of x [size][count] orthonormal, in their order.
 *  @param growth  [count] set to the logarithms of the moduli of R's diagonal, x = Q R */
void orthonormal_make(orthonormal_work *work, double *x, double *growth);

/** Sets x to orthonormal vectors with no pattern, always the same ones: vectors that lie along the axes would miss for
 *  long what grows elsewhere.
 *  @param growth  [count] overwritten */
void orthonormal_scatter(orthonormal_work *work, double *x, double *growth);

#endif

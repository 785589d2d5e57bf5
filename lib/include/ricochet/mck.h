/* Linear mechanical systems M q'' + C q' + K q = F cos(w t) + G sin(w t), of any structure.
 *
 * M is dense, symmetric and positive definite, or diagonal in sparse form; C and K are dense or sparse and need not be
 * symmetric (the energy q'^T M q' / 2 + q^T K q / 2 is meaningful if K is symmetric). */
#ifndef RICOCHET_MCK_H
#define RICOCHET_MCK_H

#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

/** A square matrix, borrowed. `values` NULL: the zero matrix. `row_start` NULL: dense, row-major [n][n]. Otherwise
 *  compressed rows: the entries of row i are values[k] in column[k], row_start[i] <= k < row_start[i + 1]. */
typedef struct ric_matrix {
  const double *values;
  const size_t *row_start; /* [n + 1] */
  const size_t *column;    /* [row_start[n]] */
} ric_matrix;

typedef struct ric_mck {
  size_t coordinates; /* n >= 1 */
  ric_matrix mass, damping, stiffness;
  double frequency;
  const double *force_cos, *force_sin; /* [n] F and G; NULL: none */
} ric_mck;

/** @returns RIC_EINVAL naming the matrix and entry: not finite, a column out of range, a mass matrix that is not
 *  symmetric, a sparse one that is not diagonal. Whether a dense one is positive definite is tested when a system is
 *  created from it. */
RIC_API ric_status ric_mck_check(const ric_mck *mck, ric_error *error);

RIC_END_DECLARATIONS

#endif

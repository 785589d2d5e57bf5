/* Random M-C-K models, whole and in every form: for tests with the library's hidden functions. */
#ifndef RICOCHET_TESTS_RANDOM_MCK_H
#define RICOCHET_TESTS_RANDOM_MCK_H

#include <ricochet/mck.h>

#include "scenario/random_source.h"

enum { RANDOM_MCK_MOST = 40 };

/** A model in the caller's storage; `model` borrows the arrays. M, C, K [n][n] are symmetric; M and K are positive
 *  definite, C is semidefinite. */
typedef struct random_mck {
  size_t n;
  double mass[RANDOM_MCK_MOST * RANDOM_MCK_MOST], damping[RANDOM_MCK_MOST * RANDOM_MCK_MOST],
      stiffness[RANDOM_MCK_MOST * RANDOM_MCK_MOST];
  double force_cos[RANDOM_MCK_MOST], force_sin[RANDOM_MCK_MOST];
  ric_mck model;
} random_mck;

/** Dense matrices; `diagonal` makes M diagonal, still in dense form. Frequencies are of order one. */
void random_mck_make(random_mck *m, size_t n, int diagonal, random_source *source);

/** Compressed rows of the non-zero entries of a dense matrix. */
typedef struct random_sparse {
  double values[RANDOM_MCK_MOST * RANDOM_MCK_MOST];
  size_t row_start[RANDOM_MCK_MOST + 1], column[RANDOM_MCK_MOST * RANDOM_MCK_MOST];
} random_sparse;
ric_matrix random_sparse_of(random_sparse *sparse, const double *dense, size_t n);

void random_state(random_source *source, size_t n, double *q, double *u);

#endif

/* Eigenvalues of the n x n block of an even orbit, and the multipliers that follow: internal to the room.
 *
 * The monodromy matrix M of an even motion is reversible, and W, the block of M on the states that time reversal leaves
 * alone, has the eigenvalues alpha = (mu + 1/mu) / 2. The gradient l of the energy is a left eigenvector, l W = l: the
 * eigenvalue 1 that every motion of a conservative system has. A reflection takes it out, and what is left has simple
 * eigenvalues where multipliers pass through 1. */
#ifndef RICOCHET_EVEN_SPECTRUM_H
#define RICOCHET_EVEN_SPECTRUM_H

#include <stdbool.h>

#include <gsl/gsl_eigen.h>

#include "ricochet/multipliers.h"

typedef struct even_spectrum {
  size_t size;                          /* n */
  gsl_matrix *block;                    /* W [n][n], the caller's to fill; used up */
  gsl_vector *left;                     /* [n] l, the same */
  gsl_vector_complex *values;           /* [n] */
  gsl_eigen_nonsymm_workspace *work[2]; /* for n and n - 1 */
  ric_complex *alpha;                   /* [count] result: all eigenvalues but the one taken out */
  size_t count;
  double largest; /* modulus of the entries of W; rounding of alpha is about 1e-15 of it */
  double defect;  /* how far l W is from l, over the largest entry of W: rounding, if the motion is an orbit */
} even_spectrum;

/** Makes room for n; nothing when there is. @returns RIC_ENOMEM */
ric_status even_spectrum_reserve(even_spectrum *e, size_t n, ric_error *error);
void even_spectrum_clear(even_spectrum *e);

/** Finds alpha from block and left. O(n^3).
 *  @param conservative  takes l out; otherwise left is not read
 *  @returns RIC_ENUMERIC when the eigenvalues do not converge */
ric_status even_spectrum_find(even_spectrum *e, bool conservative, ric_error *error);

/** The multipliers of the alpha, judged. @param m  initialised for 2n */
void even_spectrum_multipliers(const even_spectrum *e, const ric_multiplier_options *options, ric_multipliers *m);

#endif

/* Multipliers of an even orbit from one n x n block: internal to the room.
 *
 * The saltation matrix of an impact is S = K P K with P = -1 on (q_k, v_k) and two half kicks K = [[1, 0], [-s/2, 1]].
 * With the free flow F over T/2, based in the middle of the impacts at t = 0, the monodromy matrix is
 *
 *   M = P2 K2 F (K1 P1 K1) F K2.
 *
 * Time reversal R = diag(1, -1) turns F and K into their inverses, so R' = P2 R turns M into its inverse, and
 * (M + M^-1) / 2 maps the states with R' x = x to themselves: displacements of the particles that do not hit at t = 0,
 * speeds of those that do. There it is the block W of M, with the eigenvalues alpha = (mu + 1/mu) / 2.
 *
 * The gradient l of the energy along the orbit is a left eigenvector, l W = l: the eigenvalue 1 that every orbit has.
 * A reflection takes it out, and what is left has simple eigenvalues where multipliers pass through 1. */
#ifndef RICOCHET_REDUCED_H
#define RICOCHET_REDUCED_H

#include "flow_kernels.h"
#include "kicks.h"
#include "ricochet/multipliers.h"

#include <gsl/gsl_eigen.h>

typedef struct reduced {
  size_t particles;
  flow_kernels kernels;
  gsl_matrix *block;          /* W [n][n] */
  gsl_vector *left;           /* [n] l */
  gsl_vector_complex *values; /* [n - 1] */
  gsl_eigen_nonsymm_workspace *work;
  double *rows;         /* [2][n] */
  const kick **kick_of; /* [n] the impact of a particle at t = 0, NULL if it has none */
  ric_complex *alpha;   /* [n - 1] result: all eigenvalues but the trivial 1 */
  double largest;       /* modulus of the entries of W; rounding of alpha is about 1e-15 of it */
  double defect;        /* how far l W is from l, over the largest entry of W: rounding, if the orbit is one */
} reduced;

void reduced_clear(reduced *r);

/** Sets alpha [n - 1] and defect; O(n^3).
 *  @returns RIC_ENOMEM, RIC_ENUMERIC when the eigenvalues do not converge */
ric_status reduced_compute(reduced *r, const ric_chain *chain, const kick_list *kicks, const ric_orbit *orbit,
                           ric_error *error);

#endif

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
 * Its eigenvalues, and what becomes of them: even_spectrum.h. */
#ifndef RICOCHET_REDUCED_H
#define RICOCHET_REDUCED_H

#include "even_spectrum.h"
#include "flow_kernels.h"
#include "kicks.h"

typedef struct reduced {
  size_t particles;
  flow_kernels kernels;
  double *rows;         /* [2][n] */
  const kick **kick_of; /* [n] the impact of a particle at t = 0, NULL if it has none */
  even_spectrum spectrum;
} reduced;

void reduced_clear(reduced *r);

/** Finds the spectrum; O(n^3).
 *  @returns RIC_ENOMEM, RIC_ENUMERIC when the eigenvalues do not converge */
ric_status reduced_compute(reduced *r, const ric_chain *chain, const kick_list *kicks, const ric_orbit *orbit,
                           ric_error *error);

#endif

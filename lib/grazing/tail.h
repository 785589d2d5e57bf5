/* The proof that all coefficients from some index on have the sign of alpha: internal.
 *
 * With lambda, the dominant multiplier, and its projector P, c_i = lambda^i (alpha + e B^i w), B = (I - P) (L / lambda)
 * (I - P), e = eta (I - P), w = (I - P) xi. In coordinates in which B contracts, |B| < 1,
 *
 *   |e B^i w| <= |e B^j| |B^j w|   for all i >= 2 j,
 *
 * with a right-hand side that only falls as j grows, in the end like the second multiplier over lambda to the power 2j.
 * Such coordinates are C^T z with C C^T = X = sum over i < N of (B^i)^T B^i / s^(2i), |B^N / s^N| <= 1/2: there |B| <=
 * s, chosen between second / lambda and 1. Whatever rounding does to X, |B| < 1 is verified. */
#ifndef RICOCHET_TAIL_H
#define RICOCHET_TAIL_H

#include "dominant.h"

typedef struct tail_proof {
  size_t n;
  double *B;        /* [n][n] */
  double *row, *w;  /* [n] e B^j and B^j w */
  double *work;     /* [n] */
  bool contracting; /* whether |B| < 1 is certain; nothing is known otherwise */
} tail_proof;

/** At j = 0. The multiplier must be real, alone and told. @returns RIC_ENOMEM, with nothing to clear */
ric_status tail_proof_init(tail_proof *tail, const balanced_map *map, const dominant_multiplier *dominant,
                           ric_error *error);
void tail_proof_clear(tail_proof *tail);

/** |e B^j| |B^j w|: no |c_i / lambda^i - alpha| is above it for i >= 2 j. Infinite unless contracting. */
double tail_proof_bound(const tail_proof *tail);

/** Goes on to j + 1. */
void tail_proof_advance(tail_proof *tail);

#endif

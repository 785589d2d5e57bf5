/* The coefficients c_i = eta L^i xi one after the other, each with what errors may have made of it: internal.
 *
 * An error of the product L x_k, x_k = L^k xi, of at most u |L| |x_k|, from rounding or from the entries of L, which
 * are not known exactly, reaches c_i through eta L^(i-1-k):
 *
 *   noise_i = u sum_{k < i} |eta L^(i-1-k)| |L| |x_k| <= u G_i s_i,   G_i = max_{j < i} |eta L^j| / r^j,
 *                                                                     s_i = r s_(i-1) + |L| |x_(i-1)|
 *
 * for any rate r > 0. Two are carried: the modulus of the dominant multiplier, for long runs, and |L|, for the first
 * terms of matrices with a multiplier near zero. The smaller bound counts.
 *
 * A component of eta or xi along the dominant eigenvectors that is zero within the tolerance is no less uncertain: in
 * the end a remnant of it outweighs all that sinks faster. So the tolerance of alpha, times |lambda|^i, is added. */
#ifndef RICOCHET_COEFFICIENTS_H
#define RICOCHET_COEFFICIENTS_H

#include "dominant.h"

typedef struct noise_bound {
  double rate; /* r */
  double sum;  /* s_i, in the units of x */
  double most; /* log2 G_i */
} noise_bound;

typedef struct coefficient_run {
  const balanced_map *map; /* borrowed */
  size_t i;
  double *x, *row; /* [n] L^i xi and eta L^i, over powers of two that keep their largest entries in [1/2, 1) */
  double *next;    /* [n] work */
  long x_exponent, row_exponent;
  double value;   /* c_i and ... */
  double terms;   /* ... the sum of the moduli of its terms, over 2^x_exponent */
  double modulus; /* |lambda| */
  double vague;   /* log2 of that of the dominant multiplier */
  noise_bound noise[2];
} coefficient_run;

/** At i = 0. @returns RIC_ENOMEM */
ric_status coefficient_run_init(coefficient_run *run, const balanced_map *map, const dominant_multiplier *dominant,
                                ric_error *error);
void coefficient_run_clear(coefficient_run *run);

/** Goes on to i + 1. */
void coefficient_run_advance(coefficient_run *run);

/** 1 or -1 when c_i is certainly positive or negative; 0 when it is below zero_tol of its terms, or in the noise. */
int coefficient_run_sign(const coefficient_run *run, double zero_tol);

/** Whether L^i xi = 0, and every coefficient from here on. */
bool coefficient_run_over(const coefficient_run *run);

/** c_i of the map that was balanced; 0 or infinite where it has no room in a number. */
double coefficient_run_value(const coefficient_run *run);

#endif

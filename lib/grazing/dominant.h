/* The dominant multiplier of the return map near grazing, in balanced coordinates, and the coefficients eta L^i xi.
 * Internal to the library. */
#ifndef RICOCHET_DOMINANT_H
#define RICOCHET_DOMINANT_H

#include "ricochet/grazing_map.h"

/* A return map in balanced coordinates.
 *
 * z = D y with a diagonal D of powers of two; then L -> D^-1 L D, eta -> eta D, xi -> D^-1 xi, each divided by a power
 * of two. There is no rounding, and the terms eta_k (L^i xi)_k of a coefficient do not change. */

typedef struct balanced_map {
  size_t n;
  double *L;        /* [n][n]; its largest entry, and those of eta and xi, in [1/2, 1) */
  double *eta, *xi; /* [n] */
  double *scale;    /* [n] D */
  double size;      /* Frobenius norm of L */
  double eta_error; /* an entry k of eta may be off by eta_error times scale[k], ... */
  double xi_error;  /* ... of xi by xi_error over scale[k] */
  long L_exponent;  /* L of the map is D L D^-1 times 2 to this */
  long c_exponent;  /* c_i of the map is eta L^i xi times 2 to this and to i times L_exponent */
  double *block;
} balanced_map;

/** The map must have been checked. @returns RIC_ENOMEM; RIC_ENUMERIC if D overflows or underflows; nothing to clear
 *  then. */
ric_status balanced_map_init(balanced_map *balanced, const ric_grazing_map *map, ric_error *error);
void balanced_map_clear(balanced_map *balanced);

/** Memory for arrays of n numbers, preceded by n x n ones, set to 0; freed by the caller.
 *  @returns NULL without memory */
double *balanced_map_room(size_t n, size_t matrices, size_t vectors);

/* The dominant multiplier of a balanced map, with its eigenvectors and the components of eta and xi along them. */

typedef struct dominant_multiplier {
  ric_complex value; /* of the balanced L, like all numbers here; of a pair the one with im > 0 */
  double modulus;
  double second; /* largest modulus of the others, without its conjugate; 0: none */
  bool real;     /* to apart_tol */
  bool alone;    /* no other has this modulus, to apart_tol, except the conjugate of a complex one */

  /* Only if it is real and alone: */
  double *right, *left;     /* [n] eigenvectors, left . right = 1 */
  double rounding;          /* relative to the modulus: size of the change of L for which they are exact */
  double accuracy;          /* of the eigenvectors: `rounding` relative to the distance from other multipliers */
  double observed, excited; /* eta right, left xi */
  double observed_tol, excited_tol; /* below which they are zero */
  double uncertain; /* uncertainty of their product if one of them has an error of zero_tol of its terms; 0 if they are
                       not resolved */
} dominant_multiplier;

/** Errors handled by GSL must be off.
 *  @returns RIC_ENOMEM, RIC_ENUMERIC if eigenvalues do not converge; nothing to clear then. */
ric_status dominant_find(dominant_multiplier *dominant, const balanced_map *map, double zero_tol, double apart_tol,
                         ric_error *error);
void dominant_clear(dominant_multiplier *dominant);

/** Whether rounding is small enough to use its eigenvectors. */
bool dominant_is_resolved(const dominant_multiplier *dominant);

/** Whether eta and xi certainly have components along its eigenvectors. */
bool dominant_is_coupled(const dominant_multiplier *dominant);

/* The coefficients c_i = eta L^i xi one after the other, each with an error bound.
 *
 * An error of the product L x_k, x_k = L^k xi, of at most u |L| |x_k|, from rounding or from errors of the entries of
 * L, propagates to c_i by eta L^(i-1-k):
 *
 *   noise_i = u sum_{k < i} |eta L^(i-1-k)| |L| |x_k| <= u G_i s_i,   G_i = max_{j < i} |eta L^j| / r^j,
 *                                                                     s_i = r s_(i-1) + |L| |x_(i-1)|
 *
 * for any rate r > 0. Two are used: the modulus of the dominant multiplier, for long runs, and |L|, for the first terms
 * of matrices with a multiplier near zero. The smaller bound counts.
 *
 * A component of eta or xi along the dominant eigenvectors that is zero within the tolerance is uncertain, too: a
 * remainder of it eventually dominates all faster decaying terms. So the tolerance of alpha times |lambda|^i is added.
 */

typedef struct noise_bound {
  double rate, log_rate; /* r, log2 r */
  double sum;            /* s_i, in the units of x */
  double most;           /* log2 G_i */
} noise_bound;

typedef struct coefficient_run {
  const balanced_map *map; /* borrowed */
  size_t i;
  double *x, *row; /* [n] L^i xi and eta L^i, divided by powers of two so that their largest entries are in [1/2, 1) */
  double *next;    /* [n] work */
  long x_exponent, row_exponent;
  double value;       /* c_i and ... */
  double terms;       /* ... the sum of the moduli of its terms, ... */
  double given;       /* ... and what errors of eta and xi make of it, over 2^x_exponent */
  double log_modulus; /* log2 |lambda| */
  double uncertain;   /* log2 of the uncertainty of the dominant multiplier's part */
  noise_bound noise[2];
} coefficient_run;

/** At i = 0. @returns RIC_ENOMEM */
ric_status coefficient_run_init(coefficient_run *run, const balanced_map *map, const dominant_multiplier *dominant,
                                ric_error *error);
void coefficient_run_clear(coefficient_run *run);

/** Advances to i + 1. */
void coefficient_run_advance(coefficient_run *run);

/** 1 or -1 if c_i is certainly positive or negative; 0 if it is below zero_tol of its terms, or below the noise. */
int coefficient_run_sign(const coefficient_run *run, double zero_tol);

/** Whether L^i xi = 0, and thus every further coefficient. */
bool coefficient_run_over(const coefficient_run *run);

/** c_i of the original map; 0 or infinite if it underflows or overflows. */
double coefficient_run_value(const coefficient_run *run);

#endif

/* The dominant multiplier of the map beside grazing, in balanced coordinates, and the coefficients eta L^i xi. Internal
 * to the library. */
#ifndef RICOCHET_DOMINANT_H
#define RICOCHET_DOMINANT_H

#include "ricochet/grazing_map.h"

/* A grazing map in coordinates in which its numbers are of one size.
 *
 * z = D y with a diagonal D of powers of two; then L -> D^-1 L D, eta -> eta D, xi -> D^-1 xi, each divided by a power
 * of two. Nothing is rounded, and the terms eta_k (L^i xi)_k of a coefficient stay what they are. */

typedef struct balanced_map {
  size_t n;
  double *L;        /* [n][n]; its largest entry, and those of eta and xi, in [1/2, 1) */
  double *eta, *xi; /* [n] */
  double *scale;    /* [n] D */
  double size;      /* Frobenius norm of L */
  long L_exponent;  /* L of the map is D L D^-1 times 2 to this */
  long c_exponent;  /* c_i of the map is eta L^i xi times 2 to this and to i times L_exponent */
  double *block;
} balanced_map;

/** The map must have been checked. @returns RIC_ENOMEM; RIC_ENUMERIC when D has no room in a number; nothing to clear
 *  then. */
ric_status balanced_map_init(balanced_map *balanced, const ric_grazing_map *map, ric_error *error);
void balanced_map_clear(balanced_map *balanced);

/** Room for arrays of n numbers, and n x n ones before them, set to 0; freed by the caller.
 *  @returns NULL when there is none */
double *balanced_map_room(size_t n, size_t matrices, size_t vectors);

/* The dominant multiplier of a balanced map, with its eigenvectors and what eta and xi see of them. */

typedef struct dominant_multiplier {
  ric_complex value; /* of the balanced L, as are all numbers here; of a pair the one above the axis */
  double modulus;
  double second; /* largest modulus of the others, without its conjugate; 0: none */
  bool real;     /* to apart_tol */
  bool alone;    /* no other is as large, to apart_tol, but for the conjugate of a complex one */

  /* Only where it is real and alone: */
  double *right, *left;             /* [n] eigenvectors, left . right = 1 */
  double rounding;                  /* over the modulus: size of the change of L for which they are exact */
  double accuracy;                  /* of them: what this is relative to the distance from other multipliers */
  double observed, excited;         /* eta right, left xi */
  double observed_tol, excited_tol; /* below which they are zero */
  double uncertain; /* how much of their product is not there if one of them is off by zero_tol of its terms;
                   0 where they are not told */
} dominant_multiplier;

/** Errors handled by GSL must be off.
 *  @returns RIC_ENOMEM, RIC_ENUMERIC when eigenvalues do not converge; nothing to clear then. */
ric_status dominant_find(dominant_multiplier *dominant, const balanced_map *map, double zero_tol, double apart_tol,
                         ric_error *error);
void dominant_clear(dominant_multiplier *dominant);

/** Whether rounding is small enough for what follows from its eigenvectors. */
bool dominant_is_resolved(const dominant_multiplier *dominant);

/** Whether eta and xi certainly see its eigenvectors. */
bool dominant_is_coupled(const dominant_multiplier *dominant);

/* The coefficients c_i = eta L^i xi one after the other, each with what errors may have made of it.
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
  double value;     /* c_i and ... */
  double terms;     /* ... the sum of the moduli of its terms, over 2^x_exponent */
  double modulus;   /* |lambda| */
  double uncertain; /* log2 of that of the dominant multiplier */
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

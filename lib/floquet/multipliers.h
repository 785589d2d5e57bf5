/* Multipliers of a matrix, by GSL, and of an even motion, by its block; the verdict. Internal to the library.
 */
#ifndef RICOCHET_INTERNAL_MULTIPLIERS_H
#define RICOCHET_INTERNAL_MULTIPLIERS_H

#include <stdbool.h>

#include <gsl/gsl_eigen.h>

#include "ricochet/multipliers.h"

/* Stability from multipliers: the only place where it is decided. */

/** Sorts mu [count] and sets all results, with all multipliers known (count = dimension).
 *  @param trivial  number of trivial multipliers, the nearest to 1 */
void multipliers_judge(ric_multipliers *multipliers, size_t trivial, const ric_multiplier_options *options);

/** The same if mu [count] holds only those outside the unit circle and no trivial ones.
 *  @param unlocated  number of the others not known to lie in the closed unit disc
 *  @param near_one  number of the others within band_at_one of 1 */
void multipliers_judge_outside(ric_multipliers *multipliers, size_t unlocated, size_t near_one,
                               const ric_multiplier_options *options);

/** Sorts mu [count] in the order of the public header. */
void multipliers_sort(ric_multipliers *multipliers);

/** @returns RIC_EINVAL for tolerances that are not 0 <= multiplier_tol <= band < 1, 0 <= band_at_one < 1. */
ric_status multiplier_options_check(const ric_multiplier_options *options, ric_error *error);

/* Workspace for the eigenvalues of a matrix; computing them again allocates nothing. */

typedef struct multiplier_work {
  gsl_matrix *copy;           /* [n][n] */
  gsl_vector_complex *values; /* [n] */
  gsl_eigen_nonsymm_workspace *eigen;
} multiplier_work;

/** Errors handled by GSL must be off. @returns RIC_ENOMEM, with nothing to clear */
ric_status multiplier_work_init(multiplier_work *work, size_t n, ric_error *error);
void multiplier_work_clear(multiplier_work *work);

/** As ric_multipliers_of_matrix, for dimension n and options that have been checked. Errors of GSL as above. */
ric_status multiplier_work_find(multiplier_work *work, const double *M, size_t trivial,
                                const ric_multiplier_options *options, ric_multipliers *multipliers, ric_error *error);

/* Eigenvalues of the n x n block of an even orbit, and the multipliers that follow.
 *
 * The monodromy matrix M of an even motion is reversible, and W, the block of M on the states that time reversal leaves
 * unchanged, has the eigenvalues alpha = (mu + 1/mu) / 2. The gradient l of the energy is a left eigenvector, l W = l,
 * with the eigenvalue 1 of every motion of a conservative system. A reflection deflates it, and the remaining matrix
 * has simple eigenvalues where multipliers pass through 1. */

typedef struct even_spectrum {
  size_t size;                          /* n */
  gsl_matrix *block;                    /* W [n][n], filled by the caller; overwritten */
  gsl_vector *left;                     /* [n] l, the same */
  gsl_vector_complex *values;           /* [n] */
  gsl_eigen_nonsymm_workspace *work[2]; /* for n and n - 1 */
  ric_complex *alpha;                   /* [count] result: all eigenvalues except the deflated one */
  size_t count;
  double largest; /* modulus of the entries of W; rounding of alpha is about 1e-15 of it */
  double defect;  /* deviation of l W from l, relative to the largest entry of W: rounding if the motion is an orbit */
} even_spectrum;

/** Makes room for n if there is none. @returns RIC_ENOMEM */
ric_status even_spectrum_reserve(even_spectrum *e, size_t n, ric_error *error);
void even_spectrum_clear(even_spectrum *e);

/** Finds alpha from block and left. O(n^3).
 *  @param conservative  deflates l; otherwise left is not read
 *  @returns RIC_ENUMERIC if the eigenvalues do not converge */
ric_status even_spectrum_find(even_spectrum *e, bool conservative, ric_error *error);

/** The multipliers of the alpha, with the verdict. @param m  initialised for 2n */
void even_spectrum_multipliers(const even_spectrum *e, const ric_multiplier_options *options, ric_multipliers *m);

#endif

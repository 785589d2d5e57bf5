/* Multipliers of a matrix, by GSL, and of an even motion, by its block; the verdict of both. Internal to the library.
 */
#ifndef RICOCHET_INTERNAL_MULTIPLIERS_H
#define RICOCHET_INTERNAL_MULTIPLIERS_H

#include <stdbool.h>

#include <gsl/gsl_eigen.h>

#include "ricochet/multipliers.h"

/* What multipliers say about stability: the one place where it is decided. */

/** Sorts mu [count] and sets everything that follows from it, with all multipliers known (count = dimension).
 *  @param trivial  the nearest so many to 1 are 1 for any motion */
void multipliers_judge(ric_multipliers *multipliers, size_t trivial, const ric_multiplier_options *options);

/** The same when mu [count] holds only those outside the circle, and none that is 1 for any motion.
 *  @param untold  how many of the others are not known to lie on the circle or in it
 *  @param near_one  how many of the others lie within band_at_one of 1 */
void multipliers_judge_outside(ric_multipliers *multipliers, size_t unlocated, size_t near_one,
                               const ric_multiplier_options *options);

/** Sorts mu [count] as the public header says. */
void multipliers_sort(ric_multipliers *multipliers);

/** @returns RIC_EINVAL for tolerances that are not 0 <= multiplier_tol <= band < 1, 0 <= band_at_one < 1. */
ric_status multiplier_options_check(const ric_multiplier_options *options, ric_error *error);

/* Room for the eigenvalues of a matrix, so that finding them again allocates nothing. */

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
 * alone, has the eigenvalues alpha = (mu + 1/mu) / 2. The gradient l of the energy is a left eigenvector, l W = l: the
 * eigenvalue 1 that every motion of a conservative system has. A reflection takes it out, and what is left has simple
 * eigenvalues where multipliers pass through 1. */

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

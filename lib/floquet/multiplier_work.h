/* Room for the eigenvalues of a matrix, so that finding them again allocates nothing: internal to the room. */
#ifndef RICOCHET_MULTIPLIER_WORK_H
#define RICOCHET_MULTIPLIER_WORK_H

#include <gsl/gsl_eigen.h>

#include "ricochet/multipliers.h"

typedef struct multiplier_work {
  gsl_matrix *copy;           /* [n][n] */
  gsl_vector_complex *values; /* [n] */
  gsl_eigen_nonsymm_workspace *eigen;
} multiplier_work;

/** Errors handled by GSL must be off. @returns RIC_ENOMEM, with nothing to clear */
ric_status multiplier_work_init(multiplier_work *work, size_t n, ric_error *error);
void multiplier_work_clear(multiplier_work *work);

/** @returns RIC_EINVAL as ric_multipliers_of_matrix. */
ric_status multiplier_matrix_check(const double *M, size_t dimension, size_t trivial,
                                   const ric_multipliers *multipliers, ric_error *error);

/** As ric_multipliers_of_matrix, for dimension n and options that have been checked. Errors of GSL as above. */
ric_status multiplier_work_find(multiplier_work *work, const double *M, size_t trivial,
                                const ric_multiplier_options *options, ric_multipliers *multipliers, ric_error *error);

#endif

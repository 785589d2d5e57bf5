/* One-impact orbits of one period n as functions of y = sqrt(d - eta z): quantities independent of y, and functions of
 * y. Internal to the room. The error handler of GSL must be off.
 *
 * The iterate j after the impact is (I - L^n)^-1 L^(j-1) (y s xi + y^2 kappa), the impact itself that of j = n. */
#ifndef RICOCHET_ONE_IMPACT_H
#define RICOCHET_ONE_IMPACT_H

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_permutation.h>
#include <gsl/gsl_vector.h>

#include "ricochet/grazing_map.h"

typedef struct one_impact {
  const ric_grazing_map *map; /* borrowed */
  size_t period;              /* n */
  double *first, *second;     /* [n] at j - 1: eta z_j = y first + y^2 second */
  gsl_vector *xi, *kappa;     /* L^(n-1) times those of the map */
  gsl_matrix *power;          /* L^n */
  gsl_matrix *factors;        /* Q R of I - L^n or I + L^n, with pivots */
  gsl_vector *reflectors, *norms;
  gsl_permutation *order;
  gsl_vector *vector;
  gsl_matrix *derivative; /* of the n-th iterate */
  ric_multipliers multipliers;
} one_impact;

/** @returns RIC_EINVAL for the map and the period; RIC_ENUMERIC if I - L^n is singular or not finite; RIC_ENOMEM; clear
 *  it in any case. */
ric_status one_impact_init(one_impact *orbits, const ric_grazing_map *map, size_t period, ric_error *error);
void one_impact_clear(one_impact *orbits);

/** d at which the orbit of y exists; y may be infinite. */
double one_impact_d(const one_impact *orbits, double y);

/** eta z_j - d = y (steady + slope y), j in 1 ... n-1. */
void one_impact_clearance(const one_impact *orbits, size_t j, double *steady, double *slope);

/** Multipliers of the orbit of y, into `multipliers`.
 *  @returns RIC_ENUMERIC if the derivative overflows; as ric_multipliers_of_matrix */
ric_status one_impact_multipliers(one_impact *orbits, double y, ric_error *error);

/** Solves (I + sign L^n) x = b, transposed or not, in place of b; `factors` and `order` are overwritten.
 *  @returns RIC_ENUMERIC for a singular matrix, or one that is not finite */
ric_status one_impact_solve(one_impact *orbits, int sign, bool transposed, gsl_vector *b, ric_error *error);

#endif

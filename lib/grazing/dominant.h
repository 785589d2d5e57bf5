/* The dominant multiplier of a balanced map, with its eigenvectors and what eta and xi see of them: internal. */
#ifndef RICOCHET_DOMINANT_H
#define RICOCHET_DOMINANT_H

#include "balanced_map.h"

typedef struct dominant_multiplier {
  ric_complex value; /* of the balanced L, as are all numbers here; of a pair the one above the axis */
  double modulus;
  double second; /* largest modulus of the others, without its conjugate; 0: none */
  bool real;     /* to apart_tol */
  bool alone;    /* no other is as large, to apart_tol, but for the conjugate of a complex one */

  /* Only where it is real and alone: */
  double *right, *left;        /* [n] eigenvectors, left . right = 1 */
  double rounding;             /* over the modulus: size of the change of L for which they are exact */
  double accuracy;             /* of them: what this is relative to the distance from other multipliers */
  double seen, driven;         /* eta right, left xi */
  double seen_tol, driven_tol; /* below which they are zero */
  double vague;                /* how much of their product is not there if one of them is off by zero_tol of its terms;
                                  0 where they are not told */
} dominant_multiplier;

/** Errors handled by GSL must be off.
 *  @returns RIC_ENOMEM, RIC_ENUMERIC when eigenvalues do not converge; nothing to clear then. */
ric_status dominant_find(dominant_multiplier *dominant, const balanced_map *map, double zero_tol, double apart_tol,
                         ric_error *error);
void dominant_clear(dominant_multiplier *dominant);

/** Whether rounding is small enough for what follows from its eigenvectors. */
bool dominant_is_told(const dominant_multiplier *dominant);

/** Whether eta and xi certainly see its eigenvectors. */
bool dominant_is_coupled(const dominant_multiplier *dominant);

#endif

/* Floquet multipliers of periodic motions, and what they say about stability.
 *
 * The multipliers are the eigenvalues of the monodromy matrix M, the derivative of the state after one period by the
 * state before it, with the saltation matrices of its impacts (saltation.h). Some are 1 whatever the motion: one when
 * time can be shifted (no forcing), a second one when energy is conserved. They are recognised, and left out of the
 * verdict:
 *
 *   stable     all others lie in the unit disc: moduli below 1 + multiplier_tol
 *   unstable   one lies outside by more than the band
 *   undecided  one lies within the band beside the circle, or so close to 1 that a loss of stability there cannot be
 *              told from rounding
 *   unknown    there is no orbit, or the motion is not differentiable: the reason says why
 *
 * The band is 1e-6, and 1e-4 near 1 where two are 1 already: there, multipliers that meet split by the fourth root of
 * the rounding error. */
#ifndef RICOCHET_MULTIPLIERS_H
#define RICOCHET_MULTIPLIERS_H

#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

#define RIC_STABILITY_LIST(X)                                                                                          \
  X(RIC_STABLE, "stable")                                                                                              \
  X(RIC_UNSTABLE, "unstable")                                                                                          \
  X(RIC_UNDECIDED, "undecided")                                                                                        \
  X(RIC_STABILITY_UNKNOWN, "unknown")

typedef enum ric_stability {
#define X(name, text) name,
  RIC_STABILITY_LIST(X)
#undef X
      RIC_STABILITIES
} ric_stability;

/** Name of a verdict, "stable". Never NULL. */
RIC_API const char *ric_stability_name(ric_stability stability);

/** A multiplier, or any complex number. */
typedef struct ric_complex {
  double re, im;
} ric_complex;

/** Multipliers and verdict. Storage of the caller: ric_multipliers_init, ric_multipliers_clear. */
typedef struct ric_multipliers {
  ric_stability stable;
  char reason[160]; /* for people; "" when stable */
  size_t dimension; /* of the state: number of multipliers */
  size_t count;     /* of those known: all of them, or those outside the circle (determinant) */
  ric_complex *mu; /* [dimension], the first `count` set: by modulus, largest first, then by argument, positive first */
  double largest;  /* modulus; of a stable orbit of the determinant method 1; NaN when unknown */
  size_t outside;  /* how many lie outside by more than the band, ... */
  size_t real_above, real_below, complex_outside; /* ... real > 1, real < -1, and complex (pairs count twice) */
  double margin; /* largest modulus of those that are not 1 for any motion, minus 1; NaN when unknown or not found */
  double log_determinant; /* sum of ln |mu|, ln |det M|: that of e^2 over the impacts plus the integrated divergence;
                             NaN unless all are known */
} ric_multipliers;

/** @returns RIC_ENOMEM; RIC_EINVAL for a dimension of 0. */
RIC_API ric_status ric_multipliers_init(ric_multipliers *multipliers, size_t dimension, ric_error *error);
RIC_API void ric_multipliers_clear(ric_multipliers *multipliers);

/** Makes them `unknown` for this reason: no multiplier is known. */
RIC_API void ric_multipliers_fail(ric_multipliers *multipliers, const char *reason);

typedef struct ric_multiplier_options {
  double
      multiplier_tol; /* 1e-9: moduli within it of 1 lie on the circle; rounding of simple multipliers is far below */
  double band;        /* 1e-6: the verdict is `undecided` up to this distance from the circle */
  double band_at_one; /* 1e-4: the same for multipliers within it of 1, where two pairs that meet split by about the
                         fourth root of rounding */
} ric_multiplier_options;

RIC_API ric_multiplier_options ric_multiplier_options_default(void);

/** Multipliers of a matrix M [dimension][dimension], row-major, by GSL.
 *  @param trivial  how many are 1 for any motion: 0, 1 or 2. The nearest ones are taken for them
 *  @param options  NULL for the defaults
 *  @returns RIC_EINVAL for entries that are not finite or trivial > 2; RIC_ENUMERIC when the eigenvalues do not
 *           converge; RIC_ENOMEM. */
RIC_API ric_status ric_multipliers_of_matrix(const double *M, size_t dimension, size_t trivial,
                                             const ric_multiplier_options *options, ric_multipliers *multipliers,
                                             ric_error *error);

RIC_END_DECLARATIONS

#endif

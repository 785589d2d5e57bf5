/* Floquet multipliers of periodic motions, and the stability that follows from them.
 *
 * The multipliers are the eigenvalues of the monodromy matrix M, the derivative of the state after one period by the
 * state before it, with the saltation matrices of its impacts (saltation.h). Some are 1 for every motion (trivial
 * multipliers): one if time can be shifted (no forcing), a second one if energy is conserved. They are identified and
 * excluded from the verdict:
 *
 *   stable     all others lie in the unit disc: moduli below 1 + multiplier_tol
 *   unstable   one lies outside by more than the band
 *   undecided  one lies within the band around the unit circle, or so close to 1 that rounding hides whether stability
 *              is lost there
 *   unknown    there is no orbit, or the motion is not differentiable: the reason says why
 *
 * The band is 1e-6, and 1e-4 near 1 if two are 1 already: multipliers that collide there split by the fourth root of
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

/** Multipliers and verdict. Owned by the caller: ric_multipliers_init, ric_multipliers_clear. */
typedef struct ric_multipliers {
  ric_stability stable;
  char reason[160]; /* for people; "" when stable */
  size_t dimension; /* of the state: number of multipliers */
  size_t count;     /* number known: all of them, or those outside the unit circle (determinant method) */
  ric_complex *mu; /* [dimension], the first `count` set: by modulus, largest first, then by argument, positive first */
  double largest;  /* largest modulus; 1 for a stable orbit of the determinant method; NaN if unknown */
  size_t outside;  /* number outside the unit circle by more than the band, ... */
  size_t real_above, real_below, complex_outside; /* ... real > 1, real < -1, and complex (pairs count twice) */
  double margin;          /* largest modulus of the non-trivial ones minus 1; NaN if unknown or not found */
  double log_determinant; /* sum of ln |mu| = ln |det M|: sum of ln e^2 over the impacts plus the integrated divergence;
                             NaN unless all are known */
} ric_multipliers;

/** @returns RIC_ENOMEM; RIC_EINVAL for a dimension of 0. */
RIC_API ric_status ric_multipliers_init(ric_multipliers *multipliers, size_t dimension, ric_error *error);
RIC_API void ric_multipliers_clear(ric_multipliers *multipliers);

/** Sets the verdict `unknown` with this reason; no multiplier is known. */
RIC_API void ric_multipliers_fail(ric_multipliers *multipliers, const char *reason);

typedef struct ric_multiplier_options {
  double multiplier_tol; /* 1e-9: moduli within it of 1 lie on the unit circle; rounding of simple multipliers is far
                            smaller */
  double band;           /* 1e-6: the verdict is `undecided` up to this distance from the circle */
  double band_at_one;    /* 1e-4: the same for multipliers within this distance of 1, where two colliding pairs split by
                            about the fourth root of rounding */
} ric_multiplier_options;

RIC_API ric_multiplier_options ric_multiplier_options_default(void);

/** Multipliers of a matrix M [dimension][dimension], row-major, by GSL.
 *  @param trivial  number of trivial multipliers 1: 0, 1 or 2. The nearest to 1 are taken as trivial
 *  @param options  NULL for the defaults
 *  @returns RIC_EINVAL for entries that are not finite or trivial > 2; RIC_ENUMERIC if the eigenvalues do not converge;
 *           RIC_ENOMEM. */
RIC_API ric_status ric_multipliers_of_matrix(const double *M, size_t dimension, size_t trivial,
                                             const ric_multiplier_options *options, ric_multipliers *multipliers,
                                             ric_error *error);

RIC_END_DECLARATIONS

#endif

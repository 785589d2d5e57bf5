/* What follows a grazing bifurcation: the criterion of [FN97], (5.10), and the regimes beyond a continuous one.
 *
 * After an impact of low speed the state lies at y s xi, where y is the square root of the penetration, and returns
 * as y s L^i xi. The grazing motion is stable, and the bifurcation continuous, when
 *
 *   c_i = eta L^i xi > 0 for i = 0, 1, 2, ...                                                                   (5.10)
 *
 * A negative c_i sends the state into the obstacle again: the square root is taken of a square root, and the motion
 * departs along L^i xi with the first such i. The bifurcation is `discontinuous`. `undecided` names the condition
 * that fails: a c_i that is zero (higher orders then decide); an unstable motion; a dominant multiplier that is
 * complex, negative or not simple; or an eigenvector of it to which eta or xi is orthogonal.
 *
 * Finitely many signs decide infinitely many. Let lambda be the dominant multiplier, real, positive and simple, P its
 * projector and eta P xi = alpha. Then
 *
 *   c_i = lambda^i (alpha + eta B^i xi'),   B = (I - P) L / lambda,   xi' = (I - P) xi.
 *
 * All other multipliers are smaller, so there are coordinates in which |B| < 1. In them |eta B^j| |B^j xi'| decreases
 * with j and bounds the second term for all i >= 2j: once it is below alpha, all further c_i are positive.
 *
 * Zero means zero within a tolerance, since the map has errors; a sign counts if it is certain. A c_i that is
 * certainly negative decides whatever the multipliers are, also after zeros: if the earlier ones were slightly
 * negative, they would decide before it; if slightly positive, they would change nothing.
 *
 * The signs of c_i do not depend on the section or on coordinates. If the motion leaves the section towards the
 * obstacle and returns to it afterwards, c_i counts i + 1 returns. */
#ifndef RICOCHET_GRAZING_CRITERION_H
#define RICOCHET_GRAZING_CRITERION_H

#include "grazing_map.h"

RIC_BEGIN_DECLARATIONS

#define RIC_GRAZING_VERDICT_LIST(X)                                                                                    \
  X(RIC_GRAZING_CONTINUOUS, "continuous")                                                                              \
  X(RIC_GRAZING_DISCONTINUOUS, "discontinuous")                                                                        \
  X(RIC_GRAZING_UNDECIDED, "undecided")

typedef enum ric_grazing_verdict {
#define X(name, text) name,
  RIC_GRAZING_VERDICT_LIST(X)
#undef X
      RIC_GRAZING_VERDICTS
} ric_grazing_verdict;

/** Regime beyond a continuous bifurcation, by the dominant multiplier. */
#define RIC_GRAZING_REGIME_LIST(X)                                                                                     \
  X(RIC_REGIME_NONE, "none")       /* the bifurcation is not known to be continuous */                                 \
  X(RIC_REGIME_CHAOS, "chaos")     /* lambda > 2/3 */                                                                  \
  X(RIC_REGIME_WINDOWS, "windows") /* 1/4 < lambda < 2/3: period adding, chaos between the windows */                  \
  X(RIC_REGIME_OVERLAP, "overlap") /* lambda < 1/4: windows overlap */                                                 \
  X(RIC_REGIME_BORDER, "border")   /* lambda = 1/4 or 2/3 within the tolerance */

typedef enum ric_grazing_regime {
#define X(name, text) name,
  RIC_GRAZING_REGIME_LIST(X)
#undef X
      RIC_GRAZING_REGIMES
} ric_grazing_regime;

/** Names, "continuous", "windows". Never NULL. */
RIC_API const char *ric_grazing_verdict_name(ric_grazing_verdict verdict);
RIC_API const char *ric_grazing_regime_name(ric_grazing_regime regime);

typedef struct ric_grazing_criterion_options {
  double zero_tol;  /* 1e-9, in [0, 1): a c_i below it, relative to the sum of the moduli of its terms eta_k (L^i xi)_k,
                       is zero; the same for alpha relative to the sizes of its two factors. A c_i that a change of L by
                       1e-12 of its norm makes zero is zero, too, whatever zero_tol */
  double apart_tol; /* 1e-6, in [0, 1): moduli of multipliers that differ from the largest by less, relatively, count as
                       equal to it; lambda within it of 1/4 or 2/3 is at the border of two regimes */
  size_t most;      /* 100000, >= 1: coefficients to evaluate before `undecided` */
} ric_grazing_criterion_options;

RIC_API ric_grazing_criterion_options ric_grazing_criterion_options_default(void);

typedef struct ric_grazing_criterion {
  ric_grazing_verdict verdict;
  ric_grazing_regime regime;
  char reason[200];      /* for people; "" when continuous */
  size_t first_negative; /* discontinuous: the first i with c_i < 0; SIZE_MAX */
  size_t first_zero;     /* the first i with c_i = 0 within the tolerance, of those evaluated; SIZE_MAX */
  size_t settled;        /* continuous: c_i > 0 is proved from this i on, and was checked for each i before; SIZE_MAX */
  ric_complex dominant;  /* multiplier of the largest modulus, of a pair the one with im > 0; lambda if real. Of several
                            equal moduli: the rightmost */
  double second;         /* largest modulus of the others, its conjugate excepted; 0: none */
  double alpha;          /* NaN unless the dominant multiplier is real, simple and separated from the others */
} ric_grazing_criterion;

/** The verdict for the coefficients of a map; kappa and stretch have no influence.
 *  @param options  NULL for the defaults
 *  @param coefficients  [count] c_0, c_1, ..., set for every verdict; may be NULL with count 0
 *  @param departure  [size] set to L^i xi / |L^i xi| with the first i for which c_i < 0, the direction in which the
 *                    motion departs at a discontinuous bifurcation; NaN otherwise; may be NULL
 *  @returns RIC_EINVAL as ric_grazing_map_check and for options out of range; RIC_ENUMERIC if eigenvalues or singular
 *           values do not converge, or the numbers of the map differ too much in size to be scaled; RIC_ENOMEM. */
RIC_API ric_status ric_grazing_criterion_find(const ric_grazing_map *map, const ric_grazing_criterion_options *options,
                                              ric_grazing_criterion *criterion, double *coefficients, size_t count,
                                              double *departure, ric_error *error);

/** Windows that the limit map (5.14) predicts beyond a continuous bifurcation, to leading order as d -> 0. The orbit of
 *  period n is born in a border collision at d = (alpha s)^2 (1 - lambda) lambda^(2(n-2)) and loses stability by a flip
 *  at (alpha s)^2 (3/4) lambda^(2(n-1)). The window lies between the two; there is none if border <= flip (lambda >=
 *  2/3).
 *  @param stretch  s = sqrt(2 A_g) > 0 of the map
 *  @param border, flip  set
 *  @returns RIC_EINVAL unless the verdict is continuous, n >= 2 and s is finite and positive. */
RIC_API ric_status ric_grazing_predict_window(const ric_grazing_criterion *criterion, double stretch, size_t period,
                                              double *border, double *flip, ric_error *error);

RIC_END_DECLARATIONS

#endif

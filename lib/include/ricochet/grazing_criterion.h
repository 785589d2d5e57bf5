/* What follows grazing: the criterion of [FN97], (5.10), and the regimes beyond a continuous bifurcation.
 *
 * After an impact of low speed the state lies at y s xi, y the root of the penetration; it comes back as y s L^i xi.
 * The grazing motion is stable, and the bifurcation continuous, when
 *
 *   c_i = eta L^i xi > 0 for i = 0, 1, 2, ...                                                                   (5.10)
 *
 * A c_i below zero sends the state into the obstacle again: the root is taken of a root, and the motion leaves along
 * L^i xi, with the first such i: `discontinuous`. `undecided` names the condition that fails: a c_i that is zero (then
 * higher orders decide), an unstable motion, a dominant multiplier that is complex, negative or not alone, an
 * eigenvector of it that eta or xi does not see.
 *
 * Infinitely many signs are settled by finitely many. With lambda the dominant multiplier, real, positive and simple,
 * P its projector and eta P xi = alpha,
 *
 *   c_i = lambda^i (alpha + eta B^i xi'),   B = (I - P) L / lambda,   xi' = (I - P) xi.
 *
 * All other multipliers being smaller, there are coordinates in which |B| < 1. In them |eta B^j| |B^j xi'| falls as j
 * grows, and bounds the rest for all i >= 2j: once it is below alpha, all c_i that follow are positive.
 *
 * What is zero, is so within a tolerance, since the map comes with errors; a sign counts when it is certain. A c_i that
 * is certainly negative decides whatever the multipliers are, and after zeros, too: c_i that are slightly negative
 * there would decide before it, slightly positive ones change nothing.
 *
 * Signs of c_i do not depend on the section or on coordinates. On a section that the motion leaves for the obstacle and
 * comes back to after, c_i counts i + 1 returns. */
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

/** What the dominant multiplier predicts beyond a continuous bifurcation. */
#define RIC_GRAZING_REGIME_LIST(X)                                                                                     \
  X(RIC_REGIME_NONE, "none")       /* nothing: the bifurcation is not known to be continuous */                        \
  X(RIC_REGIME_CHAOS, "chaos")     /* lambda > 2/3 */                                                                  \
  X(RIC_REGIME_WINDOWS, "windows") /* 1/4 < lambda < 2/3: windows of rising periods, chaos between them */             \
  X(RIC_REGIME_OVERLAP, "overlap") /* lambda < 1/4: windows overlap */                                                 \
  X(RIC_REGIME_BORDER, "border")   /* at 1/4 or 2/3 within the tolerance */

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
                       is zero; the same for alpha and the sizes of its two factors. So is a c_i that changes of L by
                       1e-12 of its norm make zero, whatever zero_tol */
  double apart_tol; /* 1e-6, in [0, 1): moduli of multipliers within it of the largest, relative to it, are as large;
                       lambda within it of 1/4 and 2/3 is at the border of regimes */
  size_t most;      /* 100000, >= 1: coefficients to look at before `undecided` */
} ric_grazing_criterion_options;

RIC_API ric_grazing_criterion_options ric_grazing_criterion_options_default(void);

typedef struct ric_grazing_criterion {
  ric_grazing_verdict verdict;
  ric_grazing_regime regime;
  char reason[200];      /* for people; "" when continuous */
  size_t first_negative; /* discontinuous: the first i with c_i < 0; SIZE_MAX */
  size_t first_zero;     /* the first i with c_i = 0 within the tolerance, of those looked at; SIZE_MAX */
  size_t settled;        /* continuous: from this i on the tail is proved, those before have been looked at; SIZE_MAX */
  ric_complex dominant;  /* multiplier of the largest modulus, of a pair the one above the axis; lambda when real. Where
                            several are as large: the rightmost */
  double second;         /* largest modulus of the others, but for its conjugate; 0: none */
  double alpha;          /* NaN unless the dominant multiplier is real, simple, and told from others */
} ric_grazing_criterion;

/** The verdict for the coefficients of a map; kappa and stretch do not matter.
 *  @param options  NULL for the defaults
 *  @param coefficients  [count] c_0, c_1, ..., set, whatever the verdict; may be NULL with count 0
 *  @param departure  [size] set to L^i xi over its length with i the first negative one, the direction in which a
 *                    discontinuous bifurcation departs; NaN otherwise; may be NULL
 *  @returns RIC_EINVAL as ric_grazing_map_check and for options out of range; RIC_ENUMERIC when eigenvalues or singular
 *           values do not converge, or numbers of the map are too far apart to be scaled; RIC_ENOMEM. */
RIC_API ric_status ric_grazing_criterion_find(const ric_grazing_map *map, const ric_grazing_criterion_options *options,
                                              ric_grazing_criterion *criterion, double *coefficients, size_t count,
                                              double *departure, ric_error *error);

/** Windows that the limit map (5.14) predicts beyond a continuous bifurcation, to leading order as d -> 0: period n is
 *  born at d = (alpha s)^2 (1 - lambda) lambda^(2(n-2)), its border edge, and loses stability by a flip at
 *  (alpha s)^2 (3/4) lambda^(2(n-1)). The window is what lies between, none where border <= flip (lambda >= 2/3).
 *  @param stretch  s = sqrt(2 A_g) > 0 of the map
 *  @param border, flip  set
 *  @returns RIC_EINVAL unless the verdict is continuous, n >= 2 and s is finite and positive. */
RIC_API ric_status ric_grazing_predict_window(const ric_grazing_criterion *criterion, double stretch, size_t period,
                                              double *border, double *flip, ric_error *error);

RIC_END_DECLARATIONS

#endif

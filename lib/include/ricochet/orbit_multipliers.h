/* Floquet multipliers of the orbits of a chain, and the parameters at which their families lose stability.
 *
 * The orbits (orbit.h) are conservative and even about t = 0 and t = T/2. Three methods compute their multipliers.
 *
 *   reduced: n x n. The orbit is even, so M is reversible, R M R = M^-1 with a reflection R, and (M + M^-1) / 2 maps
 *   the states that R leaves unchanged to themselves. There it is an n x n block of M with the eigenvalues alpha = (mu
 *   + 1/mu) / 2: a pair (mu, 1/mu) is one number, the double 1 is a simple alpha = 1, multipliers on the unit circle
 *   are alpha in [-1, 1].
 *
 *   monodromy: 2n x 2n, from an event-driven run with 2n tangent vectors. It uses nothing of the orbit but its state.
 *
 *   determinant: O(n m) memory for m impacts. M = D (I + X Y^T) with the free flow D, diagonal in the modes, and X, Y
 *   of width 2m; mu is a multiplier where
 *
 *     f(mu) = det(I - Y^T (mu - D)^-1 D X) = 0,
 *
 *   or an eigenvalue of D whose modes vanish at the impacts. f is computed as a symmetric determinant of the jumps at
 *   the impacts, which is the same function. Signatures count the multipliers on the unit circle from below, the
 *   argument principle counts those outside, and the secant method locates them.
 *
 * The verdict `stable` means, for the reduced method, that all eigenvalues lie on the unit circle; for the
 * determinant method, that the pairs counted on the unit circle and the pair at 1 add up to n, so that none is left
 * outside. If they do not add up although nothing lies outside 1 + band, the verdict is `undecided`. */
#ifndef RICOCHET_ORBIT_MULTIPLIERS_H
#define RICOCHET_ORBIT_MULTIPLIERS_H

#include "multipliers.h"
#include "orbit.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_multiplier_method {
  RIC_MULTIPLIERS_AUTO, /* reduced up to RIC_REDUCED_PARTICLES, determinant beyond */
  RIC_MULTIPLIERS_REDUCED,
  RIC_MULTIPLIERS_MONODROMY,
  RIC_MULTIPLIERS_DETERMINANT
} ric_multiplier_method;

enum { RIC_REDUCED_PARTICLES = 400 };

typedef struct ric_orbit_multiplier_options {
  ric_multiplier_method method;
  ric_multiplier_options judge;
  bool on_circle; /* determinant: also find all multipliers on the unit circle, for up to some 500 particles; off by
                     default. Two of opposite signature that nearly coincide may be missed: then count < dimension */
  ric_poll poll;
} ric_orbit_multiplier_options;

RIC_API ric_orbit_multiplier_options ric_orbit_multiplier_options_default(void);

/** Multipliers of a solved orbit of a chain.
 *  @param solver  the one that solved it; it provides modes and workspace
 *  @param options  NULL for the defaults
 *  @param multipliers  initialised for 2n
 *  @returns RIC_EINVAL for arguments that do not match; RIC_ELIMIT for the reduced and monodromy methods beyond
 *           RIC_REDUCED_PARTICLES; RIC_ENUMERIC if eigenvalues do not converge or every contour passes too close to a
 *           multiplier; RIC_ENOMEM, RIC_ESTOPPED. The verdict is `unknown` for orbits without a state and for orbits
 *           that graze (by outcome, or by an impulse within the solver's grazing_tol). Inadmissible and non-unique
 *           orbits get a verdict like any other, except that the monodromy method gives `unknown` for inadmissible
 *           ones. The determinant method counts all multipliers outside the unit circle and locates those beyond 1.001
 *           and up to 64 closer ones; otherwise the reason says how many are not located. */
RIC_API ric_status ric_orbit_multipliers(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                                         const ric_orbit *orbit, const ric_orbit_multiplier_options *options,
                                         ric_multipliers *multipliers, ric_error *error);

/** How a family loses or regains stability. */
#define RIC_CRITICAL_LIST(X)                                                                                           \
  X(RIC_CRITICAL_PLUS_ONE, "plus_one")   /* a pair collides at +1 and leaves along the real axis */                    \
  X(RIC_CRITICAL_MINUS_ONE, "minus_one") /* the same at -1 */                                                          \
  X(RIC_CRITICAL_COLLISION, "collision") /* two pairs collide on the unit circle and leave it as a quadruple (Krein)   \
                                          */

typedef enum ric_critical_kind {
#define X(name, text) name,
  RIC_CRITICAL_LIST(X)
#undef X
      RIC_CRITICAL_KINDS
} ric_critical_kind;

RIC_API const char *ric_critical_name(ric_critical_kind kind);

/** A parameter at which multipliers leave the unit circle or return to it. */
typedef struct ric_critical {
  ric_critical_kind kind;
  double parameter;
  ric_complex mu;     /* position on the unit circle, with im >= 0 */
  bool outwards;      /* the number outside increases with the parameter */
  double uncertainty; /* half the width of the last bracket, or the rounding error of the zero in it */
} ric_critical;

/** Critical parameters of the orbits of a pattern in (low, high), increasing, by the reduced method.
 *
 *  Orbits are solved on a grid of `points` values. Where the number of multipliers outside, by kind, differs between
 *  neighbours, the critical parameter is bracketed and bisected to 1e-11. The trivial 1 is deflated, so alpha passes
 *  +-1 as a simple eigenvalue and rounding is no larger. At a collision rounding is larger; there the parameter is the
 *  zero of the discriminant (alpha_a - alpha_b)^2, extrapolated from beyond the bracket. If rounding decides over a
 *  longer interval (impulses close to 0, weak coupling), the uncertainty says so. Two changes between neighbours of the
 *  grid that cancel are missed. Parameters without an orbit end an interval; inadmissible orbits count.
 *  @param along  gamma at the given period, or the period at the chain's gamma
 *  @param found  [capacity]; @param count  set to their number, also beyond the capacity
 *  @returns RIC_EINVAL for a range or points < 2; as ric_orbit_solve and ric_orbit_multipliers. */
RIC_API ric_status ric_orbit_critical_points(ric_orbit_solver *solver, const ric_chain *chain,
                                             const ric_pattern *pattern, ric_along along, double period, double low,
                                             double high, size_t points, ric_critical *found, size_t capacity,
                                             size_t *count, ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Continuation: the curve of solutions of F(u, p) = 0 through a known one.
 *
 * n equations for n unknowns u and a parameter p have curves of solutions. A step goes to where the last points and
 * tangents lead and comes back to the curve by Newton's method, either at a given parameter (natural) or in the
 * hyperplane through the prediction that the last tangent t is normal to (pseudo-arclength), which goes around folds:
 *
 *   F(u, p) = 0,   <t_u, u - u_0> / n + t_p (p - p_0) = ds,
 *
 * with t of unit length in the norm |(u, p)|^2 = |u|^2 / n + p^2. Steps grow where Newton's method is quick and the
 * tangent turns slowly, and shrink where not. A step takes two evaluations where the prediction is good: one there, one
 * at the corrected point, which confirms it and gives its tangent. Linear systems are bordered and solved by GSL, by
 * pivoted QR below 31 unknowns, else by LU.
 *
 * Test functions are followed along the curve; where one changes sign the point is located on the curve to
 * `locate_tol`. Two are built in: folds, where the tangent's part in p changes sign, and branch points, where the
 * determinant of the bordered Jacobian does. Others belong to the problem: this file knows nothing of what u is.
 * Zeros that come in pairs within one step are not seen. */
#ifndef RICOCHET_CONTINUATION_H
#define RICOCHET_CONTINUATION_H

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

/** The equations. Callbacks return RIC_OK; RIC_ENUMERIC when there is no value here, so that a shorter step is tried;
 *  any other status ends the continuation with it. They may be asked a step beyond the bounds of p, where the curve may
 *  bend back: RIC_ENUMERIC there is in order. */
typedef struct ric_curve_problem {
  size_t unknowns; /* n >= 1 */
  /** F [n] at (u, p), its Jacobian J [n][n] row-major and its derivative F_p [n]. */
  ric_status (*residual)(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error);
  size_t tests; /* test functions besides the built-in ones */
  /** Their values [tests] at a point of the curve, with its tangent; NULL when there are none. NaN: not defined here.
   */
  ric_status (*test)(const double *u, double p, const double *t_u, double t_p, double *values, void *user,
                     ric_error *error);
  void *user;
} ric_curve_problem;

typedef struct ric_curve_options {
  bool natural;         /* steps in p alone; default false: pseudo-arclength */
  double p_low, p_high; /* the curve ends where it leaves this range; default -INFINITY, INFINITY */
  double step;          /* first step, default 0.01 */
  double step_least;    /* default 1e-8: when it would be shorter, the curve has ended */
  double step_most;     /* default 0.1 */
  double direction;     /* sign of the first step in p; default 1 */
  size_t points;        /* most steps, default 1000 */
  double newton_tol;    /* 1e-12: a correction below it, relative to 1 + |(u, p)|, confirms the point; so does one below
                         * 1000 times it that no longer shrinks: it is rounding of F. The last may be larger, up to
                         * locate_tol, where corrections shrink so fast that the next is below it */
  int iterations;       /* most corrections of a step, with the one that confirms it; default 8 */
  double turn;          /* most that the tangent may turn in a step, radians; at most 1, default 0.3 */
  double locate_tol;    /* 1e-10: special points, in arclength, relative to 1 + |p| */
  ric_poll poll;
} ric_curve_options;

RIC_API ric_curve_options ric_curve_options_default(void);

#define RIC_CURVE_POINT_LIST(X)                                                                                        \
  X(RIC_CURVE_REGULAR, "regular")                                                                                      \
  X(RIC_CURVE_FOLD, "fold")                                                                                            \
  X(RIC_CURVE_BRANCH_POINT, "branch_point")                                                                            \
  X(RIC_CURVE_TEST, "test") /* a test function of the problem vanishes: `which` */

typedef enum ric_curve_point_kind {
#define X(name, text) name,
  RIC_CURVE_POINT_LIST(X)
#undef X
      RIC_CURVE_POINT_KINDS
} ric_curve_point_kind;

RIC_API const char *ric_curve_point_name(ric_curve_point_kind kind);

/** A point of the curve. Arrays are valid during the callback. */
typedef struct ric_curve_point {
  ric_curve_point_kind kind;
  size_t which; /* test function */
  double p;
  const double *u;     /* [n] */
  const double *t_u;   /* [n] tangent, with t_p behind it, */
  double t_p;          /* in the direction of the walk */
  double arclength;    /* from the start: of cubics through the points along their tangents */
  const double *tests; /* [tests] values of the problem's test functions */
  int iterations;      /* corrections that were needed, without one that only confirms; 0 at branch points */
  double step;         /* ds that led here, of special points: the part of it up to them; 0 at the start */
} ric_curve_point;

#define RIC_CURVE_END_LIST(X)                                                                                          \
  X(RIC_CURVE_BOUND, "bound")                 /* p has reached the end of its range; the last point lies on it */      \
  X(RIC_CURVE_POINTS, "points")               /* as many steps as allowed */                                           \
  X(RIC_CURVE_CLOSED, "closed")               /* the curve has come back to its start */                               \
  X(RIC_CURVE_NOT_CONVERGED, "not_converged") /* steps shrink to nothing; the reason says what failed last */          \
  X(RIC_CURVE_ENDED, "ended")                 /* the callback asked for it */

typedef enum ric_curve_end {
#define X(name, text) name,
  RIC_CURVE_END_LIST(X)
#undef X
      RIC_CURVE_ENDS
} ric_curve_end;

RIC_API const char *ric_curve_end_name(ric_curve_end end);

typedef struct ric_curve_run {
  ric_curve_end end;
  char reason[256];                         /* for people; "" when the end speaks for itself */
  size_t points;                            /* accepted steps */
  size_t special;                           /* special points located */
  size_t missed;                            /* sign changes where no zero was found: jumps, poles, no values */
  unsigned long long iterations, jacobians; /* in all: corrections needed, residuals with their Jacobians */
} ric_curve_run;

/** Workspace of a problem. What follows allocates nothing, but for switching, and for the LU of GSL. The point callback
 * may call ric_curve_switch and ric_curve_solve of the curve that is being followed. */
typedef struct ric_curve ric_curve;

/** @param problem  copied; its user is borrowed
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for options out of range, with their name and value; RIC_ENOMEM. */
RIC_API ric_status ric_curve_create(const ric_curve_problem *problem, const ric_curve_options *options,
                                    ric_curve **curve, ric_error *error);
RIC_API void ric_curve_destroy(ric_curve **curve);

/** Follows the curve.
 *  @param u  [n] near a solution at p; set to the one that Newton's method finds there, the first point
 *  @param tangent  [n + 1] (t_u, t_p) to begin along, of any length, for switching branches or from a fold: u is then
 *                  the first point as it stands, since Newton's method has no hold there, and special points in the
 *                  first thousandth of the first step are not told. NULL: the curve's own, in `direction`
 *  @param point  sees every point in order, special points in their place; NULL for none. Non-zero ends the walk
 *  @param run  what happened; every end is RIC_OK
 *  @returns RIC_EINVAL for a start out of the range of p; RIC_ENUMERIC when the start does not converge, with its last
 *           correction, or is singular; RIC_ESTOPPED; what the callbacks return. */
RIC_API ric_status ric_curve_follow(ric_curve *curve, double *u, double p, const double *tangent,
                                    int (*point)(const ric_curve_point *point, void *user), void *user,
                                    ric_curve_run *run, ric_error *error);

/** Newton's method at a fixed parameter: the solution near u [n], which is set to it.
 *  @param iterations  set to the number of corrections that were needed, without one that only confirms: 0 at a
 *                     solution, 1 where F is linear in u; may be NULL
 *  @returns RIC_ENUMERIC when it does not converge, with the last correction. */
RIC_API ric_status ric_curve_solve(ric_curve *curve, double *u, double p, int *iterations, ric_error *error);

/** The other branch through a simple branch point: its tangent there, from the null vectors of the Jacobian and its
 *  differences (the algebraic branching equation).
 *  @param u, p, tangent  [n + 1] point and tangent of the branch that is known
 *  @param other  [n + 1] set, of unit length; its opposite leads along the other half of the branch
 *  @returns RIC_ENUMERIC when the point is no simple branch point. */
RIC_API ric_status ric_curve_switch(ric_curve *curve, const double *u, double p, const double *tangent, double *other,
                                    ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Continuation: the branch of solutions of F(u, p) = 0 through a known one.
 *
 * The solutions of n equations for n unknowns u and a parameter p are curves (branches). A step predicts the next
 * point from the last points and tangents. Newton's method corrects it, either at a given parameter (natural) or in
 * the hyperplane through the prediction normal to the last tangent t (pseudo-arclength), which passes folds:
 *
 *   F(u, p) = 0,   <t_u, u - u_0> / n + t_p (p - p_0) = ds,
 *
 * with t of unit length in the norm |(u, p)|^2 = |u|^2 / n + p^2. Steps grow where Newton's method converges quickly
 * and the tangent turns slowly, and shrink elsewhere. With a good prediction a step takes two evaluations: one there,
 * and one at the corrected point, which confirms it and gives its tangent. Linear systems are bordered and solved by
 * GSL, by pivoted QR below 31 unknowns, otherwise by LU.
 *
 * Test functions are evaluated along the branch. Where one changes sign, its zero is located on the branch to
 * `locate_tol`. Two are built in: folds, where the p component of the tangent changes sign, and branch points, where
 * the determinant of the bordered Jacobian does. The problem supplies others: this module does not know what u means.
 * Pairs of zeros within one step are missed. */
#ifndef RICOCHET_CONTINUATION_H
#define RICOCHET_CONTINUATION_H

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

/** The equations. Callbacks return RIC_OK, or RIC_ENUMERIC if there is no value here, so that a shorter step is tried;
 *  any other status ends the continuation with that status. They may be called up to one step beyond the bounds of p,
 *  where the branch may bend back; RIC_ENUMERIC is allowed there. */
typedef struct ric_curve_problem {
  size_t unknowns; /* n >= 1 */
  /** F [n] at (u, p), its Jacobian J [n][n] row-major and its derivative F_p [n]. */
  ric_status (*residual)(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error);
  size_t tests; /* test functions besides the built-in ones */
  /** Values [tests] of the test functions at a point of the branch with its tangent; NULL if there are none. NaN: not
   *  defined here.
   */
  ric_status (*test)(const double *u, double p, const double *t_u, double t_p, double *values, void *user,
                     ric_error *error);
  void *user;
} ric_curve_problem;

typedef struct ric_curve_options {
  bool natural;         /* steps in p alone; default false: pseudo-arclength */
  double p_low, p_high; /* the run ends where the branch leaves this range; default -INFINITY, INFINITY */
  double step;          /* first step, default 0.01 */
  double step_least;    /* default 1e-8: the run ends when a shorter step would be needed */
  double step_most;     /* default 0.1 */
  double direction;     /* sign of the first step in p; default 1 */
  size_t points;        /* largest number of steps, default 1000 */
  double newton_tol;    /* 1e-12: a correction below it, relative to 1 + |(u, p)|, confirms the point; so does one below
                           1000 times it that no longer shrinks: rounding of F. The last correction may be as large as
                           locate_tol if corrections shrink so fast that the next one is below newton_tol */
  int iterations;       /* largest number of corrections of a step, the confirming one included; default 8 */
  double turn;          /* largest turn of the tangent in a step, radians; at most 1, default 0.3 */
  double locate_tol;    /* 1e-10: accuracy of special points in arclength, relative to 1 + |p| */
  ric_poll poll;
} ric_curve_options;

RIC_API ric_curve_options ric_curve_options_default(void);

#define RIC_CURVE_POINT_LIST(X)                                                                                        \
  X(RIC_CURVE_REGULAR, "regular")                                                                                      \
  X(RIC_CURVE_FOLD, "fold")                                                                                            \
  X(RIC_CURVE_BRANCH_POINT, "branch_point")                                                                            \
  X(RIC_CURVE_TEST, "test") /* zero of the test function `which` of the problem */

typedef enum ric_curve_point_kind {
#define X(name, text) name,
  RIC_CURVE_POINT_LIST(X)
#undef X
      RIC_CURVE_POINT_KINDS
} ric_curve_point_kind;

RIC_API const char *ric_curve_point_name(ric_curve_point_kind kind);

/** A point of the branch. Arrays are valid during the callback. */
typedef struct ric_curve_point {
  ric_curve_point_kind kind;
  size_t which; /* test function */
  double p;
  const double *u;     /* [n] */
  const double *t_u;   /* [n] tangent (t_u, t_p), */
  double t_p;          /* in the direction of the continuation run */
  double arclength;    /* from the start, along cubics through the points and their tangents */
  const double *tests; /* [tests] values of the problem's test functions */
  int iterations;      /* corrections needed, without one that only confirms; 0 at branch points */
  double step; /* step length ds to this point; at special points the part of the step up to them; 0 at the start */
} ric_curve_point;

#define RIC_CURVE_END_LIST(X)                                                                                          \
  X(RIC_CURVE_BOUND, "bound")                 /* p has reached a bound; the last point lies on it */                   \
  X(RIC_CURVE_POINTS, "points")               /* the largest number of steps */                                        \
  X(RIC_CURVE_CLOSED, "closed")               /* the branch has returned to its start */                               \
  X(RIC_CURVE_NOT_CONVERGED, "not_converged") /* steps fall below step_least; the reason says what failed last */      \
  X(RIC_CURVE_ENDED, "ended")                 /* requested by the callback */

typedef enum ric_curve_end {
#define X(name, text) name,
  RIC_CURVE_END_LIST(X)
#undef X
      RIC_CURVE_ENDS
} ric_curve_end;

RIC_API const char *ric_curve_end_name(ric_curve_end end);

typedef struct ric_curve_run {
  ric_curve_end end;
  char reason[256];                         /* for people; "" when the end needs no explanation */
  size_t points;                            /* accepted steps */
  size_t special;                           /* special points located */
  size_t missed;                            /* sign changes without a zero: jumps, poles, missing values */
  unsigned long long iterations, jacobians; /* totals: corrections needed, residuals evaluated with Jacobians */
} ric_curve_run;

/** Workspace of a problem. The functions below allocate nothing, except for switching and inside the LU of GSL. During
 *  a continuation run the point callback may call ric_curve_switch and ric_curve_solve on the same curve. */
typedef struct ric_curve ric_curve;

/** @param problem  copied; its user is borrowed
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for options out of range, with their name and value; RIC_ENOMEM. */
RIC_API ric_status ric_curve_create(const ric_curve_problem *problem, const ric_curve_options *options,
                                    ric_curve **curve, ric_error *error);
RIC_API void ric_curve_destroy(ric_curve **curve);

/** Follows the branch: one continuation run.
 *  @param u  [n] near a solution at p; set to the solution that Newton's method finds there, the first point
 *  @param tangent  [n + 1] initial direction (t_u, t_p) of any length, to switch branches or to start at a fold. u is
 *         then taken as the first point without correction, since Newton's method fails there, and special points in
 *         the first thousandth of the first step are not reported. NULL: the tangent of the branch, in `direction`
 *  @param point  called with every point in order, special points included; NULL for none. Non-zero ends the run
 *  @param run  what happened; every end is RIC_OK
 *  @returns RIC_EINVAL for a start outside the range of p; RIC_ENUMERIC if the start does not converge, with its last
 *           correction, or is singular; RIC_ESTOPPED; what the callbacks return. */
RIC_API ric_status ric_curve_follow(ric_curve *curve, double *u, double p, const double *tangent,
                                    int (*point)(const ric_curve_point *point, void *user), void *user,
                                    ric_curve_run *run, ric_error *error);

/** Newton's method at a fixed parameter, from u [n], which is set to the solution.
 *  @param iterations  set to the number of corrections needed, without one that only confirms: 0 at a
 *                     solution, 1 where F is linear in u; may be NULL
 *  @returns RIC_ENUMERIC if it does not converge, with the last correction. */
RIC_API ric_status ric_curve_solve(ric_curve *curve, double *u, double p, int *iterations, ric_error *error);

/** Tangent of the other branch at a simple branch point, from the null vectors of the Jacobian and its differences (the
 *  algebraic branching equation).
 *  @param u, p, tangent  [n + 1] point and tangent of the known branch
 *  @param other  [n + 1] set, of unit length; its negative points along the other half of the branch
 *  @returns RIC_ENUMERIC if the point is not a simple branch point. */
RIC_API ric_status ric_curve_switch(ric_curve *curve, const double *u, double p, const double *tangent, double *other,
                                    ric_error *error);

RIC_END_DECLARATIONS

#endif

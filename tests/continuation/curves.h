/* Problems whose curves are known, and what a walk along them has shown. */
#ifndef RICOCHET_TESTS_CURVES_H
#define RICOCHET_TESTS_CURVES_H

#include <ricochet/ricochet.h>

/** u^2 + p^2 = 1. */
extern const ric_curve_problem circle;
/** p = u - u^3: folds at u = +-1/sqrt(3). */
extern const ric_curve_problem cubic_curve;
/** p u - u^3 = 0 */
extern const ric_curve_problem pitchfork;

/** Three unknowns in mixed equations: with a = u_0 - 0.4 sin p and q = p - 0.3 either a (a - q) = 0, branches u_0 = 0.4
 * sin p and 0.4 sin p + q that cross at p = 0.3, or a (q - a^2) = 0; u_1 = cos(p) / 2, u_2 = u_0 u_1. The user is a
 * bool: whether it is a pitchfork. */
extern const ric_curve_problem crossing;
/** The point of a branch of the crossing with a given u_0, and the derivative along p when u_0' is given. */
void crossing_point(double p, double u_0, double u[3]);
void crossing_tangent(double p, double u_0, double rate, double t[4]);

/** Many unknowns with the crossing's first equation for u_0, and u_i = u_0 cos(i) + sin(p) / (i + 1); all equations
 * mixed by a reflection, so that the Jacobian is dense. The user is a wide_user. */
typedef struct wide_user {
  bool is_fork;
  size_t unknowns;
} wide_user;
ric_curve_problem wide_crossing(const wide_user *user);
/** The point of a branch with a given u_0. @param u  [unknowns] set */
void wide_point(const wide_user *user, double p, double u_0, double *u);

/** Amplitudes u = (a, b) of x = a cos pt + b sin pt in x'' + 2 z x' + x + x^3 = f cos pt by harmonic balance; the user
 * is a duffing. Folds at both ends of where three amplitudes exist. */
typedef struct duffing {
  double damping, force;
} duffing;
extern const ric_curve_problem duffing_response;
/** |force| that belongs to the amplitudes at p, which is that of the problem on its curve. */
double duffing_force(const duffing *d, const double u[2], double p);

/** Bratu's problem u'' + p exp(u) = 0 on [0, 1], u = 0 at the ends, by second differences at `unknowns` points. */
ric_curve_problem bratu(size_t unknowns);

/** What a walk has shown. */
typedef struct shown_point {
  ric_curve_point_kind kind;
  size_t which;
  double p, u, t_p, t_u, arclength, step, test;
  double x[4], t[4]; /* of problems with three unknowns at most */
  int iterations;
} shown_point;

enum { MOST_SHOWN = 4000 };

typedef struct walked {
  size_t count, unknowns, tests;
  shown_point points[MOST_SHOWN];
  ric_curve_run run;
} walked;

/** Follows a curve from (u, p), which must succeed. @param u  [n] or NULL: zeros. To be freed. */
walked *walk(const ric_curve_problem *problem, const ric_curve_options *options, const double *u, double p,
             const double *tangent);
/** The k-th special point of a kind; fails the test when there is none. */
const shown_point *special(const walked *w, ric_curve_point_kind kind, size_t k);
size_t count_special(const walked *w, ric_curve_point_kind kind);
const shown_point *last(const walked *w);

ric_curve *made(const ric_curve_problem *problem, const ric_curve_options *options);

#endif

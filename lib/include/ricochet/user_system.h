/* Systems defined by the user, in the two forms of [FN97] sections 2 and 3.
 *
 * Mechanical: generalised coordinates q [n] and speeds u [m], m <= n (non-holonomic systems included),
 *
 *   M(q, t) u' = f(q, u, t),    q' = B(q, t) u + b(q, t),                                          [FN97] (2.3), (2.4)
 *
 * with gaps h_j(q, t) >= 0 of any shape. An impact changes the speeds by an impulse along the gap's gradient,
 *
 *   u+ = u- + M^-1 I,   I = -(1 + e) h'- g / (g^T M^-1 g),   g = B^T grad_q h,                              (2.9)
 *
 * so that h'+ = -e h'-; a contact that sticks (persists) carries a force lambda g with lambda >= 0.
 *
 * First order: x' = F(x, t), gaps h_j(x, t), and an impact map G per obstacle that gives the state after an impact
 * from the state before. The force of a contact that sticks acts along the direction in which G moves the state at
 * small gap rates: G must be smooth there, for negative gap rates, and tend to the identity. The restitution of such
 * a contact is -h'+ / h'- of the last impact, 1 before any.
 *
 * Callbacks return 0, or non-zero to end the run with the outcome `callback_failed`; values that are not finite have
 * the same effect. They are called at times in any order. Optional callbacks may be NULL: derivatives are then
 * central differences, with about ten digits if gaps change over lengths and times of order one (steps are about
 * 1e-3). The derivatives of gap rates for sticking and chatter are always differences. So scale systems to be
 * dimensionless. Differences cost digits of impact speeds where gaps are curved. */
#ifndef RICOCHET_USER_SYSTEM_H
#define RICOCHET_USER_SYSTEM_H

#include <stddef.h>

#include "status.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_mechanical {
  size_t coordinates; /* n >= 1 */
  size_t speeds;      /* 1 <= m <= n */
  size_t obstacles;
  const double *restitution; /* [obstacles] in [0, 1]; NULL: 1. Copied */
  /** M [m][m] row-major, symmetric positive definite. NULL: the identity. */
  int (*mass)(double t, const double *q, double *M, void *user);
  /** f [m]. */
  int (*force)(double t, const double *q, const double *u, double *f, void *user);
  /** B [n][m] row-major and b [n]. NULL: q' = u, which needs m = n. */
  int (*kinematics)(double t, const double *q, double *B, double *b, void *user);
  /** Gap h of an obstacle, positive where motion is free. */
  int (*gap)(double t, const double *q, size_t obstacle, double *h, void *user);
  /** Optional: gradient [n] of the gap in q, and its partial derivative in t. */
  int (*gap_gradient)(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user);
  /** Optional: energy of a state. */
  int (*energy)(double t, const double *q, const double *u, double *energy, void *user);
  void *user;
} ric_mechanical;

typedef struct ric_first_order {
  size_t states; /* n >= 1 */
  size_t obstacles;
  /** F [n]. */
  int (*rate)(double t, const double *x, double *rate, void *user);
  /** Gap h of an obstacle. */
  int (*gap)(double t, const double *x, size_t obstacle, double *h, void *user);
  /** Optional: gradient [n] of the gap in x, and its partial derivative in t. */
  int (*gap_gradient)(double t, const double *x, size_t obstacle, double *gradient, double *in_time, void *user);
  /** Impact map G of an obstacle: the state x_after [n] from the state x [n] before. */
  int (*impact)(double t, const double *x, size_t obstacle, double *x_after, void *user);
  /** Optional: energy of a state. */
  int (*energy)(double t, const double *x, double *energy, void *user);
  void *user;
} ric_first_order;

RIC_END_DECLARATIONS

#endif

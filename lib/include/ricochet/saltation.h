/* Saltation: how small differences of a state go through an impact.
 *
 * A motion x that differs by d just before an impact reaches the obstacle earlier or later by tau, grad h . d + tau h'-
 * = 0. Meanwhile it has moved with the rates F- before the impact, or will move with F+ after it, so that at equal
 * times
 *
 *   d+ = S d = DG (d + F- tau, tau) - F+ tau,    S = R + (F+ - R F- - G_t) (grad h)^T / h'-              [JAP] (16)
 *
 * with DG the full derivative of the impact map G(x, t) = (q, u+), R its part in the state and G_t that in time. For
 * generalised coordinates R contains the derivatives of M, B and the gap's gradient, by differences; for obstacles at
 * coordinates it is exact. F+ belongs to what follows: a contact that comes to rest is held, and S then is singular.
 *
 * S blows up as 1 / h'-: where the contact comes in slowly the linear picture ends, and the outcome is `grazing`.
 *
 * Several impacts at one time happen one after the other in a neighbouring motion, in an order that depends on the
 * difference. Where contacts do not couple and no force on one impacting mass depends on the speed of another, all
 * orders have the same product of matrices, and the motion is differentiable; second differences are of first order in
 * the step only. Otherwise there are one-sided derivatives, `not_differentiable`; where contacts couple even the state
 * after the impacts depends on the order. */
#ifndef RICOCHET_SALTATION_H
#define RICOCHET_SALTATION_H

#include <stddef.h>

#include "system.h"

RIC_BEGIN_DECLARATIONS

#define RIC_SALTATION_LIST(X)                                                                                          \
  X(RIC_SALTATION_DIFFERENTIABLE, "differentiable")                                                                    \
  X(RIC_SALTATION_GRAZING, "grazing")                                                                                  \
  X(RIC_SALTATION_NOT_DIFFERENTIABLE, "not_differentiable")

typedef enum ric_saltation_kind {
#define X(name, text) name,
  RIC_SALTATION_LIST(X)
#undef X
      RIC_SALTATION_KINDS
} ric_saltation_kind;

/** Name of a kind, "differentiable". Never NULL. */
RIC_API const char *ric_saltation_name(ric_saltation_kind kind);

/** Saltation matrix of impacts at one time, no rigid contact persisting before or after.
 *  @param q, u  [n], [m] state before, gaps of the obstacles zero
 *  @param obstacles  [count] that are hit
 *  @param grazing_tol  > 0: gap rates below it, and impacts that would go no deeper than it, are grazing
 *  @param S  [n + m][n + m] row-major, state (q, u): impacts in the order given. With coupled contacts, until none
 *            comes in any more. Untouched when grazing
 *  @param S_reverse  the same in reverse order; NULL: not wanted
 *  @param kind  set; the matrices of the two orders count as equal within 1e-9 of their size
 *  @returns RIC_EINVAL for an unknown or compliant obstacle or a gap rate >= 0; RIC_ELIMIT when coupled contacts do not
 * come apart; RIC_ECALLBACK, RIC_ENOMEM. */
RIC_API ric_status ric_saltation_find(const ric_system *system, double t, const double *q, const double *u,
                                      const size_t *obstacles, size_t count, double grazing_tol, double *S,
                                      double *S_reverse, ric_saltation_kind *kind, ric_error *error);

RIC_END_DECLARATIONS

#endif

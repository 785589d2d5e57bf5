/* Saltation matrices: the derivative of the state after an impact by the state before it, at equal times.
 *
 * A motion whose state differs by d just before an impact reaches the obstacle later by tau, where grad h . d + tau
 * h'- = 0. In this time it moves with the rates F- before the impact instead of F+ after it, so that at equal times
 *
 *   d+ = S d = DG (d + F- tau, tau) - F+ tau,    S = R + (F+ - R F- - G_t) (grad h)^T / h'-              [JAP] (16)
 *
 * with the full derivative DG of the impact map G(x, t) = (q, u+), its part R with respect to the state and its part
 * G_t with respect to time. For generalised coordinates R contains the derivatives of M, B and the gap's gradient, by
 * differences; for obstacles at coordinates it is exact. F+ belongs to the motion that follows: if the contact begins
 * to stick, it is held and S is singular.
 *
 * S grows as 1 / h'-. If the impact is too slow, linearisation fails and the outcome is `grazing`.
 *
 * In a neighbouring motion simultaneous impacts happen one after the other, in an order that depends on the
 * difference. If contacts do not couple and no force on one impacting mass depends on the speed of another, the
 * matrices of all orders have the same product and the motion is differentiable; second differences are then only of
 * first order in the step. Otherwise there are one-sided derivatives, `not_differentiable`; if contacts couple, even
 * the state after the impacts depends on the order. */
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

/** Saltation matrix of simultaneous impacts, without rigid contacts that stick before or after.
 *  @param q, u  [n], [m] state before, gaps of the obstacles zero; u NULL if m = 0
 *  @param obstacles  [count] that are hit
 *  @param grazing_tol  > 0: impacts with a gap rate below it, or a penetration depth below it, are grazing
 *  @param S  [n + m][n + m] row-major, state (q, u): impacts in the order given, repeated for coupled contacts until no
 *            gap rate is negative. Unchanged if grazing
 *  @param S_reverse  the same in reverse order; NULL: not computed
 *  @param kind  set; matrices of the two orders that agree within 1e-9 of their size count as equal
 *  @returns RIC_EINVAL for an unknown or compliant obstacle or a gap rate >= 0; RIC_ELIMIT if coupled contacts do not
 *  separate; RIC_ECALLBACK, RIC_ENOMEM. */
RIC_API ric_status ric_saltation_find(const ric_system *system, double t, const double *q, const double *u,
                                      const size_t *obstacles, size_t count, double grazing_tol, double *S,
                                      double *S_reverse, ric_saltation_kind *kind, ric_error *error);

RIC_END_DECLARATIONS

#endif

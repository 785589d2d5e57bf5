/* Normal modes of the linear part of a system: K phi_j = w_j^2 M phi_j, phi_i^T M phi_j = delta_ij.
 *
 * They come from the symmetric eigenvalue problem of L^-1 K L^-T, M = L L^T. Squared frequencies are accurate to
 * rounding of the largest one, so low frequencies of stiff systems have fewer digits. */
#ifndef RICOCHET_NORMAL_MODES_H
#define RICOCHET_NORMAL_MODES_H

#include "system.h"

RIC_BEGIN_DECLARATIONS

/** Modes of a lattice or M-C-K system; damping, forcing, nonlinear terms and obstacles are ignored.
 *  @param frequency  [n], set: angular, increasing; 0 for modes without stiffness
 *  @param shape  [n][n], set: row j is phi_j; the first of its largest components is positive
 *  @returns RIC_EINVAL for user systems and for stiffness matrices that are not symmetric; RIC_ENUMERIC where a w_j^2
 *  is negative beyond rounding, with its value, and where numbers overflow; RIC_ENOMEM. Nothing is set then. */
RIC_API ric_status ric_normal_modes(const ric_system *system, double *frequency, double *shape, ric_error *error);

RIC_END_DECLARATIONS

#endif

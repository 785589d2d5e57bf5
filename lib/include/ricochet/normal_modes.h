/* Normal modes of the linear part of a system: K phi_j = w_j^2 M phi_j, phi_i^T M phi_j = delta_ij.
 *
 * From the symmetric eigenvalue problem of L^-1 K L^-T, M = L L^T. The squares of frequencies are accurate to rounding
 * of the largest, so that slow modes of stiff systems keep fewer digits. */
#ifndef RICOCHET_NORMAL_MODES_H
#define RICOCHET_NORMAL_MODES_H

#include "system.h"

RIC_BEGIN_DECLARATIONS

/** Modes of a lattice or M-C-K system; damping, forcing, nonlinear terms and obstacles are left aside.
 *  @param frequency  [n], set: angular, rising; 0 of modes without stiffness
 *  @param shape  [n][n], set: row j is phi_j; the first of its largest components is positive
 *  @returns RIC_EINVAL for user systems and for stiffness matrices that are not symmetric; RIC_ENUMERIC where a w_j^2
 * is negative beyond rounding, with its value, and where numbers overflow; RIC_ENOMEM. Nothing is set then. */
RIC_API ric_status ric_normal_modes(const ric_system *system, double *frequency, double *shape, ric_error *error);

RIC_END_DECLARATIONS

#endif

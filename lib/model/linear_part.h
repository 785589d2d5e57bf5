/* The linear part of lattices and M-C-K systems as dense matrices: internal to the library. */
#ifndef RICOCHET_LINEAR_PART_H
#define RICOCHET_LINEAR_PART_H

#include "system_model.h"

/** K [n][n] row-major, symmetric to the last bit; nonlinear terms and obstacles are left aside.
 *  @returns RIC_EINVAL for user systems, and for a matrix that is not symmetric beyond rounding. */
ric_status linear_part_stiffness(const ric_system *system, double *stiffness, ric_error *error);

/** M: [n] of a diagonal one (system->uncoupled), [n][n] otherwise. Lattices and M-C-K systems only. */
void linear_part_mass(const ric_system *system, double *mass);

/** @returns RIC_EINVAL naming the first thing that an undamped, free, linear system has not: damping, forcing,
 * nonlinear terms; for user systems, of which that cannot be known. */
ric_status linear_part_is_all(const ric_system *system, ric_error *error);

#endif

/* The linear part of lattices and M-C-K systems as dense matrices: internal to the library. */
#ifndef RICOCHET_INTERNAL_NORMAL_MODES_H
#define RICOCHET_INTERNAL_NORMAL_MODES_H

#include "system_model.h"

/** @returns RIC_EINVAL naming the first thing that an undamped, free, linear system has not: damping, forcing,
 * nonlinear terms; for user systems, of which that cannot be known. */
ric_status linear_part_is_all(const ric_system *system, ric_error *error);

#endif

/* The linear part of lattices and M-C-K systems as dense matrices: internal to the library. */
#ifndef RICOCHET_INTERNAL_NORMAL_MODES_H
#define RICOCHET_INTERNAL_NORMAL_MODES_H

#include "system_model.h"

/** @returns RIC_EINVAL naming the first term that an undamped, free, linear system does not have: damping, forcing,
 * nonlinear terms; also for user systems, whose terms are unknown. */
ric_status linear_part_is_all(const ric_system *system, ric_error *error);

#endif

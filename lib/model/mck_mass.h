/* The mass matrix of an M-C-K system, and everything divided by it. Internal. */
#ifndef RICOCHET_MCK_MASS_H
#define RICOCHET_MCK_MASS_H

#include "mck_system.h"

/** Sets base.uncoupled, M and its inverse, M^-1 C, M^-1 K, M^-1 F and M^-1 G of a system, from a model that has been
 *  checked. A diagonal mass keeps sparse matrices sparse, any other makes all of them dense.
 *  @returns RIC_EINVAL when the mass is not positive definite, RIC_ENOMEM; destroy the system in any case. */
ric_status mck_divide_by_mass(mck_system *s, const ric_mck *mck, ric_error *error);

#endif

/* The period of an attractor, from iterates on it: internal to the room. */
#ifndef RICOCHET_INTERNAL_ATTRACTOR_H
#define RICOCHET_INTERNAL_ATTRACTOR_H

#include <stddef.h>

#include "ricochet/status.h"

/** The smallest period up to `limit` of consecutive states, 0 when there is none (the definition is in
 *  ricochet/attractor.h).
 *  @param states  [2 limit + 1][stride], of which the first `size` numbers count
 *  @param tolerance  relative to the extent of each number
 *  @param noise  relative to the largest number: smaller differences do not count */
size_t period_find(const double *states, size_t size, size_t stride, size_t limit, double tolerance, double noise);

/** Index of the first state whose number `observe` is smallest. @param states  [count][stride] */
size_t period_lowest(const double *states, size_t stride, size_t count, size_t observe);

/** Sets numbers to NaN, which may be gigabytes: asks the poll meanwhile. NULL is none.
 *  @returns RIC_OK or RIC_ESTOPPED */
ric_status fill_unknown(double *numbers, size_t count, ric_poll poll, ric_error *error);

#endif

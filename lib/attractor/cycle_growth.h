/* Growth along one period of a cycle: multipliers as exponents, impacts. Internal to the room.
 *
 * Averages over a number of iterates that is no multiple of the period are off by up to a period's worth, which near
 * the edge of a window has the wrong sign. One period gives both exactly. */
#ifndef RICOCHET_CYCLE_GROWTH_H
#define RICOCHET_CYCLE_GROWTH_H

#include "floquet/multipliers.h"
#include "numeric/linear.h"
#include "ricochet/grazing_map.h"

typedef struct cycle_growth {
  size_t size; /* 0: none */
  multiplier_work work;
  ric_multipliers multipliers;
  orthonormal_work tangents;
  double *product, *next, *derivative; /* [size][size] */
  double *once, *rate;                 /* [size] growth in an iterate, and in a period */
} cycle_growth;

/** Errors handled by GSL must be off. @returns RIC_ENOMEM, with nothing to clear */
ric_status cycle_growth_init(cycle_growth *growth, size_t size, ric_error *error);
void cycle_growth_clear(cycle_growth *growth);

/** Sets the exponents ln |mu| / period, largest first, of the derivative of a period in `product`, as far as the
 *  multipliers mu stand above its rounding.
 *  @param exponents  [count], count <= size; the others are left as they are
 *  @returns how many are set; 0 for a derivative that is not finite */
size_t cycle_growth_resolve(cycle_growth *growth, size_t period, double *exponents, size_t count);

/** Mean number of impacts per iterate. @param states  [period][size] */
double cycle_impacts(const ric_grazing_map *map, double d, const double *states, size_t period);

/** Sets the exponents ln |mu| / period, largest first. Multipliers mu that vanish in the rounding of the derivative of
 *  the period come from the growth of orthogonal tangent vectors, whose sum is exact; -INFINITY for 0.
 *  @param states  [period][size]; @param exponents  [count], count <= size; unchanged where the derivative is infinite
 *  @returns RIC_ESTOPPED */
ric_status cycle_exponents(cycle_growth *growth, const ric_grazing_map *map, double d, const double *states,
                           size_t period, ric_poll poll, double *exponents, size_t count, ric_error *error);

#endif

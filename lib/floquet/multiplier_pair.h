/* A pair (mu, 1/mu) of multipliers and the one number that stands for it, alpha = (mu + 1/mu) / 2. Internal to the
 * room. */
#ifndef RICOCHET_MULTIPLIER_PAIR_H
#define RICOCHET_MULTIPLIER_PAIR_H

#include "ricochet/multipliers.h"

/** The pair of alpha: pair[0] has the larger modulus, or the positive imaginary part on the circle. Real alpha in
 *  [-1, 1] give a pair on the circle; conjugate alpha give conjugate pairs, to the last bit. */
void multiplier_pair(ric_complex alpha, ric_complex pair[2]);

#endif

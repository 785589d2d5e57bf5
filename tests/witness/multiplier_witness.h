/* Multipliers of a solved orbit by each method and by a dense matrix. */
#ifndef RICOCHET_TESTS_MULTIPLIER_WITNESS_H
#define RICOCHET_TESTS_MULTIPLIER_WITNESS_H

#include "solved_orbit.h"

/** Multipliers of a solved orbit; the test fails if this fails. The caller clears them. */
ric_multipliers multipliers_by(ric_multiplier_method method, const solved_orbit *x, bool on_circle);

/** The same from a dense matrix, an independent witness (dense_monodromy.h). */
ric_multipliers multipliers_dense(const solved_orbit *x);

/** Largest relative distance of the first `count` multipliers of a from the nearest one of b. */
double multipliers_distance(const ric_multipliers *a, size_t count, const ric_multipliers *b);

#endif

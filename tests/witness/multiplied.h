/* A solved scenario with its multipliers. */
#ifndef RICOCHET_TESTS_MULTIPLIED_H
#define RICOCHET_TESTS_MULTIPLIED_H

#include "solved.h"

/** Multipliers of a solved orbit; fails the test unless that works. The caller clears them. */
ric_multipliers multipliers_by(ric_multiplier_method method, const solved *x, bool on_circle);

/** The same from a dense matrix, an independent witness (dense_monodromy.h). */
ric_multipliers multipliers_dense(const solved *x);

/** Largest relative distance of the first `count` multipliers of a from the nearest one of b. */
double multipliers_distance(const ric_multipliers *a, size_t count, const ric_multipliers *b);

#endif

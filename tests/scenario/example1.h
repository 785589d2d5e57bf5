/* Example 1 of [JAP]: a ring of 30 particles, particle 15 hits once per period, the others never. */
#ifndef RICOCHET_SCENARIO_EXAMPLE1_H
#define RICOCHET_SCENARIO_EXAMPLE1_H

#include "scenario.h"

enum { EXAMPLE1_PARTICLES = 30, EXAMPLE1_IMPACT = 15, EXAMPLE1_TABLE = 15 };

/** Period of the table of computational performance, 3 pi / 2. */
double example1_period(void);

/** Couplings of that table, 15 values from 0 to 0.187, evenly spaced; 0 <= row < EXAMPLE1_TABLE. */
double example1_gamma(size_t row);

/** The example at a coupling, with the period of the table. */
scenario example1_at(double gamma);

#endif

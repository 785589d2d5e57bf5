/* Motions with one impact per period, found by shooting, and Ritz's approximations of them. */
#ifndef RICOCHET_TESTS_APPROXIMATED_H
#define RICOCHET_TESTS_APPROXIMATED_H

#include <ricochet/ricochet.h>

#include "shot.h"

/** The two masses of [VID] in series on springs 3 and x + epsilon x^3, a wall at 2 (side -1; 1: its mirror image, a
 *  floor at -2) before the second. */
ric_system *duffing_masses(double epsilon, int side);

/** The impacting mode of the two masses, `before` before the period at which it begins to touch the wall.
 *  @param epsilon  0, 0.05, 0.1 or 0.2 */
shot duffing_mode(double epsilon, double before, int side);

/** A chain on springs of all kinds with one impact of a particle on a floor at -1 (side -1: a wall at 1). */
shot chain_mode(size_t particles, size_t particle, ric_ends ends, double gamma, double period, int side);

typedef struct approximated {
  ric_ritz *ritz;
  double *c;
  double error_q, error_v;
} approximated;

/** Approximates with so many functions by ric_ritz_refine; asserts that this works with all of them. */
approximated approximate(shot *s, size_t functions, bool constants);
void approximated_clear(approximated *a);

/** Least-squares slope of -log error over log number. */
double order_of(const size_t *number, const double *error, size_t count);

#endif

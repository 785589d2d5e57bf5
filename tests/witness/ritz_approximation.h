/* Motions with one impact per period, found by shooting, and Ritz's approximations of them. */
#ifndef RICOCHET_TESTS_RITZ_APPROXIMATION_H
#define RICOCHET_TESTS_RITZ_APPROXIMATION_H

#include <ricochet/ricochet.h>

#include "shooting_solution.h"

/** The two masses of [VID] in series on springs 3 and x + epsilon x^3, a wall at 2 (side -1; 1: its mirror image, a
 *  floor at -2) before the second. */
ric_system *duffing_masses(double epsilon, int side);

/** The impacting mode of the two masses, `before` below the period of its grazing point at the wall.
 *  @param epsilon  0, 0.05, 0.1 or 0.2 */
shooting_solution duffing_mode(double epsilon, double before, int side);

/** A chain on springs of all kinds with one impact of a particle on a floor at -1 (side -1: a wall at 1). */
shooting_solution chain_mode(size_t particles, size_t particle, ric_ends ends, double gamma, double period, int side);

typedef struct ritz_approximation {
  ric_ritz *ritz;
  double *c;
  double error_q, error_v;
} ritz_approximation;

/** Approximates with this number of functions by ric_ritz_refine; asserts success with all of them. */
ritz_approximation ritz_approximate(shooting_solution *s, size_t functions, bool constants);
void ritz_approximation_clear(ritz_approximation *a);

/** Least-squares slope of -log error over log number. */
double convergence_order(const size_t *number, const double *error, size_t count);

#endif

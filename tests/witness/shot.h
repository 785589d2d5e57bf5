/* Motions found by shooting, for tests. */
#ifndef RICOCHET_TESTS_SHOT_H
#define RICOCHET_TESTS_SHOT_H

#include <ricochet/ricochet.h>

/** A system with its equations and a solution. */
typedef struct shot {
  ric_system *system;
  ric_shooting *shooting;
  double *z;
  size_t unknowns;
  double given;
  int iterations;
  ric_orbit orbit;
} shot;

/** Makes the equations; asserts that this works. Takes the system over. */
shot shot_at(ric_system *system, const ric_shooting_problem *problem);
void shot_clear(shot *s);

/** Guesses; asserts that this works. Sets `given` to the period. */
void shot_guess(shot *s, const double *q, const double *u, const double *times, double period);

/** Solves by KINSOL and fills the orbit; asserts that this works. */
void shot_solve(shot *s);

/** Largest difference of J, and of the derivative by the given number, from differences of F, over 1 + the largest
 *  entry. */
double shot_jacobian_error(shot *s, double step);

/** The equations of a chain's pattern: even, period given. */
shot shot_of_chain(const ric_chain *chain, const ric_pattern *pattern);

#endif

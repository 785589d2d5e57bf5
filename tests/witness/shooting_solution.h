/* Solutions of the shooting equations, for tests. */
#ifndef RICOCHET_TESTS_SHOOTING_SOLUTION_H
#define RICOCHET_TESTS_SHOOTING_SOLUTION_H

#include <ricochet/ricochet.h>

/** A system with its equations and a solution. */
typedef struct shooting_solution {
  ric_system *system;
  ric_shooting *shooting;
  double *z;
  size_t unknowns;
  double given;
  int iterations;
  ric_orbit orbit;
} shooting_solution;

/** Creates the equations; asserts success. Owns the system afterwards. */
shooting_solution shooting_solution_of_system(ric_system *system, const ric_shooting_problem *problem);
void shooting_solution_clear(shooting_solution *s);

/** Sets z from a guess; asserts success. Sets `given` to the period. */
void shooting_solution_guess(shooting_solution *s, const double *q, const double *u, const double *times,
                             double period);

/** Solves by KINSOL and fills the orbit; asserts success. */
void shooting_solution_solve(shooting_solution *s);

/** Largest difference of J, and of the derivative by the given number, from differences of F, over 1 + the largest
 *  entry. */
double shooting_jacobian_error(shooting_solution *s, double step);

/** The equations of a chain's pattern: even, period given. */
shooting_solution shooting_solution_of_chain(const ric_chain *chain, const ric_pattern *pattern);

#endif

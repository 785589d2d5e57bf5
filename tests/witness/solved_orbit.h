/* An orbit of a chain solved for a scenario, with its solver. */
#ifndef RICOCHET_TESTS_SOLVED_ORBIT_H
#define RICOCHET_TESTS_SOLVED_ORBIT_H

#include "scenario/scenario.h"

typedef struct solved_orbit {
  scenario scenario;
  ric_orbit_solver *solver;
  ric_orbit orbit;
} solved_orbit;

/** Solves with the default options; the test fails if this fails. Owns the scenario afterwards. */
solved_orbit solve_orbit(ric_orbit_method method, scenario s);
void solved_orbit_clear(solved_orbit *x);

/** Whether the orbit has a state: neither singular nor failed. */
int solved_orbit_has_state(const solved_orbit *x);

/** Largest displacement at both ends of the half period: the reference of relative tolerances. */
double solved_orbit_scale(const solved_orbit *x);

/** Allowed difference between the methods for one orbit: 1e-12 max(1, cond / 100) of the largest displacement or
 *  velocity, with cond of the dense method. Relative, because half a unit in the last place of the period changes an
 *  orbit of size 600 near a singular point by 1e-10. */
double method_tolerance(const solved_orbit *dense);

/** Largest difference of the states of two orbits of one pattern; NaN counts as infinite. */
double state_difference(const ric_orbit *a, const ric_orbit *b);

/** Impulse of a particle, 0 if it has none. */
double impulse_of(const solved_orbit *x, size_t particle);

#endif

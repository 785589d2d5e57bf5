/* A scenario with its solver and its orbit. */
#ifndef RICOCHET_TESTS_SOLVED_H
#define RICOCHET_TESTS_SOLVED_H

#include "scenario/scenario.h"

typedef struct solved {
  scenario scenario;
  ric_orbit_solver *solver;
  ric_orbit orbit;
} solved;

/** Solves with the default options; fails the test unless that works. Takes the scenario over. */
solved solved_by(ric_orbit_method method, scenario s);
void solved_clear(solved *x);

/** Whether the orbit has a state: neither singular nor failed. */
int solved_has_state(const solved *x);

/** Largest displacement at both ends of the half period: what the tolerances are relative to. */
double solved_scale(const solved *x);

/** How far the forms of one orbit may differ: 1e-12 max(1, cond / 100) of the largest displacement or velocity, cond
 *  that of the dense form. Relative, because half a unit in the last place of the period alone moves an orbit of size
 * 600 near a singular point by 1e-10. */
double agreement(const solved *dense);

/** Largest difference of the states of two orbits of one pattern; NaN counts as infinite. */
double state_difference(const ric_orbit *a, const ric_orbit *b);

/** Impulse of a particle, 0 when it has none. */
double impulse_of(const solved *x, size_t particle);

#endif

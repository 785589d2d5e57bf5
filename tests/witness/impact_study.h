/* Linear systems whose orbits with one impact are known in closed form, for tests. */
#ifndef RICOCHET_TESTS_IMPACT_STUDY_H
#define RICOCHET_TESTS_IMPACT_STUDY_H

#include <ricochet/ricochet.h>

#include "scenario/random_source.h"

/** A system, its modes, and room for an orbit. */
typedef struct impact_study {
  ric_system *system;
  ric_impact_modes *modes;
  ric_orbit orbit;
  size_t n, hit; /* coordinates; that which obstacle 0 stands at */
  ric_obstacle obstacle;
} impact_study;

/** Takes the system over; obstacle 0 is hit. Asserts that all this works, as what follows. */
impact_study impact_study_of(ric_system *system, const ric_obstacle *obstacles);
void impact_study_clear(impact_study *s);

/** Masses 1, 1 in series on springs 3 (from the ground) and 1, a wall at 2 before the last mass: the system of [VID].
 */
impact_study impact_study_two_masses(void);

/** Up to 12 coordinates: a lattice with any ends, or matrices with a diagonal or any mass. Obstacle 0 is a floor or a
 *  wall at any coordinate, in one of five cases beyond the state of rest; up to three others. */
impact_study impact_study_random(random_source *source);

/** Whether its mass matrix is diagonal: speeds of coordinates that are not hit have no jump. */
int impact_study_random_is_diagonal(const impact_study *s);

/** A random period, up to three of the slowest mode. */
double impact_study_period(const impact_study *s, random_source *source);

/** The orbit of a period, in s->orbit. */
void impact_study_solve(impact_study *s, double period);

/** Largest displacement, or speed over the largest frequency, at both ends of the half period. */
double impact_study_scale(const impact_study *s);

/** How far rounding takes an orbit: 1e-12 of its size, more near blow-ups and resonances, where a relative error of the
 *  period, or of a frequency, is enlarged. */
double impact_study_agreement(const impact_study *s);

/** Smallest |w_j T / (2 pi) - l|, l >= 1, of all modes. */
double impact_study_detuning(const impact_study *s, double period);

#endif

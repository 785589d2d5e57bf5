/* Families ready to be followed: a system, its problem, and a guess of the first motion. Nothing here prints or
 * asserts. */
#ifndef RICOCHET_SCENARIO_FAMILY_SCENARIO_H
#define RICOCHET_SCENARIO_FAMILY_SCENARIO_H

#include <ricochet/ricochet.h>

enum { FAMILY_SCENARIO_MASSES = 20 /* most in series */ };

typedef struct family_scenario {
  ric_lattice lattice;
  ric_spring springs[FAMILY_SCENARIO_MASSES + 1]; /* of the links of masses in series */
  size_t hit;
  ric_system *system;
  ric_family_problem problem; /* its user is the scenario: do not move it */
  ric_family_options options; /* with the range */
  double start;               /* parameter */
  double *q, *u;              /* guess there */
} family_scenario;

/** Even motions of a ring, one particle of which presses a Hertz floor at -1, along the coupling from 0 to `most`.
 *  @returns 0, or -1 without memory; cleared in any case by family_scenario_clear */
int family_scenario_hertz(family_scenario *s, size_t n, double stiffness, double period, double most);

/** The same of a chain of impact oscillators whose middle particle hits. */
int family_scenario_impact(family_scenario *s, size_t n, double period, double least, double most);

/** n masses in series on springs 1 with a cubic part of 0.1, wall at 2 before the last: along the period, from
 *  a part of that of the first mode to another. */
int family_scenario_series(family_scenario *s, size_t n, double from, double to);

/** Two masses on springs 3 and 1, the second with a cubic part of 0.1, wall at 2 before the second mass: along the
 * period, from `longest` down. */
int family_scenario_two_masses(family_scenario *s, double longest, double shortest);

void family_scenario_clear(family_scenario *s);

/** Makes the family and solves for its first motion. @param z  [unknowns]
 *  @param family  to be destroyed by the caller in any case */
ric_status family_scenario_begin(const family_scenario *s, ric_family **family, double **z, ric_error *error);

#endif

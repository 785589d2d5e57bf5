/* Scenarios: a chain, a pattern and a period, ready to solve.
 *
 * Shared by the tests and the benchmark program, so nothing here prints or asserts. A builder that runs out of memory
 * leaves `pattern` NULL. */
#ifndef RICOCHET_SCENARIO_SCENARIO_H
#define RICOCHET_SCENARIO_SCENARIO_H

#include <ricochet/ricochet.h>

#include "random_source.h"

typedef struct scenario {
  ric_chain chain;
  ric_pattern *pattern;
  double period;
} scenario;

void scenario_clear(scenario *s);

/** One impact per period of one particle, at t = 0. */
scenario scenario_single(size_t particles, ric_ends ends, double gamma, double period, size_t particle);

/** The same in the middle of a chain of any size: the benchmark of large chains. */
scenario scenario_middle(size_t particles, ric_ends ends, double gamma, double period);

/** From a word of roles, one letter per particle: 's' hits at t = 0, 'h' at T/2, '.' never. Repeated `times` times. */
scenario scenario_word(const char *word, size_t times, ric_ends ends, double gamma, double period);

/** Ranges of random scenarios. */
typedef struct scenario_ranges {
  size_t most_particles;
  double highest_gamma, shortest_period, longest_period;
} scenario_ranges;

/** Random size, ends, coupling, period and roles, at least one impact; impacts are rarer in some patterns than in
 *  others. */
scenario scenario_random(random_source *source, const scenario_ranges *ranges);

/** Random size >= 2, ends, coupling and period, with 1 ... most_impacts impacts of particles at random halves. */
scenario scenario_few(random_source *source, const scenario_ranges *ranges, size_t most_impacts);

/** Solves a scenario into a fresh orbit, which the caller clears whatever the status. */
ric_status scenario_solve(const scenario *s, ric_orbit_solver *solver, ric_orbit *orbit, ric_error *error);

#endif

/* Runs of maps to their attractors for the tests, with all that they store. */
#ifndef RICOCHET_TESTS_MAP_RUNS_H
#define RICOCHET_TESTS_MAP_RUNS_H

#include <ricochet/ricochet.h>

enum { MAP_RUNS_MOST = 200 };

/** Maps of one size with their d and starts, and what came of them. */
typedef struct map_runs {
  size_t count, size;
  ric_attractor_options options;
  const ric_grazing_map *maps[MAP_RUNS_MOST];
  double d[MAP_RUNS_MOST];
  ric_attractor attractors[MAP_RUNS_MOST];
  double *numbers; /* behind the attractors: a piece for each */
  size_t piece;
} map_runs;

/** Starts at z = 0, d = 0 of the same map; map_runs_clear gives back the arrays. */
map_runs map_runs_of(const ric_grazing_map *map, size_t count, const ric_attractor_options *options);
/** The same maps and starts once more, nothing run. @param from, step  of runs: from, from + step, ... modulo count */
map_runs map_runs_again(const map_runs *runs, size_t from, size_t step, size_t count);
void map_runs_clear(map_runs *runs);

/** Runs them; fails the test where that does. */
void map_runs_go(map_runs *runs, ric_map_lanes lanes);

/** Fails the test where two results are not the same bits. */
void assert_same_attractor(const map_runs *a, size_t i, const map_runs *b, size_t k);

#endif

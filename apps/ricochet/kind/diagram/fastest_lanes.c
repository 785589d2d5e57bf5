#define _POSIX_C_SOURCE 200809L
#include "fastest_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

enum { VALUES = 64, ITERATES = 400, REPEATS = 3 };

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A map with windows and chaos, all of whose coefficients count. */
static ric_status make_map(ric_grazing_map *map, size_t size) {
  RIC_TRY(ric_grazing_map_init(map, size, NULL));
  for (size_t i = 0; i < size; i++) {
    map->L[i * size + i] = 0.5 / (1 + (double)i);
    map->eta[i] = i == 0;
    map->xi[i] = 1;
    map->kappa[i] = 3;
  }
  return RIC_OK;
}

/* Storage of the values that are run. */
typedef struct trial {
  ric_grazing_map map;
  const ric_grazing_map *maps[VALUES];
  double d[VALUES];
  ric_attractor attractors[VALUES];
  double *numbers; /* [VALUES][size + exponents] */
} trial;

static void reset(trial *t, size_t size, size_t exponents) {
  for (size_t i = 0; i < VALUES; i++) {
    double *at = t->numbers + i * (size + exponents);
    for (size_t k = 0; k < size; k++)
      at[k] = 0;
    t->maps[i] = &t->map;
    t->d[i] = 1e-4 * exp(0.1 * (double)i);
    t->attractors[i] = (ric_attractor){.z = at, .exponents = at + size};
  }
}

/* The shortest of several runs; INFINITY where there is none. */
static double time_of(trial *t, ric_map_lanes lanes, const ric_attractor_options *o, size_t size) {
  ric_map_runner *runner = NULL;
  double best = INFINITY;
  if (ric_map_runner_create(size, o, lanes, &runner, NULL) != RIC_OK)
    return INFINITY;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    reset(t, size, o->exponents);
    const double began = seconds();
    if (ric_map_runner_run(runner, VALUES, t->maps, t->d, t->attractors, NULL) == RIC_OK)
      best = fmin(best, seconds() - began);
  }
  ric_map_runner_destroy(&runner);
  return best;
}

ric_map_lanes fastest_lanes(size_t size, size_t exponents) {
  trial t = {0};
  ric_attractor_options o = ric_attractor_options_default();
  ric_map_lanes fastest = RIC_MAP_LANES_ONE;
  double best = INFINITY;
  o.transient = o.measure = ITERATES / 2;
  o.keep = 0;
  o.exponents = exponents;
  o.period_limit = 1;
  t.numbers = calloc(VALUES * (size + exponents), sizeof *t.numbers);
  if (t.numbers && make_map(&t.map, size) == RIC_OK)
    for (int lanes = 0; lanes < RIC_MAP_LANES_KINDS; lanes++) {
      const double taken =
          ric_map_lanes_available((ric_map_lanes)lanes) ? time_of(&t, (ric_map_lanes)lanes, &o, size) : INFINITY;
      if (taken < best) {
        best = taken;
        fastest = (ric_map_lanes)lanes;
      }
    }
  ric_grazing_map_clear(&t.map);
  free(t.numbers);
  return fastest;
}

/* What the scenarios of the benchmarks leave out, so that every room of the library is stressed. Each scenario builds
 * all it uses and computes a value, which is to be the same in all bits in every thread. */
#ifndef RICOCHET_TESTS_ROOMS_H
#define RICOCHET_TESTS_ROOMS_H

#include <ricochet/ricochet.h>

typedef struct room_scenario {
  const char *name;
  ric_status (*run)(double *value, ric_error *error);
} room_scenario;

/** Lists that end with a NULL name: periodic motions in closed form, by Ritz's method and in families; grazing motions,
 *  their maps, windows and attractors. */
extern const room_scenario motion_scenarios[], grazing_scenarios[];

#endif

/* A seeded generator of random numbers: the same numbers on every machine, whatever its C library (splitmix64). */
#ifndef RICOCHET_SCENARIO_RANDOM_SOURCE_H
#define RICOCHET_SCENARIO_RANDOM_SOURCE_H

#include <stddef.h>
#include <stdint.h>

typedef struct random_source {
  uint64_t state; /* any number is a seed */
} random_source;

/** Uniform in [low, high). */
double random_uniform(random_source *source, double low, double high);

/** Uniform in 0 ... count - 1, count >= 1. */
size_t random_below(random_source *source, size_t count);

#endif

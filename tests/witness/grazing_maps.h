/* Maps beside grazing for the tests: the example, random ones, and what is made of them. */
#ifndef RICOCHET_TESTS_GRAZING_MAPS_H
#define RICOCHET_TESTS_GRAZING_MAPS_H

#include <ricochet/ricochet.h>

#include "scenario/random_source.h"

/** The example, for ric_grazing_map_clear. */
ric_grazing_map example_map(double lambda, double omega);

/** A map of size 1 with eta = 1, stretch = 1. */
ric_grazing_map map_of_size_1(double L, double xi, double kappa);

/** A map with |L| <= contraction < 1, all coefficients random. */
ric_grazing_map random_map(random_source *source, size_t size, double contraction);

/** Puts S z in the place of z, S a product of shears and scales. */
void map_change_coordinates(ric_grazing_map *map, random_source *source);

/** Iterates z so many times. @param work  [size] */
void map_iterate(const ric_grazing_map *map, double d, double *z, size_t times, double *work);

/** The orbit of a y, which is there. @param z  [size]; may be NULL */
ric_grazing_cycle cycle_of(const ric_grazing_map *map, size_t period, double y, double *z);

/** Largest modulus of a - b over that of b. */
double relative_distance(const double *a, const double *b, size_t size);

#endif

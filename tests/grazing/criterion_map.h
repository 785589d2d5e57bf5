/* Small return maps near grazing, given by their numbers in any coordinates, and their criterion. */
#ifndef RICOCHET_TESTS_CRITERION_MAP_H
#define RICOCHET_TESTS_CRITERION_MAP_H

#include <ricochet/grazing_criterion.h>

#include "scenario/random_source.h"

enum { most_size = 8 };

/** Maps of size n, for ric_grazing_map_clear: zero, with these numbers, and with a diagonal L. */
ric_grazing_map empty_map(size_t n);
ric_grazing_map map_of(size_t n, const double *L, const double *eta, const double *xi);
ric_grazing_map diagonal_map(size_t n, const double *multipliers, const double *eta, const double *xi);

/** L -> S L S^-1, eta -> eta S^-1, xi -> S xi for S [n][n], n <= most_size. */
void change_coordinates(ric_grazing_map *map, const double *S);

/** Rows of a random matrix times powers of ten up to 10^+-decades. */
void random_coordinates(random_source *source, double decades, size_t n, double *S);

/** Its criterion with the default options; asserts that its fields agree with the verdict. */
ric_grazing_criterion find_criterion(const ric_grazing_map *map);

/** The same, and frees the map. */
ric_grazing_criterion find_criterion_once(ric_grazing_map map);

#endif

/* Families followed to a grazing point, for tests. Each function asserts success. */
#ifndef RICOCHET_TESTS_GRAZING_FAMILY_H
#define RICOCHET_TESTS_GRAZING_FAMILY_H

#include <ricochet/ricochet.h>

/** A family with one of its motions, and its grazing point. */
typedef struct grazing_family {
  ric_family *family;
  double *z, from; /* the motion, the parameter */
  ric_grazing grazing;
} grazing_family;

/** Options for increasing steps in a range of the parameter, without multipliers. */
ric_family_options grazing_family_options(double low, double high, double step);

/** The family of a problem, with the motion at a parameter from a guess (ric_family_start). */
grazing_family grazing_family_from(const ric_family_problem *problem, const ric_family_options *options,
                                   double parameter, const double *q, const double *u, const double *times,
                                   double period);
void grazing_family_clear(grazing_family *g);

/** Follows it to its grazing point. */
void grazing_family_find(grazing_family *g);

/** The map on a section, for ric_grazing_map_clear. */
ric_grazing_map grazing_family_map(grazing_family *g, const ric_grazing_plane *plane);

#endif

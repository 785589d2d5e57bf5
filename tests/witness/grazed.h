/* Families followed until they graze, for tests. Each function asserts that it works. */
#ifndef RICOCHET_TESTS_GRAZED_H
#define RICOCHET_TESTS_GRAZED_H

#include <ricochet/ricochet.h>

/** A family with a motion of it, and where it grazes. */
typedef struct grazed {
  ric_family *family;
  double *z, from; /* the motion, the parameter */
  ric_grazing grazing;
} grazed;

/** Steps in a range of the parameter, upwards, without multipliers. */
ric_family_options grazed_within(double low, double high, double step);

/** The family of a problem, with the motion at a parameter from a guess (ric_family_start). */
grazed grazed_from(const ric_family_problem *problem, const ric_family_options *options, double parameter,
                   const double *q, const double *u, const double *times, double period);
void grazed_clear(grazed *g);

/** Follows it until it grazes. */
void grazed_find(grazed *g);

/** The map on a section, for ric_grazing_map_clear. */
ric_grazing_map grazed_map(grazed *g, const ric_grazing_plane *plane);

#endif

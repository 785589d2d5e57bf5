/* A motion beyond grazing beside what the return map says of it. */
#ifndef RICOCHET_APP_COMPARISON_H
#define RICOCHET_APP_COMPARISON_H

#include "diagram.h"

/** Runs the map for the present task and says of the row, in which the attractor of the motion stands, what it finds.
 *  @param error  why there is no map, which the row may borrow as its reason
 *  @returns RIC_OK, also where there is no map; RIC_ESTOPPED */
ric_status comparison_put(iterated *it, diagram_row *row, ric_error *error);

/** Hausdorff distance of two sets of numbers, over the extent of the second: how far the one that is farthest from all
 *  of the other set is from those. NaN where one of them is not finite.
 *  @param a, b  [count] sorted here */
double comparison_distance(double *a, double *b, size_t count);

#endif

/* Derivatives along a path by differences: internal to the library. */
#ifndef RICOCHET_PATH_DERIVATIVE_H
#define RICOCHET_PATH_DERIVATIVE_H

#include <stddef.h>

/** A function of one variable: writes its values at s; returns NULL, or the reason of a failure. */
typedef const char *(*path_function)(void *path, double s, double *value);

/** Derivatives [size] at s = 0 of a function with `size` values: central differences with steps `step` and half of it,
 *  Richardson extrapolated, error step^4 / 480 times the fifth derivative. Four calls; the value at 0 is not needed.
 *  @param work  [2][size]; NULL for size 1 */
const char *path_derivative(path_function function, void *path, double step, size_t size, double *derivative,
                            double *work);

#endif

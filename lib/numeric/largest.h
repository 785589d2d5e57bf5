/* The largest number of a list: internal to the library. */
#ifndef RICOCHET_LARGEST_H
#define RICOCHET_LARGEST_H

#include <math.h>
#include <stddef.h>

/** Largest absolute value of x [count]; 0 for none, and NaN does not count. */
static inline double largest(const double *x, size_t count) {
  double most = 0;
  for (size_t i = 0; i < count; i++)
    most = fmax(most, fabs(x[i]));
  return most;
}

#endif

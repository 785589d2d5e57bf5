/* Lists of numbers: their largest entry, their product. Internal to the library. */
#ifndef RICOCHET_VECTOR_H
#define RICOCHET_VECTOR_H

#include <math.h>
#include <stddef.h>

/** Largest absolute value of x [count]; 0 if empty. NaN is ignored. */
static inline double largest(const double *x, size_t count) {
  double most = 0;
  for (size_t i = 0; i < count; i++)
    most = fmax(most, fabs(x[i]));
  return most;
}

/** x . y [count], summed in order. */
static inline double dot(const double *x, const double *y, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++)
    sum += x[i] * y[i];
  return sum;
}

#endif

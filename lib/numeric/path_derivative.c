#include "path_derivative.h"

#include <stddef.h>

/* Central difference. */
static const char *slope(path_function function, void *path, double step, size_t size, double *out, double *below) {
  const char *trouble = function(path, step, out);
  if (!trouble)
    trouble = function(path, -step, below);
  for (size_t i = 0; i < size && !trouble; i++)
    out[i] = (out[i] - below[i]) / (2 * step);
  return trouble;
}

const char *path_derivative(path_function function, void *path, double step, size_t size, double *derivative,
                            double *work) {
  double one[2], *coarse = work ? work : one, *below = coarse + size;
  const char *trouble = slope(function, path, step, size, coarse, below);
  if (!trouble)
    trouble = slope(function, path, step / 2, size, derivative, below);
  for (size_t i = 0; i < size && !trouble; i++)
    derivative[i] += (derivative[i] - coarse[i]) / 3;
  return trouble;
}

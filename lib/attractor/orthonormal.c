#include "orthonormal.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double put_out = 1e-13; /* what is left of a vector, over it, that counts as rounding */

ric_status orthonormal_init(orthonormal_work *w, size_t size, size_t count, ric_error *error) {
  *w = (orthonormal_work){.size = size, .count = count, .columns = malloc(size * count * sizeof *w->columns)};
  return w->columns ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors", count);
}

void orthonormal_clear(orthonormal_work *w) {
  free(w->columns);
  w->columns = NULL;
}

static double dot(const double *a, const double *b, size_t size) {
  double sum = 0;
  for (size_t i = 0; i < size; i++)
    sum += a[i] * b[i];
  return sum;
}

static void subtract(double *a, double factor, const double *b, size_t size) {
  for (size_t i = 0; i < size; i++)
    a[i] -= factor * b[i];
}

static void scale(double *a, double factor, size_t size) {
  for (size_t i = 0; i < size; i++)
    a[i] *= factor;
}

/* Largest entry: vectors are scaled by it first, so that squares stay in the range of numbers. */
static double largest(const double *a, size_t size) {
  double most = 0;
  for (size_t i = 0; i < size; i++)
    most = fmax(most, fabs(a[i]));
  return most;
}

/* Makes column k a unit vector orthogonal to those before it; returns the logarithm of what was left of it. */
static double make_column(const orthonormal_work *w, size_t k) {
  double *a = w->columns + k * w->size, most = largest(a, w->size);
  if (!(most > 0))
    return -INFINITY;
  scale(a, 1 / most, w->size);
  double before = sqrt(dot(a, a, w->size));
  for (int pass = 0; pass < 2; pass++)
    for (size_t j = 0; j < k; j++) {
      const double *b = w->columns + j * w->size;
      subtract(a, dot(a, b, w->size), b, w->size);
    }
  double left = sqrt(dot(a, a, w->size));
  bool gone = !(left > put_out * before);
  scale(a, gone ? 0 : 1 / left, w->size);
  return gone ? -INFINITY : log(most) + log(left);
}

void orthonormal_make(orthonormal_work *w, double *x, double *growth) {
  for (size_t i = 0; i < w->size; i++)
    for (size_t k = 0; k < w->count; k++)
      w->columns[k * w->size + i] = x[i * w->count + k];
  for (size_t k = 0; k < w->count; k++)
    growth[k] = make_column(w, k);
  for (size_t i = 0; i < w->size; i++)
    for (size_t k = 0; k < w->count; k++)
      x[i * w->count + k] = w->columns[k * w->size + i];
}

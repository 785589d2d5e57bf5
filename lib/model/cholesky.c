#include "cholesky.h"

#include <math.h>

/* A pivot that has lost all but this part of its diagonal entry is rounding. */
static const double dependent = 1e-12;

/* Row i of L below its diagonal; returns what is left of the diagonal entry. */
static double eliminate_row(double *a, size_t n, size_t i) {
  double *row = a + i * n, pivot = row[i];
  for (size_t j = 0; j < i; j++) {
    const double *above = a + j * n;
    double sum = row[j];
    for (size_t k = 0; k < j; k++)
      sum -= row[k] * above[k];
    row[j] = sum / above[j];
    pivot -= row[j] * row[j];
  }
  return pivot;
}

bool cholesky_factor(double *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double pivot = eliminate_row(a, n, i);
    if (!(pivot > 0 && pivot < INFINITY))
      return false;
    a[i * n + i] = sqrt(pivot);
  }
  return true;
}

void cholesky_factor_semidefinite(double *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double size = a[i * n + i], pivot = eliminate_row(a, n, i);
    a[i * n + i] = pivot > dependent * size ? sqrt(pivot) : INFINITY;
  }
}

void cholesky_solve(const double *factor, size_t n, double *x) {
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < i; k++)
      x[i] -= factor[i * n + k] * x[k];
    x[i] /= factor[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; k++)
      x[i] -= factor[k * n + i] * x[k];
    x[i] /= factor[i * n + i];
  }
}

#include "cholesky.h"

#include <math.h>

/* A pivot that has lost all but this part of its diagonal entry is rounding. */
static const double dependent = 1e-12;

void cholesky_solve_lower(const double *factor, size_t stride, size_t n, double *x) {
  for (size_t i = 0; i < n; i++) {
    const double *row = factor + i * stride;
    for (size_t k = 0; k < i; k++)
      x[i] -= row[k] * x[k];
    x[i] /= row[i];
  }
}

void cholesky_solve_upper(const double *factor, size_t stride, size_t n, double *x) {
  for (size_t i = n; i-- > 0;) {
    const double *row = factor + i * stride;
    x[i] /= row[i];
    for (size_t k = 0; k < i; k++)
      x[k] -= row[k] * x[i];
  }
}

void cholesky_solve(const double *factor, size_t n, double *x) {
  cholesky_solve_lower(factor, n, n, x);
  cholesky_solve_upper(factor, n, n, x);
}

double cholesky_row(double *a, size_t stride, size_t i) {
  double *row = a + i * stride, pivot = row[i];
  cholesky_solve_lower(a, stride, i, row);
  for (size_t k = 0; k < i; k++)
    pivot -= row[k] * row[k];
  return pivot;
}

bool cholesky_factor(double *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double pivot = cholesky_row(a, n, i);
    if (!(pivot > 0 && pivot < INFINITY))
      return false;
    a[i * n + i] = sqrt(pivot);
  }
  return true;
}

void cholesky_factor_semidefinite(double *a, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double size = a[i * n + i], pivot = cholesky_row(a, n, i);
    a[i * n + i] = pivot > dependent * size ? sqrt(pivot) : INFINITY;
  }
}

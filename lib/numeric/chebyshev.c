#include "chebyshev.h"
#include "constants.h"

#include <math.h>

double chebyshev_point(int k, int degree) {
  return (1 - cos(pi * k / degree)) / 2;
}

void chebyshev_coefficients(const double *values, int degree, double *a) {
  for (int j = 0; j <= degree; j++) {
    double sum = 0;
    for (int k = 0; k <= degree; k++) {
      double weight = k == 0 || k == degree ? 0.5 : 1;
      sum += weight * values[k] * cos(pi * j * (degree - k) / degree); /* x = 0 is the angle pi */
    }
    a[j] = sum * (j == 0 || j == degree ? 1 : 2) / degree;
  }
}

/* By T_{j+1} = 2 (2 x - 1) T_j - T_{j-1}. */
void chebyshev_to_powers(const double *a, int degree, double *c) {
  double before[CHEBYSHEV_DEGREE + 1] = {1}, now[CHEBYSHEV_DEGREE + 1] = {-1, 2};
  for (int i = 0; i <= degree; i++)
    c[i] = a[0] * before[i] + a[1] * now[i];
  for (int j = 2; j <= degree; j++)
    for (int i = j; i >= 0; i--) {
      double next = (i > 0 ? 4 * now[i - 1] : 0) - 2 * now[i] - before[i];
      before[i] = now[i];
      now[i] = next;
      c[i] += a[j] * next;
    }
}

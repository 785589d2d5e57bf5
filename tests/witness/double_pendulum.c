#include "double_pendulum.h"

#include <math.h>

int double_pendulum_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)user;
  M[0] = 2;
  M[1] = M[2] = cos(q[0] - q[1]);
  M[3] = 1;
  return 0;
}

int double_pendulum_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)user;
  double s = sin(q[0] - q[1]);
  f[0] = -s * u[1] * u[1] - 2 * sin(q[0]);
  f[1] = s * u[0] * u[0] - sin(q[1]);
  return 0;
}

void double_pendulum_solve(const double *q, const double *f, double *a) {
  double c = cos(q[0] - q[1]), det = 2 - c * c;
  a[0] = (f[0] - c * f[1]) / det;
  a[1] = (-c * f[0] + 2 * f[1]) / det;
}

void double_pendulum_hit(const double *q, double restitution, double gap_rate, double *u) {
  double g[2] = {-cos(q[0]), -cos(q[1])}, w[2];
  double_pendulum_solve(q, g, w);
  double p = -(1 + restitution) * gap_rate / (g[0] * w[0] + g[1] * w[1]);
  u[0] += p * w[0];
  u[1] += p * w[1];
}

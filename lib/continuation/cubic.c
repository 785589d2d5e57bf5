#include "cubic.h"

#include <math.h>

/* d x_i / d sigma at both ends */
typedef struct slopes {
  double scale_a, scale_b, length;
} slopes;

static slopes slopes_of(const cubic *q) {
  return (slopes){.scale_a = 1 / curve_row_dot(q->c, q->row, q->a->t),
                  .scale_b = 1 / curve_row_dot(q->c, q->row, q->b->t),
                  .length = q->b->sigma - q->a->sigma};
}

void cubic_point(const cubic *q, double sigma, double *x) {
  slopes s = slopes_of(q);
  double f = (sigma - q->a->sigma) / s.length, g = 1 - f;
  double to_b = f * f * (3 - 2 * f), of_a = f * g * g * s.length * s.scale_a, of_b = -f * f * g * s.length * s.scale_b;
  for (size_t i = 0; i < q->c->linear.size; i++)
    x[i] = q->a->x[i] + to_b * (q->b->x[i] - q->a->x[i]) + of_a * q->a->t[i] + of_b * q->b->t[i];
}

static void derivative(const cubic *q, double sigma, double *t) {
  slopes s = slopes_of(q);
  double f = (sigma - q->a->sigma) / s.length, g = 1 - f;
  double chord = 6 * f * g / s.length, of_a = g * (1 - 3 * f) * s.scale_a, of_b = f * (3 * f - 2) * s.scale_b;
  for (size_t i = 0; i < q->c->linear.size; i++)
    t[i] = chord * (q->b->x[i] - q->a->x[i]) + of_a * q->a->t[i] + of_b * q->b->t[i];
}

void cubic_tangent(const cubic *q, double sigma, double *t) {
  derivative(q, sigma, t);
  double length = curve_norm(q->c, t);
  for (size_t i = 0; i < q->c->linear.size; i++)
    t[i] /= length;
}

double cubic_length(const cubic *q) {
  slopes s = slopes_of(q);
  derivative(q, q->a->sigma + s.length / 2, q->c->z);
  return s.length * (fabs(s.scale_a) + 4 * curve_norm(q->c, q->c->z) + fabs(s.scale_b)) / 6;
}

double cubic_mismatch(const cubic *q) {
  slopes s = slopes_of(q);
  double *z = q->c->z;
  for (size_t i = 0; i < q->c->linear.size; i++)
    z[i] = q->b->x[i] - q->a->x[i] - s.length / 2 * (s.scale_a * q->a->t[i] + s.scale_b * q->b->t[i]);
  return curve_norm(q->c, z);
}

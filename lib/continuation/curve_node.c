/* Points of a curve, and the products of their vectors. */
#include "curve.h"

#include <math.h>
#include <string.h>

double curve_dot(const ric_curve *c, const double *a, const double *b) {
  size_t n = c->problem.unknowns;
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum / (double)n + a[n] * b[n];
}

double curve_norm(const ric_curve *c, const double *a) {
  return sqrt(curve_dot(c, a, a));
}

double curve_distance(const ric_curve *c, const double *a, const double *b) {
  size_t n = c->problem.unknowns;
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum / (double)n + (a[n] - b[n]) * (a[n] - b[n]));
}

double curve_row_dot(const ric_curve *c, const double *row, const double *x) {
  double sum = 0;
  for (size_t i = 0; i < c->linear.size; i++)
    sum += row[i] * x[i];
  return sum;
}

double curve_progress(ric_curve *c, const double *x) {
  for (size_t i = 0; i < c->linear.size; i++)
    c->z[i] = x[i] - c->from.x[i];
  return curve_row_dot(c, c->row, c->z);
}

void curve_tangent_row(const ric_curve *c, const double *t, double *row) {
  size_t n = c->problem.unknowns;
  for (size_t i = 0; i < n; i++)
    row[i] = t[i] / (double)n;
  row[n] = t[n];
}

void curve_parameter_row(const ric_curve *c, double sign, double *row) {
  memset(row, 0, c->linear.size * sizeof *row);
  row[c->problem.unknowns] = sign > 0 ? 1 : -1;
}

void curve_node_copy(const ric_curve *c, curve_node *to, const curve_node *from) {
  double *x = to->x, *t = to->t, *tests = to->tests;
  memcpy(x, from->x, c->linear.size * sizeof *x);
  memcpy(t, from->t, c->linear.size * sizeof *t);
  if (c->problem.tests)
    memcpy(tests, from->tests, c->problem.tests * sizeof *tests);
  *to = *from;
  to->x = x;
  to->t = t;
  to->tests = tests;
}

ric_status curve_tests(ric_curve *c, curve_node *node, ric_error *error) {
  const ric_curve_problem *problem = &c->problem;
  size_t n = problem->unknowns;
  if (problem->tests == 0)
    return RIC_OK;
  error->message[0] = '\0';
  ric_status status = problem->test(node->x, node->x[n], node->t, node->t[n], node->tests, problem->user, error);
  if (status != RIC_OK && error->message[0] == '\0')
    return ric_fail(error, status, "no test functions at p = %.9g: %s", node->x[n], ric_status_text(status));
  return status;
}

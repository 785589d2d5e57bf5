/* Points of a curve, products of their vectors, and the workspace of a continuation. */
#include "curve.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points of a curve, and the products of their vectors. */

/** <a, b> = a_u . b_u / n + a_p b_p of vectors [n + 1]. */
static double curve_dot(const ric_curve *c, const double *a, const double *b) {
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

static const size_t most_numbers = (size_t)1 << 20; /* unknowns and test functions: the squares do not overflow */

const char *ric_curve_point_name(ric_curve_point_kind kind) {
  switch (kind) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_CURVE_POINT_LIST(X)
#undef X
  case RIC_CURVE_POINT_KINDS:
    break;
  }
  return "unknown kind";
}

const char *ric_curve_end_name(ric_curve_end end) {
  switch (end) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_CURVE_END_LIST(X)
#undef X
  case RIC_CURVE_ENDS:
    break;
  }
  return "unknown end";
}

ric_curve_options ric_curve_options_default(void) {
  return (ric_curve_options){.p_low = -INFINITY,
                             .p_high = INFINITY,
                             .step = 0.01,
                             .step_least = 1e-8,
                             .step_most = 0.1,
                             .direction = 1,
                             .points = 1000,
                             .newton_tol = 1e-12,
                             .iterations = 8,
                             .turn = 0.3,
                             .locate_tol = 1e-10};
}

static ric_status check_steps(const ric_curve_options *o, ric_error *error) {
  if (!(o->p_low < o->p_high))
    return ric_fail(error, RIC_EINVAL, "p_low = %g, p_high = %g, expected p_low < p_high", o->p_low, o->p_high);
  if (!(o->step_least > 0))
    return ric_fail(error, RIC_EINVAL, "step_least = %g, expected > 0", o->step_least);
  if (!(o->step >= o->step_least))
    return ric_fail(error, RIC_EINVAL, "step = %g, expected >= step_least = %g", o->step, o->step_least);
  if (!(o->step_most >= o->step && o->step_most < INFINITY))
    return ric_fail(error, RIC_EINVAL, "step_most = %g, expected a finite number >= step = %g", o->step_most, o->step);
  if (!(fabs(o->direction) > 0))
    return ric_fail(error, RIC_EINVAL, "direction = %g, expected a number > 0 or < 0", o->direction);
  return RIC_OK;
}

static ric_status check_curve(const ric_curve_problem *problem, const ric_curve_options *o, ric_error *error) {
  if (problem->unknowns < 1 || !problem->residual)
    return ric_fail(error, RIC_EINVAL, "a problem of %zu unknowns%s, expected at least 1 and a residual",
                    problem->unknowns, problem->residual ? "" : " without a residual");
  if (problem->tests > 0 && !problem->test)
    return ric_fail(error, RIC_EINVAL, "tests = %zu without a callback for them", problem->tests);
  if (problem->unknowns > most_numbers || problem->tests > most_numbers)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu unknowns and %zu tests", problem->unknowns, problem->tests);
  RIC_TRY(check_steps(o, error));
  if (!(o->newton_tol > 0 && o->newton_tol < 1))
    return ric_fail(error, RIC_EINVAL, "newton_tol = %g, expected 0 < newton_tol < 1", o->newton_tol);
  if (o->iterations < 1)
    return ric_fail(error, RIC_EINVAL, "iterations = %d, expected >= 1", o->iterations);
  if (!(o->turn > 0 && o->turn <= 1))
    return ric_fail(error, RIC_EINVAL, "turn = %g, expected 0 < turn <= 1 (radians)", o->turn);
  if (o->points < 1)
    return ric_fail(error, RIC_EINVAL, "points = 0, expected at least 1");
  if (!(o->locate_tol > 0 && o->locate_tol < 1))
    return ric_fail(error, RIC_EINVAL, "locate_tol = %g, expected 0 < locate_tol < 1", o->locate_tol);
  return RIC_OK;
}

static double *place_node(const ric_curve *c, curve_node *node, double *block) {
  node->x = block;
  node->t = node->x + c->linear.size;
  node->tests = node->t + c->linear.size;
  return node->tests + c->problem.tests;
}

static ric_status allocate_curve(ric_curve *c, ric_error *error) {
  size_t n = c->problem.unknowns, size = n + 1, tests = c->problem.tests;
  size_t nodes = tests + 2 + 6 + CURVE_PAST, numbers = bordered_numbers(n) + 3 * size + nodes * (2 * size + tests);
  c->block = calloc(numbers, sizeof *c->block);
  c->linear.permutation = calloc(size, sizeof *c->linear.permutation);
  c->found = calloc(tests + 2, sizeof *c->found);
  keep_gsl_quiet();
  c->brent = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!c->block || !c->linear.permutation || !c->found || !c->brent)
    return ric_fail(error, RIC_ENOMEM, "no memory for a curve of %zu unknowns and %zu tests", n, tests);
  c->row = bordered_place(&c->linear, n, c->block);
  c->bound_row = c->row + size;
  c->z = c->bound_row + size;
  double *rest = c->z + size;
  curve_node *single[] = {&c->start, &c->from, &c->to, &c->trial, &c->low, &c->high};
  for (size_t k = 0; k < sizeof single / sizeof *single; k++)
    rest = place_node(c, single[k], rest);
  for (size_t k = 0; k < CURVE_PAST; k++)
    rest = place_node(c, &c->past[k], rest);
  for (size_t k = 0; k < tests + 2; k++)
    rest = place_node(c, &c->found[k], rest);
  return RIC_OK;
}

void ric_curve_destroy(ric_curve **curve) {
  if (!curve || !*curve)
    return;
  free((*curve)->block);
  free((*curve)->linear.permutation);
  free((*curve)->found);
  if ((*curve)->brent)
    gsl_root_fsolver_free((*curve)->brent);
  free(*curve);
  *curve = NULL;
}

ric_status ric_curve_create(const ric_curve_problem *problem, const ric_curve_options *options, ric_curve **curve,
                            ric_error *error) {
  REQUIRE(error, {"problem", problem}, {"curve", curve});
  ric_curve_options o = options ? *options : ric_curve_options_default();
  RIC_TRY(check_curve(problem, &o, error));
  ric_curve *c = calloc(1, sizeof *c);
  if (!c)
    return ric_fail(error, RIC_ENOMEM, "no memory for a curve");
  c->problem = *problem;
  c->options = o;
  c->linear.problem = &c->problem;
  c->linear.poll = o.poll;
  ric_status status = allocate_curve(c, error);
  if (status != RIC_OK)
    ric_curve_destroy(&c);
  else
    *curve = c;
  return status;
}

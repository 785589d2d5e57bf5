/* Special points: where test functions change sign along a step, and the tangents at branch points. */
#include "curve.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "corrector.h"
#include "ricochet/elementary.h"
#include "step.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* The bracket is bisected by corrected points to this fraction of the step. There the cubic through its ends replaces
 * the curve: a step turns by less than 1, so the error is at most about (1/256)^4 / 384 = 6e-13 of the radius of
 * curvature, and, unlike Newton's method, the cubic is not affected by the singular matrix at a branch point. */
static const double shortest = 1.0 / 256;

static const int most_trials = 100; /* of Brent's method, which bisects at least every other time */

/* Least distance of a trial from a branch point, relative to that of the ends of the bracket. */
static const double too_near = 0.1;

/* Largest value of a function at its zero, relative to its values at the ends of the bracket; otherwise it jumps. */
static const double jump = 0.1;

typedef struct search {
  ric_curve *c;
  ric_curve_point_kind kind;
  size_t which;
  double log_scale; /* of the determinant */
  ric_error *error;
  ric_status status; /* of the last evaluation */
} search;

static double value_of(const search *s, const curve_node *node) {
  switch (s->kind) {
  case RIC_CURVE_FOLD:
    return node->t[s->c->problem.unknowns];
  case RIC_CURVE_BRANCH_POINT:
    return node->det.sign ? node->det.sign * ric_exp(node->det.log - s->log_scale) : NAN;
  default:
    return node->tests[s->which];
  }
}

/* A zero at the end of a step belongs to it, not to the next one. NaN has no sign. */
static bool sign_changes(double a, double b) {
  return (a < 0 && b >= 0) || (a > 0 && b <= 0);
}

static cubic bracket_cubic(const search *s) {
  return (cubic){s->c, s->c->row, &s->c->low, &s->c->high};
}

/* Predicts a node by the cubic of the bracket. */
static void predict(const search *s, double sigma, curve_node *node) {
  cubic q = bracket_cubic(s);
  cubic_point(&q, sigma, node->x);
  cubic_tangent(&q, sigma, node->t);
  node->sigma = sigma;
}

/* Whether the bracket contains a branch point, near which the corrector is unreliable. */
static bool holds_branch_point(const ric_curve *c) {
  return c->low.det.sign * c->high.det.sign <= 0;
}

/* Near a branch point the remaining Newton error is amplified in the tangent: another correction removes it.
 */
static ric_status correct(const search *s, curve_node *node) {
  ric_curve *c = s->c;
  int again;
  RIC_TRY(corrector_run(c, c->row, node->x, true, &node->iterations, s->error));
  if (holds_branch_point(c))
    RIC_TRY(corrector_run(c, c->row, node->x, true, &again, s->error));
  RIC_TRY(corrector_tangent(c, node->t, &node->det, s->error));
  return curve_tests(c, node, s->error);
}

static bool near_branch_point(const ric_curve *c) {
  return !(c->trial.det.least >= too_near * fmax(c->low.det.least, c->high.det.least));
}

/* A corrected node well inside the bracket. A second point is tried, since the first may be a branch point. */
static ric_status trial_inside(const search *s) {
  static const double places[] = {0.5, 0.3};
  const ric_curve *c = s->c;
  ric_status status = RIC_OK;
  for (int k = 0; k < 2; k++) {
    predict(s, c->low.sigma + places[k] * (c->high.sigma - c->low.sigma), &s->c->trial);
    status = correct(s, &s->c->trial);
    if (status == RIC_OK && holds_branch_point(c) && near_branch_point(c))
      status = ric_fail(s->error, RIC_ENUMERIC, "a trial at a branch point");
    if (status != RIC_ENUMERIC)
      break;
  }
  return status;
}

/* Whether the correction of the trial, where the error of the bracket's cubic is about largest, is within the accuracy
 * of points. This does not bound the error of the cubic's tangent, and is no test near a branch point, where
 * corrections are inaccurate. */
static bool cubic_suffices(const search *s) {
  ric_curve *c = s->c;
  if (s->kind != RIC_CURVE_TEST || holds_branch_point(c))
    return false;
  cubic q = bracket_cubic(s);
  cubic_point(&q, c->trial.sigma, c->z);
  return curve_distance(c, c->z, c->trial.x) <= c->options.locate_tol * (1 + curve_norm(c, c->trial.x));
}

/* Shortens the bracket as far as the corrector converges.
 * @param found  whether the function is defined at all trials */
static ric_status shorten(const search *s, bool *found) {
  ric_curve *c = s->c;
  double end = fmax(shortest * (c->high.sigma - c->low.sigma), c->options.locate_tol);
  bool exact = false;
  *found = true;
  while (c->high.sigma - c->low.sigma > end && *found && !exact) {
    ric_status status = trial_inside(s);
    if (status == RIC_ENUMERIC)
      return RIC_OK;
    RIC_TRY(status);
    double value = value_of(s, &c->trial);
    *found = !isnan(value);
    exact = cubic_suffices(s);
    curve_node_copy(c, sign_changes(value_of(s, &c->low), value) ? &c->high : &c->low, &c->trial);
  }
  return RIC_OK;
}

/* Whether Newton's method has hardly moved a point, as it does where it converges. */
static bool correction_is_small(const ric_curve *c, const curve_node *before, const curve_node *after) {
  return curve_distance(c, before->x, after->x) <= c->options.locate_tol * (1 + curve_norm(c, before->x));
}

/* An end of the bracket that is still a point of the run is corrected once more if the function depends on the factors
 * there: its tangent is as accurate as its last correction was small, which is not enough for a nearby zero. */
static ric_status sharpen(const search *s, curve_node *end, const curve_node *walked) {
  ric_curve *c = s->c;
  if (s->kind == RIC_CURVE_TEST || end->sigma != walked->sigma)
    return RIC_OK;
  curve_node_copy(c, &c->trial, end);
  ric_status status = correct(s, &c->trial);
  if (status == RIC_OK && correction_is_small(c, end, &c->trial) && value_of(s, end) * value_of(s, &c->trial) > 0)
    curve_node_copy(c, end, &c->trial);
  return status == RIC_ENUMERIC ? RIC_OK : status;
}

/* The determinant with the cubic's tangent as the row; zero where the matrix is exactly singular. */
static ric_status determinant_at(const search *s, curve_node *node) {
  ric_curve *c = s->c;
  curve_tangent_row(c, node->t, c->bound_row);
  ric_status status = bordered_factor(&c->linear, node->x, c->bound_row, s->error);
  node->det = status == RIC_OK ? bordered_det(&c->linear) : (bordered_determinant){0};
  return status == RIC_ENUMERIC && c->linear.singular ? RIC_OK : status;
}

/* The function on the cubic, for the solver of GSL, which stops at NaN. */
static double value_on_cubic(double sigma, void *user) {
  search *s = user;
  curve_node *node = &s->c->trial;
  if (sigma == s->c->low.sigma)
    return value_of(s, &s->c->low);
  if (sigma == s->c->high.sigma)
    return value_of(s, &s->c->high);
  predict(s, sigma, node);
  s->status = RIC_OK;
  if (s->kind == RIC_CURVE_BRANCH_POINT) {
    s->status = determinant_at(s, node);
    if (s->status == RIC_OK && s->c->linear.singular)
      return 0;
  } else if (s->kind == RIC_CURVE_TEST) {
    s->status = curve_tests(s->c, node, s->error);
  }
  return s->status == RIC_OK ? value_of(s, node) : NAN;
}

/* Brent's method on the bracket. @returns the zero, NaN if there is none */
static double zero_of(search *s) {
  const ric_curve *c = s->c;
  gsl_function f = {value_on_cubic, s};
  double low = c->low.sigma, high = c->high.sigma, p = c->low.x[c->problem.unknowns], root = high;
  double tol = fmin(c->options.locate_tol * (1 + fabs(p)), 1e-3 * (high - low));
  double most = fmax(fabs(value_of(s, &c->low)), fabs(value_of(s, &c->high)));
  int code = gsl_root_fsolver_set(c->brent, &f, low, high);
  for (int k = 0; k < most_trials && code == GSL_SUCCESS && high - low > tol; k++) {
    code = gsl_root_fsolver_iterate(c->brent);
    root = gsl_root_fsolver_root(c->brent);
    low = gsl_root_fsolver_x_lower(c->brent);
    high = gsl_root_fsolver_x_upper(c->brent);
  }
  return code == GSL_SUCCESS && fabs(value_on_cubic(root, s)) <= jump * most ? root : NAN;
}

/* Sets a node to the special point: on the cubic at a branch point, otherwise corrected. */
static ric_status place_special(search *s, double sigma, curve_node *node) {
  ric_curve *c = s->c;
  predict(s, sigma, node);
  node->kind = s->kind;
  node->which = s->which;
  node->det = (bordered_determinant){0};
  node->iterations = 0;
  if (!holds_branch_point(c))
    return correct(s, node);
  return curve_tests(c, node, s->error);
}

/* One sign change between `from` and `to`. @param found  whether `node` has been set to the zero */
static ric_status locate(search *s, curve_node *node, bool *found) {
  ric_curve *c = s->c;
  curve_node_copy(c, &c->low, &c->from);
  curve_node_copy(c, &c->high, &c->to);
  s->status = RIC_OK;
  RIC_TRY(shorten(s, found));
  RIC_TRY(sharpen(s, &c->low, &c->from));
  RIC_TRY(sharpen(s, &c->high, &c->to));
  double sigma = *found ? zero_of(s) : NAN;
  *found = !isnan(sigma);
  if (s->status != RIC_OK && s->status != RIC_ENUMERIC)
    return s->status;
  ric_status status = *found ? place_special(s, sigma, node) : RIC_OK;
  *found = *found && status == RIC_OK;
  return status == RIC_ENUMERIC ? RIC_OK : status;
}

/* Inserts the last of the special points in order among the previous ones. */
static void sort_in(curve_node *found, size_t count) {
  for (size_t k = count - 1; k > 0 && found[k].sigma < found[k - 1].sigma; k--) {
    curve_node last = found[k];
    found[k] = found[k - 1];
    found[k - 1] = last;
  }
}

static ric_status search_zero(search *s, size_t *count, size_t *missed) {
  ric_curve *c = s->c;
  bool found;
  if (!sign_changes(value_of(s, &c->from), value_of(s, &c->to)))
    return RIC_OK;
  RIC_TRY(locate(s, &c->found[*count], &found));
  if (!found) {
    ++*missed;
    return RIC_OK;
  }
  cubic q = {c, c->row, &c->from, &c->found[*count]};
  c->found[*count].arclength = c->from.arclength + cubic_length(&q);
  sort_in(c->found, ++*count);
  return RIC_OK;
}

ric_status locate_special(ric_curve *c, size_t *count, size_t *missed, ric_error *error) {
  search s = {.c = c, .error = error, .log_scale = fmax(c->from.det.log, c->to.det.log)};
  *count = 0;
  for (s.kind = RIC_CURVE_FOLD; s.kind <= RIC_CURVE_BRANCH_POINT; s.kind++)
    RIC_TRY(search_zero(&s, count, missed));
  s.kind = RIC_CURVE_TEST;
  for (s.which = 0; s.which < c->problem.tests; s.which++)
    RIC_TRY(search_zero(&s, count, missed));
  return RIC_OK;
}

/* The algebraic branching equation at a simple branch point.
 *
 * There the kernel of (J, F_p) has two dimensions, spanned by the known tangent t and phi, and its rows one relation,
 * psi. Tangents v = alpha t + beta phi of branches satisfy psi . F_xx[v, v] = 0; t is one of the two solutions, so that
 * the other is 2 alpha psi . F_xx[t, phi] + beta psi . F_xx[phi, phi] = 0. */

/* Largest ratio of the smallest singular value of the bordered Jacobian to the next; otherwise it is regular, or twice
 * singular. */
static const double singular = 1e-4;

/* Least relative size of the coefficients of the equation; otherwise the other tangent is that of the known branch. */
static const double transversal = 1e-6;

typedef struct null_space {
  gsl_matrix *u, *v;
  gsl_vector *s, *work;
  gsl_vector *phi, *psi; /* [n + 1]; psi ends with 0 */
  gsl_vector *change;    /* [n + 1] */
} null_space;

static ric_status create(null_space *k, size_t size, ric_error *error) {
  k->u = gsl_matrix_alloc(size, size);
  k->v = gsl_matrix_alloc(size, size);
  gsl_vector **vectors[] = {&k->s, &k->work, &k->phi, &k->psi, &k->change};
  bool all = k->u && k->v;
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    all = (*vectors[i] = gsl_vector_alloc(size)) != NULL && all;
  return all ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for the null vectors of a matrix of size %zu", size);
}

static void clear(null_space *k) {
  gsl_vector *vectors[] = {k->s, k->work, k->phi, k->psi, k->change};
  if (k->u)
    gsl_matrix_free(k->u);
  if (k->v)
    gsl_matrix_free(k->v);
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    if (vectors[i])
      gsl_vector_free(vectors[i]);
}

/* A row of (J, F_p) of the problem times a vector. */
static double row_times(const ric_curve *c, size_t i, const double *v) {
  size_t n = c->problem.unknowns;
  double sum = c->linear.F_p[i] * v[n];
  for (size_t j = 0; j < n; j++)
    sum += c->linear.J[i * n + j] * v[j];
  return sum;
}

/* Evaluates the Jacobian; a singular one is no failure here. */
static ric_status jacobian_at(ric_curve *c, const double *x, ric_error *error) {
  ric_status status = bordered_factor(&c->linear, x, c->bound_row, error);
  return status == RIC_ENUMERIC && c->linear.singular ? RIC_OK : status;
}

/* The null vectors of the Jacobian bordered by the tangent: of smallest singular value. */
static ric_status find_null_vectors(ric_curve *c, null_space *k, ric_error *error) {
  size_t n = c->problem.unknowns, size = n + 1;
  for (size_t i = 0; i < n; i++) {
    memcpy(k->u->data + i * k->u->tda, c->linear.J + i * n, n * sizeof(double));
    gsl_matrix_set(k->u, i, n, c->linear.F_p[i]);
  }
  memcpy(k->u->data + n * k->u->tda, c->bound_row, size * sizeof(double));
  int code = gsl_linalg_SV_decomp(k->u, k->v, k->s, k->work);
  if (code)
    return ric_fail(error, gsl_status(code), "singular values of size %zu: %s", size, gsl_text(code));
  double least = gsl_vector_get(k->s, n), next = gsl_vector_get(k->s, n - 1);
  if (!(least <= singular * next))
    return ric_fail(error, RIC_ENUMERIC, "no simple branch point: the least singular values are %.3g and %.3g", least,
                    next);
  gsl_matrix_get_col(k->phi, k->v, n);
  gsl_matrix_get_col(k->psi, k->u, n);
  return RIC_OK;
}

/* psi . F_xx[phi, t] and psi . F_xx[phi, phi] by central differences of the Jacobian along phi. */
static ric_status differentiate(ric_curve *c, const null_space *k, const double *x, const double *t, double *mixed,
                                double *pure, ric_error *error) {
  double h = ric_cbrt(2.2e-16) * (1 + curve_norm(c, x)) / curve_norm(c, k->phi->data);
  *mixed = *pure = 0;
  for (int side = -1; side <= 1; side += 2) {
    for (size_t i = 0; i < c->linear.size; i++)
      k->change->data[i] = x[i] + side * h * k->phi->data[i];
    RIC_TRY(jacobian_at(c, k->change->data, error));
    for (size_t i = 0; i + 1 < c->linear.size; i++) {
      *mixed += side * k->psi->data[i] * row_times(c, i, t) / (2 * h);
      *pure += side * k->psi->data[i] * row_times(c, i, k->phi->data) / (2 * h);
    }
  }
  return RIC_OK;
}

static ric_status other_tangent(ric_curve *c, null_space *k, const double *x, const double *t, double *other,
                                ric_error *error) {
  double mixed, pure;
  RIC_TRY(create(k, c->linear.size, error));
  RIC_TRY(jacobian_at(c, x, error));
  RIC_TRY(find_null_vectors(c, k, error));
  gsl_blas_dscal(1 / curve_norm(c, k->phi->data), k->phi);
  RIC_TRY(differentiate(c, k, x, t, &mixed, &pure, error));
  if (!(fabs(mixed) > transversal * fabs(pure)))
    return ric_fail(error, RIC_ENUMERIC, "no simple branch point: the branches are tangent, psi F_xx = %.3g, %.3g",
                    mixed, pure);
  double alpha = -pure, beta = 2 * mixed, length = ric_hypot(alpha, beta);
  for (size_t i = 0; i < c->linear.size; i++)
    other[i] = (alpha * t[i] + beta * k->phi->data[i]) / length;
  return RIC_OK;
}

ric_status ric_curve_switch(ric_curve *curve, const double *u, double p, const double *tangent, double *other,
                            ric_error *error) {
  REQUIRE(error, {"curve", curve}, {"u", u}, {"tangent", tangent}, {"other", other});
  size_t n = curve->problem.unknowns;
  double *x = curve->low.x, *t = curve->low.t, length = curve_norm(curve, tangent);
  null_space k = {0};
  if (!(length > 0 && length < INFINITY))
    return ric_fail(error, RIC_EINVAL, "tangent of length %g, expected a finite length > 0", length);
  memcpy(x, u, n * sizeof *u);
  x[n] = p;
  for (size_t i = 0; i <= n; i++)
    t[i] = tangent[i] / length;
  curve_tangent_row(curve, t, curve->bound_row);
  keep_gsl_quiet();
  ric_status status = other_tangent(curve, &k, x, t, other, error);
  clear(&k);
  return status;
}

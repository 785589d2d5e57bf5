/* The algebraic branching equation at a simple branch point.
 *
 * There the kernel of (J, F_p) has two dimensions, spanned by the known tangent t and phi, and its rows one relation,
 * psi. Tangents v = alpha t + beta phi of branches satisfy psi . F_xx[v, v] = 0; t is one of the two solutions, so that
 * the other is 2 alpha psi . F_xx[t, phi] + beta psi . F_xx[phi, phi] = 0. */
#include <math.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "curve.h"

/* The smallest singular value of the bordered Jacobian over the next: more, and it is regular, or twice singular. */
static const double singular = 1e-4;

/* Of the coefficients of the equation: less, and the other tangent is that of the known branch. */
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

/* A row of (J, F_p) that the problem has given, times a vector. */
static double row_times(const ric_curve *c, size_t i, const double *v) {
  size_t n = c->problem.unknowns;
  double sum = c->linear.F_p[i] * v[n];
  for (size_t j = 0; j < n; j++)
    sum += c->linear.J[i * n + j] * v[j];
  return sum;
}

/* Evaluates the Jacobian; that it is singular is no failure here. */
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
    return ric_fail(error, RIC_ENUMERIC, "singular values of size %zu: %s", size, gsl_strerror(code));
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
  double h = cbrt(2.2e-16) * (1 + curve_norm(c, x)) / curve_norm(c, k->phi->data);
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
  double alpha = -pure, beta = 2 * mixed, length = hypot(alpha, beta);
  for (size_t i = 0; i < c->linear.size; i++)
    other[i] = (alpha * t[i] + beta * k->phi->data[i]) / length;
  return RIC_OK;
}

ric_status ric_curve_switch(ric_curve *curve, const double *u, double p, const double *tangent, double *other,
                            ric_error *error) {
  size_t n = curve->problem.unknowns;
  double *x = curve->low.x, *t = curve->low.t, length = curve_norm(curve, tangent);
  null_space k = {0};
  if (!(length > 0 && length < INFINITY))
    return ric_fail(error, RIC_EINVAL, "a tangent of length %g, expected a finite one > 0", length);
  memcpy(x, u, n * sizeof *u);
  x[n] = p;
  for (size_t i = 0; i <= n; i++)
    t[i] = tangent[i] / length;
  curve_tangent_row(curve, t, curve->bound_row);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = other_tangent(curve, &k, x, t, other, error);
  gsl_set_error_handler(handler);
  clear(&k);
  return status;
}

#include "ricochet/mck.h"

#include <math.h>

/* Entries of a mass matrix that someone computed differ by rounding from those of its transpose; more is a mistake. */
static const double symmetry_tol = 1e-12;

static ric_status check_dense(const char *name, const double *a, size_t n, ric_error *error) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (!isfinite(a[i * n + j]))
        return ric_fail(error, RIC_EINVAL, "%s[%zu][%zu] = %g, expected a finite number", name, i, j, a[i * n + j]);
  return RIC_OK;
}

static ric_status check_row(const char *name, const ric_matrix *a, size_t i, size_t n, ric_error *error) {
  if (a->row_start[i + 1] < a->row_start[i])
    return ric_fail(error, RIC_EINVAL, "%s: row_start[%zu] = %zu, expected at least row_start[%zu] = %zu", name, i + 1,
                    a->row_start[i + 1], i, a->row_start[i]);
  for (size_t k = a->row_start[i]; k < a->row_start[i + 1]; k++) {
    if (a->column[k] >= n)
      return ric_fail(error, RIC_EINVAL, "%s: column[%zu] = %zu in row %zu, expected less than %zu", name, k,
                      a->column[k], i, n);
    if (!isfinite(a->values[k]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu][%zu] = %g, expected a finite number", name, i, a->column[k],
                      a->values[k]);
  }
  return RIC_OK;
}

static ric_status check_matrix(const char *name, const ric_matrix *a, size_t n, ric_error *error) {
  if (!a->values)
    return RIC_OK;
  if (!a->row_start)
    return check_dense(name, a->values, n, error);
  if (!a->column)
    return ric_fail(error, RIC_EINVAL, "%s: column = NULL, expected the columns of the entries", name);
  for (size_t i = 0; i < n; i++)
    RIC_TRY(check_row(name, a, i, n, error));
  return RIC_OK;
}

static ric_status check_symmetric(const double *m, size_t n, ric_error *error) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++)
      if (!(fabs(m[i * n + j] - m[j * n + i]) <= symmetry_tol * sqrt(fabs(m[i * n + i] * m[j * n + j]))))
        return ric_fail(error, RIC_EINVAL, "mass[%zu][%zu] = %g and mass[%zu][%zu] = %g, expected a symmetric matrix",
                        i, j, m[i * n + j], j, i, m[j * n + i]);
  return RIC_OK;
}

static ric_status check_diagonal(const ric_matrix *m, size_t n, ric_error *error) {
  for (size_t i = 0; i < n; i++) {
    double mass = 0;
    for (size_t k = m->row_start[i]; k < m->row_start[i + 1]; k++) {
      if (m->column[k] != i)
        return ric_fail(error, RIC_EINVAL, "mass[%zu][%zu] = %g in a sparse matrix, expected diagonal entries only", i,
                        m->column[k], m->values[k]);
      mass += m->values[k];
    }
    if (!(mass > 0 && mass < INFINITY))
      return ric_fail(error, RIC_EINVAL, "mass[%zu][%zu] = %g, expected > 0", i, i, mass);
  }
  return RIC_OK;
}

static ric_status check_vector(const char *name, const double *x, size_t n, ric_error *error) {
  for (size_t i = 0; x && i < n; i++)
    if (!isfinite(x[i]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected a finite number", name, i, x[i]);
  return RIC_OK;
}

ric_status ric_mck_check(const ric_mck *mck, ric_error *error) {
  size_t n = mck->coordinates;
  if (n < 1)
    return ric_fail(error, RIC_EINVAL, "coordinates = 0, expected at least 1");
  if (!mck->mass.values)
    return ric_fail(error, RIC_EINVAL, "mass: values = NULL, expected a positive definite matrix");
  RIC_TRY(check_matrix("mass", &mck->mass, n, error));
  RIC_TRY(check_matrix("damping", &mck->damping, n, error));
  RIC_TRY(check_matrix("stiffness", &mck->stiffness, n, error));
  RIC_TRY(mck->mass.row_start ? check_diagonal(&mck->mass, n, error) : check_symmetric(mck->mass.values, n, error));
  if (!isfinite(mck->frequency))
    return ric_fail(error, RIC_EINVAL, "frequency = %g, expected a finite number", mck->frequency);
  RIC_TRY(check_vector("force_cos", mck->force_cos, n, error));
  return check_vector("force_sin", mck->force_sin, n, error);
}

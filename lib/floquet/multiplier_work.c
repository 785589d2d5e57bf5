#include "multiplier_work.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "multiplier_verdict.h"

ric_status multiplier_work_init(multiplier_work *w, size_t n, ric_error *error) {
  *w = (multiplier_work){
      .copy = gsl_matrix_alloc(n, n), .values = gsl_vector_complex_alloc(n), .eigen = gsl_eigen_nonsymm_alloc(n)};
  if (!w->copy || !w->values || !w->eigen) {
    multiplier_work_clear(w);
    return ric_fail(error, RIC_ENOMEM, "no memory for eigenvalues of a matrix of size %zu", n);
  }
  gsl_eigen_nonsymm_params(0, 1, w->eigen); /* balanced: displacements and speeds have different units */
  return RIC_OK;
}

void multiplier_work_clear(multiplier_work *w) {
  if (w->copy)
    gsl_matrix_free(w->copy);
  if (w->values)
    gsl_vector_complex_free(w->values);
  gsl_eigen_nonsymm_free(w->eigen);
  *w = (multiplier_work){0};
}

ric_status multiplier_matrix_check(const double *M, size_t dimension, size_t trivial, const ric_multipliers *m,
                                   ric_error *error) {
  if (trivial > 2 || trivial > dimension)
    return ric_fail(error, RIC_EINVAL, "trivial = %zu, expected 0, 1 or 2, and at most the dimension %zu", trivial,
                    dimension);
  if (m->dimension != dimension)
    return ric_fail(error, RIC_EINVAL, "room for %zu multipliers, expected %zu", m->dimension, dimension);
  for (size_t i = 0; i < dimension * dimension; i++)
    if (!isfinite(M[i]))
      return ric_fail(error, RIC_EINVAL, "entry [%zu][%zu] = %g, expected a finite number", i / dimension,
                      i % dimension, M[i]);
  return RIC_OK;
}

/* Eigenvalues of M + shift I, less the shift. */
static int eigenvalues(multiplier_work *w, const double *M, double shift) {
  size_t n = w->copy->size1;
  memcpy(w->copy->data, M, n * n * sizeof *M);
  for (size_t i = 0; i < n; i++)
    w->copy->data[i * (n + 1)] += shift;
  int failed = gsl_eigen_nonsymm(w->copy, w->values, w->eigen);
  for (size_t i = 0; i < n && !failed; i++)
    w->values->data[2 * i] -= shift;
  return failed;
}

/* The largest sum of a row's moduli. */
static double size_of(const double *M, size_t n) {
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    double sum = 0;
    for (size_t j = 0; j < n; j++)
      sum += fabs(M[i * n + j]);
    largest = fmax(largest, sum);
  }
  return largest;
}

ric_status multiplier_work_find(multiplier_work *w, const double *M, size_t trivial, const ric_multiplier_options *o,
                                ric_multipliers *m, ric_error *error) {
  size_t n = w->copy->size1;
  RIC_TRY(multiplier_matrix_check(M, n, trivial, m, error));
  ric_multipliers_fail(m, "not computed");
  /* GSL compares what it neglects with the diagonal beside it: where that is zero it may try in vain. */
  if (eigenvalues(w, M, 0) != GSL_SUCCESS && eigenvalues(w, M, size_of(M, n)) != GSL_SUCCESS)
    return ric_fail(error, RIC_ENUMERIC, "eigenvalues of a matrix of size %zu: they do not converge", n);
  for (size_t i = 0; i < n; i++)
    m->mu[i] = (ric_complex){w->values->data[2 * i], w->values->data[2 * i + 1]};
  m->count = n;
  multipliers_judge(m, trivial, o);
  return RIC_OK;
}

#include "even_spectrum.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "multiplier_pair.h"
#include "multiplier_verdict.h"

/* Rows of l W - l above it (over the largest entry of W) do not come from rounding. */
static const double defect_tol = 1e-6;

void even_spectrum_clear(even_spectrum *e) {
  if (e->block)
    gsl_matrix_free(e->block);
  if (e->left)
    gsl_vector_free(e->left);
  if (e->values)
    gsl_vector_complex_free(e->values);
  gsl_eigen_nonsymm_free(e->work[0]);
  gsl_eigen_nonsymm_free(e->work[1]);
  free(e->alpha);
  *e = (even_spectrum){0};
}

ric_status even_spectrum_reserve(even_spectrum *e, size_t n, ric_error *error) {
  if (e->size == n)
    return RIC_OK;
  even_spectrum_clear(e);
  e->block = gsl_matrix_alloc(n, n);
  e->left = gsl_vector_alloc(n);
  e->values = gsl_vector_complex_alloc(n);
  e->work[0] = gsl_eigen_nonsymm_alloc(n);
  e->work[1] = gsl_eigen_nonsymm_alloc(n > 1 ? n - 1 : 1);
  e->alpha = malloc(n * sizeof *e->alpha);
  if (e->block && e->left && e->values && e->work[0] && e->work[1] && e->alpha) {
    e->size = n;
    gsl_eigen_nonsymm_params(0, 1, e->work[0]); /* balanced: displacements and speeds have different units */
    gsl_eigen_nonsymm_params(0, 1, e->work[1]);
    return RIC_OK;
  }
  even_spectrum_clear(e);
  return ric_fail(error, RIC_ENOMEM, "no memory for the reduced matrix of %zu particles", n);
}

/* H W H with the reflection H that takes l to the first coordinate: its first row is (1, 0, ..., 0) up to rounding. */
static void deflate(even_spectrum *e) {
  double tau = gsl_linalg_householder_transform(e->left);
  gsl_linalg_householder_hm(tau, e->left, e->block);
  gsl_linalg_householder_mh(tau, e->left, e->block);
  e->defect = 0;
  for (size_t j = 0; j < e->size; j++)
    e->defect = fmax(e->defect, fabs(gsl_matrix_get(e->block, 0, j) - (j == 0 ? 1 : 0)) / fmax(e->largest, 1));
}

static ric_status eigenvalues(even_spectrum *e, size_t first, ric_error *error) {
  e->count = e->size - first;
  if (e->count == 0)
    return RIC_OK;
  gsl_matrix_view rest = gsl_matrix_submatrix(e->block, first, first, e->count, e->count);
  gsl_vector_complex_view values = gsl_vector_complex_subvector(e->values, 0, e->count);
  int code = gsl_eigen_nonsymm(&rest.matrix, &values.vector, e->work[first]);
  if (code != GSL_SUCCESS)
    return ric_fail(error, RIC_ENUMERIC, "eigenvalues of the reduced matrix: %s", gsl_strerror(code));
  for (size_t i = 0; i < e->count; i++) {
    gsl_complex value = gsl_vector_complex_get(&values.vector, i);
    e->alpha[i] = (ric_complex){GSL_REAL(value), GSL_IMAG(value)};
  }
  return RIC_OK;
}

ric_status even_spectrum_find(even_spectrum *e, bool conservative, ric_error *error) {
  e->largest = fmax(fabs(gsl_matrix_max(e->block)), fabs(gsl_matrix_min(e->block)));
  e->defect = 0;
  if (conservative)
    deflate(e);
  return eigenvalues(e, conservative ? 1 : 0, error);
}

void even_spectrum_multipliers(const even_spectrum *e, const ric_multiplier_options *options, ric_multipliers *m) {
  if (!(e->defect <= defect_tol)) {
    ric_multipliers_fail(m, "no multiplier at 1: the state does not belong to an orbit of this chain");
    return;
  }
  for (size_t i = 0; i < e->count; i++)
    multiplier_pair(e->alpha[i], m->mu + 2 * i);
  if (e->count < e->size)
    m->mu[m->dimension - 2] = m->mu[m->dimension - 1] = (ric_complex){1, 0};
  m->count = m->dimension;
  multipliers_judge(m, 2 * (e->size - e->count), options);
}

#include "orthonormal.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>

static const double put_out = 1e-13; /* what is left of a vector, over it, that counts as rounding */

ric_status orthonormal_init(orthonormal_work *w, size_t size, size_t count, ric_error *error) {
  w->factors = gsl_matrix_alloc(size, count);
  w->tau = gsl_vector_alloc(count);
  w->column = gsl_vector_alloc(size);
  return w->factors && w->tau && w->column ? RIC_OK
                                           : ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors", count);
}

void orthonormal_clear(orthonormal_work *w) {
  if (w->factors)
    gsl_matrix_free(w->factors);
  if (w->tau)
    gsl_vector_free(w->tau);
  if (w->column)
    gsl_vector_free(w->column);
  *w = (orthonormal_work){0};
}

/* Column k of Q, zero where the vector was put out. */
static void take_column(const orthonormal_work *w, size_t k, bool gone, gsl_matrix *x) {
  gsl_vector_set_basis(w->column, k);
  if (gone)
    gsl_vector_set_zero(w->column);
  else
    gsl_linalg_QR_Qvec(w->factors, w->tau, w->column);
  gsl_matrix_set_col(x, k, w->column);
}

void orthonormal_make(orthonormal_work *w, double *x, double *growth) {
  size_t size = w->factors->size1, count = w->factors->size2;
  gsl_matrix_view vectors = gsl_matrix_view_array(x, size, count);
  for (size_t k = 0; k < count; k++) {
    gsl_vector_view column = gsl_matrix_column(&vectors.matrix, k);
    growth[k] = gsl_blas_dnrm2(&column.vector);
  }
  gsl_matrix_memcpy(w->factors, &vectors.matrix);
  gsl_linalg_QR_decomp(w->factors, w->tau);
  for (size_t k = 0; k < count; k++) {
    double left = fabs(gsl_matrix_get(w->factors, k, k));
    bool gone = !(left > put_out * growth[k]);
    growth[k] = gone ? -INFINITY : log(left);
    take_column(w, k, gone, &vectors.matrix);
  }
}

void orthonormal_scatter(orthonormal_work *w, double *x, double *growth) {
  uint64_t state = 1; /* of a linear congruence */
  for (size_t i = 0; i < w->factors->size1 * w->factors->size2; i++) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    x[i] = (double)(state >> 11) / 0x1p52 - 1;
  }
  orthonormal_make(w, x, growth);
}

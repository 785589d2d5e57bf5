#include "dominant.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

/* Eigenvectors with larger errors say nothing: components would have to be a tenth of eta and xi to be seen. */
static const double accuracy_tol = 1e-3;
/* Rounding in eigenproblems of size n, in units of n: ten times and more what is observed. */
static const double rounding_unit = 10 * DBL_EPSILON;

bool dominant_is_told(const dominant_multiplier *d) {
  return d->accuracy <= accuracy_tol;
}

bool dominant_is_coupled(const dominant_multiplier *d) {
  return fabs(d->seen) > d->seen_tol && fabs(d->driven) > d->driven_tol;
}

void dominant_clear(dominant_multiplier *d) {
  free(d->right);
  *d = (dominant_multiplier){0};
}

/* --- the multiplier ----------------------------------------------------------------------------------------------- */

static double modulus_of(const gsl_vector_complex *values, size_t i) {
  return hypot(values->data[2 * i], values->data[2 * i + 1]);
}

/* Of those whose moduli are the largest, to the tolerance, the rightmost one: a positive one comes before others. */
static size_t choose(const gsl_vector_complex *values, double apart_tol) {
  double most = 0;
  size_t best = SIZE_MAX;
  for (size_t i = 0; i < values->size; i++)
    most = fmax(most, modulus_of(values, i));
  for (size_t i = 0; i < values->size; i++) {
    const double *mu = values->data + 2 * i;
    if (modulus_of(values, i) >= most * (1 - apart_tol) && mu[1] >= 0 &&
        (best == SIZE_MAX || mu[0] > values->data[2 * best]))
      best = i;
  }
  return best;
}

static void describe(dominant_multiplier *d, const gsl_vector_complex *values, size_t best, double apart_tol) {
  const double *mu = values->data + 2 * best;
  d->modulus = modulus_of(values, best);
  d->real = fabs(mu[1]) <= apart_tol * d->modulus;
  d->value = (ric_complex){mu[0], d->real ? 0 : mu[1]};
  d->second = 0;
  for (size_t i = 0; i < values->size; i++) {
    bool conjugate = !d->real && values->data[2 * i] == mu[0] && values->data[2 * i + 1] == -mu[1];
    if (i != best && !conjugate)
      d->second = fmax(d->second, modulus_of(values, i));
  }
  d->alone = d->second < d->modulus * (1 - apart_tol);
}

static ric_status find_value(dominant_multiplier *d, const balanced_map *map, double apart_tol, ric_error *error) {
  size_t n = map->n;
  ric_status status = RIC_OK;
  gsl_matrix *copy = gsl_matrix_alloc(n, n);
  gsl_vector_complex *values = gsl_vector_complex_alloc(n);
  gsl_eigen_nonsymm_workspace *eigen = gsl_eigen_nonsymm_alloc(n);
  if (!copy || !values || !eigen) {
    status = ric_fail(error, RIC_ENOMEM, "no memory for eigenvalues of a matrix of size %zu", n);
    goto out;
  }
  memcpy(copy->data, map->L, n * n * sizeof *map->L);
  if (gsl_eigen_nonsymm(copy, values, eigen))
    status = ric_fail(error, RIC_ENUMERIC, "eigenvalues of a matrix of size %zu: they do not converge", n);
  else
    describe(d, values, choose(values, apart_tol), apart_tol);
out:
  if (copy)
    gsl_matrix_free(copy);
  if (values)
    gsl_vector_complex_free(values);
  gsl_eigen_nonsymm_free(eigen);
  return status;
}

/* --- its eigenvectors --------------------------------------------------------------------------------------------- */

static double dot(const double *x, const double *y, size_t n) {
  double sum = 0;
  for (size_t k = 0; k < n; k++)
    sum += x[k] * y[k];
  return sum;
}

static double dot_moduli(const double *x, const double *y, size_t n) {
  double sum = 0;
  for (size_t k = 0; k < n; k++)
    sum += fabs(x[k] * y[k]);
  return sum;
}

/* What eta and xi see: nothing, if less than zero_tol of the terms, or than a hundred times what rounding makes of it.
 */
static void look_at_components(dominant_multiplier *d, const balanced_map *map, double condition, double zero_tol) {
  size_t n = map->n;
  double rounding = 100 * d->accuracy;
  double of_seen = zero_tol * dot_moduli(map->eta, d->right, n);
  double of_driven = zero_tol * dot_moduli(d->left, map->xi, n);
  d->seen = dot(map->eta, d->right, n);
  d->driven = dot(d->left, map->xi, n);
  d->seen_tol = fmax(of_seen, rounding * sqrt(dot(map->eta, map->eta, n)));
  d->driven_tol = fmax(of_driven, rounding * condition * sqrt(dot(map->xi, map->xi, n)));
  if (dominant_is_told(d))
    d->vague = fabs(d->seen) * of_driven + fabs(d->driven) * of_seen + of_seen * of_driven;
}

/* `gap`: the distance to other multipliers, or from L - lambda to a matrix with two of them, if that is less. */
static void look(dominant_multiplier *d, const balanced_map *map, double gap, double zero_tol) {
  size_t n = map->n;
  double product = dot(d->left, d->right, n);
  for (size_t k = 0; k < n; k++)
    d->left[k] /= product;
  double condition = 1 / fabs(product); /* both have had the length 1 */
  double change = rounding_unit * (double)n * map->size * condition;
  d->rounding = change / d->modulus;
  d->accuracy = change / gap;
  if (!isfinite(d->accuracy))
    d->accuracy = INFINITY;
  look_at_components(d, map, condition, zero_tol);
}

/* Singular vectors of L - lambda I to the singular value zero are both eigenvectors at once. */
static ric_status find_vectors(dominant_multiplier *d, const balanced_map *map, double zero_tol, ric_error *error) {
  size_t n = map->n;
  ric_status status = RIC_OK;
  gsl_matrix *left = gsl_matrix_alloc(n, n), *right = gsl_matrix_alloc(n, n);
  gsl_vector *singular = gsl_vector_alloc(n), *work = gsl_vector_alloc(n);
  d->right = balanced_map_room(n, 1, 2);
  if (!left || !right || !singular || !work || !d->right) {
    status = ric_fail(error, RIC_ENOMEM, "no memory for eigenvectors of a matrix of size %zu", n);
    goto out;
  }
  d->left = d->right + n;
  memcpy(left->data, map->L, n * n * sizeof *map->L);
  for (size_t k = 0; k < n; k++)
    *gsl_matrix_ptr(left, k, k) -= d->value.re;
  if (n == 1) { /* GSL makes zero of the left vector of 0 */
    gsl_matrix_set_all(left, 1);
    gsl_matrix_set_all(right, 1);
  } else if (gsl_linalg_SV_decomp(left, right, singular, work)) {
    status = ric_fail(error, RIC_ENUMERIC, "singular values of a matrix of size %zu: they do not converge", n);
    goto out;
  }
  for (size_t k = 0; k < n; k++) {
    d->right[k] = gsl_matrix_get(right, k, n - 1);
    d->left[k] = gsl_matrix_get(left, k, n - 1);
  }
  double gap = d->modulus - d->second;
  look(d, map, n > 1 ? fmin(gap, gsl_vector_get(singular, n - 2)) : gap, zero_tol);
out:
  gsl_matrix_free(left);
  gsl_matrix_free(right);
  gsl_vector_free(singular);
  gsl_vector_free(work);
  return status;
}

ric_status dominant_find(dominant_multiplier *d, const balanced_map *map, double zero_tol, double apart_tol,
                         ric_error *error) {
  *d = (dominant_multiplier){.accuracy = INFINITY};
  RIC_TRY(find_value(d, map, apart_tol, error));
  if (!d->real || !d->alone)
    return RIC_OK;
  ric_status status = find_vectors(d, map, zero_tol, error);
  if (status != RIC_OK)
    dominant_clear(d);
  return status;
}

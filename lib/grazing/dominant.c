/* The dominant multiplier of the return map near grazing, in balanced coordinates, and the coefficients eta L^i xi. */
#include "dominant.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

#include "numeric/number_block.h"
#include "numeric/vector.h"
#include "ricochet/elementary.h"

/* Coordinates that L does not couple are balanced by eta and xi only, by at most 2 to this. */
enum { most_exponent = 100 };

double *balanced_map_room(size_t n, size_t matrices, size_t vectors) {
  if (n > SIZE_MAX / sizeof(double) / matrices / 2 / n || n > SIZE_MAX / sizeof(double) / vectors / 2)
    return NULL;
  return calloc(n * n * matrices + n * vectors, sizeof(double));
}

void balanced_map_clear(balanced_map *b) {
  free(b->block);
  *b = (balanced_map){0};
}

/* Divides by a power of two that leaves the largest below 1. @returns its exponent */
static long normalise(double *x, size_t count) {
  int exponent;
  frexp(largest(x, count), &exponent);
  for (size_t i = 0; i < count; i++)
    x[i] = scalbn(x[i], -exponent);
  return exponent;
}

/* |eta_k| = |xi_k| to a factor of two, where neither is zero. */
static void balance_vectors(balanced_map *b) {
  for (size_t k = 0; k < b->n; k++) {
    int of_eta, of_xi, exponent = 0;
    frexp(b->eta[k], &of_eta);
    frexp(b->xi[k], &of_xi);
    if (b->eta[k] != 0 && b->xi[k] != 0)
      exponent = (of_xi - of_eta) / 2;
    exponent = exponent > most_exponent ? most_exponent : exponent < -most_exponent ? -most_exponent : exponent;
    b->scale[k] = ldexp(1, exponent);
  }
  for (size_t k = 0; k < b->n; k++)
    for (size_t l = 0; l < b->n; l++)
      b->L[k * b->n + l] *= b->scale[l] / b->scale[k];
}

/* Balances rows and columns of L where L couples coordinates. */
static ric_status balance_matrix(balanced_map *b, ric_error *error) {
  size_t n = b->n;
  gsl_vector *further = gsl_vector_alloc(n);
  if (!further)
    return ric_fail(error, RIC_ENOMEM, "no memory for a map of size %zu", n);
  gsl_matrix_view L = gsl_matrix_view_array(b->L, n, n);
  gsl_linalg_balance_matrix(&L.matrix, further);
  for (size_t k = 0; k < n; k++)
    b->scale[k] *= gsl_vector_get(further, k);
  gsl_vector_free(further);
  return RIC_OK;
}

static ric_status balance(balanced_map *b, ric_error *error) {
  size_t n = b->n;
  long of_eta = normalise(b->eta, n), of_xi = normalise(b->xi, n);
  b->L_exponent = normalise(b->L, n * n);
  balance_vectors(b);
  RIC_TRY(balance_matrix(b, error));
  double sum = 0;
  for (size_t k = 0; k < n; k++) {
    b->eta[k] *= b->scale[k];
    b->xi[k] /= b->scale[k];
    sum += fabs(b->eta[k]) + fabs(b->xi[k]);
  }
  if (!(isfinite(sum) && isfinite(largest(b->L, n * n))))
    return ric_fail(error, RIC_ENUMERIC, "the numbers of the map differ too much in size to be balanced");
  b->L_exponent += normalise(b->L, n * n);
  of_eta += normalise(b->eta, n);
  of_xi += normalise(b->xi, n);
  b->eta_error = scalbln(b->eta_error, -of_eta);
  b->xi_error = scalbln(b->xi_error, -of_xi);
  b->c_exponent = of_eta + of_xi;
  gsl_vector_view entries = gsl_vector_view_array(b->L, n * n);
  b->size = gsl_blas_dnrm2(&entries.vector);
  return RIC_OK;
}

ric_status balanced_map_init(balanced_map *b, const ric_grazing_map *map, ric_error *error) {
  size_t n = map->size, used = 0;
  *b = (balanced_map){
      .n = n, .eta_error = map->eta_error, .xi_error = map->xi_error, .block = balanced_map_room(n, 1, 3)};
  if (!b->block)
    return ric_fail(error, RIC_ENOMEM, "no memory for a map of size %zu", n);
  b->L = number_block_take(b->block, &used, n * n);
  b->eta = number_block_take(b->block, &used, n);
  b->xi = number_block_take(b->block, &used, n);
  b->scale = number_block_take(b->block, &used, n);
  memcpy(b->L, map->L, n * n * sizeof *b->L);
  memcpy(b->eta, map->eta, n * sizeof *b->eta);
  memcpy(b->xi, map->xi, n * sizeof *b->xi);
  ric_status status = balance(b, error);
  if (status != RIC_OK)
    balanced_map_clear(b);
  return status;
}

/* Eigenvectors with larger errors are unusable: only components of a tenth of eta and xi would be significant. */
static const double accuracy_tol = 1e-3;

/* Rounding in eigenproblems of size n, in units of n: at least ten times the observed value. */
static const double rounding_unit = 10 * DBL_EPSILON;

bool dominant_is_resolved(const dominant_multiplier *d) {
  return d->accuracy <= accuracy_tol;
}

bool dominant_is_coupled(const dominant_multiplier *d) {
  return fabs(d->observed) > d->observed_tol && fabs(d->excited) > d->excited_tol;
}

void dominant_clear(dominant_multiplier *d) {
  free(d->right);
  *d = (dominant_multiplier){0};
}

/* --- the multiplier ----------------------------------------------------------------------------------------------- */

static double modulus_of(const gsl_vector_complex *values, size_t i) {
  return ric_hypot(values->data[2 * i], values->data[2 * i + 1]);
}

/* Of the multipliers with the largest modulus, to the tolerance, the rightmost one: a positive one is preferred. */
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

static double dot_moduli(const double *x, const double *y, size_t n) {
  double sum = 0;
  for (size_t k = 0; k < n; k++)
    sum += fabs(x[k] * y[k]);
  return sum;
}

/* What errors of the entries of eta make of eta x, and those of xi of x xi. */
static double from_eta(const balanced_map *map, const double *x) {
  double sum = 0;
  for (size_t k = 0; k < map->n; k++)
    sum += map->scale[k] * fabs(x[k]);
  return map->eta_error * sum;
}

static double from_xi(const balanced_map *map, const double *x) {
  double sum = 0;
  for (size_t k = 0; k < map->n; k++)
    sum += fabs(x[k]) / map->scale[k];
  return map->xi_error * sum;
}

/* Components of eta and xi along the eigenvectors; zero if below zero_tol of their terms, below a hundred times their
 * rounding, or below what eta and xi are known to.
 */
static void evaluate_components(dominant_multiplier *d, const balanced_map *map, double condition, double zero_tol) {
  size_t n = map->n;
  double rounding = 100 * d->accuracy;
  double of_observed = fmax(zero_tol * dot_moduli(map->eta, d->right, n), from_eta(map, d->right));
  double of_excited = fmax(zero_tol * dot_moduli(d->left, map->xi, n), from_xi(map, d->left));
  d->observed = dot(map->eta, d->right, n);
  d->excited = dot(d->left, map->xi, n);
  d->observed_tol = fmax(of_observed, rounding * sqrt(dot(map->eta, map->eta, n)));
  d->excited_tol = fmax(of_excited, rounding * condition * sqrt(dot(map->xi, map->xi, n)));
  if (dominant_is_resolved(d))
    d->uncertain = fabs(d->observed) * of_excited + fabs(d->excited) * of_observed + of_observed * of_excited;
}

/* `gap`: the distance to other multipliers, or from L - lambda to a matrix with a double one, if that is smaller. */
static void evaluate_dominant(dominant_multiplier *d, const balanced_map *map, double gap, double zero_tol) {
  size_t n = map->n;
  double product = dot(d->left, d->right, n);
  for (size_t k = 0; k < n; k++)
    d->left[k] /= product;
  double condition = 1 / fabs(product); /* both have the length 1 before */
  double change = rounding_unit * (double)n * map->size * condition;
  d->rounding = change / d->modulus;
  d->accuracy = change / gap;
  if (!isfinite(d->accuracy))
    d->accuracy = INFINITY;
  evaluate_components(d, map, condition, zero_tol);
}

/* The singular vectors of L - lambda I for the singular value zero are both eigenvectors. */
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
  if (n == 1) { /* GSL returns a zero left vector for the matrix 0 */
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
  evaluate_dominant(d, map, n > 1 ? fmin(gap, gsl_vector_get(singular, n - 2)) : gap, zero_tol);
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

/* Assumed accuracy of the numbers of a map relative to the norm; rounding adds less up to size 1000. */
static const double entry_tol = 1e-12;

static double length(const double *x, size_t n) {
  gsl_vector_const_view view = gsl_vector_const_view_array(x, n);
  return gsl_blas_dnrm2(&view.vector);
}

static void evaluate_coefficient(coefficient_run *run) {
  run->value = run->terms = 0;
  for (size_t k = 0; k < run->map->n; k++) {
    double term = run->map->eta[k] * run->x[k];
    run->value += term;
    run->terms += fabs(term);
  }
  run->given = from_eta(run->map, run->x) + scalbln(from_xi(run->map, run->row), run->row_exponent - run->x_exponent);
}

static void noise_bound_init(noise_bound *noise, double rate) {
  *noise = (noise_bound){.rate = rate, .log_rate = ric_log2(rate), .most = -INFINITY};
}

ric_status coefficient_run_init(coefficient_run *run, const balanced_map *map, const dominant_multiplier *dominant,
                                ric_error *error) {
  size_t n = map->n, used = 0;
  double *block = balanced_map_room(n, 1, 3);
  double modulus = dominant->modulus;
  *run = (coefficient_run){.map = map, .uncertain = ric_log2(dominant->uncertain)};
  if (!block)
    return ric_fail(error, RIC_ENOMEM, "no memory for the coefficients of a map of size %zu", n);
  run->x = number_block_take(block, &used, n);
  run->row = number_block_take(block, &used, n);
  run->next = number_block_take(block, &used, n);
  memcpy(run->x, map->xi, n * sizeof *run->x);
  memcpy(run->row, map->eta, n * sizeof *run->row);
  run->log_modulus = ric_log2(modulus);
  noise_bound_init(&run->noise[0], modulus > 0 ? modulus : map->size);
  noise_bound_init(&run->noise[1], map->size);
  evaluate_coefficient(run);
  return RIC_OK;
}

void coefficient_run_clear(coefficient_run *run) {
  free(run->x);
  *run = (coefficient_run){0};
}

/* x becomes L x, or x L, over a power of two. @returns its exponent */
static int multiply(coefficient_run *run, double *x, CBLAS_TRANSPOSE_t transposed) {
  size_t n = run->map->n;
  int exponent;
  gsl_matrix_const_view L = gsl_matrix_const_view_array(run->map->L, n, n);
  gsl_vector_const_view from = gsl_vector_const_view_array(x, n);
  gsl_vector_view to = gsl_vector_view_array(run->next, n);
  gsl_blas_dgemv(transposed, 1, &L.matrix, &from.vector, 0, &to.vector);
  frexp(largest(run->next, n), &exponent);
  for (size_t k = 0; k < n; k++)
    x[k] = scalbn(run->next[k], -exponent);
  return exponent;
}

static void add_noise(coefficient_run *run) {
  double row = ric_log2(length(run->row, run->map->n)) + (double)run->row_exponent;
  double x = run->map->size * length(run->x, run->map->n);
  for (size_t k = 0; k < 2; k++) {
    noise_bound *noise = &run->noise[k];
    noise->most = fmax(noise->most, run->i > 0 ? row - (double)run->i * noise->log_rate : row);
    noise->sum = noise->rate * noise->sum + x;
  }
}

void coefficient_run_advance(coefficient_run *run) {
  add_noise(run);
  int exponent = multiply(run, run->x, CblasNoTrans);
  for (size_t k = 0; k < 2; k++)
    run->noise[k].sum = scalbn(run->noise[k].sum, -exponent);
  run->x_exponent += exponent;
  run->row_exponent += multiply(run, run->row, CblasTrans);
  run->i++;
  evaluate_coefficient(run);
}

static double noise_of(const noise_bound *noise) {
  double reach = ric_exp2(noise->most) * noise->sum;
  return isnan(reach) ? INFINITY : reach;
}

/* Uncertainty of the part of the dominant multiplier. */
static double uncertain_part(const coefficient_run *run) {
  double reach = run->uncertain - (double)run->x_exponent;
  return ric_exp2(run->i > 0 ? reach + (double)run->i * run->log_modulus : reach);
}

int coefficient_run_sign(const coefficient_run *run, double zero_tol) {
  double unit = fmax((double)run->map->n * DBL_EPSILON, entry_tol);
  double noise = run->i > 0 ? unit * fmin(noise_of(&run->noise[0]), noise_of(&run->noise[1])) : 0;
  double tolerance = fmax(zero_tol, unit) * run->terms + run->given + noise + uncertain_part(run);
  if (!(fabs(run->value) > tolerance))
    return 0;
  return run->value > 0 ? 1 : -1;
}

bool coefficient_run_over(const coefficient_run *run) {
  return largest(run->x, run->map->n) == 0;
}

double coefficient_run_value(const coefficient_run *run) {
  return scalbln(run->value, run->x_exponent + run->map->c_exponent + (long)run->i * run->map->L_exponent);
}

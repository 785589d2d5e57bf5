#include "coefficients.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>

#include "numeric/largest.h"
#include "numeric/number_block.h"

/* No numbers of a map are known better than to this, relative to the norm; rounding adds less up to size 1000. */
static const double entry_tol = 1e-12;

static double length(const double *x, size_t n) {
  gsl_vector_const_view view = gsl_vector_const_view_array(x, n);
  return gsl_blas_dnrm2(&view.vector);
}

static void evaluate(coefficient_run *run) {
  run->value = run->terms = 0;
  for (size_t k = 0; k < run->map->n; k++) {
    double term = run->map->eta[k] * run->x[k];
    run->value += term;
    run->terms += fabs(term);
  }
}

ric_status coefficient_run_init(coefficient_run *run, const balanced_map *map, const dominant_multiplier *dominant,
                                ric_error *error) {
  size_t n = map->n, used = 0;
  double *block = balanced_map_room(n, 1, 3);
  double modulus = dominant->modulus;
  *run = (coefficient_run){.map = map, .modulus = modulus, .vague = log2(dominant->vague)};
  if (!block)
    return ric_fail(error, RIC_ENOMEM, "no memory for the coefficients of a map of size %zu", n);
  run->x = number_block_take(block, &used, n);
  run->row = number_block_take(block, &used, n);
  run->next = number_block_take(block, &used, n);
  memcpy(run->x, map->xi, n * sizeof *run->x);
  memcpy(run->row, map->eta, n * sizeof *run->row);
  run->noise[0] = (noise_bound){.rate = modulus > 0 ? modulus : map->size, .most = -INFINITY};
  run->noise[1] = (noise_bound){.rate = map->size, .most = -INFINITY};
  evaluate(run);
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
  double row = log2(length(run->row, run->map->n)) + (double)run->row_exponent;
  double x = run->map->size * length(run->x, run->map->n);
  for (size_t k = 0; k < 2; k++) {
    noise_bound *noise = &run->noise[k];
    noise->most = fmax(noise->most, run->i > 0 ? row - (double)run->i * log2(noise->rate) : row);
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
  evaluate(run);
}

static double noise_of(const noise_bound *noise) {
  double reach = exp2(noise->most) * noise->sum;
  return isnan(reach) ? INFINITY : reach;
}

/* Of the dominant multiplier's part. */
static double vague_part(const coefficient_run *run) {
  double reach = run->vague - (double)run->x_exponent;
  return exp2(run->i > 0 ? reach + (double)run->i * log2(run->modulus) : reach);
}

int coefficient_run_sign(const coefficient_run *run, double zero_tol) {
  double unit = fmax((double)run->map->n * DBL_EPSILON, entry_tol);
  double noise = run->i > 0 ? unit * fmin(noise_of(&run->noise[0]), noise_of(&run->noise[1])) : 0;
  double tolerance = fmax(zero_tol, unit) * run->terms + noise + vague_part(run);
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

#include "balanced_map.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>

#include "numeric/largest.h"
#include "numeric/number_block.h"

/* Coordinates that L does not couple are balanced by eta and xi alone, by no more than 2 to this. */
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

/* Rows and columns of L are made of one size where L couples coordinates. */
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
  b->L_exponent = normalise(b->L, n * n);
  b->c_exponent = normalise(b->eta, n) + normalise(b->xi, n);
  balance_vectors(b);
  RIC_TRY(balance_matrix(b, error));
  double sum = 0;
  for (size_t k = 0; k < n; k++) {
    b->eta[k] *= b->scale[k];
    b->xi[k] /= b->scale[k];
    sum += fabs(b->eta[k]) + fabs(b->xi[k]);
  }
  if (!(isfinite(sum) && isfinite(largest(b->L, n * n))))
    return ric_fail(error, RIC_ENUMERIC, "the map has numbers too far apart to be balanced");
  b->L_exponent += normalise(b->L, n * n);
  b->c_exponent += normalise(b->eta, n) + normalise(b->xi, n);
  gsl_vector_view entries = gsl_vector_view_array(b->L, n * n);
  b->size = gsl_blas_dnrm2(&entries.vector);
  return RIC_OK;
}

ric_status balanced_map_init(balanced_map *b, const ric_grazing_map *map, ric_error *error) {
  size_t n = map->size, used = 0;
  *b = (balanced_map){.n = n, .block = balanced_map_room(n, 1, 3)};
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

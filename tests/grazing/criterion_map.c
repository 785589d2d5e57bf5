#include "criterion_map.h"

#include "support.h"

ric_grazing_map empty_map(size_t n) {
  ric_grazing_map map;
  assert_int_equal(ric_grazing_map_init(&map, n, NULL), RIC_OK);
  return map;
}

ric_grazing_map map_of(size_t n, const double *L, const double *eta, const double *xi) {
  ric_grazing_map map = empty_map(n);
  memcpy(map.L, L, n * n * sizeof *L);
  memcpy(map.eta, eta, n * sizeof *eta);
  memcpy(map.xi, xi, n * sizeof *xi);
  return map;
}

ric_grazing_map diagonal_map(size_t n, const double *multipliers, const double *eta, const double *xi) {
  ric_grazing_map map = empty_map(n);
  for (size_t k = 0; k < n; k++)
    map.L[k * n + k] = multipliers[k];
  memcpy(map.eta, eta, n * sizeof *eta);
  memcpy(map.xi, xi, n * sizeof *xi);
  return map;
}

/* c = a b of size n x n. */
static void product(size_t n, const double *a, const double *b, double *c) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double sum = 0;
      for (size_t k = 0; k < n; k++)
        sum += a[i * n + k] * b[k * n + j];
      c[i * n + j] = sum;
    }
}

/* Gauss and Jordan, with the largest pivot of each column. */
static void invert(size_t n, const double *matrix, double *inverse) {
  double a[most_size * most_size];
  memcpy(a, matrix, n * n * sizeof *a);
  for (size_t i = 0; i < n * n; i++)
    inverse[i] = i % (n + 1) == 0;
  for (size_t column = 0; column < n; column++) {
    size_t pivot = column;
    for (size_t i = column; i < n; i++)
      pivot = fabs(a[i * n + column]) > fabs(a[pivot * n + column]) ? i : pivot;
    for (size_t j = 0; j < n; j++) {
      double x = a[pivot * n + j], y = inverse[pivot * n + j];
      a[pivot * n + j] = a[column * n + j];
      inverse[pivot * n + j] = inverse[column * n + j];
      a[column * n + j] = x;
      inverse[column * n + j] = y;
    }
    for (size_t i = 0; i < n; i++) {
      double factor = (a[i * n + column] - (i == column)) / a[column * n + column];
      for (size_t j = 0; j < n; j++) {
        a[i * n + j] -= factor * a[column * n + j];
        inverse[i * n + j] -= factor * inverse[column * n + j];
      }
    }
  }
}

void change_coordinates(ric_grazing_map *map, const double *S) {
  size_t n = map->size;
  double inverse[most_size * most_size], half[most_size * most_size], eta[most_size], xi[most_size];
  invert(n, S, inverse);
  product(n, S, map->L, half);
  product(n, half, inverse, map->L);
  for (size_t i = 0; i < n; i++) {
    eta[i] = xi[i] = 0;
    for (size_t k = 0; k < n; k++) {
      eta[i] += map->eta[k] * inverse[k * n + i];
      xi[i] += S[i * n + k] * map->xi[k];
    }
  }
  memcpy(map->eta, eta, n * sizeof *eta);
  memcpy(map->xi, xi, n * sizeof *xi);
}

void random_coordinates(random_source *source, double decades, size_t n, double *S) {
  for (size_t i = 0; i < n; i++) {
    double scale = pow(10, random_uniform(source, -decades, decades));
    for (size_t j = 0; j < n; j++)
      S[i * n + j] = scale * (random_uniform(source, -1, 1) + 2 * (i == j));
  }
}

ric_grazing_criterion find_criterion(const ric_grazing_map *map) {
  ric_grazing_criterion c;
  ric_error error;
  if (ric_grazing_criterion_find(map, NULL, &c, NULL, 0, NULL, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_int_equal(c.reason[0] == '\0', c.verdict == RIC_GRAZING_CONTINUOUS);
  assert_int_equal(c.settled == SIZE_MAX, c.verdict != RIC_GRAZING_CONTINUOUS);
  assert_int_equal(c.regime == RIC_REGIME_NONE, c.verdict != RIC_GRAZING_CONTINUOUS);
  assert_int_equal(c.first_negative == SIZE_MAX, c.verdict != RIC_GRAZING_DISCONTINUOUS);
  return c;
}

ric_grazing_criterion find_criterion_once(ric_grazing_map map) {
  ric_grazing_criterion c = find_criterion(&map);
  ric_grazing_map_clear(&map);
  return c;
}

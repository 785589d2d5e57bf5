#include "grazing_maps.h"

#include <math.h>
#include <string.h>

#include "support.h"

ric_grazing_map example_map(double lambda, double omega) {
  ric_grazing_map map;
  assert_int_equal(ric_grazing_map_example(&map, lambda, omega, NULL), RIC_OK);
  return map;
}

ric_grazing_map map_of_size_1(double L, double xi, double kappa) {
  ric_grazing_map map;
  assert_int_equal(ric_grazing_map_init(&map, 1, NULL), RIC_OK);
  map.L[0] = L;
  map.eta[0] = 1;
  map.xi[0] = xi;
  map.kappa[0] = kappa;
  return map;
}

ric_grazing_map random_map(random_source *source, size_t size, double contraction) {
  ric_grazing_map map;
  assert_int_equal(ric_grazing_map_init(&map, size, NULL), RIC_OK);
  for (size_t i = 0; i < size; i++) {
    double sum = 0;
    for (size_t j = 0; j < size; j++)
      sum += fabs(map.L[i * size + j] = random_uniform(source, -1, 1));
    for (size_t j = 0; j < size; j++)
      map.L[i * size + j] *= contraction / sum;
    map.eta[i] = random_uniform(source, -1, 1);
    map.xi[i] = random_uniform(source, -1, 1);
    map.kappa[i] = random_uniform(source, -3, 3);
  }
  map.stretch = random_uniform(source, 0.5, 2);
  return map;
}

/* Puts z_to + by z_from in the place of z_to. */
static void shear(ric_grazing_map *map, size_t from, size_t to, double by) {
  size_t n = map->size;
  for (size_t j = 0; j < n; j++)
    map->L[to * n + j] += by * map->L[from * n + j];
  for (size_t i = 0; i < n; i++)
    map->L[i * n + from] -= by * map->L[i * n + to];
  map->eta[from] -= by * map->eta[to];
  map->xi[to] += by * map->xi[from];
  map->kappa[to] += by * map->kappa[from];
}

/* Puts by z_i in the place of z_i. */
static void scale(ric_grazing_map *map, size_t i, double by) {
  size_t n = map->size;
  for (size_t j = 0; j < n; j++)
    map->L[i * n + j] *= by;
  for (size_t j = 0; j < n; j++)
    map->L[j * n + i] /= by;
  map->eta[i] /= by;
  map->xi[i] *= by;
  map->kappa[i] *= by;
}

void map_change_coordinates(ric_grazing_map *map, random_source *source) {
  for (size_t i = 0; i < map->size; i++) {
    scale(map, i, random_uniform(source, 0.5, 2));
    for (size_t j = 0; j < map->size; j++)
      if (i != j)
        shear(map, i, j, random_uniform(source, -0.7, 0.7));
  }
}

void map_iterate(const ric_grazing_map *map, double d, double *z, size_t times, double *work) {
  for (size_t i = 0; i < times; i++) {
    ric_grazing_map_step(map, d, z, work);
    memcpy(z, work, map->size * sizeof *z);
  }
}

double relative_distance(const double *a, const double *b, size_t size) {
  double off = 0, largest = 0;
  for (size_t i = 0; i < size; i++) {
    off = fmax(off, fabs(a[i] - b[i]));
    largest = fmax(largest, fabs(b[i]));
  }
  return off / largest;
}

ric_grazing_cycle cycle_of(const ric_grazing_map *map, size_t period, double y, double *z) {
  ric_grazing_cycle cycle;
  ric_error error = {0};
  if (ric_grazing_cycle_at(map, period, y, &cycle, z, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return cycle;
}

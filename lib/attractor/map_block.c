#include "map_block.h"

#include <stdlib.h>

enum { MOST_SIZE = 4096, ALIGNMENT = 64 };

static double *take(double **store, size_t count) {
  double *taken = *store;
  *store += count;
  return taken;
}

ric_status map_block_init(map_block *b, size_t size, size_t width, size_t vectors, ric_error *error) {
  *b = (map_block){.size = size, .width = width};
  if (size <= MOST_SIZE) {
    size_t rows = size * (size + 3) + 2 + 2 * vectors * (size + 1) + vectors;
    b->numbers = aligned_alloc(ALIGNMENT, (rows * width * sizeof(double) / ALIGNMENT + 1) * ALIGNMENT);
  }
  if (!b->numbers)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu maps of size %zu side by side", width, size);
  double *store = b->numbers;
  b->d = take(&store, width);
  b->impacts = take(&store, width);
  b->eta = take(&store, size * width);
  b->xi = take(&store, size * width);
  b->kappa = take(&store, size * width);
  b->L = take(&store, size * size * width);
  b->v = take(&store, vectors * size * width);
  b->next_v = take(&store, vectors * size * width);
  b->weight = take(&store, vectors * width);
  b->norm = take(&store, vectors * width);
  b->power = (int64_t *)take(&store, vectors * width);
  return RIC_OK;
}

void map_block_clear(map_block *b) {
  free(b->numbers);
  *b = (map_block){0};
}

/* Bits of the numbers that are not zero. */
static uint32_t pattern_of(const double *x, size_t count) {
  uint32_t bits = 0;
  for (size_t i = 0; i < count; i++)
    bits |= (uint32_t)(x[i] != 0) << i;
  return bits;
}

static void load_lane(map_block *b, const ric_grazing_map *map, double d, size_t lane) {
  size_t size = b->size, width = b->width;
  b->d[lane] = d;
  for (size_t i = 0; i < size; i++) {
    b->eta[i * width + lane] = map->eta[i];
    b->xi[i * width + lane] = map->stretch * map->xi[i];
    b->kappa[i * width + lane] = map->kappa[i];
  }
  for (size_t i = 0; i < size * size; i++)
    b->L[i * width + lane] = map->L[i];
  if (size <= MAP_SMALL)
    b->pattern |= pattern_of(map->L, size * size) | pattern_of(map->eta, size) << size * size;
}

void map_block_load(map_block *b, const ric_grazing_map *const *maps, const double *d, size_t count) {
  b->vectors = 0;
  b->pattern = 0;
  for (size_t l = 0; l < b->width; l++) {
    size_t which = l < count ? l : count - 1;
    load_lane(b, maps[which], d[which], l);
  }
}

void map_block_carry(map_block *b, const double *directions, size_t vectors) {
  b->vectors = vectors;
  for (size_t l = 0; l < b->width; l++) {
    for (size_t i = 0; i < vectors * b->size; i++)
      b->v[i * b->width + l] = directions[i];
    for (size_t k = 0; k < vectors; k++) {
      b->norm[k * b->width + l] = 1;
      b->power[k * b->width + l] = 0;
    }
  }
}

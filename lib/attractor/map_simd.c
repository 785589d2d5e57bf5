/* Blocks of maps side by side, and the variants of the kernel that iterates them. */
#include "map_simd.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/number_block.h"

enum { MOST_SIZE = 4096, ALIGNMENT = 64 };

ric_status map_block_init(map_block *b, size_t size, size_t width, size_t vectors, ric_error *error) {
  *b = (map_block){.size = size, .width = width};
  if (size <= MOST_SIZE) {
    size_t rows = size * (size + 3) + 2 + 2 * vectors * (size + 1) + vectors;
    b->numbers = aligned_alloc(ALIGNMENT, (rows * width * sizeof(double) / ALIGNMENT + 1) * ALIGNMENT);
  }
  if (!b->numbers)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu maps of size %zu side by side", width, size);
  double *store = b->numbers;
  b->d = number_store_take(&store, width);
  b->impacts = number_store_take(&store, width);
  b->eta = number_store_take(&store, size * width);
  b->xi = number_store_take(&store, size * width);
  b->kappa = number_store_take(&store, size * width);
  b->L = number_store_take(&store, size * size * width);
  b->v = number_store_take(&store, vectors * size * width);
  b->next_v = number_store_take(&store, vectors * size * width);
  b->weight = number_store_take(&store, vectors * width);
  b->norm = number_store_take(&store, vectors * width);
  b->power = (int64_t *)number_store_take(&store, vectors * width);
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

enum { SHORTEN = 4 }; /* iterates between two looks at the lengths of tangent vectors: they change by 1e38 in each */
enum { GROUPS_FOUR = 4, GROUPS_EIGHT = 4 };

/* Loops of few rounds, and branches that always go the same way within them, are to be none. */
#if defined(__GNUC__) && !defined(__clang__)
#define FEW _Pragma("GCC unroll 8")
#else
#define FEW
#endif

static const double put_out = 1e-26; /* what is left of a vector, over it, that counts as rounding: of squares */

#define LANE   double
#define LANES  1
#define GROUPS 1
#define TARGET
#define NAMED(f)        f##_one
#define MASK            bool
#define BITS            bits_one
#define NOT_BELOW(x, y) (!((x) < (y)))
#define KEEP(mask, x)   ((mask) ? (x) : 0.0)
#define ANY(mask)       (mask)
#define ROOT(x)         sqrt(x)

static inline double number_of(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

#define AS_LANE(bits) number_of(bits)
#if defined(__GNUC__)
typedef uint64_t __attribute__((may_alias)) bits_one;
#else
typedef uint64_t bits_one;
#endif

#include "map_simd.inc"

#ifdef RIC_WIDE /* the compiler makes functions for processors other than the one at hand */
#include <immintrin.h>

typedef double lane_four __attribute__((vector_size(32), may_alias));
typedef uint64_t bits_four __attribute__((vector_size(32), may_alias));
typedef double lane_eight __attribute__((vector_size(64), may_alias));
typedef uint64_t bits_eight __attribute__((vector_size(64), may_alias));

#define LANE            lane_four
#define LANES           4
#define GROUPS          GROUPS_FOUR
#define TARGET          __attribute__((target("avx2")))
#define NAMED(f)        f##_four
#define MASK            __m256d
#define BITS            bits_four
#define NOT_BELOW(x, y) _mm256_cmp_pd(x, y, _CMP_NLT_UQ)
#define KEEP(mask, x)   _mm256_and_pd(mask, x)
#define ANY(mask)       (_mm256_movemask_pd(mask) != 0)
#define ROOT(x)         _mm256_sqrt_pd(x)
#define AS_LANE(bits)   ((lane_four)(bits))
#include "map_simd.inc"

#define LANE            lane_eight
#define LANES           8
#define GROUPS          GROUPS_EIGHT
#define TARGET          RIC_WIDE
#define NAMED(f)        f##_eight
#define MASK            __mmask8
#define BITS            bits_eight
#define NOT_BELOW(x, y) _mm512_cmp_pd_mask(x, y, _CMP_NLT_UQ)
#define KEEP(mask, x)   _mm512_maskz_mov_pd(mask, x)
#define ANY(mask)       ((mask) != 0)
#define ROOT(x)         _mm512_sqrt_pd(x)
#define AS_LANE(bits)   ((lane_eight)(bits))
#include "map_simd.inc"
#endif

map_kernel map_kernel_of(ric_map_lanes lanes) {
#ifdef RIC_WIDE
  if (lanes == RIC_MAP_LANES_FOUR && __builtin_cpu_supports("avx2"))
    return (map_kernel){advance_four, 4 * GROUPS_FOUR};
  if (lanes == RIC_MAP_LANES_EIGHT && ric_has_wide())
    return (map_kernel){advance_eight, 8 * GROUPS_EIGHT};
#endif
  return lanes == RIC_MAP_LANES_ONE ? (map_kernel){advance_one, 1} : (map_kernel){NULL, 0};
}

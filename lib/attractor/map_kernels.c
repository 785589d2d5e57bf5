#include "map_block.h"

#include <float.h>
#include <math.h>
#include <string.h>

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
#define AS_LANE(bits)   number_of(bits)
#if defined(__GNUC__)
typedef uint64_t __attribute__((may_alias)) bits_one;
#else
typedef uint64_t bits_one;
#endif
static inline double number_of(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}
#include "map_lanes.h"

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
#include "map_lanes.h"

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
#include "map_lanes.h"
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

/* Loops over particles for wide vector registers (SIMD): internal to the library.
 *
 * A static function marked RIC_VECTORISED is compiled twice, and the processor selects the variant. Both variants
 * perform the same operations in the same order, without fused multiplications, so results are equal in every bit. A
 * function marked RIC_WIDE, if the compiler supports it, is for processors with registers of eight numbers
 * (ric_has_wide()): types of that size are slow on all others. */
#ifndef RICOCHET_SIMD_H
#define RICOCHET_SIMD_H

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) &&                       \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define RIC_VECTORISED __attribute__((target_clones("avx2", "default")))
#define RIC_WIDE       __attribute__((target("avx512f")))
#define RIC_INLINE                                                                                                     \
  static inline __attribute__((always_inline)) /* so that each variant contains all functions it calls */
#else
#define RIC_VECTORISED
#define RIC_INLINE static inline
#endif

#ifdef RIC_WIDE
#include <stdbool.h>
static inline bool ric_has_wide(void) {
  return __builtin_cpu_supports("avx512f");
}
#endif

/* SIMD lanes for sums that are not loops over particles, which compilers do not vectorise. Operators act on every lane,
 * so results do not depend on whether the type exists. Passed by pointer: the calling convention for values depends on
 * the processor. */
#if defined(__GNUC__)
typedef double ric_lanes __attribute__((vector_size(32), aligned(8), may_alias));
enum { RIC_LANES = 4 };
#else
typedef double ric_lanes;
enum { RIC_LANES = 1 };
#endif

#endif

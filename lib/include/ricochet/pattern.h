/* Impact patterns: which particles of a chain hit their floor, and when in the period ([JAP] (4)-(6)).
 *
 * `start` is I2, the particles that hit at t = 0 mod T; `half` is I1, those that hit at t = T/2 mod T; all others are
 * free (I0). Two patterns are equivalent if a symmetry of the chain maps one to the other: shifts (rings), the
 * reflection i -> n - 1 - i, and the exchange of the two halves of the period, t -> t + T/2. Their orbits are images of
 * one another. */
#ifndef RICOCHET_PATTERN_H
#define RICOCHET_PATTERN_H

#include <stdbool.h>
#include <stddef.h>

#include "chain.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_role { RIC_ROLE_FREE, RIC_ROLE_START, RIC_ROLE_HALF } ric_role;

typedef struct ric_pattern ric_pattern;

/** @param start, half  particles that hit at t = 0 and at t = T/2, in any order; results keep this order. Copied
 *  @returns RIC_EINVAL for an index out of range, one given twice or in both, or no impact at all. */
RIC_API ric_status ric_pattern_create(size_t particles, const size_t *start, size_t start_count, const size_t *half,
                                      size_t half_count, ric_pattern **pattern, ric_error *error);
RIC_API void ric_pattern_destroy(ric_pattern **pattern);

RIC_API size_t ric_pattern_particles(const ric_pattern *pattern);
/** Number of impacts per period, m >= 1. */
RIC_API size_t ric_pattern_impacts(const ric_pattern *pattern);
/** Particle of an impact: 0 <= index < m, `start` in the order given, then `half`. */
RIC_API size_t ric_pattern_impact(const ric_pattern *pattern, size_t index);
RIC_API ric_role ric_pattern_role(const ric_pattern *pattern, size_t particle);

/** Text for messages: "start 15 of 30", "start 0 3 6 ... 27 (10) half 1 of 30". Cut to size with "...".
 *  @returns text. */
RIC_API const char *ric_pattern_text(const ric_pattern *pattern, char *text, size_t size);

/** A symmetry: first reflect, then shift, then exchange. Particle i of the pattern becomes particle
 *  (reflect ? n - 1 - i : i) + shift (mod n). */
typedef struct ric_symmetry {
  size_t shift; /* 0 unless the chain is a ring */
  bool reflect;
  bool exchange;
} ric_symmetry;

/** Image of a pattern under a symmetry. @returns RIC_EINVAL for a shift >= n, or a shift on a chain with ends. */
RIC_API ric_status ric_pattern_image(const ric_pattern *pattern, ric_ends ends, ric_symmetry symmetry,
                                     ric_pattern **image, ric_error *error);

/** The symmetry that maps a pattern to its canonical representative: the image whose sequence of roles (start < half <
 *  free, from particle 0) is lexicographically smallest. Equivalent patterns have equal representatives. O(n). */
RIC_API ric_status ric_pattern_reduce(const ric_pattern *pattern, ric_ends ends, ric_symmetry *symmetry,
                                      ric_error *error);

/** Whether two patterns give every particle the same role. */
RIC_API bool ric_pattern_equal(const ric_pattern *a, const ric_pattern *b);

RIC_END_DECLARATIONS

#endif

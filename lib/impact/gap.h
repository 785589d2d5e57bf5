/* The gap of an obstacle along a piece of motion, as polynomials: internal to the library.
 *
 * Obstacles at coordinates: the gap is linear in the state and its polynomial that of the coordinate, exact. Gaps of
 * user systems: interpolation at Chebyshev points, on halves of the interval where a degree of 12 does not resolve it
 * to the flow's tolerance. */
#ifndef RICOCHET_IMPACT_GAP_H
#define RICOCHET_IMPACT_GAP_H

#include "flow/flow_method.h"

enum { GAP_DEGREE = 12, GAP_NODES = GAP_DEGREE + 1 };

/** The gap on a part [from, to] of a piece, in y = (x - from) / (to - from). */
typedef struct gap_part {
  double from, to;
  int degree;
  double c[RIC_POLY_DEGREE + 1];
} gap_part;

/** Workspace of the interpolation. */
typedef struct gap_reader {
  const ric_system *system;
  double tolerance; /* of the interpolation, relative to the largest value of the gap on the part and to 1 */
  double *q;        /* [GAP_NODES][n] coordinates at the nodes of a part */
  double from, to;  /* that part */
} gap_reader;

ric_status gap_reader_init(gap_reader *reader, const ric_flow *flow, ric_error *error);
void gap_reader_clear(gap_reader *reader);

/** A new piece: forgets the nodes. */
void gap_reader_reset(gap_reader *reader);

/** The gap on [from, to] of a piece that contains the obstacle's coordinate.
 *  @param part  set; `resolved` is set to false when the interpolation misses the tolerance
 *  @returns NULL, or why a callback failed. */
const char *gap_read(gap_reader *reader, const ric_segment *piece, size_t obstacle, double from, double to,
                     gap_part *part, bool *resolved);

#endif

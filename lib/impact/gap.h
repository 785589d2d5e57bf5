/* What is watched of a contact along a piece of motion, as polynomials: internal to the library.
 *
 * Obstacles at coordinates: the gap is linear in the state and its polynomial that of the coordinate, exact; so are the
 * forces of held contacts that a Taylor flow gives. Everything else is interpolated at Chebyshev points, on halves of
 * the interval where a degree of 12 does not resolve it to the flow's tolerance. Two points besides the nodes must
 * agree, so that oscillations do not hide between them; a function that does much within a fraction of a step still
 * can, and `longest_step` is the user's bound for it. */
#ifndef RICOCHET_IMPACT_GAP_H
#define RICOCHET_IMPACT_GAP_H

#include "flow/flow_method.h"

enum { GAP_DEGREE = 12, GAP_NODES = GAP_DEGREE + 1, GAP_PROBES = 2 };

/** Functions that are positive until the next event of a contact, and the gap rate, which shows where the gap is
 * smallest: gaps that hardly change over a step lose that in their rounding. */
typedef enum watch {
  WATCH_GAP,   /* of an open contact */
  WATCH_PRESS, /* minus the gap of a pressed one */
  WATCH_FORCE, /* of a held one */
  WATCH_RATE   /* of the gap, in time */
} watch;

/** The function on a part [from, to] of a piece, in y = (x - from) / (to - from). */
typedef struct gap_part {
  double from, to;
  int degree;
  double c[RIC_POLY_DEGREE + 1];
  double residual; /* what the interpolation misses, over the tolerance; 0 where nothing is interpolated */
} gap_part;

/** Workspace of the interpolation. */
typedef struct gap_reader {
  ric_flow *flow;
  double *states;  /* [GAP_NODES + GAP_PROBES][n + m] at the points of a part; NULL where nothing is interpolated */
  double from, to; /* that part */
} gap_reader;

ric_status gap_reader_init(gap_reader *reader, ric_flow *flow, ric_error *error);
void gap_reader_clear(gap_reader *reader);

/** A new piece: forgets the states. */
void gap_reader_reset(gap_reader *reader);

/** The function on [from, to] of a piece that contains the obstacle's coordinate.
 *  @returns NULL, or why a callback failed. */
const char *gap_read(gap_reader *reader, const ric_segment *piece, size_t obstacle, watch what, double from, double to,
                     gap_part *part);

/** Whether a part will do: its interpolation meets the tolerance, or it is no better than that of the part twice as
 * long
 *  (`before`, INFINITY for none), so that what is left is rounding of the function. */
bool gap_is_resolved(const gap_part *part, double before);

#endif

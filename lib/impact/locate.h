/* Gaps and forces of contacts as polynomials along a step, and their first zeros. Internal to the library. */
#ifndef RICOCHET_LOCATE_H
#define RICOCHET_LOCATE_H

#include "flow/flow_method.h"

/* Functions that are monitored for a contact along a segment, as polynomials.
 *
 * Obstacles at coordinates: the gap is linear in the state and its polynomial that of the coordinate, exact; so are the
 * forces of held contacts from a Taylor flow. All other functions are interpolated at Chebyshev points, on halves of
 * the interval if degree 12 does not resolve them to the flow's tolerance. Two points besides the nodes must agree, so
 * that oscillations between nodes are detected; features within a small fraction of a step can still be missed, and
 * `longest_step` is the user's bound for them. */

/** Functions that are positive until the next event of a contact, and the gap rate, which locates minima of the gap:
 * the minimum of a gap that hardly changes over a step is lost in its rounding. */
typedef enum contact_function {
  WATCH_GAP,   /* of an open contact */
  WATCH_PRESS, /* minus the gap of a pressed one */
  WATCH_FORCE, /* of a held one */
  WATCH_RATE   /* of the gap, in time */
} contact_function;

/** The function on a part [from, to] of a piece, in y = (x - from) / (to - from). */
typedef struct gap_part {
  double from, to;
  int degree;
  double c[RIC_POLY_DEGREE + 1];
  double residual; /* error of the interpolation over the tolerance; 0 without interpolation */
} gap_part;

/** Workspace of the interpolation. */
typedef struct gap_reader {
  ric_flow *flow;
  double *states;  /* [GAP_NODES + GAP_PROBES][n + m] at the points of a part; NULL without interpolation */
  double from, to; /* that part */
} gap_reader;

ric_status gap_reader_init(gap_reader *reader, ric_flow *flow, ric_error *error);
void gap_reader_clear(gap_reader *reader);

/** A new piece: discards the states. */
void gap_reader_reset(gap_reader *reader);

/** The function on [from, to] of a piece that contains the obstacle's coordinate.
 *  @returns NULL, or why a callback failed. */
const char *gap_read(gap_reader *reader, const ric_segment *piece, size_t obstacle, contact_function what, double from,
                     double to, gap_part *part);

/** Whether a part is resolved: its interpolation is within the tolerance, or no better than that of the part twice as
 * long (`before`, INFINITY for none), so that the error is rounding of the function. */
bool gap_is_resolved(const gap_part *part, double before);

/* Onset and end of contacts on a step of a flow.
 *
 * One locator for all flows and all kinds of contact. Each contact has a function that is positive until its next
 * event: the gap of an open obstacle, the force of a held one, minus the gap of a pressed one. Bounds exclude most
 * contacts at once; the first roots of the others are certified (polynomial.h). */

/** How an open or pressed contact began; distinguishes a root at the start of the step from the next one. */
typedef enum departure {
  DEPARTED,      /* its function is clearly positive */
  DEPARTS_FAST,  /* it is zero with a positive rate: the next root is that of the function divided by x */
  DEPARTS_SLOWLY /* zero with rate zero: a root must lie below that value by the noise */
} departure;

/** An event on the step. */
typedef struct contact_root {
  size_t obstacle;
  double x;     /* position in the step */
  double depth; /* grazing without contact: the minimum of the gap; NaN: a root */
} contact_root;

typedef struct contact_root_list {
  contact_root *hits;
  size_t count, capacity;
} contact_root_list;

typedef struct locator {
  gap_reader reader;
  unsigned char *departure;  /* [obstacles] */
  double *base;              /* [obstacles] value of the function when it departed slowly */
  double grazing_tol, noise; /* values of the functions below the noise are zero */
  size_t parts;              /* interpolated in this step */
  double horizon;            /* the step was scanned up to here: 1 unless functions vary too fast */
  double *lower, *upper;     /* bounds of the coordinates of a piece */
  size_t width;
  double first;             /* position of the first root in the step; > 1 if there is none */
  contact_root_list roots;  /* those within the time tolerance of it */
  contact_root_list grazes; /* minima above zero before it */
} locator;

ric_status locator_init(locator *l, ric_flow *flow, double grazing_tol, ric_error *error);
void locator_clear(locator *l);

/** Scans a step of the flow. Afterwards `roots` holds the first event and those within time_tol of it, in order of
 *  obstacles, or nothing; `grazes` the near misses before it, in order of time. Nothing is known beyond `horizon`.
 *  @returns RIC_ENOMEM, RIC_ECALLBACK; RIC_ELIMIT if a function varies too fast to be resolved in the step. */
ric_status locator_scan(locator *l, ric_flow *flow, double time_tol, ric_error *error);

#endif

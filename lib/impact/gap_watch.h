/* The smallest gaps along a periodic motion, and when the first obstacle is passed. Internal to the library. */
#ifndef RICOCHET_GAP_WATCH_H
#define RICOCHET_GAP_WATCH_H

#include <stdint.h>

#include "locate.h"

/* Gaps arrive as polynomials on stretches of time, their minima are certified (polynomial.h): no violation is missed.
 *
 * Of an obstacle that the motion does not hit the smallest value counts. One that it hits has gaps that come from zero
 * and go to zero, and there are two ways to look between the impacts. Where the impact is exactly at x = 0 of a
 * polynomial, the polynomial divided by x counts instead (`divided`): positive as long as the obstacle is left, zero
 * where the impulse vanishes, and continuous in parameters. Otherwise its local minima count.
 *
 * Ties within the tolerance go to the gap that was seen first: in the order of time, then of obstacles. */

#define NO_OBSTACLE SIZE_MAX

/** A gap, where and when. */
typedef struct gap_found {
  double value; /* INFINITY: none */
  double time;
  size_t obstacle; /* NO_OBSTACLE: none */
  bool divided;    /* the value is that of a divided polynomial: not above the gap where it is negative */
} gap_found;

typedef struct gap_watch {
  double tolerance;           /* absolute, on values; values above a hundred times their size are to rounding, 1e-14 */
  double zero;                /* gaps below -zero are violations; INFINITY: none are looked for */
  double most_own;            /* values of obstacles that are hit count up to this; INFINITY: all do */
  gap_found free, own;        /* smallest of obstacles that are not hit, and that are */
  gap_found first;            /* the first gap below -zero */
  double next_free, next_own; /* values that are smaller by more than the tolerance */
} gap_watch;

void gap_watch_begin(gap_watch *w, double tolerance, double zero, double most_own);

/** The gap of an obstacle on the part [from, to] of a segment, as a polynomial in y = (x - from) / (to - from). */
typedef struct gap_piece {
  const double *c; /* [degree + 1] */
  int degree;
  double start, length; /* of the segment; negative: it runs back in time */
  double from, to;
  size_t obstacle;
  bool hit;     /* the motion hits this obstacle, here or elsewhere */
  bool divided; /* c is the gap divided by y; c[-1] is its value at 0, zero to rounding */
} gap_piece;

/** Whether a gap that is nowhere below a bound on a stretch of time may matter. @param from  the beginning of it */
static inline bool gap_watch_cares(const gap_watch *w, bool hit, double bound, double from) {
  return bound <= (hit ? w->next_own : w->next_free) || (bound < -w->zero && from < w->first.time);
}

/** Looks for the smallest value. */
void gap_watch_value(gap_watch *w, const gap_piece *p);

/** The smaller of both gaps. */
static inline const gap_found *gap_watch_least(const gap_watch *w) {
  return w->free.value <= w->own.value ? &w->free : &w->own;
}

/* The gaps of a system's rigid obstacles, from the segments of its flow. */

typedef struct system_gaps {
  gap_watch watch;
  const ric_system *system; /* borrowed */
  gap_reader reader;
  bool *hit;             /* [obstacles] by the motion at all: the caller sets them, before the first motion */
  double *slope;         /* [obstacles] of the gap at the end of the last segment; NaN after an impact */
  bool any_free;         /* there are rigid ones that it does not hit */
  double *lower, *upper; /* [n] bounds of coordinates */
  const char *trouble;   /* why a gap could not be read; NULL */
} system_gaps;

/** @param flow  that moves the system; borrowed. Clear it also after an error. */
ric_status system_gaps_init(system_gaps *g, ric_flow *flow, ric_error *error);
void system_gaps_clear(system_gaps *g);

/** Begins a motion: nothing is known yet. @param zero  gaps below -zero are violations */
void system_gaps_begin(system_gaps *g, double zero);

/** The motion comes from an impact of an obstacle: its gap starts anew. */
void system_gaps_after(system_gaps *g, size_t obstacle);

/** A segment of the motion. @param end  x up to which it counts */
void system_gaps_segment(system_gaps *g, const ric_segment *segment, double end);

/** At a state of a motion that is even about this time: gaps of obstacles that it hits elsewhere are at an extremum.
 *  @param hit  [n] which obstacle each coordinate hits there, NO_OBSTACLE: none
 *  @param q, rates  [n], [n + m] state and its rates of change */
void system_gaps_turn(system_gaps *g, const size_t *hit, double time, const double *q, const double *rates);

/** At an impact of an obstacle where a motion closes: other gaps may turn around there.
 *  @param before, after  states [n + m] */
void system_gaps_close(system_gaps *g, size_t obstacle, double time, const double *before, const double *after);

#endif

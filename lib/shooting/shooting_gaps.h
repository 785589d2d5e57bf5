/* The smallest gaps of a motion that shooting has found: internal to the room.
 *
 * Gaps are polynomials on the segments of the arcs, their minima certified (polynomial.h). Of an obstacle that the
 * motion does not hit the smallest value counts; of one that it hits the smallest local minimum away from the impacts,
 * where the gap comes from and goes to zero. */
#ifndef RICOCHET_SHOOTING_GAPS_H
#define RICOCHET_SHOOTING_GAPS_H

#include "impact/gap.h"
#include "shooting_parts.h"

/** A gap, where and when. */
typedef struct gap_found {
  double value; /* INFINITY: none */
  double time;
  size_t obstacle;
} gap_found;

typedef struct shooting_gaps {
  ric_shooting *s; /* borrowed */
  gap_reader reader;
  bool *hit;             /* [obstacles] in the motion at all */
  double *slope;         /* [obstacles] of the gap at the end of the last segment; NaN after an impact */
  bool any_free;         /* obstacles that it does not hit */
  double *lower, *upper; /* [n] bounds of coordinates */
  double zero;           /* gaps below -zero are violations */
  gap_found free, own;   /* smallest of obstacles that are not hit, and that are */
  gap_found first;       /* the first gap below -zero, INFINITY */
  const piece_run *run;
  const char *trouble; /* why a gap could not be read; NULL */
} shooting_gaps;

ric_status shooting_gaps_create(ric_shooting *s, shooting_gaps **gaps, ric_error *error);
void shooting_gaps_destroy(shooting_gaps **gaps);

/** Begins a motion: nothing found yet. */
void shooting_gaps_reset(shooting_gaps *g);

/** For an observer of the motion. @param end  of the segment that counts */
void shooting_gaps_begin(shooting_gaps *g, const piece_run *run);
void shooting_gaps_look(shooting_gaps *g, const ric_segment *piece, double end);

/** At an end of the half period of an even motion, with the state s->x there: gaps of obstacles that it hits elsewhere
 *  are at an extremum. @param hit  which obstacle each coordinate hits there */
ric_status shooting_gaps_turn(shooting_gaps *g, const size_t *hit, double time, ric_error *error);

/** Where a motion closes with an impact: other gaps may turn around there.
 *  @param before, after  states [n + m] */
void shooting_gaps_close(shooting_gaps *g, const piece_run *run, const double *before, const double *after);

#endif

/* A periodic motion cut into pieces, and where each of its numbers stands in z: internal to the room.
 *
 * Times of events are affine in the unknowns, e = z[index] + of_period T; an arc joins two of them and is cut into
 * pieces of equal length. Pieces follow each other in time; the unknowns begin with the states at their beginnings. */
#ifndef RICOCHET_ARCS_H
#define RICOCHET_ARCS_H

#include <stdint.h>

#include "model/system_model.h"
#include "ricochet/shooting.h"

/** A time as a function of the unknowns. */
typedef struct event_time {
  size_t index; /* in z; NO_UNKNOWN: none */
  double of_period;
} event_time;

#define NO_UNKNOWN SIZE_MAX

/** How a piece ends. */
typedef enum piece_end {
  PIECE_CUT,    /* the next one begins with its state */
  PIECE_IMPACT, /* the same, after an impact */
  PIECE_HALF    /* even motions: half the period */
} piece_end;

typedef struct arc_piece {
  event_time begin, end; /* of the arc */
  double from, to;       /* part of the arc, in [0, 1] */
  size_t state;          /* where its first state stands in z */
  piece_end how;
  size_t obstacle; /* that is hit */
  bool closes;     /* its end is the beginning of the first one, a period later */
  size_t row;      /* of its first equation */
} arc_piece;

typedef struct arc_plan {
  size_t coordinates, speeds, size; /* n, m, n + m */
  ric_motion_kind kind;
  bool energy_given;
  arc_piece *pieces;
  size_t count, arc_count; /* of pieces, of arcs */
  event_time *impacts;     /* [sequence] */
  size_t *sequence;        /* [sequence_count] obstacles */
  size_t sequence_count;
  size_t period, lambda; /* in z, NO_UNKNOWN */
  size_t unknowns;
  size_t phase_row, energy_row; /* NO_UNKNOWN */
  size_t *at_start, *at_half;   /* even: [n] obstacle hit by a coordinate, NO_UNKNOWN: at rest there; else NULL */
  size_t start_count, half_count;
} arc_plan;

ric_status arcs_init(arc_plan *a, const ric_system *system, const ric_shooting_problem *problem, ric_error *error);
void arcs_clear(arc_plan *a);

/** The period at z, when `given` is the given number. */
double arcs_period(const arc_plan *a, const double *z, double given);
double arcs_time(event_time e, const double *z, double period);

/** Times at which a piece begins and ends. */
double piece_begin(const arc_piece *p, const double *z, double period);
double piece_finish(const arc_piece *p, const double *z, double period);

/** Numbers of the first state: n for even motions, else n + m. */
size_t arcs_first_numbers(const arc_plan *a);

#endif

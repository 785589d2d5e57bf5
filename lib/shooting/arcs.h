/* Arcs of a motion between impacts: where their unknowns stand, and how one is run. Internal to the library. */
#ifndef RICOCHET_ARCS_H
#define RICOCHET_ARCS_H

#include <stdint.h>

#include "flow/flow_method.h"
#include "model/system_model.h"
#include "ricochet/shooting.h"
#include "ricochet/trajectory.h"

/* A periodic motion cut into pieces, and where each of its numbers stands in z.
 *
 * Times of events are affine in the unknowns, e = z[index] + of_period T; an arc joins two of them and is cut into
 * pieces of equal length. Pieces follow each other in time; the unknowns begin with the states at their beginnings. */

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

/* Free motion along a piece of an arc, with tangent vectors.
 *
 * Rigid obstacles let it pass: where it goes through one it is no motion of the system, but the equations of shooting
 * have their values there. Compliant obstacles act. Without them the flow alone is enough, and time may run backwards.
 */

typedef struct arc_runner {
  const ric_system *system;
  ric_flow *flow;             /* NULL where compliant obstacles need a trajectory */
  ric_trajectory *trajectory; /* NULL otherwise */
  ric_poll poll;
  unsigned long long last_step; /* of the flow, as it counts them: longer motions are given up; 0: none are */
} arc_runner;

ric_status arc_runner_init(arc_runner *runner, const ric_system *system, const ric_flow_options *flow, ric_poll poll,
                           ric_error *error);
void arc_runner_clear(arc_runner *runner);

/** Sees the pieces of steps, as an observer does. */
typedef struct arc_watch {
  int (*segment)(const ric_segment *piece, double end, void *user);
  void *user;
} arc_watch;

/** Moves a state from one time to another.
 *  @param x  [n + m] state, moved
 *  @param columns, d  [n + m][columns] row-major tangent vectors, moved; 0, NULL for none
 *  @param watcher  sees the pieces; NULL
 *  @returns RIC_ENUMERIC when the motion blows up, takes too many steps, or would run backwards where it cannot;
 * RIC_ECALLBACK, RIC_ESTOPPED, RIC_ENOMEM. */
ric_status arc_runner_move(arc_runner *runner, double from, double to, double *x, size_t columns, double *d,
                           const arc_watch *watcher, ric_error *error);

/** The flow that moves it. */
ric_flow *arc_runner_flow(const arc_runner *runner);

#endif

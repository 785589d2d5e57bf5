/* Arcs of a motion between impacts: indices of their unknowns, and the integration of one. Internal to the library. */
#ifndef RICOCHET_ARCS_H
#define RICOCHET_ARCS_H

#include <stdint.h>

#include "flow/flow_method.h"
#include "model/system_model.h"
#include "ricochet/shooting.h"
#include "ricochet/trajectory.h"

/* A periodic motion cut into pieces, and the index of each of its numbers in z.
 *
 * Times of events are affine in the unknowns, e = z[index] + of_period T; an arc is the motion between two of them
 * and is cut into pieces of equal length. Pieces are in order of time; z begins with the states at their beginnings. */

/** A time as a function of the unknowns. */
typedef struct event_time {
  size_t index; /* in z; NO_UNKNOWN: none */
  double of_period;
} event_time;

#define NO_UNKNOWN SIZE_MAX

/** How a piece ends. */
typedef enum piece_end {
  PIECE_CUT,    /* continuity: its end is the first state of the next one */
  PIECE_IMPACT, /* the same, after an impact */
  PIECE_HALF    /* even motions: half the period */
} piece_end;

typedef struct arc_piece {
  event_time begin, end; /* of the arc */
  double from, to;       /* part of the arc, in [0, 1] */
  size_t state;          /* index of its first state in z */
  piece_end how;
  size_t obstacle; /* the one that is hit */
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
  size_t *at_start, *at_half;   /* even: [n] obstacle that a coordinate hits, NO_UNKNOWN: at rest there; else NULL */
  size_t start_count, half_count;
} arc_plan;

ric_status arcs_init(arc_plan *a, const ric_system *system, const ric_shooting_problem *problem, ric_error *error);
void arcs_clear(arc_plan *a);

/** The period at z. @param given  the given number of the problem */
double arcs_period(const arc_plan *a, const double *z, double given);
double arcs_time(event_time e, const double *z, double period);

/** Times at which a piece begins and ends. */
double piece_begin(const arc_piece *p, const double *z, double period);
double piece_finish(const arc_piece *p, const double *z, double period);

/** Numbers of the first state: n for even motions, else n + m. */
size_t arcs_first_numbers(const arc_plan *a);

/* Free motion along a piece of an arc, with tangent vectors.
 *
 * Rigid obstacles do not act on it: beyond one it is no motion of the system, but the equations of shooting are
 * defined there. Compliant obstacles act. In a system without them the flow alone suffices, and time may run
 * backwards. */

typedef struct arc_runner {
  const ric_system *system;
  ric_flow *flow;             /* NULL where compliant obstacles need a trajectory */
  ric_trajectory *trajectory; /* NULL otherwise */
  ric_poll poll;
  unsigned long long last_step; /* number of a step of the flow at which the integration is given up; 0: no limit */
} arc_runner;

ric_status arc_runner_init(arc_runner *runner, const ric_system *system, const ric_flow_options *flow, ric_poll poll,
                           ric_error *error);
void arc_runner_clear(arc_runner *runner);

/** Called with the pieces of steps, as ric_observer is. */
typedef struct arc_watch {
  int (*segment)(const ric_segment *piece, double end, void *user);
  void *user;
} arc_watch;

/** Integrates a state from one time to another.
 *  @param x  [n + m] state, replaced
 *  @param columns, d  [n + m][columns] row-major tangent vectors, replaced; 0, NULL for none
 *  @param watcher  called with the pieces; NULL
 *  @returns RIC_ENUMERIC when the motion blows up, takes too many steps, or would run backwards where it cannot;
 *  RIC_ECALLBACK, RIC_ESTOPPED, RIC_ENOMEM. */
ric_status arc_runner_move(arc_runner *runner, double from, double to, double *x, size_t columns, double *d,
                           const arc_watch *watcher, ric_error *error);

/** The flow that integrates it. */
ric_flow *arc_runner_flow(const arc_runner *runner);

#endif

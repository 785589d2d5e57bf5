/* Free motion along a piece of an arc, with tangent vectors: internal to the library.
 *
 * Rigid obstacles let it pass: where it goes through one it is no motion of the system, but the equations of shooting
 * have their values there. Compliant obstacles act. Without them the flow alone is enough, and time may run backwards.
 */
#ifndef RICOCHET_ARC_RUNNER_H
#define RICOCHET_ARC_RUNNER_H

#include "flow/flow_method.h"
#include "ricochet/trajectory.h"

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

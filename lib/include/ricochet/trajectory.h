/* Trajectories: event-driven simulation of motions with impacts.
 *
 * A trajectory integrates a system with a flow, locates contacts on the segments, applies the impact law and
 * continues. Contact location is certified: a step has no contact if bounds of the gap polynomial exclude one, and
 * the first root is proved to be the first. Two roots in one step are two roots. Only contacts shallower than the
 * integration error of the state can be missed (docs/theory.md).
 *
 * Nothing is stored: an observer receives segments and events in order. A run ends with an outcome; a failure keeps
 * the state, the time and the reason. Time only increases. */
#ifndef RICOCHET_TRAJECTORY_H
#define RICOCHET_TRAJECTORY_H

#include <stdbool.h>
#include <stddef.h>

#include "event.h"
#include "flow.h"

RIC_BEGIN_DECLARATIONS

#define RIC_RUN_OUTCOME_LIST(X)                                                                                        \
  X(RIC_RUN_COMPLETED, "completed")     /* the end was reached */                                                      \
  X(RIC_RUN_EVENT_LIMIT, "event_limit") /* more event times per unit of time than allowed */                           \
  X(RIC_RUN_BLOW_UP, "blow_up")         /* the state exceeds bounds, or steps become too short */                      \
  X(RIC_RUN_UNRESOLVED, "unresolved")   /* a gap or a contact force varies too fast for the steps */                   \
  X(RIC_RUN_CALLBACK_FAILED, "callback_failed")                                                                        \
  X(RIC_RUN_ENDED, "ended")                           /* requested by the observer */                                  \
  X(RIC_RUN_GRAZING, "grazing")                       /* tangent vectors undefined: a grazing contact */               \
  X(RIC_RUN_NOT_DIFFERENTIABLE, "not_differentiable") /* the same: impacts whose order matters   \ */

typedef enum ric_run_outcome {
#define X(name, text) name,
  RIC_RUN_OUTCOME_LIST(X)
#undef X
      RIC_RUN_OUTCOMES
} ric_run_outcome;

/** Name of an outcome, "completed". Never NULL. */
RIC_API const char *ric_run_outcome_name(ric_run_outcome outcome);

/** Receives a motion as it is computed. Either callback may be NULL. A non-zero return value ends the run with the
 *  outcome `ended`, after that event or after the pieces of that step. */
typedef struct ric_observer {
  /** A piece of the motion, valid for x in [0, end], 0 < end <= 1; pieces of one step follow each other. */
  int (*segment)(const ric_segment *piece, double end, void *user);
  /** Events. Simultaneous ones are ordered: Hertz contacts and releases first, then impacts, then rests, each by
   *  obstacle. */
  int (*event)(const ric_event *event, void *user);
  void *user;
} ric_observer;

typedef struct ric_trajectory_options {
  ric_flow_options flow;
  double event_time_tol; /* 1e-12: impacts closer in time, relative to 1 + |t|, are simultaneous */
  double grazing_tol;    /* 1e-10: minima of a gap within it of zero are grazing. Absolute */
  double chatter_tol; /* 1e-4: for e < 1, a series of impacts (chatter) that accumulates within this time is summed, or
                         within this fraction of the time in which the gap's acceleration changes by its own size if
                         that is shorter. The error is about its third power. It is at least the fourth root of the
                         flow's tolerance; smaller values would lose digits. 0: never */
  double rest_tol; /* 1e-13 (at least ten times the flow's tolerance): gap rates below it, relative to 1 + the largest
                      speed, are zero, as are gaps below it; such contacts can stick */
  double events_per_time; /* 1e5: more event times than this within a unit of time end the run */
  bool pass_rigid; /* rigid obstacles, including those of user systems, are ignored and only compliant ones act; default
                      false */
  ric_poll poll;   /* called at every step */
} ric_trajectory_options;

RIC_API ric_trajectory_options ric_trajectory_options_default(void);

/** Result of a run. */
typedef struct ric_run {
  ric_run_outcome outcome;
  char reason[256]; /* for people; "" when completed */
  double time;      /* reached */
  unsigned long long events[RIC_EVENT_KINDS];
  double energy_start, energy_end; /* NaN if the energy is unknown */
  double impact_loss;              /* energy dissipated by the impacts */
  ric_flow_counts flow;            /* of this run */
} ric_run;

typedef struct ric_trajectory ric_trajectory;

/** @param system  borrowed, must outlive the trajectory
 *  @param options  copied, NULL for the defaults; checked here
 *  @returns RIC_EINVAL for options out of range, and for a coordinate whose rigid floor and wall leave no room unless
 *           pass_rigid is set; RIC_ENOMEM. */
RIC_API ric_status ric_trajectory_create(const ric_system *system, const ric_trajectory_options *options,
                                         ric_trajectory **trajectory, ric_error *error);
RIC_API void ric_trajectory_destroy(ric_trajectory **trajectory);

/** Sets time and state. Discards the history, and reads the system's numbers again if they
 *  have changed (system.h). Closed contacts are evaluated when the run continues: those with a negative gap rate have
 *  an impact at once, those that are pressed stick.
 *  @param q, u  [n], [m]; u NULL if m = 0
 *  @returns RIC_EINVAL for a state that is not finite or lies below a rigid obstacle by more than grazing_tol, naming
 *           the obstacle and the gap, and for changed obstacles that leave no room, unless pass_rigid is set;
 *           RIC_ENOMEM. */
RIC_API ric_status ric_trajectory_start(ric_trajectory *trajectory, double t, const double *q, const double *u,
                                        ric_error *error);

/** Runs to the time `end`. Can be called again to continue, also after the outcomes `event_limit` and `ended`.
 *  @param observer  NULL for none
 *  @param run  what happened; every outcome is RIC_OK
 *  @returns RIC_EINVAL for an end before the current time or not finite, without a start, or for a system that has
 *           changed since the start; RIC_ESTOPPED. */
RIC_API ric_status ric_trajectory_run(ric_trajectory *trajectory, double end, const ric_observer *observer,
                                      ric_run *run, ric_error *error);

RIC_API double ric_trajectory_time(const ric_trajectory *trajectory);
RIC_API const double *ric_trajectory_q(const ric_trajectory *trajectory); /* [n], valid until the next run or start */
RIC_API const double *ric_trajectory_u(const ric_trajectory *trajectory); /* [m] */

/** Whether an obstacle's contact sticks (persists) now. */
RIC_API int ric_trajectory_rests(const ric_trajectory *trajectory, size_t obstacle);

/** Sets tangent vectors, which are propagated with the state from now on: between contacts by the variational
 *  equation (ric_flow_carry), through impacts by saltation matrices (saltation.h). Contacts that stick constrain
 *  them, too.
 *
 *  If an impact is grazing or non-differentiable, the tangent vectors are undefined and the run stops, after the
 *  impact if there is one, with an outcome that says so. The vectors are then lost, and a further run continues
 *  without them. Call this function between start and run, or between runs; ric_trajectory_start removes the vectors.
 *  @param dq, du  [n][columns], [m][columns] row-major, copied; du NULL if m = 0; columns 0 removes the vectors
 *  @returns RIC_EINVAL for values that are not finite, without a start, or for a system that has changed since the
 *           start; RIC_ENOMEM. */
RIC_API ric_status ric_trajectory_carry(ric_trajectory *trajectory, size_t columns, const double *dq, const double *du,
                                        ric_error *error);
RIC_API size_t ric_trajectory_columns(const ric_trajectory *trajectory);   /* 0 if they were lost */
RIC_API const double *ric_trajectory_dq(const ric_trajectory *trajectory); /* [n][columns], until the next call */
RIC_API const double *ric_trajectory_du(const ric_trajectory *trajectory); /* [m][columns] */

/** States at given times, filled during a run. Pass ric_sampler_segment as the observer's segment callback with the
 *  sampler as its user, or call it from your own callback. */
typedef struct ric_sampler {
  const double *times; /* [count] not decreasing. Borrowed */
  size_t count;
  size_t coordinates, speeds; /* n, m */
  double *q, *u;              /* [count][n], [count][m]; u may be NULL. Borrowed, filled; a time that coincides with an
                                 impact gets the state after it */
  size_t next;                /* index of the first time not filled yet; 0 at the start */
} ric_sampler;
RIC_API int ric_sampler_segment(const ric_segment *piece, double end, void *sampler);

/** Fills the remaining times up to the trajectory's current time with its state; call it after the run. */
RIC_API void ric_sampler_finish(ric_sampler *sampler, const ric_trajectory *trajectory);

RIC_END_DECLARATIONS

#endif

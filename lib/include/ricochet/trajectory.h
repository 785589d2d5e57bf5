/* Trajectories: motion with impacts, event by event.
 *
 * A trajectory moves a system with a flow, finds the contacts on its segments, applies the impact law and goes on.
 * Contacts are located with certainty: a step is free of them when bounds of the gap polynomial say so, and the first
 * root is the first because nothing else is possible. Two roots in one step are two roots. What an integration error
 * can hide is stated in docs/theory.md: contacts shallower than the error of the state.
 *
 * Nothing is stored: segments and events go to an observer, in order. A run ends with an outcome; a failure keeps the
 * state, the time and the reason. Motion goes forward in time only. */
#ifndef RICOCHET_TRAJECTORY_H
#define RICOCHET_TRAJECTORY_H

#include <stdbool.h>
#include <stddef.h>

#include "event.h"
#include "flow.h"

RIC_BEGIN_DECLARATIONS

#define RIC_RUN_OUTCOME_LIST(X)                                                                                        \
  X(RIC_RUN_COMPLETED, "completed")     /* reached the end */                                                          \
  X(RIC_RUN_EVENT_LIMIT, "event_limit") /* events at more times per unit of time than allowed */                       \
  X(RIC_RUN_BLOW_UP, "blow_up")         /* the state grows beyond bounds, or steps shrink to nothing */                \
  X(RIC_RUN_UNRESOLVED, "unresolved")   /* a gap or a contact force varies too fast for the steps */                   \
  X(RIC_RUN_CALLBACK_FAILED, "callback_failed")                                                                        \
  X(RIC_RUN_ENDED, "ended")                           /* the observer asked for the end */                             \
  X(RIC_RUN_GRAZING, "grazing")                       /* tangent vectors have no way through a contact that grazes */  \
  X(RIC_RUN_NOT_DIFFERENTIABLE, "not_differentiable") /* nor through impacts whose order matters */

typedef enum ric_run_outcome {
#define X(name, text) name,
  RIC_RUN_OUTCOME_LIST(X)
#undef X
      RIC_RUN_OUTCOMES
} ric_run_outcome;

/** Name of an outcome, "completed". Never NULL. */
RIC_API const char *ric_run_outcome_name(ric_run_outcome outcome);

/** Sees a motion as it is computed. Either callback may be NULL; non-zero ends the run with the outcome `ended`, after
 *  the event, or after the pieces of the step, that it was shown. */
typedef struct ric_observer {
  /** A piece of the motion, valid for x in [0, end], 0 < end <= 1; pieces of one step follow each other. */
  int (*segment)(const ric_segment *piece, double end, void *user);
  /** Events; of those of one time, switches and releases come first, then impacts, then rests, each in order of their
   *  obstacles. */
  int (*event)(const ric_event *event, void *user);
  void *user;
} ric_observer;

typedef struct ric_trajectory_options {
  ric_flow_options flow;
  double event_time_tol;  /* 1e-12: impacts closer than it, relative to 1 + |t|, are simultaneous */
  double grazing_tol;     /* 1e-10: minima of a gap within it of zero are grazing. Absolute */
  double chatter_tol;     /* 1e-4: for e < 1, a series of impacts that will have accumulated within this time (or within
                             this part of the time in which the gap's acceleration changes by its own size, when that is
                             shorter) is summed up. What is left out is about its third power. At least the
                            fourth root of the flow's tolerance: beyond, digits are lost. 0: never */
  double rest_tol;        /* 1e-13 (at least ten times the flow's tolerance): gap rates below it, relative to 1 + the
                             largest speed, are zero, and so are gaps below it */
  double events_per_time; /* 1e5: events at more times than this within a unit of time end the run */
  bool pass_rigid; /* rigid obstacles, users' among them, let every motion pass as if they were not there, and only
                      compliant ones act; default false */
  ric_poll poll;   /* asked at every step */
} ric_trajectory_options;

RIC_API ric_trajectory_options ric_trajectory_options_default(void);

/** What a run did. */
typedef struct ric_run {
  ric_run_outcome outcome;
  char reason[256]; /* for people; "" when completed */
  double time;      /* reached */
  unsigned long long events[RIC_EVENT_KINDS];
  double energy_start, energy_end; /* NaN where energy is not known */
  double impact_loss;              /* energy that the impacts took */
  ric_flow_counts flow;            /* of this run */
} ric_run;

typedef struct ric_trajectory ric_trajectory;

/** @param system  borrowed, must outlive the trajectory
 *  @param options  copied, NULL for the defaults; checked here
 *  @returns RIC_EINVAL, also for a coordinate whose rigid floor and wall leave no room, unless motions pass them;
 *           RIC_ENOMEM. */
RIC_API ric_status ric_trajectory_create(const ric_system *system, const ric_trajectory_options *options,
                                         ric_trajectory **trajectory, ric_error *error);
RIC_API void ric_trajectory_destroy(ric_trajectory **trajectory);

/** Sets time and state [n], [m] (u NULL where m = 0); forgets the history, and takes over the system's numbers if they
 *  have changed (system.h). Closed contacts are looked at when the run goes on: those that move in hit at once, those
 *  that are pushed in rest.
 *  @returns RIC_EINVAL for a state that is not finite or lies below a rigid obstacle by more than grazing_tol, naming
 *           the obstacle and the gap, and for obstacles that leave no room since they have changed, unless motions pass
 *           them; RIC_ENOMEM. */
RIC_API ric_status ric_trajectory_start(ric_trajectory *trajectory, double t, const double *q, const double *u,
                                        ric_error *error);

/** Moves on to time `end`. Can be called again to go on, also after an event limit or the observer's end.
 *  @param observer  NULL for none
 *  @param run  what happened; every outcome is RIC_OK
 *  @returns RIC_EINVAL for an end before the time reached or not finite, without a start, or for a system that has
 *           changed since; RIC_ESTOPPED. */
RIC_API ric_status ric_trajectory_run(ric_trajectory *trajectory, double end, const ric_observer *observer,
                                      ric_run *run, ric_error *error);

RIC_API double ric_trajectory_time(const ric_trajectory *trajectory);
RIC_API const double *ric_trajectory_q(const ric_trajectory *trajectory); /* [n], valid until the next run or start */
RIC_API const double *ric_trajectory_u(const ric_trajectory *trajectory); /* [m] */

/** Whether an obstacle's contact persists now. */
RIC_API int ric_trajectory_rests(const ric_trajectory *trajectory, size_t obstacle);

/** Tangent vectors that move along with the state from now on, between contacts as ric_flow_carry says, through impacts
 *  by their saltation (saltation.h). Contacts that persist hold them, too. A run that meets a contact through which
 * they have no way, one that grazes or impacts whose order matters, ends there with an outcome that says so, after the
 *  impact if there is one; they are lost, and a further run goes on without them. Call it between start and run, or
 * between runs; ric_trajectory_start ends it.
 *  @param dq, du  [n][columns], [m][columns] row-major, copied; du NULL where m = 0; columns 0: none any more
 *  @returns RIC_EINVAL for values that are not finite, without a start, or for a system that has changed since;
 *           RIC_ENOMEM. */
RIC_API ric_status ric_trajectory_carry(ric_trajectory *trajectory, size_t columns, const double *dq, const double *du,
                                        ric_error *error);
RIC_API size_t ric_trajectory_columns(const ric_trajectory *trajectory);   /* 0 when they were lost */
RIC_API const double *ric_trajectory_dq(const ric_trajectory *trajectory); /* [n][columns], until the next call */
RIC_API const double *ric_trajectory_du(const ric_trajectory *trajectory); /* [m][columns] */

/** States at given times, filled in as a run goes: hand ric_sampler_segment to the run as the observer's segment
 *  callback with the sampler as its user, or call it from your own. */
typedef struct ric_sampler {
  const double *times; /* [count] not decreasing. Borrowed */
  size_t count;
  size_t coordinates, speeds; /* n, m */
  double *q, *u;              /* [count][n], [count][m]; u may be NULL. Borrowed, filled; a time that coincides with an
                                 impact gets the state after it */
  size_t next;                /* first time not filled yet; 0 at the start */
} ric_sampler;
RIC_API int ric_sampler_segment(const ric_segment *piece, double end, void *sampler);

/** Fills the remaining times that are not later than the trajectory's own with its state; call it after the run. */
RIC_API void ric_sampler_finish(ric_sampler *sampler, const ric_trajectory *trajectory);

RIC_END_DECLARATIONS

#endif

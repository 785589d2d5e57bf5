/* Data of a trajectory: internal to the room. */
#ifndef RICOCHET_INTERNAL_TRAJECTORY_H
#define RICOCHET_INTERNAL_TRAJECTORY_H

#include "impact_law.h"
#include "locate.h"
#include "ricochet/trajectory.h"
#include "saltation.h"

/** Obstacles in a list that grows. */
typedef struct index_list {
  size_t *items;
  size_t count, capacity;
} index_list;

ric_status index_list_add(index_list *list, size_t item, ric_error *error);

/** Whether a contact sticks; COMES_TO_REST: it is held since its impacts were summed, and sticks from a time in
 * `coming` on. */
typedef enum resting { RESTS_NOT, RESTS, COMES_TO_REST } resting;

typedef struct coming_rest {
  double time;
  size_t obstacle;
} coming_rest;

/** Workspace of tangent vectors at the onset of contacts. */
typedef struct impact_tangents {
  tangent_jump jump;
  double *before; /* [n + m] state before the current events */
  unsigned char *contact, *contact_before,
      *contact_after;  /* [obstacles] contact states: between simultaneous impacts, before them, after one */
  double *other;       /* [n + m][columns] in the other order of simultaneous impacts */
  double *state;       /* [n + m] between simultaneous impacts */
  index_list group;    /* contacts that act together, */
  double *restitution; /* [restitution_capacity] and their restitutions */
  size_t restitution_capacity;
  ric_saltation_kind kind; /* of the last contacts; not differentiable: the tangent vectors are lost */
  size_t obstacle;         /* at which they were lost, */
  double time;             /* and when */
} impact_tangents;

struct ric_trajectory {
  const ric_system *system;
  ric_trajectory_options options;
  ric_flow *flow;
  locator locator;
  impact_solver law;
  bool started, fresh; /* fresh: contacts at the start have not been evaluated yet */
  double noise;        /* gaps and gap rates below it, relative to 1 + the size of the state, are zero */
  double rate_noise;   /* the same for gap rates in the current state; for gaps: locator.noise */

  impact *impacts; /* simultaneous contacts */
  size_t impact_count, impact_capacity;
  unsigned char *resting;               /* [obstacles] */
  index_list held, departing, settling; /* contacts that stick; that have just opened; that are undecided */
  index_list closed;                    /* work: contacts that act together */
  double *accelerations, *forces;       /* of settling contacts, grown with them */
  size_t settling_capacity;
  coming_rest *coming; /* in no order */
  size_t coming_count, coming_capacity;
  double *rates, *shifted; /* [n + m] work */
  impact_tangents tangents;

  const ric_observer *observer; /* of the current run; NULL: none */
  ric_run *run;
  bool ended;          /* requested by the observer */
  double window_start; /* of the unit of time in which events are counted */
  double window_events;
};

/** Sets the time to another one at which the forces are the same; nothing else changes, including contacts and tangent
 *  vectors. */
ric_status trajectory_set_clock(ric_trajectory *tr, double time, ric_error *error);

/** Passes an event to the observer and counts it. Unset fields: see event_of. */
void trajectory_show(ric_trajectory *tr, const ric_event *event);

/** An event of an obstacle at the current time, with place and time only. */
ric_event event_of(const ric_trajectory *tr, ric_event_kind kind, size_t obstacle);
void trajectory_show_kind(ric_trajectory *tr, ric_event_kind kind, size_t obstacle);

/** Evaluates the contacts closed at the start: some have an impact at once, some stick, some open. */
ric_status contacts_begin(ric_trajectory *tr, ric_error *error);

/** The flow is at the first roots of a step: applies the events there and restarts the flow. */
ric_status contacts_onset(ric_trajectory *tr, ric_error *error);

/** Decides which of tr->settling stick and which open, and empties the list. If contacts couple, the list holds all
 *  closed contacts, persistent ones included. */
ric_status contacts_settle(ric_trajectory *tr, ric_error *error);

/** Projects contacts onto their obstacles, all together: removes the gaps caused by errors of the flow by the least
 *  motion along the directions of impulses. First-order systems have no such directions and are unchanged. */
ric_status contacts_put_on(ric_trajectory *tr, const size_t *obstacles, size_t count, ric_error *error);

/** Projects held contacts of user systems that have drifted back onto their obstacles. @param moved  whether any was */
ric_status contacts_keep_on(ric_trajectory *tr, bool *moved, ric_error *error);

/** Rates of a state at time t into tr->rates, and the second derivative of a gap from these rates. @returns
 *  RIC_ECALLBACK with the failure of the system in the message */
ric_status contact_rates(ric_trajectory *tr, double t, const double *q, const double *u, ric_error *error);
ric_status contact_acceleration(ric_trajectory *tr, double t, const double *q, const double *u, size_t obstacle,
                                double *acceleration, ric_error *error);

/** Second derivative of a gap in the current state, with its own contact open. */
ric_status gap_acceleration(ric_trajectory *tr, size_t obstacle, double *acceleration, ric_error *error);

/** Tangent vectors are undefined at this contact. */
void impact_tangents_lose(ric_trajectory *tr, size_t obstacle, double time, ric_saltation_kind kind);

void impact_tangents_clear(impact_tangents *c);

/** Removes tangent vectors that are lost. @param reason  text of why, set */
ric_status impact_tangents_end(ric_trajectory *tr, char *reason, size_t room, ric_error *error);

/** Finds the impacts of tr->impacts [count] whose series accumulates soon, and sets their `accumulation`: the time from
 *  now, NaN for all others. @param hits  number of new impacts, which come first; the others are persistent contacts */
ric_status chatter_ahead(ric_trajectory *tr, size_t hits, ric_error *error);

/** Sets rate_noise and locator.noise for the current state. */
void contacts_measure(ric_trajectory *tr);

/* The states of a contact (contact.c). */

/** Sets all contacts open and clearly positive, or passed, and empties all lists. */
void contacts_reset(ric_trajectory *tr);

/** Whether it is rigid and ignored (pass_rigid). */
bool contact_is_passed(const ric_trajectory *tr, size_t obstacle);

/** Whether it sticks, or is held and will stick. */
bool contact_persists(const ric_trajectory *tr, size_t obstacle);

/** It opens, or stays open, and departs from its current gap; a sticking one is released, with an event. It stays on
 *  the list of held contacts until contacts_forget_released. */
ric_status contact_opens(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error);
void contacts_forget_released(ric_trajectory *tr);

/** It is pressed from now on; DEPARTED: it is clear of zero. */
ric_status contact_presses(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error);

/** It is held, and sticks from a later time on. */
ric_status contact_will_rest(ric_trajectory *tr, size_t obstacle, double time, ric_error *error);

/** Emits the events `rest` that are due. */
void contacts_come_to_rest(ric_trajectory *tr);

/** The next time at which a contact sticks, `end` if that is later. */
double contacts_next_rest(const ric_trajectory *tr, double end);

/** After a step, or the part of it up to its first event: contacts clear of zero have departed. */
ric_status contacts_depart(ric_trajectory *tr, ric_error *error);

#endif

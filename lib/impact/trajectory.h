/* What a trajectory holds: internal to the impact room. */
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

/** Whether a contact persists; COMES_TO_REST: it is held since its impacts were summed up, and will have come to rest
 * at a time in `coming`. */
typedef enum resting { RESTS_NOT, RESTS, COMES_TO_REST } resting;

typedef struct coming_rest {
  double time;
  size_t obstacle;
} coming_rest;

/** What tangent vectors need where contacts meet. */
typedef struct impact_tangents {
  tangent_jump jump;
  double *before;                                          /* [n + m] state before what is happening now */
  unsigned char *contact, *contact_before, *contact_after; /* [obstacles] the same for contacts: between impacts of one
                                                              time, before them, after one */
  double *other;       /* [n + m][columns] in the other order of simultaneous impacts */
  double *state;       /* [n + m] between impacts of one time */
  index_list group;    /* contacts that push together, */
  double *restitution; /* [restitution_capacity] and theirs */
  size_t restitution_capacity;
  ric_saltation_kind kind; /* of the last contacts; not differentiable: the tangent vectors are lost */
  size_t obstacle;         /* that has lost them, */
  double time;             /* and when */
} impact_tangents;

struct ric_trajectory {
  const ric_system *system;
  ric_trajectory_options options;
  ric_flow *flow;
  locator locator;
  impact_solver law;
  bool started, fresh; /* fresh: contacts at the start have not been looked at yet */
  double noise;        /* gaps and gap rates below it, relative to 1 + the size of the state, are zero */
  double rate_noise;   /* the same for gap rates in the present state; for gaps: locator.noise */

  impact *impacts; /* contacts of one time */
  size_t impact_count, impact_capacity;
  unsigned char *resting;               /* [obstacles] */
  index_list held, departing, settling; /* contacts that persist; have just left; are to be decided */
  index_list closed;                    /* work: contacts that act together */
  double *accelerations, *forces;       /* of settling contacts, grown with them */
  size_t settling_capacity;
  coming_rest *coming; /* in no order */
  size_t coming_count, coming_capacity;
  double *rates, *shifted; /* [n + m] work */
  impact_tangents tangents;

  const ric_observer *observer; /* of the run going on; NULL: none */
  ric_run *run;
  bool ended;          /* the observer asked for it */
  double window_start; /* of the unit of time in which events are counted */
  double window_events;
};

/** Sets the clock to another time at which the forces are the same; everything else stays as it is, contacts and
 *  tangent vectors too. */
ric_status trajectory_set_clock(ric_trajectory *tr, double time, ric_error *error);

/** Shows an event to the observer and counts it. Unset fields: see event_of. */
void trajectory_show(ric_trajectory *tr, const ric_event *event);

/** An event of an obstacle now, with nothing known but where and when. */
ric_event event_of(const ric_trajectory *tr, ric_event_kind kind, size_t obstacle);
void trajectory_show_kind(ric_trajectory *tr, ric_event_kind kind, size_t obstacle);

/** Looks at the contacts closed at the start: some hit at once, some rest, some leave. */
ric_status contacts_begin(ric_trajectory *tr, ric_error *error);

/** The flow stands at the first roots of a step: applies what happens there and restarts the flow. */
ric_status contacts_onset(ric_trajectory *tr, ric_error *error);

/** Decides which of tr->settling persist and which open, and empties it. In systems whose contacts couple the list
 *  holds all that are closed, those that persist with them. */
ric_status contacts_settle(ric_trajectory *tr, ric_error *error);

/** Puts contacts onto their obstacles, all together: takes away what errors of the flow have left of their gaps, by the
 *  least motion along the directions in which impulses move them. First-order systems have none and stay. */
ric_status contacts_put_on(ric_trajectory *tr, const size_t *obstacles, size_t count, ric_error *error);

/** Puts held contacts of user systems back where they have drifted off. @param moved  whether any was */
ric_status contacts_keep_on(ric_trajectory *tr, bool *moved, ric_error *error);

/** Second derivative of a gap in the present state, with its own contact open. */
ric_status gap_acceleration(ric_trajectory *tr, size_t obstacle, double *acceleration, ric_error *error);

/** Before contacts meet: remembers what tangent vectors need. Does nothing when none are carried; nor do the next. */
void impact_tangents_mark(ric_trajectory *tr);

/** A contact has been touched so that tangent vectors have no way on. */
void impact_tangents_lose(ric_trajectory *tr, size_t obstacle, double time, ric_saltation_kind kind);

/** After the contacts have met: takes tangent vectors through the first `hits` of tr->impacts. */
ric_status impact_tangents_jump(ric_trajectory *tr, size_t hits, ric_error *error);

/** A contact persists from the start on, and holds the tangent vectors. */
void impact_tangents_hold(ric_trajectory *tr, size_t obstacle);
void impact_tangents_clear(impact_tangents *c);

/** Tangent vectors that are lost are carried no more. @param reason  text of why, set */
ric_status impact_tangents_end(ric_trajectory *tr, char *reason, size_t room, ric_error *error);

/** Finds the impacts of tr->impacts [count] whose series accumulates soon, and sets their `accumulation`: the time from
 *  now, NaN for all others. @param hits  how many of them are new, the first ones; the others persist */
ric_status chatter_ahead(ric_trajectory *tr, size_t hits, ric_error *error);

/** Measures the present state: sets rate_noise and locator.noise. */
void contacts_measure(ric_trajectory *tr);

/* The life of a contact (contact.c). */

/** All contacts open and clear of zero, or passed, nothing on any list. */
void contacts_reset(ric_trajectory *tr);

/** It is rigid and motions go through it, from the start on. */
bool contact_is_passed(const ric_trajectory *tr, size_t obstacle);

/** It rests or comes to rest. */
bool contact_persists(const ric_trajectory *tr, size_t obstacle);

/** It opens, or stays open, and departs from its present gap; one that has persisted is released, which is shown. Those
 *  stay on the list of held ones until contacts_forget_released. */
ric_status contact_opens(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error);
void contacts_forget_released(ric_trajectory *tr);

/** It presses from now on; DEPARTED: it is clear of zero. */
ric_status contact_presses(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error);

/** It is held from now on; one that has not persisted comes to rest, which is shown. */
ric_status contact_rests(ric_trajectory *tr, size_t obstacle, ric_error *error);

/** It persists, and counts as at rest from a later time on. */
ric_status contact_will_rest(ric_trajectory *tr, size_t obstacle, double time, ric_error *error);

/** Shows those whose time of rest has come. */
void contacts_come_to_rest(ric_trajectory *tr);

/** The first time of rest to come, `end` when it is later. */
double contacts_next_rest(const ric_trajectory *tr, double end);

/** A step, or the part of it up to its first event, is over: contacts that are clear of zero have departed. */
ric_status contacts_depart(ric_trajectory *tr, ric_error *error);

/** Present value of the function whose root is a contact's next event: its gap, or minus its gap while it is pressed.
 */
double departure_value(const ric_trajectory *tr, size_t obstacle);

#endif

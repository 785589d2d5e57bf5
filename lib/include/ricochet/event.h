/* Events of a motion with obstacles: what happened, where, when, how hard.
 *
 *   transversal   an impact: the gap vanishes with a rate below zero
 *   grazing       a gap whose minimum lies within grazing_tol of zero, `depth`. Above zero, and where the rate is zero
 *                 to rounding, nothing jumps; below it the impact law was applied to the small rate
 *   simultaneous  an impact within event_time_tol of another that does not couple with it: order does not matter
 *   coupled       an impact whose impulse depends on those of other contacts closed at that time (2.9); in sequence, in
 *                 another order, the outcome would differ
 *   chatter       an impact of a series whose intervals shrink like a geometric one: the rest of it is summed up.
 *                 `accumulation` is the time at which it ends
 *   rest          a contact begins to persist: gap and gap rate stay zero, held by a force
 *   release       that force has come down to zero and the contact opens
 *   contact       a compliant (Hertz) obstacle begins to press; nothing jumps
 *   parting       it ends to press */
#ifndef RICOCHET_EVENT_H
#define RICOCHET_EVENT_H

#include <stddef.h>

#include "export.h"

RIC_BEGIN_DECLARATIONS

#define RIC_EVENT_LIST(X)                                                                                              \
  X(RIC_EVENT_TRANSVERSAL, "transversal")                                                                              \
  X(RIC_EVENT_GRAZING, "grazing")                                                                                      \
  X(RIC_EVENT_SIMULTANEOUS, "simultaneous")                                                                            \
  X(RIC_EVENT_COUPLED, "coupled")                                                                                      \
  X(RIC_EVENT_CHATTER, "chatter")                                                                                      \
  X(RIC_EVENT_REST, "rest")                                                                                            \
  X(RIC_EVENT_RELEASE, "release")                                                                                      \
  X(RIC_EVENT_CONTACT, "contact")                                                                                      \
  X(RIC_EVENT_PARTING, "parting")

typedef enum ric_event_kind {
#define X(name, text) name,
  RIC_EVENT_LIST(X)
#undef X
      RIC_EVENT_KINDS
} ric_event_kind;

/** Name of a kind, "transversal". Never NULL. */
RIC_API const char *ric_event_name(ric_event_kind kind);

typedef struct ric_event {
  ric_event_kind kind;
  double time;
  size_t obstacle;     /* index among the system's obstacles */
  size_t coordinate;   /* of the obstacle; SIZE_MAX for gaps of user systems */
  double gap_rate;     /* just before, <= 0 at impacts; 0 at grazing above zero, rest and release */
  double gap_rate_end; /* just after */
  double impulse;      /* along the gap's gradient, >= 0; NaN for impact maps of first-order systems */
  double energy_loss;  /* that the impact took from the system, shared out over the contacts of one time; NaN where
                          energy is not known */
  double depth;        /* grazing: the minimum of the gap; NaN for other kinds */
  double accumulation; /* chatter: when the impacts accumulate; NaN for other kinds */
} ric_event;

/** Whether the speeds jump at events of this kind. */
static inline int ric_event_jumps(const ric_event *event) {
  return event->impulse != 0 && event->kind <= RIC_EVENT_CHATTER;
}

RIC_END_DECLARATIONS

#endif

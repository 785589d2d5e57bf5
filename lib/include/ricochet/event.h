/* Events of a motion with obstacles: what happened, where, when, and at which gap rate.
 *
 *   transversal   an impact: the gap vanishes with a negative rate
 *   grazing       a grazing contact: the minimum `depth` of the gap lies within grazing_tol of zero. If it is above
 *                 zero (a near miss), or the rate is zero to rounding, nothing jumps; if it is below, the impact law
 *                 was applied to the small rate
 *   simultaneous  an impact within event_time_tol of another with which it does not couple: the order does not matter
 *   coupled       an impact whose impulse depends on those of other contacts closed at that time ([FN97] (2.9)). The
 *                 same impacts one after another, in some order, would give another result
 *   chatter       an impact of a series that accumulates (Zeno behaviour): its intervals shrink geometrically and the
 *                 rest of the series is summed. `accumulation` is the time at which it ends
 *   rest          a contact begins to stick: gap and gap rate stay zero, held by a contact force
 *   release       the contact force reaches zero and the contact opens
 *   contact       onset of contact with a compliant (Hertz) obstacle; nothing jumps
 *   parting       end of contact with a compliant obstacle */
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
  double energy_loss;  /* energy dissipated by the impact, divided among simultaneous contacts; NaN where energy is
                          unknown */
  double depth;        /* grazing: minimum of the gap; NaN for other kinds */
  double accumulation; /* chatter: time at which the impacts accumulate; NaN for other kinds */
} ric_event;

/** Whether the speeds jump at this event. */
static inline int ric_event_jumps(const ric_event *event) {
  return event->impulse != 0 && event->kind <= RIC_EVENT_CHATTER;
}

RIC_END_DECLARATIONS

#endif

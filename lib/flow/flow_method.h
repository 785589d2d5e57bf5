/* The functions that every method of a flow provides: internal to the library. */
#ifndef RICOCHET_FLOW_METHOD_H
#define RICOCHET_FLOW_METHOD_H

#include "model/system_model.h"
#include "ricochet/flow.h"

typedef struct flow_method {
  /** A new motion begins; `start` follows. Discards what was learnt from the steps of the previous motion; `renewed`:
   *  the system's numbers have changed and are read again. After a failure the arrays can be destroyed, or `begin`
   *  called again. NULL: the flow stores neither. */
  ric_status (*begin)(ric_flow *flow, bool renewed, ric_error *error);
  /** Discards the history; time, state and contacts of the flow have changed. */
  ric_status (*start)(ric_flow *flow, ric_error *error);
  /** Sets flow->length and flow->end for a step towards `stop`; end is `stop` itself if the step reaches it. */
  ric_status (*step)(ric_flow *flow, double stop, ric_error *error);
  ric_segment (*piece)(ric_flow *flow, size_t index);
  /** Moves flow->q and flow->u to position x of the step. */
  void (*accept)(ric_flow *flow, double x);
  /** Force of a held contact along the step as a polynomial c [RIC_POLY_DEGREE + 1] in x; returns its degree, -1 if it
   * has none. NULL: the flow provides states only, from which forces follow. */
  int (*reaction)(ric_flow *flow, size_t obstacle, double *c);
  /** flow->tangent has been replaced: makes room for the tangents. */
  ric_status (*carry)(ric_flow *flow, ric_error *error);
  /** Propagates flow->tangent to position x of the step; the state has not been moved yet. */
  void (*transport)(ric_flow *flow, double x);
  void (*destroy)(ric_flow *flow);
} flow_method;

/** A method's struct begins with this. */
struct ric_flow {
  const flow_method *method;
  const ric_system *system;
  ric_flow_options options;    /* with all defaults replaced */
  double time, length, end;    /* start of the step, its signed length, its end */
  double *q, *u;               /* [n], [m] state at `time`, owned */
  unsigned char *contact;      /* [obstacles] contact_state, owned */
  tangents tangent;            /* at `time`, owned */
  size_t tangent_room;         /* allocated columns of its block */
  unsigned long long revision; /* revision of the system whose numbers the flow uses */
  size_t pieces;
  ric_flow_counts counts;
};

/** Creates a flow of each method; flow_init initialises the common part. */
ric_status lattice_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                               ric_error *error);
ric_status mck_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                           ric_error *error);
ric_status cvodes_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                              ric_error *error);

/** Allocates state and contacts, all open. */
ric_status flow_init(ric_flow *flow, const flow_method *method, const ric_system *system,
                     const ric_flow_options *options, ric_error *error);
void flow_clear(ric_flow *flow);

/** @returns RIC_EINVAL if the system has changed since the start. */
ric_status flow_check_revision(const ric_flow *flow, ric_error *error);

/** The state, the tangents or the contacts were changed in place: discards the history. */
ric_status flow_restart(ric_flow *flow, ric_error *error);

/** Changes the state of a contact. Takes effect with the next start or restart. A held coordinate must have rate zero.
 */
void flow_set_contact(ric_flow *flow, size_t obstacle, contact_state state);
contact_state flow_contact(const ric_flow *flow, size_t obstacle);

#endif

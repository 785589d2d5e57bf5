/* The Taylor flow of a lattice, for the files that share it: internal to the flow. */
#ifndef RICOCHET_LATTICE_FLOW_PARTS_H
#define RICOCHET_LATTICE_FLOW_PARTS_H

#include "lattice_series.h"
#include "lattice_variation.h"
#include "taylor_stepper.h"

typedef struct lattice_flow {
  ric_flow base;
  taylor_stepper stepper;
  const ric_lattice *lattice;   /* the system's */
  lattice_series *series;       /* of the piece that was asked for last */
  lattice_series *aside;        /* of the neighbourhood of one particle; NULL with one piece */
  size_t block;                 /* particles of a piece, the last may have fewer */
  size_t made;                  /* piece that `series` holds, SIZE_MAX: none */
  size_t ended;                 /* the first pieces have their state at the end of the step in q_next, u_next */
  double *q_next, *u_next;      /* [n] */
  lattice_variation *variation; /* NULL until tangent vectors are carried */

  /* Contacts, each list in order of coordinates. */
  size_t *held;           /* [held_count], of at most [obstacles] */
  lattice_press *pressed; /* [pressed_count], of at most [compliant obstacles] */
  lattice_press *acting;  /* [acting_count] those of `pressed` whose force has a series at the start of this step */
  size_t held_count, pressed_count, acting_count;
  bool contacts_changed; /* since `series` was told */
  bool aside_stale;
} lattice_flow;

/** Sorts out which pressed contacts act. Those that have only just closed, or are about to open, have no series; their
 *  force is negligible on a short step and left out.
 *  @param direction  +1 or -1, the sense of time
 *  @param limit  set to the longest step with that force left out, INFINITY when all act */
ric_status lattice_flow_take_contacts(lattice_flow *flow, int direction, double *limit, ric_error *error);

/** Collects held and pressed contacts from the states of the flow's contacts. */
void lattice_flow_list_contacts(lattice_flow *flow);

/** Whether a pressed contact takes part in this step. */
bool lattice_flow_acts(const lattice_flow *flow, const lattice_press *press);

int lattice_flow_reaction(ric_flow *flow, size_t obstacle, double *c);

#endif

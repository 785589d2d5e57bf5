/* The Taylor flow of a lattice, for the files that share it: internal to the flow. */
#ifndef RICOCHET_LATTICE_FLOW_PARTS_H
#define RICOCHET_LATTICE_FLOW_PARTS_H

#include <math.h>

#include "flow_method.h"
#include "lattice_series.h"

typedef struct lattice_flow {
  ric_flow base;
  const ric_lattice *lattice; /* the system's */
  lattice_series *series;     /* of the piece that was asked for last */
  lattice_series *aside;      /* of the neighbourhood of one particle; NULL with one piece */
  size_t block;               /* particles of a piece, the last may have fewer */
  size_t made;                /* piece that `series` holds, SIZE_MAX: none */
  size_t ended;               /* the first pieces have their state at the end of the step in q_next, u_next */
  double *q_next, *u_next;    /* [n] */

  /* Contacts, each list in order of coordinates. */
  size_t *held;           /* [held_count], of at most [obstacles] */
  lattice_press *pressed; /* [pressed_count], of at most [compliant obstacles] */
  lattice_press *acting;  /* [acting_count] those of `pressed` whose force has a series at the start of this step */
  size_t held_count, pressed_count, acting_count;
  bool contacts_changed; /* since `series` was told */
  bool aside_stale;

  int order;
  bool linear;           /* the step follows from the bound of frequencies while no Hertz contact acts */
  double longest;        /* that step */
  double longest_forced; /* the step that the frequency of the forcing allows */
  double trial;          /* length at which the next series is computed when the step follows from its decay */
} lattice_flow;

/** Degree of the segments, and longest step times the highest frequency, for a tolerance. */
int lattice_flow_order(double tolerance);
double lattice_flow_reach(double tolerance, int order);

/** Length for the series of a first step: that of the linear part if it has one. */
static inline double lattice_flow_first_trial(const lattice_flow *flow) {
  return isfinite(flow->longest) ? flow->longest : 1;
}

/** Chooses the step: sets length and end of the flow. */
ric_status lattice_flow_choose_step(lattice_flow *flow, double stop, ric_error *error);

/** Puts piece `index` of a step of the given length into the workspace, with its end state where that comes cheap. */
ric_segment lattice_flow_make(lattice_flow *flow, size_t index, double length);

/** Sorts out which pressed contacts act. Those that have only just closed, or are about to open, have no series; their
 *  force is negligible on a short step and left out.
 *  @param direction  +1 or -1, the sense of time
 *  @param limit  set to the longest step with that force left out, INFINITY when all act */
ric_status lattice_flow_take_contacts(lattice_flow *flow, int direction, double *limit, ric_error *error);

/** Collects held and pressed contacts from the states of the flow's contacts. */
void lattice_flow_list_contacts(lattice_flow *flow);

int lattice_flow_reaction(ric_flow *flow, size_t obstacle, double *c);

#endif

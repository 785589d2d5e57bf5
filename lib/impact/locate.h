/* Where contacts begin and end on a step of a flow: internal to the library.
 *
 * One locator for all flows and all kinds of contact. Each contact has a function that is positive until its next
 * event: the gap of an open obstacle, the force of a held one, minus the gap of a pressed one. Bounds exclude most of
 * them at once; the first roots of the rest are found with certainty (polynomial.h). */
#ifndef RICOCHET_LOCATE_H
#define RICOCHET_LOCATE_H

#include "gap.h"

/** How an open or pressed contact has begun; tells a root at the start of the step from the next one. */
typedef enum departure {
  DEPARTED,      /* its function is clear of zero */
  DEPARTS_FAST,  /* it is zero with a positive rate: the next root is that of the function divided by x */
  DEPARTS_SLOWLY /* zero with rate zero: it must fall below its value then by the noise to have a root */
} departure;

/** An event on the step. */
typedef struct contact_root {
  size_t obstacle;
  double x;     /* position in the step */
  double depth; /* grazing without contact: the minimum of the gap; NaN: a root */
} contact_root;

typedef struct contact_root_list {
  contact_root *hits;
  size_t count, capacity;
} contact_root_list;

typedef struct locator {
  gap_reader reader;
  unsigned char *departure;  /* [obstacles] */
  double *base;              /* [obstacles] value of the function when it departed slowly */
  double grazing_tol, noise; /* values of the functions below the noise are zero */
  size_t parts;              /* interpolated in this step */
  double horizon;            /* the step was looked at up to here: 1 unless functions vary too fast for all of it */
  double *lower, *upper;     /* bounds of the coordinates of a piece */
  size_t width;
  double first;             /* position of the first root in the step; > 1 when there is none */
  contact_root_list roots;  /* those within the time tolerance of it */
  contact_root_list grazes; /* minima above zero before it */
} locator;

ric_status locator_init(locator *l, ric_flow *flow, double grazing_tol, ric_error *error);
void locator_clear(locator *l);

/** Looks at a step of the flow. Afterwards `roots` holds the first event and those within time_tol of it, in order of
 *  obstacles, or nothing; `grazes` the near misses before it, in order of time. Nothing is known beyond `horizon`.
 *  @returns RIC_ENOMEM, RIC_ECALLBACK; RIC_ELIMIT when a function varies too fast to be resolved in the step. */
ric_status locator_scan(locator *l, ric_flow *flow, double time_tol, ric_error *error);

#endif

/* The motion of a chain over half a period, as segments, and states of an orbit at any time. Internal to the library.
 */
#ifndef RICOCHET_MOTION_H
#define RICOCHET_MOTION_H

#include <stdbool.h>

#include "flow/lattice_series.h"

/* The solution: the state of the chain at both ends of the half period. */

/** Arrays [sites], borrowed. */
typedef struct boundary_state {
  double *q, *v;           /* t = 0+ */
  double *q_half, *v_half; /* t = (T/2)- */
} boundary_state;

/* The motion of an orbit over its half period, as a stream of segments.
 *
 * The flow runs from t = 0+ forward to T/4 and from t = (T/2)- back to T/4. An orbit is even about both ends, so
 * this is the whole motion; both contacts are at the start of a run, where the segment begins exactly at the
 * contact; and the difference of the two runs at T/4 measures how well the state satisfies the equations of motion. */

/** One block of particles over one step. */
typedef struct motion_piece {
  ric_segment segment; /* in the orbit's time; length < 0 in the run from T/2 */
  bool from_half;      /* belongs to that run */
  bool at_contact;     /* first step of its run: starts at the impacts */
} motion_piece;

/** Called with every piece; in a run in order of its steps, in a step in order of particles. */
typedef void (*motion_visit)(const motion_piece *piece, void *user);

typedef struct motion {
  lattice_series *series;
  ric_lattice lattice; /* that of the chain of the run */
  size_t capacity;
  double *store; /* [6][capacity]: two states of a run, and the end of the second run */
} motion;

ric_status motion_prepare(motion *m, size_t particles, ric_error *error);
void motion_clear(motion *m);

/** Streams the pieces. @param visit  NULL: only the mismatch is computed
 *  @param mismatch  set to the largest difference of the two runs at T/4, in positions and in velocities over the
 *  largest frequency; may be NULL
 *  @returns RIC_ESTOPPED when the poll callback asks to stop. */
ric_status motion_run(motion *m, const ric_chain *chain, double period, const boundary_state *state, motion_visit visit,
                      void *user, double *mismatch, ric_poll poll, ric_error *error);

#endif

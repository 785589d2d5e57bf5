/* What a solver finds: the state of the chain at both ends of the half period. Internal to the library. */
#ifndef RICOCHET_BOUNDARY_STATE_H
#define RICOCHET_BOUNDARY_STATE_H

/** Arrays [sites], borrowed. */
typedef struct boundary_state {
  double *q, *v;           /* t = 0+ */
  double *q_half, *v_half; /* t = (T/2)- */
} boundary_state;

#endif

/* Motion of a chain between impacts as a sum over its modes: exact, O(n^2) per time, and nothing of it shared with the
 * Taylor flow that it is a witness for. The modes themselves are compared with a dense eigenvalue solver in
 * test_chain. */
#ifndef RICOCHET_TESTS_MODAL_MOTION_H
#define RICOCHET_TESTS_MODAL_MOTION_H

#include <ricochet/ricochet.h>

typedef struct modal_motion {
  size_t n;
  double *shape;            /* [mode][particle] */
  double *omega;            /* [mode] */
  double *position, *speed; /* [mode] coordinates at time 0 */
} modal_motion;

modal_motion modal_motion_create(const ric_chain *chain);
void modal_motion_clear(modal_motion *m);

/** Sets the state at time 0. */
void modal_motion_set(modal_motion *m, const double *q, const double *v);

/** State at a time; v may be NULL. */
void modal_motion_state(modal_motion *m, double time, double *q, double *v);

/** Position of one particle at a time; `speed`, when not NULL, is set to its velocity. */
double modal_motion_particle(const modal_motion *m, size_t particle, double time, double *speed);

/** Largest amplitude a particle could have: the Euclidean norm of the modal amplitudes, times omega_max^power. Bounds
 *  every derivative of that order. */
double modal_motion_bound(const modal_motion *m, int power);

#endif

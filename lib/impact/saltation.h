/* The jump of tangent vectors at one impact: internal to the room. See ricochet/saltation.h for the formula. */
#ifndef RICOCHET_INTERNAL_SALTATION_H
#define RICOCHET_INTERNAL_SALTATION_H

#include "impact_law.h"
#include "ricochet/saltation.h"

/** An impact, and the persistent contacts coupled to it. */
typedef struct jump_group {
  const size_t *obstacles;   /* [count] the impact comes first */
  const double *restitution; /* [count] */
  size_t count;
  bool sticks; /* impact maps: the series of impacts that begins here is summed */
} jump_group;

/** Workspace for a number of tangent vectors. */
typedef struct tangent_jump {
  const ric_system *system;
  impact_solver *law; /* borrowed */
  size_t columns;
  double *rates_before, *rates_after; /* [n + m] */
  double *line, *point;               /* [n + m] one tangent vector with its time shift; a state on its line */
  double *state;                      /* [n + m] before the impact */
  double *derivative;                 /* [n + m] of the map along the line */
  double *work;                       /* [2 (n + m)] */
  double *shift;                      /* [columns] tau */
  double in_time;                     /* of the line */
} tangent_jump;

ric_status tangent_jump_init(tangent_jump *jump, const ric_system *system, impact_solver *law, size_t columns,
                             ric_error *error);
void tangent_jump_clear(tangent_jump *jump);

/** Applies an impact to a state and tangent vectors.
 *  @param contact  [obstacles] states of contacts before; set to those after
 *  @param after  states of contacts after
 *  @param q, u  [n], [m] the state, changed
 *  @param d  changed, unless the impact is grazing
 *  @param kind  differentiable or grazing; then nothing is changed
 *  @returns RIC_ECALLBACK, RIC_ENOMEM; RIC_EINVAL if the gap rate is not negative. */
ric_status tangent_jump_apply(tangent_jump *jump, double t, const jump_group *group, double grazing_tol,
                              unsigned char *contact, const unsigned char *after, double *q, double *u,
                              const tangents *d, ric_saltation_kind *kind, ric_error *error);

/** Applies the impact map alone to a state and tangent vectors, on the obstacle or off it, for any gap rate.
 *  @param d  becomes DG d + G_t in_time
 *  @param in_time  [columns] derivative of the time of the impact along each of them */
ric_status tangent_jump_map(tangent_jump *jump, double t, const jump_group *group, double *q, double *u,
                            const tangents *d, const double *in_time, ric_error *error);

/** Whether two orders of impacts give the same numbers [size], within 1e-9 of the largest. */
bool tangent_jumps_agree(const double *a, const double *b, size_t size);

#endif

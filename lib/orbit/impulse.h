/* The impulse-response form of the boundary-value problem (orbit.h), on the unit cell. Internal to the library. */
#ifndef RICOCHET_IMPULSE_H
#define RICOCHET_IMPULSE_H

#include "boundary_state.h"
#include "contact.h"
#include "numeric/linear_system.h"

/** Workspace. */
typedef struct impulse {
  response response;
  contact_system contacts;
  double *p; /* [capacity] impulses of the cell's contacts */
  size_t capacity;
} impulse;

void impulse_clear(impulse *w);

/** State of the orbit of a cell; O(n log n + m^3).
 *  @param solution  set; when it is singular and not solvable the state is left alone */
ric_status impulse_solve(impulse *w, const unit_cell *cell, double period, const ric_orbit_options *options,
                         const boundary_state *state, linear_outcome *solution, ric_error *error);

/** Smallest-to-largest eigenvalues of the cell's contact matrix, [impacts]. */
ric_status impulse_eigenvalues(impulse *w, const unit_cell *cell, double period, double *eigenvalues, ric_error *error);

#endif

/* The boundary-value problem (10)-(11) of [JAP], solved with a matrix exponential: the reference, internal. */
#ifndef RICOCHET_DENSE_H
#define RICOCHET_DENSE_H

#include "boundary_state.h"
#include "numeric/linear_system.h"
#include "ricochet/orbit.h"

/** State of the orbit of a pattern on the whole chain, O(n^3), allocating what it needs.
 *
 *  Beyond options->singular_condition the solution of least norm is taken if it satisfies the equations to
 * residual_tol.
 *  @param solution  set; the condition number is that of the matrix of (11)
 *  Source: (M + N exp(A T/2)) x(0) = B, [JAP] (11), with the boundary conditions (8). */
ric_status dense_solve(const ric_chain *chain, const ric_pattern *pattern, double period,
                       const ric_orbit_options *options, const boundary_state *state, linear_outcome *solution,
                       ric_error *error);

#endif

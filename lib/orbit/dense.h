/* The boundary-value problem (10)-(11) of [JAP], solved with a matrix exponential: the reference, internal. */
#ifndef RICOCHET_DENSE_H
#define RICOCHET_DENSE_H

#include "boundary_state.h"
#include "ricochet/chain.h"
#include "ricochet/pattern.h"

/** State of the orbit of a pattern on the whole chain, O(n^3), allocating what it needs.
 *  @param condition  set to the estimated condition number of the matrix of (11), infinite when it is singular
 *  @param singular_condition  beyond it the equations are solved in the sense of least norm, on the numerical rank
 *  Source: (M + N exp(A T/2)) x(0) = B, [JAP] (11), with the boundary conditions (8). */
ric_status dense_solve(const ric_chain *chain, const ric_pattern *pattern, double period, double singular_condition,
                       const boundary_state *state, double *condition, ric_error *error);

#endif

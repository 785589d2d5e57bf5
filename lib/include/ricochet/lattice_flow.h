/* Taylor flow of the linear lattice (1) with lambda = 0.
 *
 * The Taylor coefficients of q(t + h x) in x follow from the stencil of the force,
 *
 *   c_{j+2,i} = h^2 / ((j + 1)(j + 2)) (-(1 + 2 gamma) c_{j,i} + gamma (c_{j,i-1} + c_{j,i+1})),
 *
 * even ones from the positions, odd ones from the velocities: O(n) per step, vectorised over particles. The chain is
 * worked through in blocks that stay in cache; a block reads order / 2 neighbours beyond its ends, taken from the image
 * ring of the chain (chain.h), so that no end is special. Nothing here knows of contacts. */
#ifndef RICOCHET_LATTICE_FLOW_H
#define RICOCHET_LATTICE_FLOW_H

#include <stddef.h>

#include "chain.h"
#include "segment.h"

enum {
  RIC_LATTICE_ORDER = 24, /* degree of the segments */
  RIC_LATTICE_BLOCK = 256 /* particles of a block: 25 coefficients of 280 particles are 56 kB */
};

/** Longest step whose truncation error, (omega h)^25 / 25! relative to the amplitude, is below 1e-16: 2.2 / omega_max.
 */
RIC_API double ric_lattice_step(const ric_chain *chain);

/** Workspace of the flow: the coefficients of one block. */
typedef struct ric_lattice_flow ric_lattice_flow;
RIC_API ric_status ric_lattice_flow_create(ric_lattice_flow **flow, ric_error *error);
RIC_API void ric_lattice_flow_destroy(ric_lattice_flow **flow);

/** Segment of the particles [first, first + count), count <= RIC_LATTICE_BLOCK, from the state of the whole chain.
 *  @param q, v  [n] state at time `start`
 *  @param length  step, with |length| <= ric_lattice_step; negative runs back in time
 *  @returns the segment; its coefficients live in `flow` until the next call. */
RIC_API ric_segment ric_lattice_flow_segment(ric_lattice_flow *flow, const ric_chain *chain, const double *q,
                                             const double *v, double start, double length, size_t first, size_t count);

#endif

/* Entries of the free flow of a chain over T and T/2, from kernels on its image ring: internal to the room.
 *
 * The flow over t is [[cos(W t), sin(W t) / W], [-W sin(W t), cos(W t)]] on (q, v), W^2 the stiffness matrix. Its
 * blocks are functions of the stiffness matrix, so n / 2 + 1 numbers each hold them. */
#ifndef RICOCHET_FLOW_KERNELS_H
#define RICOCHET_FLOW_KERNELS_H

#include <stdbool.h>

#include "model/lattice_transform.h"

/** Kernels of one time. */
typedef struct flow_kernel {
  double *cosine, *sine, *fall; /* cos, sin / W, -W sin */
} flow_kernel;

typedef struct flow_kernels {
  ric_chain shape; /* particles and ends that the plans belong to */
  lattice_transform *transform;
  flow_kernel full, half;
} flow_kernels;

void flow_kernels_clear(flow_kernels *f);

/** Fills the kernels; plans are kept for chains of the same particles and ends. */
ric_status flow_kernels_compute(flow_kernels *f, const ric_chain *chain, double period, ric_error *error);

/** Entry of a flow: row (i, displacement or speed), column (j, displacement or speed). */
double flow_kernel_entry(const flow_kernel *kernel, const ric_chain *chain, bool speed_row, size_t i, bool speed_column,
                         size_t j);

#endif

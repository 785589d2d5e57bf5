/* The Taylor recurrence of a few particles: internal to the flow.
 *
 * Where a block is the whole of a lattice of up to FEW particles there is nothing to gain from loops over columns
 * (lattice_block.h). Here the system is a dense one, and its nonlinear springs, which take nearly all of the time, are
 * lanes side by side; linear ones take none. With the extension x_s of spring s,
 *
 *   c'' = A c + B c' + forcing - sum_s P_s (a_s x_s^2 + b_s x_s^3),
 *
 * level j + 2 follows from the levels up to j, and without dampers level j + 3 from those up to j + 1: two levels are
 * made at a time, so that the sums of one hide how long those of the other take. Without nonlinear springs what takes
 * time is that a level waits for the one before: all that does not depend on it is done beside, and what follows from
 * the length of the step alone once for all steps of that length. */
#ifndef RICOCHET_LATTICE_FEW_H
#define RICOCHET_LATTICE_FEW_H

#include "lattice_block.h"
#include "numeric/vectorised.h"

enum {
  FEW = 8,
  FEW_LEVELS = 32, /* an even number */
  FEW_GROUPS = (2 * FEW + 1 + RIC_LANES - 1) / RIC_LANES,
  FEW_VECTORS = FEW / RIC_LANES
};

/** Springs side by side. */
typedef struct few_springs {
  size_t count;
  ric_lanes quadratic, cubic;
  ric_lanes stretch[FEW];                 /* extension by each coordinate: 0, 1 or -1 */
  ric_lanes pull[RIC_LANES][FEW_VECTORS]; /* accelerations by a unit of each force */
  ric_lanes x[FEW_LEVELS], square[FEW_LEVELS];
} few_springs;

/** Column by column: what all particles feel of one. */
typedef ric_lanes few_matrix[FEW][FEW_VECTORS];

/** What makes level j + 2 of linear particles in a step of length h, (j + 1) (j + 2) beside: h^2 times accelerations by
 *  level j, and h (j + 1) times those by level j + 1. Where a reciprocal may be rounded (lattice_block.h), the divisor
 * is in them, and 1 beside. */
typedef struct few_scales {
  double h;
  double low[FEW_LEVELS], high[FEW_LEVELS], divisor[FEW_LEVELS];
} few_scales;

typedef struct lattice_few {
  size_t groups;
  few_matrix stiffness, damping; /* accelerations by each coordinate, by each speed */
  few_scales scales;
  few_springs group[FEW_GROUPS];
} lattice_few;

/** Whether blocks of that many particles, with these terms, are for lattice_few when they are a whole lattice: all of
 * up to FEW but for linear ones too large for a dense matrix to be worth it. */
bool lattice_few_takes(size_t count, unsigned terms);

/** Columns that levels of such a block have at least: ghosts, and particles that are not there. */
size_t lattice_few_columns(size_t count);

/** Takes over the rows of the block. */
void lattice_few_load(lattice_few *few, const lattice_block *block);

/** lattice_block_raise for such a block. */
void lattice_few_raise(lattice_few *few, lattice_block *block, double h, const double *cosine, const double *sine);

#endif

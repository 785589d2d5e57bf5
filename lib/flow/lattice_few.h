/* The Taylor recurrence of a few particles with nonlinear springs: internal to the flow.
 *
 * Where a block is the whole of a lattice of up to FEW particles there is nothing to gain from loops over columns
 * (lattice_block.h). Here the system is a dense one, and its nonlinear springs, which take nearly all of the time, are
 * lanes side by side; linear ones take none. With the extension x_s of spring s,
 *
 *   c'' = A c + B c' + forcing - sum_s P_s (a_s x_s^2 + b_s x_s^3),
 *
 * level j + 2 follows from the levels up to j, and without dampers level j + 3 from those up to j + 1: two levels are
 * made at a time, so that the sums of one hide how long those of the other take. */
#ifndef RICOCHET_LATTICE_FEW_H
#define RICOCHET_LATTICE_FEW_H

#include "lattice_block.h"
#include "vectorised.h"

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

typedef struct lattice_few {
  size_t groups;
  few_matrix stiffness, damping; /* accelerations by each coordinate, by each speed */
  few_springs group[FEW_GROUPS];
} lattice_few;

/** Whether blocks of that many particles, with these terms, are for lattice_few when they are a whole lattice. */
bool lattice_few_takes(size_t count, unsigned terms);

/** Columns that levels of such a block have at least: ghosts, and particles that are not there. */
size_t lattice_few_columns(size_t count);

/** Takes over the rows of the block. */
void lattice_few_load(lattice_few *few, const lattice_block *block);

/** lattice_block_raise for such a block. */
void lattice_few_raise(lattice_few *few, lattice_block *block, double h, const double *cosine, const double *sine);

#endif

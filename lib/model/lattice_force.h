/* The force on one particle of a lattice: internal to the library. */
#ifndef RICOCHET_LATTICE_FORCE_H
#define RICOCHET_LATTICE_FORCE_H

#include "ricochet/lattice.h"

/** Force on a particle at time t, positions q [n] and velocities v [n], without obstacles: its own spring, two links
 *  and the forcing. O(1). */
double lattice_force(const ric_lattice *lattice, size_t particle, double t, const double *q, const double *v);

/** Bounds from the rows of the linear part. */
typedef struct lattice_rows_bound {
  double stiffness, damping; /* largest row sums of |K| / m and of |C| / m */
  double softest;            /* least K_ii - sum |K_ij| over m: a lower bound of the squares of frequencies */
} lattice_rows_bound;

lattice_rows_bound lattice_row_bounds(const ric_lattice *lattice);

#endif

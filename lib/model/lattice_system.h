/* Lattices: forces and energies, their derivatives, and the system of a lattice. Internal to the library. */
#ifndef RICOCHET_LATTICE_SYSTEM_H
#define RICOCHET_LATTICE_SYSTEM_H

#include "ricochet/lattice.h"
#include "system_model.h"

/* The force on one particle of a lattice. */

/** Force on a particle at time t, positions q [n] and velocities v [n], without obstacles: its own spring, two links
 *  and the forcing. O(1). */
double lattice_force(const ric_lattice *lattice, size_t particle, double t, const double *q, const double *v);

/** Bounds from the rows of the linear part. */
typedef struct lattice_rows_bound {
  double stiffness, damping; /* largest row sums of |K| / m and of |C| / m */
  double softest;            /* least K_ii - sum |K_ij| over m: a lower bound of the squares of frequencies */
} lattice_rows_bound;

lattice_rows_bound lattice_row_bounds(const ric_lattice *lattice);

/* The linearised forces of a lattice. */

/** Derivatives [n][columns] of the accelerations at positions q [n] along tangent vectors. O(n) per column. */
void lattice_tangent(const ric_lattice *lattice, const double *q, const tangents *d, double *acceleration);

/* A lattice as a system. */

/** The lattice of a system whose `taylor` is SYSTEM_LATTICE; its arrays belong to the system. */
const ric_lattice *lattice_system_lattice(const ric_system *system);

#endif

/* The linearised forces of a lattice: internal to the library. */
#ifndef RICOCHET_LATTICE_TANGENT_H
#define RICOCHET_LATTICE_TANGENT_H

#include "ricochet/lattice.h"
#include "system_model.h"

/** Derivatives [n][columns] of the accelerations at positions q [n] along tangent vectors. O(n) per column. */
void lattice_tangent(const ric_lattice *lattice, const double *q, const tangents *d, double *acceleration);

#endif

/* The Taylor series of a lattice over a step, block by block. Internal to the library. */
#ifndef RICOCHET_LATTICE_SERIES_H
#define RICOCHET_LATTICE_SERIES_H

#include "lattice_block.h"
#include "ricochet/lattice.h"
#include "ricochet/segment.h"
#include "taylor_step.h"

/* Taylor series of lattices, block by block.
 *
 * The coefficients of q(start + length x) in x for a range of particles, from the state of the whole lattice: O(n) per
 * step, vectorised over particles (lattice_block.h). A range that is not the whole lattice reads neighbours beyond its
 * ends: order / 2 of them, order - 1 with damped links. The caller says which coordinates are held and which Hertz
 * contacts are pressed. Contacts are not detected here. */

enum {
  LATTICE_SERIES_BLOCK = 256, /* particles of a block: 27 coefficients of 282 particles are 61 kB */
  LATTICE_SERIES_ORDER = 30   /* highest order */
};

/** A pressed Hertz contact: force side * stiffness * u^{3/2} with u = side (position - q) > 0. */
typedef struct lattice_press {
  size_t coordinate;
  int side;
  double position, stiffness;
} lattice_press;

/** Active contacts, each list in order of its coordinates. */
typedef struct lattice_contacts {
  const size_t *held; /* held coordinates */
  size_t held_count;
  const lattice_press *pressed;
  size_t pressed_count;
} lattice_contacts;

/** Workspace of one block. */
typedef struct lattice_series lattice_series;

/** @param lattice  determines the terms: later lattices must have the same
 *  @param order  4 to LATTICE_SERIES_ORDER
 *  @param block  largest number of particles of a range; if all, every range is the whole lattice */
ric_status lattice_series_create(const ric_lattice *lattice, int order, size_t block, lattice_series **series,
                                 ric_error *error);
void lattice_series_destroy(lattice_series **series);

/** Whether a lattice has exactly the terms for which the workspace was created. */
bool lattice_series_fits(const lattice_series *series, const ric_lattice *lattice);

/** Sets the lattice and its contacts (NULL: none), both borrowed until the next call.
 *  @returns RIC_ENOMEM. */
ric_status lattice_series_begin(lattice_series *series, const ric_lattice *lattice, const lattice_contacts *contacts,
                                ric_error *error);

/** Segment of the particles [first, first + count), count <= block; after the last one of a ring comes the first.
 *  @param q, v  [n] state at time `start`; q of pressed coordinates lies below their obstacles (u > 0)
 *  @param length  not 0; negative: backwards in time
 *  @returns the segment; its coefficients live in the workspace until the next call. */
ric_segment lattice_series_segment(lattice_series *series, const double *q, const double *v, double start,
                                   double length, size_t first, size_t count);

/** The last segment. */
ric_segment lattice_series_last(const lattice_series *series);

/** Decay of the coefficients of the last segment; branch points are those of its own pressed contacts. */
taylor_decay lattice_series_decay(const lattice_series *series);

/** Makes the last segment shorter without a new recurrence.
 *  @param length  of the sign that it had */
ric_segment lattice_series_shorten(lattice_series *series, const double *q, const double *v, double length);

/** Force on a particle of the last segment along it, as if it were not held: its springs, its links and the forcing,
 *  without Hertz contacts. Its neighbours must belong to the segment, or the segment be the whole lattice.
 *  @param c  [RIC_POLY_DEGREE + 1], all set; cubes and cosines have terms beyond the order of the series
 *  @returns the degree. */
int lattice_series_force(const lattice_series *series, size_t particle, double *c);

/* The workspace of lattice_series, for the files that share it. */

enum { SERIES_POWERS = (RIC_POLY_DEGREE / 4 + 1) * 4 };

struct lattice_series {
  lattice_block block;
  lattice_few *few; /* computes the levels; NULL: the block does */
  double *store;    /* all arrays of the block */
  size_t halo;
  const ric_lattice *lattice;
  lattice_contacts contacts;
  bool ring;
  ric_segment segment; /* the last one */
  size_t loaded_count; /* particles of the range whose rows are loaded, from segment.first on; 0: none */
  size_t held_count;
  size_t *held_column; /* [stride] */
  double cosine[SERIES_POWERS], sine[SERIES_POWERS];
  double turn;                 /* frequency times length of the steps for which `power` is valid */
  double power[SERIES_POWERS]; /* turn^j / j! */
};

#endif

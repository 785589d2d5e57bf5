/* The Taylor series of a lattice over a step, block by block. Internal to the library. */
#ifndef RICOCHET_LATTICE_SERIES_H
#define RICOCHET_LATTICE_SERIES_H

#include <stdbool.h>
#include <stddef.h>
#include "hertz_series.h"
#include "numeric/simd.h"
#include "ricochet/lattice.h"
#include "ricochet/segment.h"
#include "taylor_step.h"

/* The Taylor recurrence on a block of columns.
 *
 * With x = (t - start) / h the motion of a particle is sum_j c_j x^j, and
 *
 *   (j + 1) (j + 2) c_{j+2} = h^2 f_j / m,
 *
 * f_j the j-th coefficient of its force: a stencil for linear springs, one on c_{j+1} for dampers, truncated Cauchy
 * products for squares and cubes, the series of cosine and sine for the forcing, and that of a Hertz contact
 * (hertz_series.h).
 *
 * A block does not depend on lattices: its columns have rows of constants. Columns of zeros are walls; an inverse mass
 * of zero holds a column in place. */

/** Constants of a column. Link constants belong to the link on its left. */
typedef enum block_row {
  ROW_OWN, /* linear springs, over the mass */
  ROW_LEFT,
  ROW_RIGHT,
  ROW_DAMP_OWN, /* dampers, over the mass */
  ROW_DAMP_LEFT,
  ROW_DAMP_RIGHT,
  ROW_SITE_SQUARE, /* quadratic and cubic on-site springs, over the mass */
  ROW_SITE_CUBE,
  ROW_LINK_SQUARE,
  ROW_LINK_CUBE,
  ROW_INVERSE_MASS,
  ROW_COS, /* forcing over the mass */
  ROW_SIN,
  BLOCK_ROWS
} block_row;

/** Terms of a block beyond linear springs. */
enum { BLOCK_DAMPED = 1, BLOCK_LINK_DAMPED = 2, BLOCK_SITE_NONLINEAR = 4, BLOCK_LINK_NONLINEAR = 8, BLOCK_FORCED = 16 };

/** A pressed Hertz contact of a column. */
typedef struct block_press {
  size_t column;
  double side, position; /* of the obstacle */
  double strength;       /* side times stiffness over the mass */
  double start;          /* penetration at the start of the step */
  hertz_series series;
} block_press;

typedef struct block_presses {
  size_t count, capacity;
  block_press *press; /* [capacity] */
} block_presses;

typedef struct lattice_block {
  int order;
  unsigned terms;          /* BLOCK_DAMPED | ... */
  size_t stride;           /* columns allocated */
  size_t ghosts;           /* columns before the first particle and after the last */
  size_t count;            /* particles */
  bool whole;              /* the whole chain: one ghost at each side, no column becomes invalid */
  bool ring;               /* and its ghosts are the particles of the other end */
  double *c;               /* [order + 1][stride] */
  double *row[BLOCK_ROWS]; /* [stride], NULL if the terms do not use them */
  double *square;          /* [order + 1][stride] squares of c */
  double *extension;       /* [order + 1][stride] c minus that of the column to the left */
  double *extension_square;
  double *force; /* [stride] scratch, with any of the terms */
  block_presses presses;
} lattice_block;

/** Columns at each side that become invalid in a step of this order, unless they are the end of a chain. */
size_t lattice_block_halo(int order, unsigned terms);

/** Sets the ghosts of a level of a whole ring to the particles of its other end. */
static inline void lattice_block_close_ring(lattice_block *block, int level) {
  double *c = block->c + (size_t)level * block->stride;
  if (block->whole && block->ring) {
    c[0] = c[block->count];
    c[block->count + 1] = c[1];
  }
}

/** Fills c_2 ... c_order from c_0 and c_1 (velocity times h); ghosts and initial penetrations are given.
 *  @param cosine, sine  [order + 1] series of the forcing's cosine and sine */
void lattice_block_raise(lattice_block *block, double h, const double *cosine, const double *sine);

/* The Taylor recurrence of a few particles.
 *
 * For a whole lattice of up to FEW particles loops over columns are inefficient. Here the system is
 * dense, and its nonlinear springs, which dominate the cost, are in SIMD lanes; linear springs cost nothing extra. With
 * the extension x_s of spring s,
 *
 *   c'' = A c + B c' + forcing - sum_s P_s (a_s x_s^2 + b_s x_s^3),
 *
 * level j + 2 follows from the levels up to j, and without dampers level j + 3 from those up to j + 1: two levels are
 * computed at a time, which hides the latency of their sums. Without nonlinear springs the latency from level to level
 * dominates: everything independent of the previous level is computed in parallel, and everything that depends on the
 * step length only is computed once for all steps of that length. */

enum {
  FEW = 8,
  FEW_LEVELS = 32, /* an even number */
  FEW_GROUPS = (2 * FEW + 1 + RIC_LANES - 1) / RIC_LANES,
  FEW_VECTORS = FEW / RIC_LANES
};

/** Springs in SIMD lanes. */
typedef struct few_springs {
  size_t count;
  ric_lanes quadratic, cubic;
  ric_lanes stretch[FEW];                 /* extension by each coordinate: 0, 1 or -1 */
  ric_lanes pull[RIC_LANES][FEW_VECTORS]; /* accelerations by a unit of each force */
  ric_lanes x[FEW_LEVELS], square[FEW_LEVELS];
} few_springs;

/** Column by column: the action of one particle on all. */
typedef ric_lanes few_matrix[FEW][FEW_VECTORS];

/** Matrices for level j + 2 of linear particles in a step of length h, with the divisor (j + 1) (j + 2) separate: h^2
 *  times accelerations by level j, and h (j + 1) times those by level j + 1. Where a reciprocal may be rounded
 * , the matrices include the divisor, and 1 is separate. */
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

/** Whether lattice_few treats blocks of that many particles with these terms if they are a whole lattice: all up to
 * FEW, except linear ones for which a dense matrix does not pay. */
bool lattice_few_takes(size_t count, unsigned terms);

/** Least number of columns of such a block: ghosts, and padding up to FEW particles. */
size_t lattice_few_columns(size_t count);

/** Copies the rows of the block. */
void lattice_few_load(lattice_few *few, const lattice_block *block);

/** lattice_block_raise for such a block. */
void lattice_few_raise(lattice_few *few, lattice_block *block, double h, const double *cosine, const double *sine);

/* Taylor series of lattices, block by block.
 *
 * The coefficients of q(start + length x) in x for a range of particles, from the state of the whole lattice: O(n) per
 * step, vectorised over particles. A range that is not the whole lattice reads neighbours beyond its
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

/* The Taylor recurrence on a block of columns: internal to the flow.
 *
 * With x = (t - start) / h the motion of a particle is sum_j c_j x^j, and
 *
 *   (j + 1) (j + 2) c_{j+2} = h^2 f_j / m,
 *
 * f_j the j-th coefficient of its force: a stencil for linear springs, one on c_{j+1} for dampers, truncated Cauchy
 * products for squares and cubes, the series of cosine and sine for the forcing, and that of a Hertz contact
 * (hertz_series.h).
 *
 * A block knows nothing of lattices: its columns carry rows of constants. Columns of zeros are walls, an inverse mass
 * of zero holds a column where it is. */
#ifndef RICOCHET_LATTICE_BLOCK_H
#define RICOCHET_LATTICE_BLOCK_H

#include <stdbool.h>
#include <stddef.h>

#include "hertz_series.h"

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

/** What a block has beyond linear springs. */
enum { BLOCK_DAMPED = 1, BLOCK_LINK_DAMPED = 2, BLOCK_SITE_NONLINEAR = 4, BLOCK_LINK_NONLINEAR = 8, BLOCK_FORCED = 16 };

/** Below this divisor a rounded reciprocal would change the size of a mode by the same 1e-17 at every step, which adds
 *  up; rounding of a quotient depends on the motion and does not. Later coefficients are too small to matter. */
enum { LAST_DIVIDED = 56 };

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
  bool whole;              /* the whole chain: one ghost at each side, no level lost */
  bool ring;               /* and its ghosts are the particles of the other end */
  double *c;               /* [order + 1][stride] */
  double *row[BLOCK_ROWS]; /* [stride], NULL where the terms have no use for them */
  double *square;          /* [order + 1][stride] squares of c */
  double *extension;       /* [order + 1][stride] c minus that of the column to the left */
  double *extension_square;
  double *force; /* [stride] scratch, with any of the terms */
  block_presses presses;
} lattice_block;

/** Columns at each side that a step of this order uses up when they are not the end of a chain. */
size_t lattice_block_halo(int order, unsigned terms);

/** Sets the ghosts of a level of a whole ring to the particles of its other end. */
static inline void lattice_block_close_ring(lattice_block *block, int level) {
  double *c = block->c + (size_t)level * block->stride;
  if (block->whole && block->ring) {
    c[0] = c[block->count];
    c[block->count + 1] = c[1];
  }
}

/** Adds the j-th coefficient of the pressed contacts' forces to c_{j+2}, in a step of length h. */
void lattice_block_press(lattice_block *block, int j, double h);

/** Fills c_2 ... c_order from c_0 and c_1 (velocity times h); ghosts and the starts of the presses are given.
 *  @param cosine, sine  [order + 1] series of the forcing's cosine and sine */
void lattice_block_raise(lattice_block *block, double h, const double *cosine, const double *sine);

#endif

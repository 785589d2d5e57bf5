/* What the two files of lattice variations share: internal to the flow. */
#ifndef RICOCHET_LATTICE_VARIATION_PARTS_H
#define RICOCHET_LATTICE_VARIATION_PARTS_H

#include "lattice_variation.h"

enum { LANES = 8 /* tangent vectors side by side */ };

typedef struct stencil {
  double *own, *left, *right; /* [n] over the mass */
} stencil;

struct lattice_variation {
  const ric_lattice *lattice;
  size_t n;
  int order;
  bool ring, damped, nonlinear;
  bool keeps;  /* all levels: there is room for a varying stiffness */
  bool varies; /* it varies in this step */
  double length;
  size_t lanes; /* for which the ends of the levels are walls */
  double *constants, *inverse_mass;
  stencil springs, dampers;
  double *sum_q, *sum_u; /* [n][LANES] */
  double *levels;        /* [order + 1 or 3][n + 2][LANES] */
  double *series;        /* the next three */
  double *q;             /* [order + 1][n] coordinates over the accepted part */
  double *site, *link;   /* [order + 1][n], [order + 1][n + 1] varying stiffness */
  const size_t *held;    /* borrowed */
  size_t held_count;
};

#endif

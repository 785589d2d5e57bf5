/* What the two files of lattice variations share: internal to the flow. */
#ifndef RICOCHET_LATTICE_VARIATION_PARTS_H
#define RICOCHET_LATTICE_VARIATION_PARTS_H

#include <stdint.h>

#include "lattice_variation.h"
#include "vectorised.h"

enum { LANES = 8, HALF = 4 /* tangent vectors side by side */ };

typedef struct stencil {
  double *own, *left, *right; /* [n] over the mass */
} stencil;

static const size_t NO_PARTICLE = SIZE_MAX;

/** A spring whose stiffness varies along steps: of the lattice, or a pressed Hertz contact. */
typedef struct varying_spring {
  size_t from, to; /* particles; NO_PARTICLE: wall or ground */
  double quadratic, cubic;
} varying_spring;

struct lattice_variation {
  const ric_lattice *lattice;
  size_t n;
  int order;
  bool ring, damped;
  double length;
  size_t lanes; /* for which the ends of the levels are walls */
  double *constants, *inverse_mass;
  stencil springs, dampers;
  double *sum_q, *sum_u; /* [n][LANES] */
  double *levels;        /* [3][n + 2][LANES] those in use */
  double nothing[LANES]; /* extension at a wall */
  varying_spring *varying;
  size_t capacity;    /* of springs that may vary */
  size_t nonlinear;   /* of the lattice, the first of them */
  size_t count;       /* in this step */
  size_t compliant;   /* Hertz contacts that may press */
  double *series;     /* the next four; NULL when nothing varies */
  double *q;          /* [order + 1][n] coordinates over the accepted part */
  double *k;          /* [capacity][order + 1] varying stiffness */
  double *stretch;    /* [capacity][order + 1][LANES] extensions by the tangent vectors */
  double *force;      /* [capacity][2][LANES] of the levels that are made */
  const size_t *held; /* borrowed */
  size_t held_count;
};

#endif

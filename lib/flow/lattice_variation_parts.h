/* What the two files of lattice variations share: internal to the flow. */
#ifndef RICOCHET_LATTICE_VARIATION_PARTS_H
#define RICOCHET_LATTICE_VARIATION_PARTS_H

#include <stdint.h>

#include "lattice_variation.h"
#include "numeric/vectorised.h"

/* Tangent vectors side by side. */
#if defined(__GNUC__)
typedef double wide_lanes __attribute__((vector_size(64), aligned(8), may_alias));
enum { WIDE = 8 };
#else
typedef double wide_lanes;
enum { WIDE = 1 };
#endif

enum { LEVELS = 4 /* that are in use at a time */ };

typedef struct stencil {
  double *own, *left, *right; /* [n] over the mass */
} stencil;

static const size_t NO_PARTICLE = SIZE_MAX;

/** A spring whose stiffness varies along steps: of the lattice, or a pressed Hertz contact. */
typedef struct varying_spring {
  size_t from, to; /* particles; NO_PARTICLE: wall or ground */
  double quadratic, cubic;
} varying_spring;

/** What one such spring does to a particle. */
typedef struct spring_pull {
  size_t spring;
  double weight; /* +-1 over the mass */
} spring_pull;

struct lattice_variation {
  const ric_lattice *lattice;
  size_t n;
  int order;
  bool ring, damped;
  double length;
  double *constants, *inverse_mass;
  stencil springs, dampers;
  bool *still;        /* [n] particles that are held; none between steps */
  size_t *first_pull; /* [n + 1] those on particle i are pulls[first_pull[i]] and on */
  spring_pull *pulls; /* [2 capacity] */
  varying_spring *varying;
  size_t capacity;       /* of springs that may vary */
  size_t nonlinear;      /* of the lattice, the first of them */
  size_t count;          /* in this step */
  size_t compliant;      /* Hertz contacts that may press */
  double *series;        /* the next two; NULL when nothing varies */
  double *q;             /* [order + 1][n] coordinates over the accepted part */
  double *k;             /* [capacity][order + 1] varying stiffness */
  double *lanes;         /* the others */
  double *levels;        /* [LEVELS][n + 2][WIDE] those in use */
  double *sum_q, *sum_u; /* [n][WIDE] */
  double *stretch;       /* [capacity][order + 1][WIDE] extensions by the tangent vectors */
  double *force;         /* [capacity][2][WIDE] of the levels that are made */
};

#endif

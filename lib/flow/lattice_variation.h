/* Tangent vectors of a lattice along a step: its stiffness as series, and the recurrence. Internal to the library. */
#ifndef RICOCHET_LATTICE_VARIATION_H
#define RICOCHET_LATTICE_VARIATION_H

#include <stdint.h>

#include "lattice_series.h"
#include "model/system_model.h"
#include "numeric/simd.h"

/* Tangent vectors of a lattice along a step of its Taylor flow.
 *
 * Along the motion q(x) of a step, 0 <= x <= 1, tangent vectors satisfy the variational equation. Their coefficients
 * follow by the recurrence of the state, several vectors in SIMD lanes,
 *
 *   (j + 1) (j + 2) c_{j+2} = h^2 / m [-(K c_j) - (j + 1) / h (C c_{j+1}) - sum_l k_l c_{j-l}],
 *
 * where K and C are the constant part and k_l the coefficients of the stiffness that varies along the step: 2 a q + 3 b
 * q^2 for quadratic and cubic springs, 3/2 k u^{1/2} for Hertz contacts, whose coefficients obey u r' = u' r / 2. Only
 * the extensions of springs with varying stiffness are stored; other coefficients are discarded after summation. */

typedef struct lattice_variation lattice_variation;

/** @param compliant  largest number of Hertz contacts pressed at a time */
ric_status lattice_variation_create(const ric_lattice *lattice, int order, size_t compliant,
                                    lattice_variation **variation, ric_error *error);
void lattice_variation_destroy(lattice_variation **variation);

/** Reads the changed numbers of the lattice. @returns false if its terms do not fit */
bool lattice_variation_renew(lattice_variation *variation);

/** Whether the stiffness may vary along a step; then the coordinates of the step are needed. */
bool lattice_variation_varies(const lattice_variation *variation, const lattice_contacts *acting);

/** Begins a step of the accepted length: no coordinates are known yet. */
void lattice_variation_begin(lattice_variation *variation, double length);

/** Adds a piece of the step, of which the part [0, x] is accepted. Pieces cover all particles. */
void lattice_variation_take(lattice_variation *variation, const ric_segment *piece, double x);

/** After all pieces: computes the varying stiffness, including that of the active Hertz contacts. */
void lattice_variation_stiffen(lattice_variation *variation, const lattice_contacts *acting);

/** Propagates tangent vectors to the end of the accepted part. @param held  held coordinates */
void lattice_variation_transport(lattice_variation *variation, const lattice_contacts *held, const tangents *d);

/* Data shared with lattice_simd.inc. */

enum { LEVELS = 4 /* in use at a time */ };

typedef struct stencil {
  double *own, *left, *right; /* [n] over the mass */
} stencil;

static const size_t NO_PARTICLE = SIZE_MAX;

/** A spring whose stiffness varies along steps: of the lattice, or a pressed Hertz contact. */
typedef struct varying_spring {
  size_t from, to; /* particles; NO_PARTICLE: wall or ground */
  double quadratic, cubic;
} varying_spring;

/** Action of one such spring on a particle. */
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
  bool *still;        /* [n] held particles; none between steps */
  size_t *first_pull; /* [n + 1] those on particle i start at pulls[first_pull[i]] */
  spring_pull *pulls; /* [2 capacity] */
  varying_spring *varying;
  size_t capacity;       /* largest number of varying springs */
  size_t nonlinear;      /* of the lattice, the first of them */
  size_t count;          /* in this step */
  size_t compliant;      /* largest number of pressed Hertz contacts */
  double *series;        /* storage of the next two; NULL if nothing varies */
  double *q;             /* [order + 1][n] coordinates over the accepted part */
  double *k;             /* [capacity][order + 1] varying stiffness */
  double *lanes;         /* storage of the following */
  double *levels;        /* [LEVELS][n + 2][WIDE] those in use */
  double *sum_q, *sum_u; /* [n][WIDE] */
  double *stretch;       /* [capacity][order + 1][WIDE] extensions by the tangent vectors */
  double *force;         /* [capacity][2][WIDE] of the levels being computed */
};

#endif

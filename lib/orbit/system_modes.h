/* What is kept of a linear system with one obstacle that is hit, and the workspace: internal to the room. */
#ifndef RICOCHET_SYSTEM_MODES_H
#define RICOCHET_SYSTEM_MODES_H

#include <stdbool.h>

#include "ricochet/impact_modes.h"

enum { MODES_ORDER = 24 };

struct ric_impact_modes {
  size_t n, obstacle_count;
  size_t obstacle;           /* that is hit */
  size_t hit;                /* k, its coordinate */
  ric_obstacle *obstacles;   /* [obstacle_count] */
  ric_orbit_options options; /* tolerances: those of orbits of chains */
  double fastest;            /* largest frequency */
  double *frequency, *shape; /* [n]; [n][n], row j is phi_j */
  double *seen;              /* [n] phi_j(k); 0 of modes that do not move k */
  double *mobility;          /* [n] M^-1 e_k */
  /* of one period: */
  double *amplitude;     /* [n] C_j */
  double *reach;         /* [n] sum_j |C_j phi_j(i)|: no |q_i| is larger */
  double *q, *v;         /* [n] a state */
  double *cosine, *sine; /* [n] of w_j (T/2 - t) at the start of a segment */
  double *even, *odd;    /* [n] what a coordinate takes of both */
  double *series;        /* [MODES_ORDER + 1][n] Taylor coefficients of cos and sin (w_j h x) by turns */
  double *block;         /* behind all numbers */
};

#endif

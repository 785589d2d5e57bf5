/* Orbits of linear systems with one impact per period: their modes, motion and gaps. Internal to the room. */
#ifndef RICOCHET_INTERNAL_IMPACT_MODES_H
#define RICOCHET_INTERNAL_IMPACT_MODES_H

#include <stdbool.h>

#include "ricochet/impact_modes.h"
#include "admissibility.h"

/* What is kept of a linear system with one obstacle that is hit, and the workspace. */

enum { MODES_ORDER = 24 };

struct ric_impact_modes {
  size_t n;
  size_t obstacle;         /* that is hit */
  size_t hit;              /* k, its coordinate */
  ric_obstacle *obstacles; /* [names.count] */
  obstacle_names names;
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

/* The motion that an impulse at every multiple of a period keeps up, mode by mode.
 *
 *   q(t) = sum_j C_j phi_j cos(w_j (T/2 - t)), 0 <= t <= T,    C_j = p phi_j(k) / (2 w_j sin(w_j T/2)),    p = b /
 * S(T),
 *
 * with the impulse p on the coordinate k that reaches its obstacle at b, and S(T) = sum_j phi_j(k)^2 cot(w_j T/2) / (2
 * w_j). At a resonance of modes that move k the impulse is zero, and C_j has a limit for them alone. */

/** S(T) over the sum of the absolute values of its terms: from 1 at a resonance to -1 at the next. */
double response_balance(const ric_impact_modes *modes, double period);

/* The smallest gaps over a half period, about whose ends the motion is even.
 *
 * Gaps are Taylor polynomials of the closed form on segments, each made from the cosines and sines at its start. The
 * gap of the obstacle that is hit is zero at 0: it is divided by x on the first segment, where x goes from 0 to 1, so
 * that it is positive there as long as the obstacle is left, and meets the gap itself at the end. */

/** The smaller gap of a period over the largest displacement: positive where the orbit is admissible, zero where it
 *  grazes. Resonances and large amplitudes are not told from others.
 *  @param least  set to that gap; may be NULL */
double impact_modes_margin(ric_impact_modes *modes, double period, gap_found *least);

#endif

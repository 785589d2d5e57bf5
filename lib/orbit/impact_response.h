/* The motion between the impacts of a linear system with one impact per period: modes, gaps, verdict. Internal to the
 * library. */
#ifndef RICOCHET_IMPACT_RESPONSE_H
#define RICOCHET_IMPACT_RESPONSE_H

#include <stdbool.h>

#include "ricochet/impact_modes.h"

/* What is kept of a linear system with one obstacle that is hit, and the workspace. */

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

/* The motion that an impulse at every multiple of a period keeps up, mode by mode.
 *
 *   q(t) = sum_j C_j phi_j cos(w_j (T/2 - t)), 0 <= t <= T,    C_j = p phi_j(k) / (2 w_j sin(w_j T/2)),    p = b /
 * S(T),
 *
 * with the impulse p on the coordinate k that reaches its obstacle at b, and S(T) = sum_j phi_j(k)^2 cot(w_j T/2) / (2
 * w_j). At a resonance of modes that move k the impulse is zero, and C_j has a limit for them alone. */

/** The response of a period; its C_j are in modes->amplitude. */
typedef struct periodic_response {
  double period;
  double impulse;    /* p on the coordinate, 0 at a resonance; positive: upwards */
  double condition;  /* bound of the largest displacement over |b| */
  bool carried;      /* modes at resonance reach the obstacle without an impulse: `mode` is the fastest of them */
  bool free;         /* `mode` is at resonance and does not move k: any amplitude of it may be added */
  size_t mode;       /* of `carried` and `free` */
  unsigned harmonic; /* its l */
} periodic_response;

/** S(T) over the sum of the absolute values of its terms: from 1 at a resonance to -1 at the next. */
double response_balance(const ric_impact_modes *modes, double period);

/** @param resonance_tol  on |w_j T / (2 pi) - l|; 0 leaves resonances out unless a sine is zero
 *  Sets modes->amplitude and modes->reach; they may be infinite. */
void response_find(ric_impact_modes *modes, double period, double resonance_tol, periodic_response *response);

/** State at 0 <= t <= T, at 0 after the impact. @param v  may be NULL */
void response_state(const ric_impact_modes *modes, const periodic_response *response, double t, double *q, double *v);

/** Gap rate of the obstacle that is hit, after the impact. */
double response_gap_rate(const ric_impact_modes *modes, const periodic_response *response);

/** Energy of the motion. */
double response_energy(const ric_impact_modes *modes);

/* The smallest gaps of a periodic response over its half period.
 *
 * The motion is even about 0 and T/2. Gaps are Taylor polynomials of the closed form on segments, each made from the
 * cosines and sines at its start, and their minima certified (polynomial.h). The gap of the obstacle that is hit is
 * zero at 0: it is divided by x on the first segment, where x goes from 0 to 1, so that it is positive there as long as
 * the obstacle is left, and meets the gap itself at the end. */

/** A gap, where and when. */
typedef struct least_gap {
  double value; /* INFINITY: none */
  double time;
  size_t obstacle;
} least_gap;

/* Whether the response of a period is an orbit. */

typedef struct impact_verdict {
  ric_outcome outcome;
  char reason[RIC_REASON_BYTES]; /* "" when admissible */
  double scale;                  /* largest displacement */
  least_gap free, own;           /* over half a period: of all but the obstacle that is hit; of it */
} impact_verdict;

/** The smaller of both gaps over the scale: positive where the orbit is admissible, zero where it grazes. Resonances
 *  and large amplitudes are not told from others. `verdict` has its gaps and its scale only. */
double impact_verdict_margin(ric_impact_modes *modes, double period, periodic_response *response,
                             impact_verdict *verdict);

/** The outcome with its reason. modes->q and modes->v are the state at 0 then, unless it is singular. */
void impact_verdict_find(ric_impact_modes *modes, double period, periodic_response *response, impact_verdict *verdict);

/** Says which obstacle is touched, and when. */
void impact_verdict_touch(const impact_verdict *verdict, char *text, size_t bytes);

#endif

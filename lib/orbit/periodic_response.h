/* The motion that an impulse at every multiple of a period keeps up, mode by mode: internal to the room.
 *
 *   q(t) = sum_j C_j phi_j cos(w_j (T/2 - t)), 0 <= t <= T,    C_j = p phi_j(k) / (2 w_j sin(w_j T/2)),    p = b /
 * S(T),
 *
 * with the impulse p on the coordinate k that reaches its obstacle at b, and S(T) = sum_j phi_j(k)^2 cot(w_j T/2) / (2
 * w_j). At a resonance of modes that move k the impulse is zero, and C_j has a limit for them alone. */
#ifndef RICOCHET_PERIODIC_RESPONSE_H
#define RICOCHET_PERIODIC_RESPONSE_H

#include "ricochet/impact_modes.h"
#include "system_modes.h"

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

#endif

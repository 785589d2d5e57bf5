/* Hertz contacts in Taylor flows: internal to the room. The force law k u^{3/2} itself: hertz_force, model/obstacle.c.
 *
 * With the penetration u = -gap > 0, p = u^{3/2} obeys u p' = (3/2) u' p, so that
 *
 *   p_j = (1 / (j u_0)) sum_{i=1..j} (3 i / 2 - (j - i)) u_i p_{j-i}.
 *
 * The series converges up to the times at which u vanishes, before or after; so steps shrink towards the onset and the
 * end of a contact. At these times, where u_0 is zero up to rounding, there is no series: the first step is so short
 * that the force is negligible. */
#ifndef RICOCHET_HERTZ_SERIES_H
#define RICOCHET_HERTZ_SERIES_H

#include <stdbool.h>

enum { HERTZ_LEVELS = 31 };

typedef struct hertz_series {
  double u[HERTZ_LEVELS], p[HERTZ_LEVELS]; /* coefficients of u and u^{3/2} */
} hertz_series;

/** Computes p_j from u_j; call it in order of j from 0, with u_0 > 0. @returns p_j */
double hertz_series_next(hertz_series *s, int j, double u);

/** Coefficients r [order + 1] of u^{1/2} from those of u, u_0 > 0: u r' = u' r / 2. For the derivative of the force. */
void hertz_root_series(const double *u, int order, double *r);

/** Impulsive jump of the speed of a tangent vector, over minus its coordinate and the mass, by a contact whose force
 *  was omitted from a step: the integral of the stiffness 3/2 k u^{1/2} over the step, with u changing linearly between
 *  its end values. */
double hertz_left_out(double stiffness, double u_start, double u_end, double duration);

/** Lower bound of |x| for zeros of u, from u_0, u_1 and u_2. */
double hertz_series_nearest_zero(const hertz_series *s);

/** A pressed contact at the start of a step. */
typedef struct hertz_contact {
  double penetration; /* u */
  double rate;        /* u' in the direction of the step */
  double bend;        /* |u''| */
  double strength;    /* k divided by the mass */
} hertz_contact;

/** Whether the force of a contact has a usable series. If not, the force is omitted, and `limit` is reduced to the
 *  longest step on which that changes the gap rate by less than the tolerance.
 *  @param natural  time scale of the motion without the contact
 *  @param least  shortest step */
bool hertz_acts(const hertz_contact *c, double tolerance, double natural, double least, double *limit);

#endif

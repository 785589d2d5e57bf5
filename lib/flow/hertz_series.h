/* Hertz contacts in Taylor flows: internal to the room.
 *
 * With the penetration u = -gap > 0, p = u^{3/2} obeys u p' = (3/2) u' p, so that
 *
 *   p_j = (1 / (j u_0)) sum_{i=1..j} (3 i / 2 - (j - i)) u_i p_{j-i}.
 *
 * The series converges up to the time at which u vanishes, before or after; so steps shrink towards the beginning and
 * the end of a contact. There, where u_0 is zero up to rounding, there is none: a step so short that the force does not
 * matter leads away. */
#ifndef RICOCHET_HERTZ_SERIES_H
#define RICOCHET_HERTZ_SERIES_H

#include <stdbool.h>

enum { HERTZ_LEVELS = 31 };

typedef struct hertz_series {
  double u[HERTZ_LEVELS], p[HERTZ_LEVELS]; /* coefficients of u and u^{3/2} */
} hertz_series;

/** Takes u_j and finds p_j; levels come in order from 0, and u_0 > 0. @returns p_j */
double hertz_series_next(hertz_series *s, int j, double u);

/** Coefficients r [order + 1] of u^{1/2} from those of u, u_0 > 0: u r' = u' r / 2. For the derivative of the force. */
void hertz_root_series(const double *u, int order, double *r);

/** Change of the speed of a tangent vector, over minus its coordinate and the mass, by a contact whose force was left
 *  out of a step: the stiffness 3/2 k u^{1/2} over its duration, while u goes evenly from one value to the other. */
double hertz_left_out(double stiffness, double u_start, double u_end, double duration);

/** Lower bound of |x| for zeros of u, from u_0, u_1 and u_2. */
double hertz_series_nearest_zero(const hertz_series *s);

/** A pressed contact at the start of a step. */
typedef struct hertz_contact {
  double penetration; /* u */
  double rate;        /* u' in the sense in which the step runs */
  double bend;        /* |u''| */
  double strength;    /* k over the mass that it moves */
} hertz_contact;

/** Whether the force of a contact has a series that is worth anything. Where it has none it is left out, and `limit` is
 *  lowered to the longest step for which that changes the gap rate by less than the tolerance.
 *  @param natural  time in which the motion without the contact changes
 *  @param least  shortest step */
bool hertz_acts(const hertz_contact *c, double tolerance, double natural, double least, double *limit);

#endif

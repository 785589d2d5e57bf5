/* Taylor series of Hertz's force while a contact is pressed: internal to the room.
 *
 * With the penetration u = -gap > 0, p = u^{3/2} obeys u p' = (3/2) u' p, so that
 *
 *   p_j = (1 / (j u_0)) sum_{i=1..j} (1.5 i - (j - i)) u_i p_{j-i}.
 *
 * The series converges up to the time at which u vanishes, before or after; so steps shrink towards the beginning and
 * the end of a contact. At its very beginning, where u_0 is zero up to rounding, there is none: a first step so short
 * that the force does not matter leads away from there. */
#ifndef RICOCHET_HERTZ_SERIES_H
#define RICOCHET_HERTZ_SERIES_H

enum { HERTZ_LEVELS = 31 };

typedef struct hertz_series {
  double u[HERTZ_LEVELS], p[HERTZ_LEVELS]; /* coefficients of u and u^{3/2} */
} hertz_series;

/** Takes u_j and finds p_j; levels come in order from 0, and u_0 > 0. @returns p_j */
double hertz_series_next(hertz_series *s, int j, double u);

/** A contact at the start of a step, and how its coordinate moves without its force. */
typedef struct hertz_begin {
  double penetration, rate, acceleration; /* u, u', u'' */
  double strength;                        /* k over the mass that it moves */
} hertz_begin;

/** Longest step, at most `length`, over which Hertz's force may be left out: the speed that it would give lies below
 *  `negligible` > 0. Found by halving. */
double hertz_begin_step(const hertz_begin *b, double length, double negligible);

/** Whether a contact has just begun, or is about to end: its penetration is small against the way in that step. */
int hertz_begins(const hertz_begin *b, double step);

#endif

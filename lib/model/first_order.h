/* First-order systems of a user: what their two files share. */
#ifndef RICOCHET_FIRST_ORDER_H
#define RICOCHET_FIRST_ORDER_H

#include "system_model.h"
#include "user_gap.h"

typedef struct first_order {
  ric_system base;
  ric_first_order model;
  user_gap gap;
  double *ratio;                 /* [obstacles] restitution seen last; written by impact */
  double *numbers;               /* one block that all the following lie in, and the place of `gap` */
  double *gradient, *rate;       /* [n] of the last gap rate */
  double *path, *before, *after; /* [n] points of a path; states before and after a trial impact */
  double *free_rate, *table;     /* [n] free rate of the reaction; [FIRST_ORDER_TRIALS][n] extrapolation */
  double *foot, *approach;       /* [n] a state of zero gap rate, and the line on which impact maps are tried there */
  double *limit;                 /* [n] of an extrapolation */
  size_t *held;                  /* [held_most] indices of the contacts that are held */
  size_t held_most;
  double *direction, *matrix, *lambda; /* [held_most][n], [held_most][held_most], [held_most] */
} first_order;

enum { FIRST_ORDER_TRIALS = 4 };

/** F at (t, x). */
const char *first_order_free_rate(const first_order *s, double t, const double *x, double *rate);

/** G at (t, x). */
const char *first_order_map(const first_order *s, size_t obstacle, double t, const double *x, double *x_after);

const char *first_order_gap_rate(const ric_system *system, size_t obstacle, double t, const double *x, const double *u,
                                 double *rate);
const char *first_order_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *x,
                                         const double *u, const double *x_rate, const double *u_rate,
                                         double *acceleration);

/** How fast the gap rate changes along a line of states x + s x_rate, on which time runs at time_rate. */
const char *first_order_rate_slope(const first_order *s, size_t obstacle, double t, double time_rate, const double *x,
                                   const double *x_rate, double *slope);

/** The direction d [n] in which the impact map moves states of small gap rate, scaled so that the gap rate changes at
 *  unit rate along it. */
const char *first_order_push(const first_order *s, size_t obstacle, double t, const double *x, double *d);

/** See system_model. */
const char *first_order_impact_slope(const ric_system *system, size_t obstacle, double t, const double *x, double *xi,
                                     impact_slope *found);

/** Adds the forces of the held contacts to a free rate; s->held lists the contacts, s->lambda their forces, `count` how
 *  many. @param contact  NULL: none */
const char *first_order_hold(const first_order *s, const unsigned char *contact, double t, const double *x,
                             double *x_rate, size_t *count);

const char *first_order_reaction(const ric_system *system, const unsigned char *contact, size_t obstacle, double t,
                                 const double *x, const double *u, double *lambda);

#endif

/* Mechanical systems of a user: what their two files share. */
#ifndef RICOCHET_MECHANICAL_H
#define RICOCHET_MECHANICAL_H

#include "system_model.h"
#include "user_gap.h"

typedef struct mechanical {
  ric_system base;
  ric_mechanical model;
  user_gap gap;
  double *restitution;                       /* [obstacles] */
  double *numbers;                           /* one block that all the following lie in, and the place of `gap` */
  double *mass;                              /* [m][m], factorised */
  double *B, *b;                             /* [n][m], [n] of the last kinematics */
  double *gradient;                          /* [n] of the last gap */
  double *normal;                            /* [m] g of gap_rate */
  double *path_q, *path_u, *rate_q, *rate_u; /* [n], [m]: points of a path, and free rates */
  size_t *held;                              /* [held_most] indices of the contacts that are held */
  size_t held_most;
  double *held_g, *held_w, *held_matrix, *lambda; /* [held_most][m] twice, [held_most][held_most], [held_most] */
} mechanical;

/** B and b at (t, q), for mechanical_velocity and mechanical_normal. */
const char *mechanical_kinematics(const mechanical *s, double t, const double *q);

/** q' = B u + b. */
void mechanical_velocity(const mechanical *s, const double *u, double *q_rate);

/** g = B^T grad h [m] and the part of the gap rate that does not depend on the speeds. */
const char *mechanical_normal(const mechanical *s, size_t obstacle, double t, const double *q, double *g,
                              double *offset);

/** M, factorised in s->mass. */
const char *mechanical_mass(const mechanical *s, double t, const double *q);

/** x [m] from M x = x. */
void mechanical_mass_solve(const mechanical *s, double *x);

/** Rates of the free motion; leaves kinematics and mass at (t, q). */
const char *mechanical_free_rate(const mechanical *s, double t, const double *q, const double *u, double *q_rate,
                                 double *u_rate);

const char *mechanical_gap_rate(const ric_system *system, size_t obstacle, double t, const double *q, const double *u,
                                double *rate);
const char *mechanical_gap_acceleration(const ric_system *system, size_t obstacle, double t, const double *q,
                                        const double *u, const double *q_rate, const double *u_rate,
                                        double *acceleration);

/** Adds the forces of the held contacts to free rates, with kinematics and mass at (t, q); s->held lists the contacts,
 *  s->lambda their forces, `count` how many. @param contact  NULL: none */
const char *mechanical_hold(const mechanical *s, const unsigned char *contact, double t, const double *q,
                            const double *u, const double *q_rate, double *u_rate, size_t *count);

const char *mechanical_reaction(const ric_system *system, const unsigned char *contact, size_t obstacle, double t,
                                const double *q, const double *u, double *lambda);

#endif

/* The impact law: jumps of speeds at one time, for one contact or several. Internal to the library.
 *
 * Newton's law h'+ = -e h'- with an impulse p >= 0 along the gap's gradient, [FN97] (2.9). Contacts that do not couple
 * (g_i^T M^-1 g_j = 0) are treated one by one, in any order. Coupled ones, and persistent contacts coupled to an
 * impact, together satisfy Moreau's form of the law,
 *
 *   0 <= p  _|_  A p + (1 + e) h'- >= 0,   A_ij = g_i^T M^-1 g_j,
 *
 * a linear complementarity problem. Impact maps of first-order systems are applied in order of the obstacles. */
#ifndef RICOCHET_IMPACT_LAW_H
#define RICOCHET_IMPACT_LAW_H

#include "model/system_model.h"
#include "numeric/complementarity.h"

/** One contact at the time of impact. */
typedef struct impact {
  size_t obstacle;
  double restitution;
  double rate, rate_end; /* gap rates before and after */
  double impulse;
  double loss;         /* of energy; NaN where unknown */
  bool coupled;        /* with another of the list */
  bool leaves;         /* set by the caller */
  double accumulation; /* time from now at which the series of its impacts ends; NaN: no chatter */
} impact;

/** Workspace for simultaneous contacts. It grows; solving again for as many contacts allocates nothing. */
typedef struct impact_solver {
  const ric_system *system;
  complementarity_work lcp;
  size_t capacity; /* contacts with directions */
  double *g, *w;   /* [capacity][m], uncoupled systems: one row */
  contact_direction *directions;
  double *matrix, *rhs, *solution; /* [capacity^2], [capacity], [capacity] */
  double *before, *after;          /* [n] states of impact maps */
} impact_solver;

ric_status impact_solver_init(impact_solver *solver, const ric_system *system, ric_error *error);
void impact_solver_clear(impact_solver *solver);

/** Makes room for `count` simultaneous contacts, so that as many allocate nothing later. */
ric_status impact_solver_reserve(impact_solver *solver, size_t count, ric_error *error);

/** Applies the law to contacts [count] with their `obstacle` and `restitution` given; sets all other fields.
 *  @param q, u  [n], [m] state; u changes (q for first-order systems) */
ric_status impact_apply(impact_solver *solver, double t, double *q, double *u, impact *contacts, size_t count,
                        ric_error *error);

/** After impact_apply for one impact, alone or with persistent contacts coupled to it: removes the part of restitution
 * from the impulse of `contact`, so that the final gap rate of the impact is zero. By (2.9) and Moreau's form, impulses
 * are proportional to 1 + e. Call it for every contact of the list.
 *  @param restitution  of the hit */
ric_status impact_stick(impact_solver *solver, double t, double *q, double *u, impact *contact, double restitution,
                        ric_error *error);

/** Multiplies the gap rates of contacts by -e through impulses of either sign, all together if they couple: stops
 * contacts that stick, and is the impact law if the active contacts are known. Not for first-order systems.
 *  @param restitution  [count]; NULL: zeros
 *  @param loss  of energy, set; may be NULL */
ric_status impact_reflect(impact_solver *solver, double t, const double *q, double *u, const size_t *obstacles,
                          const double *restitution, size_t count, double *loss, ric_error *error);

/** Adds to u [m] the speeds of least kinetic energy that close the gaps of contacts [count] in a unit of time; not for
 *  first-order systems. Of dependent contacts the first ones decide. */
ric_status impact_close_in(impact_solver *solver, double t, const double *q, double *u, const size_t *obstacles,
                           size_t count, ric_error *error);

/** Solves the contact conditions for accelerations of contacts with gap and gap rate zero,
 *
 *   0 <= lambda  _|_  A lambda + b >= 0,   b = accelerations of the gaps without these forces.
 *
 *  @param obstacles  [count]
 *  @param b  [count] becomes A lambda + b, zero where it is below the errors of the accelerations
 *  @param lambda  [count], set */
ric_status contact_forces(impact_solver *solver, double t, const double *q, const size_t *obstacles, double *b,
                          size_t count, double *lambda, ric_error *error);

#endif

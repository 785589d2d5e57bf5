/* A system: smooth forces, obstacles and impact laws, in one form for every model.
 *
 * A state is (q, u): n coordinates and m speeds. Lattices and M-C-K systems have m = n and u = q'; mechanical user
 * systems have m <= n; systems in first-order form have their state in q and no speeds (m = 0, u may be NULL). Flows
 * (flow.h) integrate states between contacts, trajectories (trajectory.h) through them. */
#ifndef RICOCHET_SYSTEM_H
#define RICOCHET_SYSTEM_H

#include <stddef.h>

#include "lattice.h"
#include "mck.h"
#include "obstacle.h"
#include "user_system.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_system ric_system;

/** Systems from their models. All data are copied; callbacks and their `user` are borrowed. User systems keep their
 *  work arrays: functions of one of them, and of flows and trajectories on it, must not run in two threads at a time.
 *  @param obstacles  [count], may be NULL for none
 *  @returns RIC_EINVAL with the field, the value and what is allowed; RIC_ENOMEM. */
RIC_API ric_status ric_system_create_lattice(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count,
                                             ric_system **system, ric_error *error);
/** @param obstacles  [count], may be NULL for none */
RIC_API ric_status ric_system_create_mck(const ric_mck *mck, const ric_obstacle *obstacles, size_t count,
                                         ric_system **system, ric_error *error);
RIC_API ric_status ric_system_create_mechanical(const ric_mechanical *model, ric_system **system, ric_error *error);
RIC_API ric_status ric_system_create_first_order(const ric_first_order *model, ric_system **system, ric_error *error);
/** The lattice of a chain with its floors: obstacles are the particles that have one, in order, with restitution 1. */
RIC_API ric_status ric_system_create_chain(const ric_chain *chain, ric_system **system, ric_error *error);
RIC_API void ric_system_destroy(ric_system **system);

/** Changes the numbers of a system in place: flows and trajectories on it read them at their next start. Do not
 *  change a system during a motion: steps, runs and tangent vectors fail until there is a new start. On failure
 *  nothing has changed.
 *
 *  The numbers of a lattice, copied. Allocates nothing unless an optional array is given for the first time.
 *  @returns RIC_EINVAL as for a new lattice, for another number of particles or other ends than at creation, and for
 *           a system that is not a lattice; RIC_ENOMEM. */
RIC_API ric_status ric_system_set_lattice(ric_system *system, const ric_lattice *lattice, ric_error *error);

/** The same for an M-C-K system; matrices may change their form, and a mass matrix is factorised again. Allocates.
 *  @returns RIC_EINVAL as for a new one, for another number of coordinates, and for any other system; RIC_ENOMEM. */
RIC_API ric_status ric_system_set_mck(ric_system *system, const ric_mck *mck, ric_error *error);

/** The same for the obstacles of a lattice or an M-C-K system. Position, restitution and the stiffness of compliant
 *  ones may change; coordinate, side and whether an obstacle is rigid may not. Allocates nothing.
 *  @param obstacles  [count], may be NULL for none
 *  @returns RIC_EINVAL naming the obstacle, and for another count or a user system. */
RIC_API ric_status ric_system_set_obstacles(ric_system *system, const ric_obstacle *obstacles, size_t count,
                                            ric_error *error);

RIC_API size_t ric_system_coordinates(const ric_system *system); /* n */
RIC_API size_t ric_system_speeds(const ric_system *system);      /* m */
RIC_API size_t ric_system_obstacles(const ric_system *system);

/** Gap of an obstacle; NaN when its callback fails. @param q  [n] */
RIC_API double ric_system_gap(const ric_system *system, size_t obstacle, double t, const double *q);

/** Gap rate of an obstacle along the motion; NaN when a callback fails. @param q, u  [n], [m] */
RIC_API double ric_system_gap_rate(const ric_system *system, size_t obstacle, double t, const double *q,
                                   const double *u);

/** Energy of a state, including pressed Hertz contacts; NaN for a user system without the callback. */
RIC_API double ric_system_energy(const ric_system *system, double t, const double *q, const double *u);

/** Rates of the free motion: q_rate [n], u_rate [m]; including Hertz contacts that are pressed at q.
 *  @param u, u_rate  NULL if m = 0
 *  @returns RIC_ECALLBACK if a callback fails or gives values that are not finite, or a mass matrix is not positive
 *           definite. */
RIC_API ric_status ric_system_rate(const ric_system *system, double t, const double *q, const double *u, double *q_rate,
                                   double *u_rate, ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Shooting: periodic motions of any system as solutions of equations F(z) = 0.
 *
 * A motion with impacts is cut at its impacts. In between it is free, and smooth in the state and the times of its
 * ends; F says that the arcs fit: every arc ends on its obstacle, the impact law leads to the next one, the last closes
 * the period. The times of the impacts are unknowns of their own, so that no contact is searched for and F stays smooth
 * where an impact grazes, beyond it (as motions that pass through the obstacle), and where impacts coincide.
 * Derivatives are exact, from tangent vectors (flow.h) and the derivative of the impact map.
 *
 * Four kinds of motion differ in how they close:
 *
 *   even          about t = 0 and t = T/2, of systems that run backwards as they run forwards (q' = u, no damping,
 *                 forcing by cosines): half a period is enough. At t = 0 and T/2 coordinates are at rest, or hit
 *                 their obstacle and change sign of speed, any number of them together: the orbits of [JAP] (7)-(8),
 *                 with one unknown and one equation per coordinate. The period or the energy is given.
 *   forced        with a given period, a multiple of that of the forcing.
 *   autonomous    without forcing, with an unknown period: isolated motions of self-excited systems.
 *   conservative  without forcing or losses: motions come in families, the period or the energy is given. Conservation
 *                 makes one equation redundant: one unknown lambda, times the gradient of the energy, is added to the
 *                 closing equation. It makes the Jacobian regular, and is zero at every motion; solutions where it is
 *                 not close nothing.
 *
 * Unknowns z, in this order: states at the beginnings of arcs (each cut into `pieces`); times of impacts; the period,
 * where it is not given; lambda. The first state of even motions has one number per coordinate: q_i, or u_i for
 * coordinates that are hit at t = 0. Without impacts the first state is that at t = 0, otherwise the one after the
 * first impact; motions of autonomous and conservative systems start there at t = 0, and without impacts at a phase
 * that the guess fixes. */
#ifndef RICOCHET_SHOOTING_H
#define RICOCHET_SHOOTING_H

#include "monodromy.h"
#include "multipliers.h"
#include "orbit.h"
#include "trajectory.h"
#include "verify.h"

RIC_BEGIN_DECLARATIONS

typedef enum ric_motion_kind {
  RIC_MOTION_EVEN,
  RIC_MOTION_FORCED,
  RIC_MOTION_AUTONOMOUS,
  RIC_MOTION_CONSERVATIVE
} ric_motion_kind;

typedef struct ric_shooting_problem {
  ric_motion_kind kind;
  bool energy_given;      /* even, conservative: the given number is the energy, not the period */
  const size_t *at_start; /* [start_count] even: obstacles at coordinates that are hit at t = 0. Arrays are copied */
  size_t start_count;
  const size_t *at_half; /* [half_count] even: those hit at T/2 */
  size_t half_count;
  const size_t *sequence; /* [count] obstacles in the order in which they are hit: even, between 0 and T/2; else in a
                             period */
  size_t count;
  size_t pieces;         /* shooting segments per arc; 0, the default: one. More for strongly unstable motions */
  ric_flow_options flow; /* default ric_flow_options_default() */
  double grazing_tol;    /* 1e-10: gaps and gap rates smaller than it count as zero; 0: the default */
  ric_poll poll;
} ric_shooting_problem;

/** The equations of a problem, with their workspace. Evaluating them allocates nothing but what CVODES does. */
typedef struct ric_shooting ric_shooting;

/** @param system  borrowed, must outlive it; its numbers may change (ric_system_set_lattice, ...) between calls
 *  @returns RIC_EINVAL for obstacles that do not exist, are compliant, or are given twice at 0 or T/2; for even motions
 *           of systems without u = q' or with obstacles not at coordinates; RIC_ENOMEM. */
RIC_API ric_status ric_shooting_create(ric_system *system, const ric_shooting_problem *problem, ric_shooting **shooting,
                                       ric_error *error);
RIC_API void ric_shooting_destroy(ric_shooting **shooting);

RIC_API size_t ric_shooting_unknowns(const ric_shooting *shooting);
/** Number of impacts per period. Orbits list them in this order: at_start, sequence, at_half, and of even motions the
 *  mirror images of the sequence in the second half; of other motions the second of the sequence comes first, and its
 *  first last. */
RIC_API size_t ric_shooting_impacts(const ric_shooting *shooting);

/** What its flow has done since it was made. */
RIC_API ric_flow_counts ric_shooting_counted(const ric_shooting *shooting);

/** A first z from a guess of the motion. States of later arcs follow from the flow and the impact law.
 *  @param q, u  [n], [m] first state: at t = 0+ (even), after the first impact, or at t = 0 without impacts
 *  @param times  [count] of the impacts of `sequence`, increasing; NULL when there are none
 *  @param period  > 0
 *  @param z  [unknowns], set
 *  @returns RIC_EINVAL for times out of order; as ric_shooting_residual. */
RIC_API ric_status ric_shooting_guess(ric_shooting *shooting, const double *q, const double *u, const double *times,
                                      double period, double *z, ric_error *error);

/** F [unknowns] at z, its Jacobian J [unknowns][unknowns] row-major and its derivative by the given number.
 *  @param given  the period T > 0; the energy where that is given; without meaning for autonomous motions
 *  @param J, F_given  may be NULL, both. J leaves out lambda times the second derivative of the energy: nothing where
 *                     lambda is zero, as it is at every motion
 *  @returns RIC_ENUMERIC where there is no value: the motion blows up, impacts out of order in a system with compliant
 *           obstacles, a period that is not positive; RIC_ECALLBACK, RIC_ESTOPPED. */
RIC_API ric_status ric_shooting_residual(ric_shooting *shooting, const double *z, double given, double *F, double *J,
                                         double *F_given, ric_error *error);

/** Solves F(z) = 0 from afar: Newton's method with line search by SUNDIALS KINSOL, exact Jacobians.
 *  @param z  [unknowns] guess; set to the solution
 *  @param tolerance  of the largest residual, relative to 1 + the largest unknown; 0: 1e-13
 *  @param iterations  set to the number of Newton's steps (one for linear problems); may be NULL
 *  @returns RIC_ENUMERIC when it does not converge, with the residual left, or converges to no motion (lambda is not
 *           zero), and what ric_shooting_residual returns; z is then where it got. */
RIC_API ric_status ric_shooting_solve(ric_shooting *shooting, double *z, double given, double tolerance,
                                      int *iterations, ric_error *error);

/** The orbit of a solution, judged: impacts with times and gap rates, energy, residual, and the smallest gaps of a run
 *  over the segments of its arcs, certified there.
 *
 *  `admissible`: all impulses positive, impacts in order, all gaps positive in between; `inadmissible` with what is
 * violated first; `grazing` where an impulse or a gap is zero within grazing_tol; `failed` where the equations do not
 * hold, or hold for no motion: the system has not the symmetry that the kind takes for granted (even: it runs backwards
 * as it runs forwards; forced: time repeats after the period; the others: time does not matter), or lambda is not zero.
 * Gaps of obstacles that are hit count at their minima between the impacts. The clearance is the smallest gap of the
 * rigid obstacles that are not hit at all; NaN if there are none. The state (q, v) is the first one: at t = 0+, of
 * forced motions with impacts just after the one that is listed last; (q_half, v_half) is half a period later, before
 * an impact there.
 *  @param orbit  initialised for the system's coordinates and ric_shooting_impacts
 *  @returns as ric_shooting_residual. */
RIC_API ric_status ric_shooting_orbit(ric_shooting *shooting, const double *z, double given, ric_orbit *orbit,
                                      ric_error *error);

/** Largest displacement of a solution: of any coordinate, at any time of the period.
 *  @returns as ric_shooting_residual. */
RIC_API ric_status ric_shooting_amplitude(ric_shooting *shooting, const double *z, double given, double *amplitude,
                                          ric_error *error);

/** States of a solution at equal distances in time, t_k = t_0 + k T / (count - 1), with t_0 that of the first state:
 * over a whole period. At an impact the state before it; NaN where arcs of an inadmissible motion run backwards.
 *  @param count  >= 2
 *  @param q, v  [count][n], [count][m]; v may be NULL where m = 0
 *  @returns RIC_EINVAL; as ric_shooting_residual. */
RIC_API ric_status ric_shooting_states(ric_shooting *shooting, const double *z, double given, size_t count, double *q,
                                       double *v, ric_error *error);

/** Verifies the orbit of a solution by an event-driven run (verify.h), from within the longest time between its impacts
 *  on; `not_run` unless it is admissible.
 *  @param orbit  of the solution, from ric_shooting_orbit
 *  @returns as ric_verify, ric_shooting_residual. */
RIC_API ric_status ric_shooting_verify(ric_shooting *shooting, const double *z, double given, const ric_orbit *orbit,
                                       const ric_verify_options *options, ric_verification *verification,
                                       ric_error *error);

/** Multipliers of a solution, also of one that is not admissible, from the tangent vectors of its arcs. Of even motions
 * by the n x n block (M + M^-1) / 2, as orbit_multipliers.h says.
 *  @param multipliers  initialised for n + m; `unknown` where an impact grazes
 *  @returns as ric_shooting_residual; RIC_ENUMERIC when eigenvalues do not converge. */
RIC_API ric_status ric_shooting_multipliers(ric_shooting *shooting, const double *z, double given,
                                            const ric_multiplier_options *options, ric_multipliers *multipliers,
                                            ric_error *error);

/** How small differences of the state of a solution go from one time to another: the derivative of the state at `to` by
 *  that at `from`, both times standing still, impacts in (from, to] included by their saltation. Not of even motions.
 *  @param to  in [from, from + T]
 *  @param x  [n + m] state at `from`, after an impact there; set
 *  @param transfer  [n + m][n + m] row-major, set; may be NULL
 *  @returns RIC_EINVAL for even motions and times out of order or not finite; RIC_ENUMERIC for an impact on the way
 *           that is too slow for a derivative, and where impacts out of order leave no arc at `from`; as
 * ric_shooting_residual. */
RIC_API ric_status ric_shooting_transfer(ric_shooting *shooting, const double *z, double given, double from, double to,
                                         double *x, double *transfer, ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Shooting: periodic motions of any system as solutions of equations F(z) = 0.
 *
 * A motion with impacts is cut at its impacts into arcs. On an arc the motion is free and depends smoothly on its
 * initial state and the times of its ends. F states that the arcs match: every arc ends on its obstacle, the impact
 * law leads to the next arc, and the last arc closes the period. The times of impacts are unknowns, so contacts need
 * not be searched for, and F is smooth where an impact grazes, beyond it (where the motion passes through the
 * obstacle), and where impacts coincide. Derivatives are exact, from tangent vectors (flow.h) and the derivative of
 * the impact map.
 *
 * Four kinds of motion differ in how they close:
 *
 *   even          about t = 0 and t = T/2, of time-reversible systems (q' = u, no damping, forcing by cosines): half a
 *                 period is enough. At t = 0 and T/2 coordinates are at rest, or hit their obstacle and reverse their
 *                 speed, any number of them at once: the orbits of [JAP] (7)-(8), with one unknown and one equation
 *                 per coordinate. The period or the energy is given.
 *   forced        with a given period, a multiple of that of the forcing.
 *   autonomous    limit cycles: without forcing, with an unknown period; isolated motions of self-excited systems.
 *   conservative  without forcing or losses: motions come in families, and the period or the energy is given.
 *                 Conservation makes one equation redundant: the closing equation gets an additional term, an unknown
 *                 lambda times the gradient of the energy. It makes the Jacobian regular, and lambda is zero for every
 *                 motion. A solution with another lambda is not a periodic motion.
 *
 * Unknowns z, in this order: initial states of arcs (each arc cut into `pieces`); times of impacts; the period, if it
 * is not given; lambda. The first state of even motions has one number per coordinate: q_i, or u_i for coordinates
 * that are hit at t = 0. Without impacts the first state is that at t = 0, otherwise the one after the first impact.
 * Motions of autonomous and conservative systems start at that impact at t = 0, and without impacts at a phase that
 * the guess fixes. */
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
  const size_t *at_start; /* [start_count] even: obstacles hit at t = 0, at coordinates. Arrays are copied */
  size_t start_count;
  const size_t *at_half; /* [half_count] even: those hit at T/2 */
  size_t half_count;
  const size_t
      *sequence; /* [count] obstacles in the order of their impacts: even, between 0 and T/2; else in a period */
  size_t count;
  size_t pieces; /* multiple-shooting intervals per arc; 0, the default: one. More for strongly unstable motions */
  ric_flow_options flow; /* default ric_flow_options_default() */
  double grazing_tol;    /* 1e-10: gaps and gap rates below it count as zero; 0: the default */
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
/** Number of impacts per period. Orbits of even motions list them in the order at_start, sequence, at_half, mirror
 *  images of the sequence in the second half. Orbits of other motions list the second impact of the sequence first and
 *  its first impact last. */
RIC_API size_t ric_shooting_impacts(const ric_shooting *shooting);

/** Work of its flow since it was created. */
RIC_API ric_flow_counts ric_shooting_counted(const ric_shooting *shooting);

/** Initial z from a guess of the motion. States of later arcs follow from the flow and the impact law.
 *  @param q, u  [n], [m] first state: at t = 0+ (even), after the first impact, or at t = 0 without impacts;
 *               u NULL if m = 0
 *  @param times  [count] of the impacts of `sequence`, increasing; NULL if there are none
 *  @param period  > 0
 *  @param z  [unknowns], set
 *  @returns RIC_EINVAL for times out of order; as ric_shooting_residual. */
RIC_API ric_status ric_shooting_guess(ric_shooting *shooting, const double *q, const double *u, const double *times,
                                      double period, double *z, ric_error *error);

/** F [unknowns] at z, its Jacobian J [unknowns][unknowns] row-major and its derivative by the given number.
 *  @param given  the period T > 0, or the energy if that is given; unused for autonomous motions
 *  @param J, F_given  may be NULL, both. J omits lambda times the second derivative of the energy, which is zero at
 *                     every motion
 *  @returns RIC_ENUMERIC if there is no value: the motion blows up, impacts are out of order in a system with compliant
 *           obstacles, or the period is not positive; RIC_ECALLBACK, RIC_ESTOPPED. */
RIC_API ric_status ric_shooting_residual(ric_shooting *shooting, const double *z, double given, double *F, double *J,
                                         double *F_given, ric_error *error);

/** Solves F(z) = 0 from a distant guess: Newton's method with line search by SUNDIALS KINSOL, with exact Jacobians.
 *  @param z  [unknowns] guess; set to the solution
 *  @param tolerance  of the largest residual, relative to 1 + the largest unknown; 0: 1e-13
 *  @param iterations  set to the number of Newton steps (one for linear problems); may be NULL
 *  @returns RIC_ENUMERIC if it does not converge, with the remaining residual, or converges to a solution that is no
 *           motion (lambda is not zero); as ric_shooting_residual. z is then the last iterate. */
RIC_API ric_status ric_shooting_solve(ric_shooting *shooting, double *z, double given, double tolerance,
                                      int *iterations, ric_error *error);

/** The orbit of a solution with its outcome: impacts with times and gap rates, energy, residual, and the smallest
 *  gaps, certified on the segments of its arcs.
 *
 *    admissible    all impulses positive, impacts in order, all gaps positive in between
 *    inadmissible  the reason names the first violation
 *    grazing       an impulse or a gap is zero within grazing_tol
 *    failed        the equations are violated, lambda is not zero, or the system lacks the symmetry that the kind
 *                  requires (even: time reversal; forced: time repeats after the period; the others: no dependence on
 *                  time), so that the solution is no motion
 *
 *  Gaps of obstacles that are hit count at their minima between the impacts. The clearance is the smallest gap of the
 *  rigid obstacles that are not hit at all; NaN if there are none. The state (q, v) is the first one: at t = 0+; for
 *  forced motions with impacts, just after the impact that is listed last. (q_half, v_half) is half a period later,
 *  before an impact there.
 *  @param orbit  initialised for the system's coordinates and ric_shooting_impacts
 *  @returns as ric_shooting_residual. */
RIC_API ric_status ric_shooting_orbit(ric_shooting *shooting, const double *z, double given, ric_orbit *orbit,
                                      ric_error *error);

/** Amplitude of a solution: the largest displacement of any coordinate over the period.
 *  @returns as ric_shooting_residual. */
RIC_API ric_status ric_shooting_amplitude(ric_shooting *shooting, const double *z, double given, double *amplitude,
                                          ric_error *error);

/** States of a solution over one period at equidistant times t_k = t_0 + k T / (count - 1), with the time t_0 of the
 *  first state. At an impact the state before it; NaN on arcs of an inadmissible motion that run backwards in time.
 *  @param count  >= 2
 *  @param q, v  [count][n], [count][m]; v may be NULL if m = 0
 *  @returns RIC_EINVAL; as ric_shooting_residual. */
RIC_API ric_status ric_shooting_states(ric_shooting *shooting, const double *z, double given, size_t count, double *q,
                                       double *v, ric_error *error);

/** Verifies the orbit of a solution by an event-driven run (verify.h), from within the longest time between its impacts
 *  on; `not_run` unless it is admissible.
 *  @param orbit  of the solution, from ric_shooting_orbit
 *  @param options  NULL for the defaults
 *  @returns as ric_verify, ric_shooting_residual. */
RIC_API ric_status ric_shooting_verify(ric_shooting *shooting, const double *z, double given, const ric_orbit *orbit,
                                       const ric_verify_options *options, ric_verification *verification,
                                       ric_error *error);

/** Floquet multipliers of a solution, admissible or not, from the tangent vectors of its arcs; for even motions by the
 *  n x n block (M + M^-1) / 2, see orbit_multipliers.h.
 *  @param options  NULL for the defaults
 *  @param multipliers  initialised for n + m; `unknown` if an impact grazes
 *  @returns as ric_shooting_residual; RIC_ENUMERIC if eigenvalues do not converge. */
RIC_API ric_status ric_shooting_multipliers(ric_shooting *shooting, const double *z, double given,
                                            const ric_multiplier_options *options, ric_multipliers *multipliers,
                                            ric_error *error);

/** Transition matrix of the variational equation along a solution: the derivative of the state at the fixed time `to`
 *  by that at the fixed time `from`, with the saltation matrices of impacts in (from, to]. Not for even motions.
 *  @param to  in [from, from + T]
 *  @param x  [n + m] state at `from`, after an impact there; set
 *  @param transfer  [n + m][n + m] row-major, set; may be NULL
 *  @returns RIC_EINVAL for even motions and times out of order or not finite; RIC_ENUMERIC if an impact in between is
 *           too slow for a derivative, or impacts out of order leave no arc at `from`; as ric_shooting_residual. */
RIC_API ric_status ric_shooting_transfer(ric_shooting *shooting, const double *z, double given, double from, double to,
                                         double *x, double *transfer, ric_error *error);

RIC_END_DECLARATIONS

#endif

/* Periodic orbits of the chain with a given impact pattern.
 *
 * One struct describes an orbit, however it was found (shooting.h finds those of any system): state at t = 0+ and at
 * t = T/2-, impacts, energy, residual, and an outcome with its reason. The orbits computed here are conservative
 * (restitution 1), have at most one impact per particle and period, at t = 0 or t = T/2, and are even about both
 * times.
 *
 * There are two methods. `impulse` superposes the responses of the modes to periodic unit impulses,
 *
 *   q(t) = sum_l p_l G_{.l}(t - t_l),
 *   G_kl(t) = sum_j phi_j(k) phi_j(l) cos(omega_j (T/2 - t)) / (2 omega_j sin(omega_j T/2)),
 *
 * and solves the contact conditions q_k(t_k) = b_k, one linear equation per impact: O(n log n + m^3), explicit in
 * gamma, spatially periodic patterns on their unit cell. `dense` solves the boundary-value problem (10)-(11) of [JAP]
 * with the exponential of the 2n x 2n matrix: the reference, O(n^3).
 *
 * Outcomes (they are results, not errors):
 *   admissible   impulses positive, every gap positive between impacts ([JAP] (9)), certified on the whole period
 *   inadmissible a solution of the equations that violates one of the two; the reason says which first, where and when
 *   grazing      an impulse or a gap vanishes within grazing_tol; in particular, resonant modes satisfy the contact
 *                conditions alone: the impulses are zero and the orbit is a linear mode that grazes the floor
 *   resonant     the orbit exists and is not unique: a resonant mode vanishes at every contact and its amplitude is
 *                free (0 in the orbit given), or the equations are singular but solvable (the orbit given is the
 *                smallest solution)
 *   singular     the contact matrix is singular: there is no orbit, amplitudes blow up nearby; states are NaN
 *   not_converged, failed  no result, with the reason */
#ifndef RICOCHET_ORBIT_H
#define RICOCHET_ORBIT_H

#include <stddef.h>

#include "chain.h"
#include "pattern.h"
#include "resonance.h"
#include "system.h"

RIC_BEGIN_DECLARATIONS

#define RIC_OUTCOME_LIST(X)                                                                                            \
  X(RIC_ADMISSIBLE, "admissible")                                                                                      \
  X(RIC_INADMISSIBLE, "inadmissible")                                                                                  \
  X(RIC_GRAZING, "grazing")                                                                                            \
  X(RIC_RESONANT, "resonant")                                                                                          \
  X(RIC_SINGULAR, "singular")                                                                                          \
  X(RIC_NOT_CONVERGED, "not_converged")                                                                                \
  X(RIC_FAILED, "failed")

typedef enum ric_outcome {
#define X(name, text) name,
  RIC_OUTCOME_LIST(X)
#undef X
      RIC_OUTCOME_COUNT
} ric_outcome;

/** Name of an outcome, "admissible". Never NULL. */
RIC_API const char *ric_outcome_name(ric_outcome outcome);

typedef enum ric_orbit_method { RIC_METHOD_IMPULSE, RIC_METHOD_DENSE } ric_orbit_method;

enum { RIC_REASON_BYTES = 224, RIC_DENSE_PARTICLES = 400 /* largest chain of the dense method */ };

/** Tolerances. Unless stated otherwise they are relative to the size of the orbit, max(abs(q), abs(v) / omega_max) at t
 *  = 0 and T/2; the velocities account for displacements in between. */
typedef struct ric_orbit_options {
  ric_orbit_method method;
  double clearance_tol;      /* 1e-12: accuracy of the clearance; a hundred times the rounding */
  double grazing_tol;        /* 1e-10: gaps and impulses below it count as zero */
  double residual_tol;       /* 1e-9: an orbit that violates the equations by more is `failed` */
  double resonance_tol;      /* 1e-10: |omega_j T / (2 pi) - l| below it is a resonance. Absolute */
  double singular_condition; /* 1e9: condition numbers above it are singular: results there would have seven digits */
  ric_poll poll;
} ric_orbit_options;

RIC_API ric_orbit_options ric_orbit_options_default(void);

/** A periodic orbit. Owned by the caller: ric_orbit_init, ric_orbit_clear. */
typedef struct ric_orbit {
  ric_outcome outcome;
  char reason[RIC_REASON_BYTES]; /* why, for people; "" when admissible */
  double period;
  size_t particles;        /* n, coordinates of a system */
  size_t speeds;           /* n of chains */
  size_t impacts;          /* m */
  double *q, *v;           /* [n], [speeds] state at t = 0+ */
  double *q_half, *v_half; /* [n], [speeds] state at t = (T/2)-, before the impacts there */
  double *impulse;         /* [m] in the order of the pattern, along the gap: > 0 if the obstacle pushes;
                              velocity jumps for masses 1; NaN for impact maps */
  double *impact_time;     /* [m] in [0, T) */
  double *gap_rate;        /* [m] before the impact */
  size_t *impact_obstacle; /* [m] obstacle of the system; for chains the particle */
  double energy;           /* total, constant along the orbit */
  double residual;  /* largest violation of the contact conditions, and of the equations of motion between both states
                       (velocities divided by the largest frequency) */
  double clearance; /* smallest gap over the whole period of the free particles that have a floor; NaN if none */
  double clearance_time;        /* when, in [0, T/2]; NaN */
  long long clearance_particle; /* its particle (for user systems: obstacle); -1 */
  double condition;   /* impulse: largest free response over the response at the contacts; dense: of its matrix */
  long long mode;     /* the resonant mode of `grazing` and `resonant`; -1 */
  long long harmonic; /* l of that resonance; 0 */
} ric_orbit;

/** Allocates the arrays. @returns RIC_ENOMEM, RIC_EINVAL for a size of 0. */
RIC_API ric_status ric_orbit_init(ric_orbit *orbit, size_t particles, size_t impacts, ric_error *error);
/** The same for motions of any system, with any number of impacts including 0. */
RIC_API ric_status ric_orbit_init_for(ric_orbit *orbit, const ric_system *system, size_t impacts, ric_error *error);
RIC_API void ric_orbit_clear(ric_orbit *orbit);

/** Sets the outcome `failed` with this reason: NaN in every array, no clearance. For problems that are rejected before
 *  they reach a solver.
 */
RIC_API void ric_orbit_fail(ric_orbit *orbit, const char *reason);

/** Workspace of the solvers and of all functions that integrate an orbit in time. It grows to the size of the largest
 *  problem. Solving again by impulse response with the same numbers of particles, ends and impacts allocates nothing
 * away from resonances and singular points (except inside FFTW, in the transforms of chains with ends and of sizes with
 *  large prime factors). Do not share it between threads. */
typedef struct ric_orbit_solver ric_orbit_solver;

/** @param options  copied, NULL for the defaults; checked here */
RIC_API ric_status ric_orbit_solver_create(const ric_orbit_options *options, ric_orbit_solver **solver,
                                           ric_error *error);
RIC_API void ric_orbit_solver_destroy(ric_orbit_solver **solver);

/** Memory of solver and orbit in bytes for a chain and a pattern, on the unit cell if the pattern has one. */
RIC_API double ric_orbit_bytes(const ric_chain *chain, const ric_pattern *pattern, ric_orbit_method method);

/** The orbit of a pattern at a period.
 *  @param orbit  initialised for the chain's particles and the pattern's impacts
 *  @returns RIC_EINVAL for invalid arguments, including an impacting particle without a floor and a period <= 0;
 *           RIC_ELIMIT for the dense method beyond RIC_DENSE_PARTICLES, and for a fastest mode with more than
 *           RIC_MOST_HARMONICS oscillations per period; RIC_ENUMERIC if displacements overflow or more than 32 wave
 *           numbers are at resonance at once; RIC_ESTOPPED. Everything else is an outcome. The orbit of a call that
 *           returns an error is `failed`, with the error's message as its reason.
 *  Source: [JAP] (7)-(11). */
RIC_API ric_status ric_orbit_solve(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                                   double period, ric_orbit *orbit, ric_error *error);

/** States of an orbit at given times, which are reduced to the period; at an impact the state after it.
 *  @param times  [count], unordered
 *  @param q, v  [count][n], row-major; v may be NULL
 *  @returns RIC_EINVAL for an orbit without a state (singular, failed) or a time that is not finite. */
RIC_API ric_status ric_orbit_states(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                                    const double *times, size_t count, double *q, double *v, ric_error *error);

/** Parameters in (low, high), increasing, at which the contact matrix of a pattern, on its unit cell, is singular.
 *
 *  Between two resonances every eigenvalue of the contact matrix decreases along gamma and along the period, so the
 *  number of negative eigenvalues counts the zeros of the determinant in between. A zero is missed only if its distance
 *  from a resonance is below 1e-12 of the range.
 *  @param points  [capacity]; @param count  set to their number, also beyond the capacity
 *  @returns RIC_EINVAL as ric_chain_resonances; RIC_ELIMIT when there are more than 10^5 resonances in the range. */
RIC_API ric_status ric_orbit_singular_points(ric_orbit_solver *solver, const ric_chain *chain,
                                             const ric_pattern *pattern, ric_along along, double period, double low,
                                             double high, double *points, size_t capacity, size_t *count,
                                             ric_error *error);

RIC_END_DECLARATIONS

#endif

/* First guesses of periodic motions of lattices: the states from which Newton's method finds the first motion of a
 * family.
 *
 * Newton's method needs a guess near a motion. For lattices four kinds of motion have approximations:
 *
 *   particles     for weak links, excited particles oscillate each on its on-site spring, and the others are at rest. A
 *                 spring with a cubic term has the period T at one amplitude;
 *   mode          at small energies a nonlinear normal mode is close to that of the linear part;
 *   even          the motion of the linear part with impacts at t = 0 and T/2 solves linear equations, so Newton's
 *                 method finds it from rest (the orbits of [JAP] (7)-(8)). With the nonlinear terms times a factor that
 *                 grows from 0 to 1 (homotopy) a continuation run at the period T leads to that of the lattice. The
 *                 family may turn back before (a fold in the factor); then there is no guess, and the message says at
 *                 which factor;
 *   grazing mode  the families with one impact in several oscillations of a normal mode begin where the mode grazes the
 *                 obstacle. For the linear part this is the mode at the amplitude at which the particle just reaches
 *                 the obstacle. The same homotopy continues the motion with an impact of zero speed to that of the
 *                 lattice. With the period fixed, large-amplitude modes never reach contact, so the period is left
 *                 free.
 *
 * A Hertz contact (compliant obstacle) counts as rigid in the homotopy. In the guess a particle in such a contact at
 * t = 0 is at rest at the depth d at which the work of the contact, 2/5 k d^(5/2), equals its kinetic energy. */
#ifndef RICOCHET_GUESS_H
#define RICOCHET_GUESS_H

#include "lattice.h"
#include "obstacle.h"
#include "shooting.h"

RIC_BEGIN_DECLARATIONS

/** A first guess: input of ric_shooting_guess and ric_family_start. */
typedef struct ric_guess {
  double *q, *v; /* [n] state at t = 0+ */
  double period;
  int rise; /* of a grazing mode: sign of the energy's change along the family with the impact, on the side where its
               impulse pushes; 0: the two energies beside grazing are equal. 0 of other guesses */
} ric_guess;

/** Allocates the arrays, zeros. @returns RIC_ENOMEM; RIC_EINVAL for no particles */
RIC_API ric_status ric_guess_init(ric_guess *guess, size_t particles, ric_error *error);
/** Frees them; a guess of zeros is unchanged. */
RIC_API void ric_guess_clear(ric_guess *guess);

/** The motions to be approximated. Borrowed during the call. */
typedef struct ric_guess_problem {
  const ric_lattice *lattice;
  const ric_obstacle *obstacles; /* [obstacle_count] */
  size_t obstacle_count;
  const ric_shooting_problem *motion; /* even, with the period given; its poll is called */
} ric_guess_problem;

/** Uncoupled oscillations of particles, at rest at t = 0 at the amplitude a with w (1 + 3/8 c a^2 / w^2) = 2 pi / T,
 *  the frequency of q'' + w^2 q + c q^3 = 0 at small a. The spring is the on-site one or, in a lattice without, the
 *  link before the particle; w is 1 without a linear part.
 *  @param excited  [count] particles
 *  @param guess  initialised for the lattice, as in the calls below; unchanged on failure
 *  @returns RIC_EINVAL for particles that do not exist, and if no amplitude has the period */
RIC_API ric_status ric_guess_particles(const ric_lattice *lattice, const size_t *excited, size_t count, double period,
                                       ric_guess *guess, ric_error *error);

/** A normal mode of the linear part at an energy, at rest at its turning point; the period is its own.
 *  @param mode  in the order of frequencies (normal_modes.h)
 *  @param energy  > 0
 *  @returns RIC_EINVAL for energies and modes out of range, and modes without a frequency; as ric_normal_modes */
RIC_API ric_status ric_guess_mode(const ric_lattice *lattice, size_t mode, double energy, ric_guess *guess,
                                  ric_error *error);

/** The even motion with the given impacts and period, continued from that of the linear part. Impacts between 0 and T/2
 *  (`sequence`) are ignored in the linear part: their times are no linear unknowns.
 *  @returns RIC_EINVAL for a motion that is not even, and if the linear part has no such motion; RIC_ENUMERIC if the
 *           homotopy does not reach the factor 1, with the factor reached; as ric_family_create and ric_family_follow
 */
RIC_API ric_status ric_guess_even(const ric_guess_problem *problem, double period, ric_guess *guess, ric_error *error);

/** The motion in which a normal mode grazes a rigid obstacle at t = 0.
 *  @param problem  with one impact, at t = 0: the obstacle
 *  @param swings  >= 1, periods of the mode in one period of the motion
 *  @returns RIC_EINVAL for other impacts, and modes that do not move the particle or have no frequency; RIC_ENUMERIC if
 *           the homotopy does not reach the factor 1, with the factor reached; as ric_family_trace */
RIC_API ric_status ric_guess_grazing_mode(const ric_guess_problem *problem, size_t mode, size_t swings,
                                          ric_guess *guess, ric_error *error);

/** Replaces the guess by the motion of its period, and computes its energy: to follow a family at given energies if a
 *  period is known.
 *  @param shooting  of the motion with the period given
 *  @param times  [count] as ric_shooting_guess; NULL if there are none
 *  @param energy  set
 *  @returns as ric_shooting_guess, ric_shooting_solve and ric_shooting_orbit */
RIC_API ric_status ric_guess_solve(ric_shooting *shooting, const double *times, ric_guess *guess, double *energy,
                                   ric_error *error);

RIC_END_DECLARATIONS

#endif

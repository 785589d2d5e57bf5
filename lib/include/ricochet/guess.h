/* First guesses of periodic motions of lattices: the states from which Newton's method finds a family's first motion.
 *
 * Newton's method converges from a guess that is near a motion. Of a lattice four kinds of motion are known nearly:
 *
 *   particles     where the links are weak, particles that are excited swing each on its on-site spring, the others
 *                 are at rest. A spring with a cubic term has the period T at one amplitude;
 *   mode          at small energies a nonlinear normal mode is nearly the one of the linear part;
 *   even          the motion of the linear part with impacts at t = 0 and T/2 solves linear equations, so Newton's
 *                 method finds it from rest (the orbits of [JAP] (7)-(8)). With the nonlinear terms times a factor that
 *                 grows from 0 to 1 (homotopy) a continuation run at the period T takes it to that of the lattice. The
 *                 family may turn back before (a fold in the factor); then there is no guess, and the message says at
 *                 which factor;
 *   grazing mode  the families with one impact in some swings of a normal mode begin where the mode grazes the
 *                 obstacle. Of the linear part it is the mode at the amplitude at which the particle just reaches the
 *                 obstacle; the motion with an impact of zero speed is taken to that of the lattice by the same
 *                 homotopy, with the period free. Homotopies at a given period fail for modes that must swing far.
 *
 * A Hertz contact (compliant obstacle) counts as rigid in the homotopy. In the guess a particle that presses one at
 * t = 0 is at rest at the depth at which the work of the contact, 2/5 k d^(5/2), has taken its kinetic energy. */
#ifndef RICOCHET_GUESS_H
#define RICOCHET_GUESS_H

#include "lattice.h"
#include "obstacle.h"
#include "shooting.h"

RIC_BEGIN_DECLARATIONS

/** A first guess: what ric_shooting_guess and ric_family_start take. */
typedef struct ric_guess {
  double *q, *v; /* [n] state at t = 0+ */
  double period;
  int rise; /* of a grazing mode: sign of the energy's change along the family with the impact, on the side where its
               impulse pushes; 0: the two energies beside grazing are equal. 0 of other guesses */
} ric_guess;

/** Allocates the arrays, zeros. @returns RIC_ENOMEM; RIC_EINVAL for no particles */
RIC_API ric_status ric_guess_init(ric_guess *guess, size_t particles, ric_error *error);
/** Frees them; a guess of zeros is left alone. */
RIC_API void ric_guess_clear(ric_guess *guess);

/** The motions that are guessed. Borrowed during the call. */
typedef struct ric_guess_problem {
  const ric_lattice *lattice;
  const ric_obstacle *obstacles; /* [obstacle_count] */
  size_t obstacle_count;
  const ric_shooting_problem *motion; /* even, with the period given; its poll is asked */
} ric_guess_problem;

/** Particles that swing alone, at rest at t = 0 at the amplitude a with w (1 + 3/8 c a^2 / w^2) = 2 pi / T, the
 *  frequency of q'' + w^2 q + c q^3 = 0 at small a. The spring is the on-site one, in a lattice that has none the link
 *  before the particle; w is 1 without a linear part.
 *  @param excited  [count] particles
 *  @param guess  initialised for the lattice, as in the calls below; on failure it keeps what it had
 *  @returns RIC_EINVAL for particles that do not exist, and where no amplitude has the period */
RIC_API ric_status ric_guess_particles(const ric_lattice *lattice, const size_t *excited, size_t count, double period,
                                       ric_guess *guess, ric_error *error);

/** A normal mode of the linear part at an energy, at rest at its turning point; the period is its own.
 *  @param mode  in the order of frequencies (normal_modes.h)
 *  @param energy  > 0
 *  @returns RIC_EINVAL for energies and modes out of range, and modes without a frequency; as ric_normal_modes */
RIC_API ric_status ric_guess_mode(const ric_lattice *lattice, size_t mode, double energy, ric_guess *guess,
                                  ric_error *error);

/** The even motion with the given impacts and period, continued from that of the linear part. Where there are impacts
 *  between 0 and T/2 (`sequence`) it is that of the linear part without them: their times are no linear unknowns.
 *  @returns RIC_EINVAL for a motion that is not even, and where the linear part has no such motion; RIC_ENUMERIC where
 *           the motion does not reach all nonlinear terms, with the factor reached; as ric_family_create and
 *           ric_family_follow */
RIC_API ric_status ric_guess_even(const ric_guess_problem *problem, double period, ric_guess *guess, ric_error *error);

/** The motion in which a normal mode grazes a rigid obstacle at t = 0.
 *  @param problem  with one impact, at t = 0: the obstacle
 *  @param swings  >= 1, periods of the mode in one of the motion
 *  @returns RIC_EINVAL for other impacts, and modes that do not move the particle or have no frequency; RIC_ENUMERIC
 *           where the motion does not reach all nonlinear terms, with the factor reached; as ric_family_trace */
RIC_API ric_status ric_guess_grazing_mode(const ric_guess_problem *problem, size_t mode, size_t swings,
                                          ric_guess *guess, ric_error *error);

/** Puts the motion of the guess's period in place of the guess, and finds its energy: where a family is to be followed
 *  at given energies, and a period is what is known.
 *  @param shooting  of the motion with the period given
 *  @param times  [count] as ric_shooting_guess
 *  @param energy  set
 *  @returns as ric_shooting_guess, ric_shooting_solve and ric_shooting_orbit */
RIC_API ric_status ric_guess_solve(ric_shooting *shooting, const double *times, ric_guess *guess, double *energy,
                                   ric_error *error);

RIC_END_DECLARATIONS

#endif

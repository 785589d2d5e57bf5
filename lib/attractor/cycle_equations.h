/* The equations of a cycle with a fixed itinerary: internal to the room.
 *
 * With y = sqrt(d - eta z) of each impact among the unknowns, all iterates are polynomials,
 *
 *   z -> L z,   or   z -> L z + y s xi + y^2 kappa   and   y^2 + eta z - d = 0,
 *
 * smooth through the border, which an impact reaches at y = 0 and another iterate at eta z = d: the equations have
 * solutions on both sides. The cycle is cut into pieces, so short that L to the power of their length is not large;
 * unknowns x: the states at which the pieces begin, then the y. The derivative of the n-th iterate follows as L -
 * ((s / 2y) xi + kappa) eta of each impact. */
#ifndef RICOCHET_CYCLE_EQUATIONS_H
#define RICOCHET_CYCLE_EQUATIONS_H

#include "ricochet/cycle_window.h"

typedef struct cycle_equations {
  const ric_map_line *line; /* borrowed */
  ric_grazing_map map;      /* at the parameter set last */
  double d, parameter;
  size_t period, impacts, unknowns;
  bool *hits;     /* [period] the itinerary */
  size_t *starts; /* [pieces + 1] first iterate of each piece, then the period */
  size_t pieces;
  double *z, *next;             /* [size] */
  double *slopes, *next_slopes; /* [size][unknowns] of z by the unknowns; [size][size] by the state */
  ric_multipliers multipliers;
} cycle_equations;

/** Takes the itinerary from the state z [size] at the parameter p.
 *  @returns RIC_EINVAL for the period, the line and z; RIC_ELIMIT for too many unknowns; RIC_ENOMEM; always to be
 * cleared */
ric_status cycle_equations_init(cycle_equations *e, const ric_map_line *line, double p, size_t period, const double *z,
                                ric_error *error);
void cycle_equations_clear(cycle_equations *e);

/** The map at a parameter. @returns what `at` does; as ric_grazing_map_check */
ric_status cycle_equations_set(cycle_equations *e, double p, ric_error *error);

/** x [unknowns] by iterating z [size], from which the itinerary has been taken, at the parameter set last. */
void cycle_equations_guess(cycle_equations *e, const double *z, double *x);

/** F [unknowns] at x and the parameter set last, its Jacobian J [unknowns][stride] by x, which may be NULL, and of
 *  each iterate what is positive while the itinerary stands: y, or eta z - d.
 *  @param clearance  [period], may be NULL */
void cycle_equations_at(cycle_equations *e, const double *x, double *F, double *J, size_t stride, double *clearance);

/** Multipliers at a solution, into `multipliers`.
 *  @returns RIC_ENUMERIC where the derivative overflows, as at y = 0 */
ric_status cycle_equations_spectrum(cycle_equations *e, const double *x, ric_error *error);

/** The first period of the cycle at a solution: `period`, or a part of it. */
size_t cycle_equations_least_period(cycle_equations *e, const double *x);

#endif

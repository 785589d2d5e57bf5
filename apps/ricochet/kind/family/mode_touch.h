/* Where the families with one impact in some swings of a normal mode begin: the mode touches the obstacle.
 *
 * Of the linear part it is the mode at the amplitude at which the particle comes to the obstacle, run through once or
 * several times: a motion with an impact of no speed. With the nonlinear terms times a factor that grows from 0 to 1 it
 * is continued to that of the lattice, as such a motion: its period and its energy change on the way. At a period that
 * stays (even_start.h) the families of modes that must swing far to touch do not come there. */
#ifndef RICOCHET_APP_MODE_TOUCH_H
#define RICOCHET_APP_MODE_TOUCH_H

#include "model/lattice_model.h"

typedef struct mode_touch {
  size_t mode;   /* in the order of frequencies of the linear part */
  size_t swings; /* periods of the mode in one of the motion */
  double period; /* of the motion, set */
  int rise;      /* set: sign of the energy's change along its family, on the side on which the impact pushes */
  double *z;     /* [particles] set: displacements, but the speed of the particle that touches */
} mode_touch;

/** Finds the motion.
 *  @param motion  even, with one impact, at t = 0
 *  @param touch  its z is the caller's
 *  @returns RIC_EINVAL for modes that do not move the particle or have no frequency; RIC_ENUMERIC where the motion does
 *           not come to all nonlinear terms; as ric_family_trace */
ric_status mode_touch_find(mode_touch *touch, const lattice_model *model, const ric_shooting_problem *motion,
                           ric_error *error);

#endif

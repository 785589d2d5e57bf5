/* A short way of the free motion in one go: internal to the room.
 *
 * A flow with variable order starts with short steps of low order, each as wrong as its tolerance allows: after a way
 * of 1e-6 the gap of a motion that grazes by 1e-13 is lost in that. Here Gragg's midpoint rule is extrapolated
 * (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.9), which over times that are short
 * for the motion errs by rounding only; where it does not, it says so. */
#ifndef RICOCHET_LEAP_H
#define RICOCHET_LEAP_H

#include <stdbool.h>

#include "model/system_model.h"

typedef struct leap {
  const ric_system *system;
  double *rows;                /* [LEAP_ROWS][n + m] extrapolations of one row, over those of the row before */
  double *before, *now, *rate; /* [n + m] ways from the start; rates of change */
  double *point;               /* [n + m] */
} leap;

ric_status leap_init(leap *l, const ric_system *system, ric_error *error);
void leap_clear(leap *l);

/** Moves a state by dt, when callbacks work and the extrapolation converges to `tolerance` of the size of the state, or
 *  of 1e-3 when that is larger. @returns whether it has; x is untouched otherwise. */
bool leap_move(leap *l, double t, double dt, double *x, double tolerance);

#endif

/* The coefficients of grazing at a state, with the impact map's second derivative there. Internal to the library. */
#ifndef RICOCHET_LOCAL_H
#define RICOCHET_LOCAL_H

#include <stdbool.h>

#include "model/system_model.h"
#include "ricochet/bypass.h"

/* A short way of the free motion in one go.
 *
 * A flow with variable order starts with short steps of low order, each as wrong as its tolerance allows: after a way
 * of 1e-6 the gap of a motion that grazes by 1e-13 is lost in that. Here Gragg's midpoint rule is extrapolated
 * (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.9), which over times that are short
 * for the motion errs by rounding only; where it does not, it says so. */

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

/* What every function of grazing asks of an obstacle. */

/** @returns RIC_EINVAL for an unknown or compliant obstacle. */
ric_status grazing_check_obstacle(const ric_system *system, size_t obstacle, ric_error *error);

/** @returns RIC_ECALLBACK with what went wrong. */
ric_status grazing_blame(double t, size_t obstacle, const char *trouble, ric_error *error);

/** Gap rate and its rate of change along the free motion. @param rates  [n + m] work, set to those of the state */
ric_status grazing_rates(const ric_system *system, size_t obstacle, double t, const double *x, double *rates,
                         double *rate, double *acceleration, ric_error *error);

/** @returns RIC_EINVAL when the numbers of a grazing point are not those of this system, or A_g is not above zero. */
ric_status grazing_check_local(const ric_grazing_local *local, const ric_system *system, ric_error *error);

#endif

/* Derivatives of the rates of any system along tangent vectors: internal to the library.
 *
 * Systems that know theirs give them; for all others they are differences along each vector (path_derivative.h). Steps
 * are 2e-3 in coordinates, whose scales are taken to be one, so that both errors, of the formula and of rounding, are
 * about 1e-13. */
#ifndef RICOCHET_TANGENT_H
#define RICOCHET_TANGENT_H

#include "system_model.h"

/** Doubles of work for a system of any model. */
size_t system_tangent_work(const ric_system *s);

/** @param work  [system_tangent_work] */
const char *system_tangent(const ric_system *s, const unsigned char *contact, double t, const double *q,
                           const double *u, const tangents *d, const tangents *d_rate, double *work);

/** Step of differences along a direction: coordinates and time move by 2e-3, speeds by that much of the largest of
 * them.
 *  @param place  largest entry of the direction in coordinates and time; @param pace  the same in speeds
 *  @param speed  largest speed at the point */
double system_tangent_step(double place, double pace, double speed);

#endif

/* Lyapunov exponents along a motion that consists of several runs: internal to the room.
 *
 * A course propagates tangent vectors along a trajectory from one run to the next, orthonormalises them and sums their
 * growth. Between runs the sums may be reset and the time of the trajectory may be set. */
#ifndef RICOCHET_INTERNAL_LYAPUNOV_H
#define RICOCHET_INTERNAL_LYAPUNOV_H

#include "numeric/linear.h"
#include "ricochet/lyapunov.h"

/** Zeroed is empty. */
typedef struct lyapunov_course {
  ric_trajectory *trajectory;
  ric_lyapunov_options options;
  size_t n, size, count;
  double *vectors; /* [size][count] */
  double *growth;  /* [count] logarithms of R's diagonal of one stride */
  double *sum;     /* [count] their sums */
  double begin;    /* time at which the sums begin; -INFINITY unless set by the caller */
  double time;     /* over which they are taken */
  double mark;     /* end of the current interval */
  double stride;   /* time between two factorisations within it */
  orthonormal_work work;
} lyapunov_course;

/** @param options  copied, in range; the caller handles `transient`
 *  @returns RIC_ENOMEM; clear it for every status. */
ric_status lyapunov_course_init(lyapunov_course *course, ric_trajectory *trajectory,
                                const ric_lyapunov_options *options, ric_error *error);
void lyapunov_course_clear(lyapunov_course *course);

/** Resets vectors and strides, for another motion of the trajectory. */
void lyapunov_course_restart(lyapunov_course *course);

/** Resets the sums; the vectors are kept. */
void lyapunov_course_forget(lyapunov_course *course);

/** Runs the trajectory to `end`.
 *  @param run  set, with counts of the whole run. With an outcome that says that tangent vectors are undefined, they
 *              are lost permanently: the trajectory can continue without the course
 *  @returns as ric_trajectory_run */
ric_status lyapunov_course_run(lyapunov_course *course, double end, ric_run *run, ric_error *error);

#endif

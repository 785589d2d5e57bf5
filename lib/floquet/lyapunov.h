/* Lyapunov exponents along a motion that is run part by part: internal to the room.
 *
 * A course carries tangent vectors along a trajectory from one run to the next, makes them orthonormal on the way and
 * adds up how they grow. Between runs the sums may be begun anew and the clock of the trajectory may be set. */
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
  double *sum;     /* [count] of them all */
  double begin;    /* time at which the sums begin; -INFINITY unless a caller sets it */
  double time;     /* over which they go */
  double mark;     /* end of the present interval */
  double stride;   /* from one factorisation to the next within it */
  orthonormal_work work;
} lyapunov_course;

/** @param options  copied, in range; `transient` is the caller's to heed
 *  @returns RIC_ENOMEM; clear it whatever the status. */
ric_status lyapunov_course_init(lyapunov_course *course, ric_trajectory *trajectory,
                                const ric_lyapunov_options *options, ric_error *error);
void lyapunov_course_clear(lyapunov_course *course);

/** The first vectors and strides again, for another motion of the trajectory. */
void lyapunov_course_restart(lyapunov_course *course);

/** Begins the sums anew; the vectors stay as they are. */
void lyapunov_course_forget(lyapunov_course *course);

/** Runs the trajectory to `end`.
 *  @param run  set, counts of all that was run. With an outcome that says that the tangent vectors have no way on, they
 *              are lost for good: the trajectory may go on without the course
 *  @returns as ric_trajectory_run */
ric_status lyapunov_course_run(lyapunov_course *course, double end, ric_run *run, ric_error *error);

#endif

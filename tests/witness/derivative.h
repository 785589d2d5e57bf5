/* The derivative of the state that a run reaches by the state it starts from, in two ways. */
#ifndef RICOCHET_TESTS_DERIVATIVE_H
#define RICOCHET_TESTS_DERIVATIVE_H

#include <ricochet/ricochet.h>

/** By tangent vectors carried through the run, into D [n + m][n + m] row-major.
 *  @param x  [n + m] state at `start`
 *  @returns the outcome of the run; D is set when it is completed */
ric_run_outcome derivative_by_tangents(const ric_system *system, const ric_trajectory_options *options, double start,
                                       const double *x, double end, double *D);

/** By central differences of runs; `order` 2, or 4 with steps h and h / 2 extrapolated. */
void derivative_by_differences(const ric_system *system, const ric_trajectory_options *options, double start,
                               const double *x, double end, double step, int order, double *D);

/** Largest difference of two matrices over the largest entry of the second. */
double derivative_error(const double *A, const double *B, size_t size);

#endif

/* Scenarios of curves of solutions. */
#include <math.h>
#include <stdlib.h>

#include "bench.h"
#include "scenario/smooth_curve.h"

/* Points of a curve in three unknowns; nearly all of the time is the library's. */
static work_done small(size_t points, int natural) {
  size_t calls = 0;
  const ric_curve_problem problem = smooth_wave(&calls);
  ric_curve_options options = ric_curve_options_default();
  options.points = points;
  options.natural = natural;
  ric_curve *curve = NULL;
  ric_curve_run run = {0};
  double u[3] = {0};
  int failed = ric_curve_create(&problem, &options, &curve, NULL) != RIC_OK;
  double began = bench_seconds();
  failed = failed || ric_curve_follow(curve, u, 0, NULL, NULL, NULL, &run, NULL) != RIC_OK || run.points != points;
  double seconds = bench_seconds() - began;
  if (curve)
    ric_curve_destroy(&curve);
  return (work_done){.tasks = points,
                     .n = 3,
                     .failed = failed,
                     .seconds = seconds,
                     .measure = "evaluations_of_a_point",
                     .value = (double)calls / (double)points};
}

/* A correction of a problem with many unknowns, from a solution: an evaluation of n^2 numbers, factors, a solution. */
static work_done large(size_t n, int variant) {
  (void)variant;
  smooth_line line;
  ric_curve *curve = NULL;
  int iterations = -1, failed = smooth_line_init(&line, n);
  const ric_curve_problem problem = smooth_line_problem(&line);
  double *u = calloc(n, sizeof *u), seconds = 0;
  failed = failed || !u || ric_curve_create(&problem, NULL, &curve, NULL) != RIC_OK;
  if (!failed) {
    double began = bench_seconds();
    failed = ric_curve_solve(curve, u, 0, &iterations, NULL) != RIC_OK || iterations != 0;
    seconds = bench_seconds() - began;
  }
  if (curve)
    ric_curve_destroy(&curve);
  free(u);
  smooth_line_clear(&line);
  return (work_done){.tasks = 1, .n = n, .failed = failed, .seconds = seconds};
}

const benchmark continuation_benchmarks[] = {
    {"continuation_small", "200 points of a curve in 3 unknowns", 101, 200, 0, small},
    {"continuation_large", "one correction of a problem with 1000 unknowns", 3, 1000, 0, large},
    {0}};

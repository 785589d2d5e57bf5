/* Scenarios of families of motions. */
#include <stdlib.h>

#include "bench.h"
#include "scenario/family_scenario.h"

static const double period = 4.71238898038469; /* 3 pi / 2 */

/* Follows a scenario. */
static work_done walk(family_scenario *s, int failed, size_t n) {
  ric_family *family = NULL;
  double *z = NULL, began = bench_seconds();
  ric_curve_run run = {0};
  failed = failed || family_scenario_begin(s, &family, &z, NULL) != RIC_OK;
  failed = failed || ric_family_follow(family, z, s->start, NULL, NULL, NULL, &run, NULL) != RIC_OK;
  failed = failed || (run.end != RIC_CURVE_BOUND && run.end != RIC_CURVE_POINTS);
  double seconds = bench_seconds() - began;
  ric_family_destroy(&family);
  family_scenario_clear(s);
  free(z);
  return (work_done){.tasks = run.points + 1,
                     .n = n,
                     .failed = failed,
                     .seconds = seconds,
                     .measure = "jacobians_of_a_point",
                     .value = (double)run.jacobians / (double)(run.points + 1)};
}

/* The couplings of the performance table of [JAP], 15 of them, under Hertz's law. */
static work_done hertz(size_t stiffness, int multipliers) {
  family_scenario s;
  int failed = family_scenario_hertz(&s, 30, (double)stiffness, period, 0.187);
  s.options.multipliers = multipliers;
  s.options.curve.natural = true;
  s.options.curve.newton_tol = 1e-10;
  s.options.curve.step = s.options.curve.step_most = 0.187 / 14;
  s.options.curve.turn = 1;
  return walk(&s, failed, 30);
}

static work_done cubic(size_t points, int multipliers) {
  family_scenario s;
  int failed = family_scenario_two_masses(&s, 7.2, 5);
  s.options.multipliers = multipliers;
  s.options.curve.newton_tol = 1e-10; /* which the flow's errors, some times its tolerance, are to stay below */
  s.problem.motion.flow.tolerance = 1e-13;
  s.options.curve.points = points;
  s.options.curve.step = s.options.curve.step_most = 0.01;
  return walk(&s, failed, 2);
}

static work_done series(size_t n, int multipliers) {
  family_scenario s;
  int failed = family_scenario_series(&s, n, 0.98, 0.9);
  s.options.multipliers = multipliers;
  s.options.curve.newton_tol = 1e-10;
  s.problem.motion.flow.tolerance = 1e-13;
  s.options.curve.points = 200;
  s.options.curve.step = s.options.curve.step_most = 0.02;
  return walk(&s, failed, n);
}

static work_done chain(size_t n, int multipliers) {
  family_scenario s;
  int failed = family_scenario_impact(&s, n, period, 0.01, 0.18);
  s.options.multipliers = multipliers;
  s.options.curve.points = 50;
  s.options.curve.step = s.options.curve.step_most = 0.0034;
  return walk(&s, failed, n);
}

const benchmark family_benchmarks[] = {
    {"family_hertz", "15 orbits of 30 particles on Hertz floors, k = 100", 5, 100, 0, hertz},
    {"family_hertz_multipliers", "the same with multipliers", 3, 100, 1, hertz},
    {"family_cubic", "200 motions of two masses with a cubic spring and a wall", 11, 200, 0, cubic},
    {"family_cubic_multipliers", "the same with multipliers", 5, 200, 1, cubic},
    {"family_series", "200 motions of 20 masses with cubic springs and a wall, with multipliers", 3, 20, 1, series},
    {"family_chain", "50 orbits of 1000 impact oscillators", 1, 1000, 0, chain},
    {0}};

/* The scenarios. Each repeat starts from nothing: solver, plans and orbit are made anew, as a user's first call does.
 */
#include "bench.h"

#include <math.h>
#include <stdio.h>

#include "scenario/example1.h"
#include "scenario/scenario.h"

static ric_orbit_solver *solver_for(int method) {
  ric_orbit_options options = ric_orbit_options_default();
  ric_orbit_solver *solver = NULL;
  options.method = (ric_orbit_method)method;
  ric_orbit_solver_create(&options, &solver, NULL);
  return solver;
}

/* Orbits of one pattern over couplings and periods; `admissible` counts those. */
static size_t solve_grid(const scenario *s, ric_orbit_solver *solver, const double *gammas, size_t gamma_count,
                         const double *periods, size_t period_count) {
  ric_orbit orbit;
  size_t admissible = 0;
  ric_chain chain = s->chain;
  if (ric_orbit_init(&orbit, chain.particles, ric_pattern_impacts(s->pattern), NULL) != RIC_OK)
    return 0;
  for (size_t i = 0; i < period_count; i++)
    for (size_t j = 0; j < gamma_count; j++) {
      chain.gamma = gammas[j];
      if (ric_orbit_solve(solver, &chain, s->pattern, periods[i], &orbit, NULL) == RIC_OK)
        admissible += orbit.outcome == RIC_ADMISSIBLE;
    }
  ric_orbit_clear(&orbit);
  return admissible;
}

static work_done table(size_t argument, int method) {
  (void)argument;
  double gammas[EXAMPLE1_TABLE], period = example1_period();
  for (size_t row = 0; row < EXAMPLE1_TABLE; row++)
    gammas[row] = example1_gamma(row);
  ric_orbit_solver *solver = solver_for(method);
  scenario s = example1_at(0);
  size_t admissible = solver && s.pattern ? solve_grid(&s, solver, gammas, EXAMPLE1_TABLE, &period, 1) : 0;
  scenario_clear(&s);
  ric_orbit_solver_destroy(&solver);
  return (work_done){.tasks = EXAMPLE1_TABLE, .n = EXAMPLE1_PARTICLES, .failed = admissible != EXAMPLE1_TABLE};
}

/* The grid of data/studies/grid.yaml. */
static work_done grid(size_t side, int method) {
  double gammas[128], periods[128];
  for (size_t i = 0; i < side; i++) {
    gammas[i] = 0.6 * (double)i / (double)(side - 1);
    periods[i] = 3.2 + 3.0 * (double)i / (double)(side - 1);
  }
  ric_orbit_solver *solver = solver_for(method);
  scenario s = example1_at(0);
  size_t admissible = solver && s.pattern ? solve_grid(&s, solver, gammas, side, periods, side) : 0;
  scenario_clear(&s);
  ric_orbit_solver_destroy(&solver);
  return (work_done){.tasks = side * side, .n = EXAMPLE1_PARTICLES, .failed = admissible == 0};
}

static work_done large(size_t n, int ends) {
  ric_orbit_solver *solver = solver_for(RIC_METHOD_IMPULSE);
  scenario s = scenario_middle(n, (ric_ends)ends, 0.1, example1_period());
  size_t admissible = solver && s.pattern ? solve_grid(&s, solver, &s.chain.gamma, 1, &s.period, 1) : 0;
  scenario_clear(&s);
  ric_orbit_solver_destroy(&solver);
  return (work_done){.tasks = 1, .n = n, .failed = admissible != 1};
}

const benchmark benchmarks[] = {
    {"table", "the 15 orbits of the table of [JAP], impulse method", 101, 0, RIC_METHOD_IMPULSE, table},
    {"table_dense", "the same with the dense method", 11, 0, RIC_METHOD_DENSE, table},
    {"grid", "100 x 100 orbits over period and gamma", 5, 100, RIC_METHOD_IMPULSE, grid},
    {"ring_1000000", "one orbit of a ring", 5, 1000000, RIC_ENDS_PERIODIC, large},
    {"fixed_1000000", "one orbit with fixed ends", 5, 1000000, RIC_ENDS_FIXED, large},
    {"free_1000000", "one orbit with free ends", 5, 1000000, RIC_ENDS_FREE, large},
    {"ring_prime", "one orbit of a ring with a prime number of particles", 5, 100003, RIC_ENDS_PERIODIC, large},
    {"fixed_prime", "one orbit with fixed ends and a prime number of particles", 5, 100003, RIC_ENDS_FIXED, large},
    {"free_prime", "one orbit with free ends and a prime number of particles", 5, 100003, RIC_ENDS_FREE, large},
    {0}};

static double median_of_5(size_t n, int ends) {
  double t[5];
  for (int i = 0; i < 5; i++) {
    double began = bench_seconds();
    work_done done = large(n, ends);
    t[i] = done.failed ? NAN : bench_seconds() - began;
    for (int j = i; j > 0 && t[j] < t[j - 1]; j--) {
      double swap = t[j];
      t[j] = t[j - 1];
      t[j - 1] = swap;
    }
  }
  return t[2];
}

/* Least-squares slope of log(seconds) over log(n): 1 is linear; n log n gives 1.10 on this range. */
int bench_scaling(void) {
  static const char *const names[] = {"periodic", "fixed", "free"};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    int points = 0;
    for (size_t n = 1000; n <= 1000000; n *= 10, points++) {
      double x = log((double)n), y = log(median_of_5(n, ends));
      sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    double slope = (points * sxy - sx * sy) / (points * sxx - sx * sx);
    printf("{\"scenario\": \"scaling_%s\", \"exponent\": %.3f, \"from\": 1000, \"to\": 1000000, \"repeats\": 5}\n",
           names[ends], slope);
    if (!(slope < 2))
      return 1;
  }
  return 0;
}

/* Scenarios of multipliers. Each repeat starts from nothing and solves the orbits, too. */
#define _DEFAULT_SOURCE /* getrusage */
#include <sys/resource.h>

#include "bench.h"
#include "scenario/example1.h"
#include "scenario/scenario.h"

/* What a family of orbits needs. */
typedef struct family {
  scenario s;
  ric_orbit_solver *solver;
  ric_orbit orbit;
  ric_multipliers multipliers;
  int failed;
} family;

static family family_of(scenario s) {
  family f = {.s = s};
  f.failed = !s.pattern || ric_orbit_solver_create(NULL, &f.solver, NULL) != RIC_OK ||
             ric_orbit_init(&f.orbit, s.chain.particles, ric_pattern_impacts(s.pattern), NULL) != RIC_OK ||
             ric_multipliers_init(&f.multipliers, 2 * s.chain.particles, NULL) != RIC_OK;
  return f;
}

static void family_clear(family *f) {
  ric_multipliers_clear(&f->multipliers);
  ric_orbit_clear(&f->orbit);
  ric_orbit_solver_destroy(&f->solver);
  scenario_clear(&f->s);
}

/* Orbit and multipliers at a coupling. */
static void judge(family *f, double gamma, ric_multiplier_method method, ric_stability expected) {
  ric_orbit_multiplier_options options = ric_orbit_multiplier_options_default();
  options.method = method;
  f->s.chain.gamma = gamma;
  f->failed = f->failed ||
              ric_orbit_solve(f->solver, &f->s.chain, f->s.pattern, f->s.period, &f->orbit, NULL) != RIC_OK ||
              ric_orbit_multipliers(f->solver, &f->s.chain, f->s.pattern, &f->orbit, &options, &f->multipliers, NULL) !=
                  RIC_OK ||
              f->multipliers.stable != expected;
}

/* The 15 orbits of the table: stable up to gamma = 0.132. */
static work_done table(size_t argument, int method) {
  (void)argument;
  family f = family_of(example1_at(0));
  for (size_t row = 0; row < EXAMPLE1_TABLE; row++) {
    double gamma = example1_gamma(row);
    judge(&f, gamma, (ric_multiplier_method)method, gamma < 0.132 ? RIC_STABLE : RIC_UNSTABLE);
  }
  work_done done = {.tasks = EXAMPLE1_TABLE, .n = EXAMPLE1_PARTICLES, .failed = f.failed};
  family_clear(&f);
  return done;
}

static double peak_bytes(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * (double)usage.ru_maxrss;
}

/* Stability of a large ring with one impact, at a coupling of so many thousandths. */
static work_done verdict(size_t n, int thousandths) {
  double before = peak_bytes(), gamma = thousandths / 1000.0;
  family f = family_of(scenario_middle(n, RIC_ENDS_PERIODIC, gamma, example1_period()));
  judge(&f, gamma, RIC_MULTIPLIERS_DETERMINANT, gamma < 0.132 ? RIC_STABLE : RIC_UNSTABLE);
  work_done done = {.tasks = 1,
                    .n = n,
                    .failed = f.failed,
                    .measure = "bytes_of_a_particle",
                    .value = (peak_bytes() - before) / (double)n};
  family_clear(&f);
  return done;
}

const benchmark multiplier_benchmarks[] = {
    {"multipliers_table", "the 15 orbits of the table with all their multipliers", 101, 0, RIC_MULTIPLIERS_REDUCED,
     table},
    {"verdict_10000", "stability of a ring of 10 000, with the memory it takes", 1, 10000, 100, verdict},
    {"verdict_unstable", "the same of an unstable orbit", 1, 10000, 187, verdict},
    {"verdict_beyond", "the same beyond the first resonance, where modes of both signs overlap", 1, 10000, 230,
     verdict},
    {0}};

/* Benchmarks: scenarios timed over several repeats, one JSON line each. */
#ifndef RICOCHET_BENCH_H
#define RICOCHET_BENCH_H

#include <stddef.h>

/** What one repeat of a scenario did. */
typedef struct work_done {
  size_t tasks;        /* orbits, points of a curve */
  size_t n;            /* particles of each, unknowns */
  int failed;          /* something was not what the scenario promises */
  double seconds;      /* of the part that counts; 0: of all of it */
  const char *measure; /* name of a figure besides time, NULL: none */
  double value;
} work_done;

typedef struct benchmark {
  const char *name;
  const char *what;
  size_t repeats;
  size_t argument; /* handed to run */
  int variant;
  work_done (*run)(size_t argument, int variant);
} benchmark;

/** Lists that end with a NULL name: orbits, trajectories, multipliers, curves of solutions, families, flows, and
 * diagrams of maps, sections of motions. */
extern const benchmark benchmarks[], trajectory_benchmarks[], multiplier_benchmarks[], continuation_benchmarks[],
    family_benchmarks[], flow_benchmarks[], diagram_benchmarks[], section_benchmarks[];

/** Seconds on the monotonic clock. */
double bench_seconds(void);

/** Prints the growth of time with n from 1e3 to 1e6 for each kind of ends, as an exponent. */
int bench_scaling(void);

#endif

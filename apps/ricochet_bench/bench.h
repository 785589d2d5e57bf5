/* Benchmarks: scenarios timed over several repeats, one JSON line each. */
#ifndef RICOCHET_BENCH_H
#define RICOCHET_BENCH_H

#include <stddef.h>

/** What one repeat of a scenario did. */
typedef struct work_done {
  size_t tasks; /* orbits */
  size_t n;     /* particles of each */
  int failed;   /* an orbit was not what the scenario promises */
} work_done;

typedef struct benchmark {
  const char *name;
  const char *what;
  size_t repeats;
  size_t argument; /* handed to run */
  int variant;
  work_done (*run)(size_t argument, int variant);
} benchmark;

/** Ends with a NULL name. */
extern const benchmark benchmarks[];

/** Seconds on the monotonic clock. */
double bench_seconds(void);

/** Prints the growth of time with n from 1e3 to 1e6 for each kind of ends, as an exponent. */
int bench_scaling(void);

#endif

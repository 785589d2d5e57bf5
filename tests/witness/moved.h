/* Systems and flows for tests: made, run and destroyed in one line each. */
#ifndef RICOCHET_TESTS_MOVED_H
#define RICOCHET_TESTS_MOVED_H

#include <ricochet/ricochet.h>

typedef struct moved {
  ric_system *system;
  ric_flow *flow;
} moved;

/** A lattice with its flow; `options` may be NULL. */
moved moved_lattice(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count,
                    const ric_flow_options *options);
void moved_clear(moved *m);

void moved_start(const moved *m, double t, const double *q, const double *u);

/** Steps to time `end`; with `pieces`, every piece of every step is asked for on the way. */
void moved_run(const moved *m, double end, int pieces);

double moved_energy(const moved *m);

#endif

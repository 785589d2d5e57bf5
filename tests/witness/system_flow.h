/* A system with its flow, for tests: created, run and destroyed in one line each. */
#ifndef RICOCHET_TESTS_SYSTEM_FLOW_H
#define RICOCHET_TESTS_SYSTEM_FLOW_H

#include <ricochet/ricochet.h>

typedef struct system_flow {
  ric_system *system;
  ric_flow *flow;
} system_flow;

/** A lattice with its flow; `options` may be NULL. */
system_flow system_flow_of_lattice(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count,
                                   const ric_flow_options *options);
void system_flow_clear(system_flow *m);

void system_flow_start(const system_flow *m, double t, const double *q, const double *u);

/** Steps to time `end`; with `pieces`, every piece of every step is computed. */
void system_flow_run(const system_flow *m, double end, int pieces);

double system_flow_energy(const system_flow *m);

#endif

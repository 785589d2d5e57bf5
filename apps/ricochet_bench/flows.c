/* Scenarios of flows alone. */
#include "bench.h"

#include <ricochet/ricochet.h>

enum { HALF_PERIODS = 1000 /* of a repeat */ };

/* Two masses between walls, the spring between them cubic: an orbit that the second one's impacts make, from one of
 * them to the time of rest. */
static const double half_period = 3.25, start_q[2] = {0.709, 2}, start_u[2] = {0, -0.63};

static ric_system *two_masses(void) {
  const ric_spring links[3] = {{.linear = 3}, {.linear = 1, .cubic = 0.1}, {.linear = 0}};
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  ric_system *system = NULL;
  lattice.on_site = (ric_spring){0};
  lattice.links = links;
  ric_system_create_lattice(&lattice, NULL, 0, &system, NULL);
  return system;
}

/* Along half a period with the first columns of the identity. */
static int go(ric_flow *flow, size_t columns) {
  double d[16] = {0}, *dq = d, *du = d + 2 * columns;
  for (size_t k = 0; k < columns; k++)
    d[k * columns + k] = 1;
  if (ric_flow_start(flow, 0, start_q, start_u, NULL) != RIC_OK ||
      (columns > 0 && ric_flow_carry(flow, columns, dq, du, NULL) != RIC_OK))
    return 1;
  while (ric_flow_time(flow) != half_period) {
    if (ric_flow_step(flow, half_period, NULL) != RIC_OK)
      return 1;
    ric_flow_accept(flow, 1);
  }
  return 0;
}

/* Half periods with tangent vectors at a tolerance of 10^-digits. */
static work_done small(size_t columns, int digits) {
  ric_flow_options options = ric_flow_options_default();
  ric_flow *flow = NULL;
  ric_system *system = two_masses();
  double tolerance = 1;
  for (int i = 0; i < digits; i++)
    tolerance /= 10;
  options.tolerance = tolerance;
  int failed = !system || ric_flow_create(system, &options, &flow, NULL) != RIC_OK || go(flow, columns);
  double began = bench_seconds();
  for (int k = 0; k < HALF_PERIODS && !failed; k++)
    failed = go(flow, columns);
  double seconds = bench_seconds() - began;
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
  return (work_done){.tasks = HALF_PERIODS, .n = 2, .failed = failed, .seconds = seconds};
}

const benchmark flow_benchmarks[] = {
    {"orbit_small", "1000 half periods of two masses with a cubic spring between", 51, 0, 16, small},
    {"orbit_small_2", "the same with 2 tangent vectors", 51, 2, 16, small},
    {"orbit_small_4", "the same with 4 tangent vectors", 51, 4, 16, small},
    {"orbit_small_loose", "the same with 2 and a tolerance of 1e-13", 51, 2, 13, small},
    {0}};

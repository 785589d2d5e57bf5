#include "system_flow.h"

#include "support.h"

system_flow system_flow_of_lattice(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count,
                                   const ric_flow_options *options) {
  system_flow m = {0};
  assert_int_equal(ric_system_create_lattice(lattice, obstacles, count, &m.system, NULL), RIC_OK);
  assert_int_equal(ric_flow_create(m.system, options, &m.flow, NULL), RIC_OK);
  return m;
}

void system_flow_clear(system_flow *m) {
  ric_flow_destroy(&m->flow);
  ric_system_destroy(&m->system);
}

void system_flow_start(const system_flow *m, double t, const double *q, const double *u) {
  assert_int_equal(ric_flow_start(m->flow, t, q, u, NULL), RIC_OK);
}

void system_flow_run(const system_flow *m, double end, int pieces) {
  ric_error error = {0};
  while (ric_flow_time(m->flow) != end) {
    if (ric_flow_step(m->flow, end, &error) != RIC_OK)
      fail_msg("%s", error.message);
    for (size_t i = 0; pieces && i < ric_flow_pieces(m->flow); i++)
      ric_flow_piece(m->flow, i);
    ric_flow_accept(m->flow, 1);
  }
}

double system_flow_energy(const system_flow *m) {
  return ric_system_energy(m->system, ric_flow_time(m->flow), ric_flow_q(m->flow), ric_flow_u(m->flow));
}

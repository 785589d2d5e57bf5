#include "moved.h"

#include "support.h"

moved moved_lattice(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count,
                    const ric_flow_options *options) {
  moved m = {0};
  assert_int_equal(ric_system_create_lattice(lattice, obstacles, count, &m.system, NULL), RIC_OK);
  assert_int_equal(ric_flow_create(m.system, options, &m.flow, NULL), RIC_OK);
  return m;
}

void moved_clear(moved *m) {
  ric_flow_destroy(&m->flow);
  ric_system_destroy(&m->system);
}

void moved_start(const moved *m, double t, const double *q, const double *u) {
  assert_int_equal(ric_flow_start(m->flow, t, q, u, NULL), RIC_OK);
}

void moved_run(const moved *m, double end, int pieces) {
  ric_error error = {0};
  while (ric_flow_time(m->flow) != end) {
    if (ric_flow_step(m->flow, end, &error) != RIC_OK)
      fail_msg("%s", error.message);
    for (size_t i = 0; pieces && i < ric_flow_pieces(m->flow); i++)
      ric_flow_piece(m->flow, i);
    ric_flow_accept(m->flow, 1);
  }
}

double moved_energy(const moved *m) {
  return ric_system_energy(m->system, ric_flow_time(m->flow), ric_flow_q(m->flow), ric_flow_u(m->flow));
}

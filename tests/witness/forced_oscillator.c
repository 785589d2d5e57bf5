#include "forced_oscillator.h"

#include "support.h"

static ric_status set(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  forced_oscillator *o = user;
  o->force = p[0];
  o->lattice.frequency = p[1];
  *given = 6.283185307179586 / p[1];
  return ric_system_set_lattice(system, &o->lattice, error);
}

void forced_oscillator_init(forced_oscillator *o) {
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  wall.restitution = 0.8;
  *o = (forced_oscillator){.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .force = 1};
  o->lattice.on_site.damping = 0.1;
  o->lattice.force_cos = &o->force;
  o->lattice.frequency = 1;
  assert_int_equal(ric_system_create_lattice(&o->lattice, &wall, 1, &o->system, NULL), RIC_OK);
}

void forced_oscillator_clear(forced_oscillator *o) {
  ric_system_destroy(&o->system);
}

ric_family_problem forced_oscillator_problem(forced_oscillator *o, size_t impacts, size_t periods, double frequency) {
  static const size_t wall[4] = {0, 0, 0, 0};
  assert_true(impacts <= 4);
  return (ric_family_problem){
      .system = o->system,
      .motion = {.kind = RIC_MOTION_FORCED, .sequence = wall, .count = impacts, .flow = ric_flow_options_default()},
      .set = set,
      .user = o,
      .parameters = 2,
      .second = frequency,
      .periods = periods};
}

double forced_oscillator_grazing(double frequency) {
  return hypot(1 - frequency * frequency, 0.1 * frequency);
}

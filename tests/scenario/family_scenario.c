#include "family_scenario.h"

#include <math.h>
#include <stdlib.h>

static ric_status set_coupling(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  family_scenario *s = user;
  (void)given;
  s->lattice.link.linear = p[0];
  return ric_system_set_lattice(system, &s->lattice, error);
}

static int allocate(family_scenario *s, size_t n) {
  s->q = calloc(2 * n, sizeof *s->q);
  s->u = s->q ? s->q + n : NULL;
  s->options = ric_family_options_default();
  s->problem.motion.flow = ric_flow_options_default();
  s->problem.motion.kind = RIC_MOTION_EVEN;
  s->problem.parameters = 1;
  s->problem.user = s;
  return s->q ? 0 : -1;
}

/* A ring with a floor under every particle. */
static int ring(family_scenario *s, size_t n, double stiffness) {
  ric_obstacle *floors = calloc(n, sizeof *floors);
  *s = (family_scenario){.lattice = ric_lattice_default(n, RIC_ENDS_PERIODIC), .hit = n / 2};
  int failed = allocate(s, n) || !floors;
  for (size_t i = 0; i < n && !failed; i++) {
    floors[i] = ric_obstacle_floor(i, -1);
    floors[i].stiffness = stiffness;
  }
  failed = failed || ric_system_create_lattice(&s->lattice, floors, n, &s->system, NULL) != RIC_OK;
  free(floors);
  s->problem.system = s->system;
  s->problem.set = set_coupling;
  return failed ? -1 : 0;
}

static void set_range(family_scenario *s, double start, double end) {
  s->start = start;
  s->options.curve.p_low = fmin(start, end);
  s->options.curve.p_high = fmax(start, end);
  s->options.curve.direction = end - start;
}

int family_scenario_hertz(family_scenario *s, size_t n, double stiffness, double period, double most) {
  if (ring(s, n, stiffness))
    return -1;
  double v = fabs(tan(period / 2)); /* of the impact law, without coupling; all of it is pressed into the floor */
  s->q[s->hit] = -1 - pow(5 * v * v / (4 * stiffness), 0.4);
  s->problem.given = period;
  set_range(s, 0, most);
  return 0;
}

int family_scenario_impact(family_scenario *s, size_t n, double period, double least, double most) {
  if (ring(s, n, INFINITY))
    return -1;
  s->problem.motion.at_start = &s->hit;
  s->problem.motion.start_count = 1;
  s->problem.given = period;
  set_range(s, least, most);
  return 0;
}

int family_scenario_two_masses(family_scenario *s, double longest, double shortest) {
  static const ric_obstacle wall = {
      .coordinate = 1, .side = -1, .position = 2, .restitution = 1, .stiffness = INFINITY};
  *s = (family_scenario){.lattice = ric_lattice_default(2, RIC_ENDS_FIXED), .springs = {{3, 0, 0, 0}, {1, 0, 0.1, 0}}};
  if (allocate(s, 2))
    return -1;
  s->lattice.on_site = (ric_spring){0};
  s->lattice.links = s->springs;
  if (ric_system_create_lattice(&s->lattice, &wall, 1, &s->system, NULL) != RIC_OK)
    return -1;
  s->problem.system = s->system;
  s->problem.motion.at_start = &s->hit; /* obstacle 0 */
  s->problem.motion.start_count = 1;
  s->q[0] = 0.65;
  s->q[1] = 2;
  s->u[1] = -0.3;
  set_range(s, longest, shortest);
  return 0;
}

/* The orbit of the linear springs, in closed form. */
static ric_status guess_linear(family_scenario *s, double part, double *first_period) {
  ric_impact_modes *modes = NULL;
  ric_orbit orbit = {0};
  size_t n = s->lattice.particles;
  RIC_TRY(ric_impact_modes_create(s->system, 0, &modes, NULL));
  ric_status status = ric_orbit_init(&orbit, n, 1, NULL);
  *first_period = 2 * acos(-1) / ric_impact_modes_frequencies(modes)[0];
  if (status == RIC_OK)
    status = ric_impact_modes_orbit(modes, part * *first_period, &orbit, NULL);
  for (size_t i = 0; i < n && status == RIC_OK; i++) {
    s->q[i] = orbit.q[i];
    s->u[i] = orbit.v[i];
  }
  ric_orbit_clear(&orbit);
  ric_impact_modes_destroy(&modes);
  return status;
}

int family_scenario_series(family_scenario *s, size_t n, double from, double to) {
  const ric_obstacle wall = {.coordinate = n - 1, .side = -1, .position = 2, .restitution = 1, .stiffness = INFINITY};
  double period;
  *s = (family_scenario){.lattice = ric_lattice_default(n, RIC_ENDS_FIXED)};
  if (n > FAMILY_SCENARIO_MASSES || allocate(s, n))
    return -1;
  s->lattice.on_site = (ric_spring){0};
  s->lattice.links = s->springs;
  for (size_t i = 0; i < n; i++)
    s->springs[i] = (ric_spring){.linear = 1};
  if (ric_system_create_lattice(&s->lattice, &wall, 1, &s->system, NULL) != RIC_OK ||
      guess_linear(s, from, &period) != RIC_OK)
    return -1;
  for (size_t i = 0; i < n; i++)
    s->springs[i].cubic = 0.1;
  s->problem.system = s->system;
  s->problem.motion.at_start = &s->hit; /* obstacle 0 */
  s->problem.motion.start_count = 1;
  set_range(s, from * period, to * period);
  return ric_system_set_lattice(s->system, &s->lattice, NULL) == RIC_OK ? 0 : -1;
}

void family_scenario_clear(family_scenario *s) {
  ric_system_destroy(&s->system);
  free(s->q);
  *s = (family_scenario){0};
}

ric_status family_scenario_begin(const family_scenario *s, ric_family **family, double **z, ric_error *error) {
  *z = NULL;
  RIC_TRY(ric_family_create(&s->problem, &s->options, family, error));
  *z = calloc(ric_shooting_unknowns(ric_family_shooting(*family)), sizeof **z);
  if (!*z)
    return ric_fail(error, RIC_ENOMEM, "no memory for a motion");
  double period = s->problem.set ? s->problem.given : s->start;
  return ric_family_start(*family, s->start, s->q, s->u, NULL, period, *z, NULL, error);
}

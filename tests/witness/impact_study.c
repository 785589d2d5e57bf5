#include "impact_study.h"

#include "random_lattice.h"
#include "random_mck.h"
#include "support.h"

enum { MOST = 12, MOST_OBSTACLES = 4 };

static const double pi = 3.14159265358979323846;

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

impact_study impact_study_of(ric_system *system, const ric_obstacle *obstacles) {
  impact_study s = {
      .system = system, .n = ric_system_coordinates(system), .hit = obstacles[0].coordinate, .obstacle = obstacles[0]};
  ric_error error;
  check(ric_impact_modes_create(system, 0, &s.modes, &error), &error);
  check(ric_orbit_init(&s.orbit, s.n, 1, &error), &error);
  return s;
}

void impact_study_clear(impact_study *s) {
  ric_orbit_clear(&s->orbit);
  ric_impact_modes_destroy(&s->modes);
  ric_system_destroy(&s->system);
}

impact_study impact_study_two_masses(void) {
  const ric_spring none[2] = {{.linear = 0}, {.linear = 0}}, links[3] = {{.linear = 3}, {.linear = 1}, {.linear = 0}};
  const ric_obstacle wall = ric_obstacle_wall(1, 2);
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  ric_system *system;
  ric_error error;
  lattice.on_sites = none;
  lattice.links = links;
  check(ric_system_create_lattice(&lattice, &wall, 1, &system, &error), &error);
  return impact_study_of(system, &wall);
}

/* Obstacle 0 near, the others further away, no two at one coordinate and side. */
static size_t random_obstacles(random_source *source, size_t n, ric_obstacle *o) {
  size_t count = 1 + random_below(source, MOST_OBSTACLES), kept = 1;
  for (size_t j = 0; j < count; j++) {
    int side = random_below(source, 2) ? 1 : -1;
    double away = random_uniform(source, 0.5, 2) * (j > 0 ? 2.5 : 1);
    o[j] = side > 0 ? ric_obstacle_floor(random_below(source, n), -away)
                    : ric_obstacle_wall(random_below(source, n), away);
  }
  if (random_below(source, 5) == 0)
    o[0].position = -o[0].position / 4;
  for (size_t j = 1; j < count; j++)
    if (o[j].coordinate != o[0].coordinate)
      o[kept++] = o[j];
  return kept;
}

impact_study impact_study_random(random_source *source) {
  static random_lattice lattice;
  static random_mck mck;
  size_t n = 1 + random_below(source, MOST), kind = random_below(source, 5);
  ric_obstacle o[MOST_OBSTACLES];
  size_t count = random_obstacles(source, n, o);
  ric_system *system;
  ric_error error;
  random_lattice_set(&lattice, source, n, (ric_ends)(kind % 3), 0);
  random_mck_make(&mck, n, kind == 3, source);
  mck.model.damping.values = NULL;
  mck.model.force_cos = mck.model.force_sin = NULL;
  if (kind < 3)
    check(ric_system_create_lattice(&lattice.lattice, o, count, &system, &error), &error);
  else
    check(ric_system_create_mck(&mck.model, o, count, &system, &error), &error);
  return impact_study_of(system, o);
}

int impact_study_random_is_diagonal(const impact_study *s) {
  double q[MOST] = {0}, u[MOST] = {0}, energy = 0;
  for (size_t i = 0; i < s->n; i++) { /* kinetic energies add up when speeds do not couple */
    u[i] = 1;
    energy += ric_system_energy(s->system, 0, q, u);
    u[i] = 0;
  }
  for (size_t i = 0; i < s->n; i++)
    u[i] = 1;
  return fabs(ric_system_energy(s->system, 0, q, u) - energy) < 1e-12 * energy;
}

double impact_study_period(const impact_study *s, random_source *source) {
  return random_uniform(source, 0.2, 3) * 2 * pi / ric_impact_modes_frequencies(s->modes)[0];
}

void impact_study_solve(impact_study *s, double period) {
  ric_error error;
  check(ric_impact_modes_orbit(s->modes, period, &s->orbit, &error), &error);
}

double impact_study_scale(const impact_study *s) {
  double most = 0, fastest = ric_impact_modes_frequencies(s->modes)[s->n - 1];
  for (size_t i = 0; i < s->n; i++) {
    most = fmax(most, fmax(fabs(s->orbit.q[i]), fabs(s->orbit.q_half[i])));
    most = fmax(most, fabs(s->orbit.v[i]) / fastest);
  }
  return most;
}

double impact_study_agreement(const impact_study *s) {
  double detuning = impact_study_detuning(s, s->orbit.period);
  return 1e-12 * impact_study_scale(s) * fmax(1, s->orbit.condition / 10) * fmax(1, 1e-2 / detuning);
}

double impact_study_detuning(const impact_study *s, double period) {
  double nearest = 1;
  for (size_t j = 0; j < s->n; j++) {
    double turns = ric_impact_modes_frequencies(s->modes)[j] * period / (2 * pi);
    if (turns > 0.5)
      nearest = fmin(nearest, fabs(turns - round(turns)));
  }
  return nearest;
}

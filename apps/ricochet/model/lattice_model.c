#include "lattice_model.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "chain_model.h"

static bool is_duffing_chain(const study_values *v) {
  return strcmp(value_word(v, KEY_MODEL_TYPE), "duffing_chain") == 0;
}

static bool lists_springs(const study_values *v) {
  static const study_key keys[] = {KEY_MODEL_STIFFNESS, KEY_MODEL_QUADRATIC, KEY_MODEL_CUBIC, KEY_MODEL_DAMPING};
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    if (value_is_list(v, keys[i]))
      return true;
  return false;
}

int lattice_model_init(lattice_model *m, const study_values *v) {
  const size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  const bool masses = value_is_list(v, KEY_MODEL_MASS), springs = is_duffing_chain(v) || lists_springs(v);
  *m = (lattice_model){.lattice = ric_lattice_default(n, RIC_ENDS_PERIODIC)};
  m->force_cos = calloc(n, sizeof *m->force_cos);
  m->force_sin = calloc(n, sizeof *m->force_sin);
  m->obstacles = calloc(2 * n, sizeof *m->obstacles);
  if (masses)
    m->masses = calloc(n, sizeof *m->masses);
  if (springs)
    m->springs = calloc(n + 1, sizeof *m->springs);
  if (m->force_cos && m->force_sin && m->obstacles && (m->masses || !masses) && (m->springs || !springs))
    return 0;
  lattice_model_clear(m);
  return -1;
}

void lattice_model_clear(lattice_model *m) {
  free(m->masses);
  free(m->springs);
  free(m->force_cos);
  free(m->force_sin);
  free(m->obstacles);
  *m = (lattice_model){0};
}

/* The spring of a particle: of a chain its own, of a Duffing chain the one before it. */
static ric_spring spring_of(const study_values *v, size_t particle) {
  return (ric_spring){.linear = value_of_particle(v, KEY_MODEL_STIFFNESS, particle),
                      .quadratic = value_of_particle(v, KEY_MODEL_QUADRATIC, particle),
                      .cubic = value_of_particle(v, KEY_MODEL_CUBIC, particle),
                      .damping = value_of_particle(v, KEY_MODEL_DAMPING, particle)};
}

static ric_spring coupling(const study_values *v) {
  return (ric_spring){.linear = value_number(v, KEY_MODEL_GAMMA, 0),
                      .quadratic = value_number(v, KEY_MODEL_LINK_QUADRATIC, 0),
                      .cubic = value_number(v, KEY_MODEL_LINK_CUBIC, 0),
                      .damping = value_number(v, KEY_MODEL_LINK_DAMPING, 0)};
}

/* A Duffing chain is a lattice without on-site springs between two walls, from the second of which it is loose. */
static void read_springs(lattice_model *m, const study_values *v) {
  ric_lattice *lattice = &m->lattice;
  const bool in_series = is_duffing_chain(v);
  for (size_t i = 0; m->springs && i < lattice->particles; i++)
    m->springs[i] = spring_of(v, i);
  lattice->ends = in_series ? RIC_ENDS_FIXED : chain_model_ends(v);
  lattice->links = in_series ? m->springs : NULL;
  lattice->on_sites = in_series ? NULL : m->springs;
  lattice->on_site = in_series ? (ric_spring){0} : spring_of(v, 0);
  lattice->link = in_series ? (ric_spring){0} : coupling(v);
}

/* A cos(w t + phase) = A cos(phase) cos(w t) - A sin(phase) sin(w t); no force at all is cheaper than one of zeros. */
static void read_force(lattice_model *m, const study_values *v) {
  const double phase = value_number(v, KEY_MODEL_PHASE, 0);
  int any = 0;
  for (size_t i = 0; i < m->lattice.particles; i++) {
    const double amplitude = value_of_particle(v, KEY_MODEL_FORCE, i);
    m->force_cos[i] = amplitude * cos(phase);
    m->force_sin[i] = -amplitude * sin(phase);
    any = any || amplitude != 0;
  }
  m->lattice.frequency = value_number(v, KEY_MODEL_FREQUENCY, 0);
  m->lattice.force_cos = any ? m->force_cos : NULL;
  m->lattice.force_sin = any ? m->force_sin : NULL;
}

/* The obstacles of one side; null stands for none. */
static void add_obstacles(lattice_model *m, const study_values *v, study_key key, int side) {
  const double hertz = value_number(v, KEY_MODEL_HERTZ, 0);
  for (size_t i = 0; i < m->lattice.particles; i++) {
    const double position = value_of_particle(v, key, i);
    if (position > -INFINITY)
      m->obstacles[m->obstacle_count++] = (ric_obstacle){.coordinate = i,
                                                         .side = side,
                                                         .position = position,
                                                         .restitution = value_of_particle(v, KEY_MODEL_RESTITUTION, i),
                                                         .stiffness = hertz > 0 ? hertz : INFINITY};
  }
}

void lattice_model_read(lattice_model *m, const study_values *v) {
  if (!m->masses)
    m->lattice.mass = value_number(v, KEY_MODEL_MASS, 0);
  for (size_t i = 0; m->masses && i < m->lattice.particles; i++)
    m->masses[i] = value_number(v, KEY_MODEL_MASS, i);
  m->lattice.masses = m->masses;
  read_springs(m, v);
  read_force(m, v);
  m->obstacle_count = 0;
  add_obstacles(m, v, KEY_MODEL_FLOOR, +1);
  add_obstacles(m, v, KEY_MODEL_WALL, -1);
}

size_t lattice_model_obstacle(const lattice_model *m, size_t particle, int side) {
  for (size_t j = 0; j < m->obstacle_count; j++)
    if (m->obstacles[j].coordinate == particle && m->obstacles[j].side == side)
      return j;
  return SIZE_MAX;
}

ric_status lattice_model_hits(const lattice_model *m, const study_values *v, study_key key, size_t *hits,
                              ric_error *error) {
  for (size_t i = 0; i < value_count(v, key); i++) {
    const size_t particle = (size_t)value_number(v, key, i);
    hits[i] = lattice_model_obstacle(m, particle, +1);
    if (hits[i] == SIZE_MAX)
      hits[i] = lattice_model_obstacle(m, particle, -1);
    if (hits[i] == SIZE_MAX)
      return ric_fail(error, RIC_EINVAL, "particle %zu has no obstacle to hit", particle);
  }
  return RIC_OK;
}

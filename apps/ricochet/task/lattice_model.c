#include "lattice_model.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "chain_model.h"

int lattice_model_init(lattice_model *m, const study_values *v) {
  const size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  *m = (lattice_model){.lattice = ric_lattice_default(n, RIC_ENDS_PERIODIC)};
  m->force_cos = calloc(n, sizeof *m->force_cos);
  m->force_sin = calloc(n, sizeof *m->force_sin);
  m->obstacles = calloc(2 * n, sizeof *m->obstacles);
  if (value_is_list(v, KEY_MODEL_MASS))
    m->masses = calloc(n, sizeof *m->masses);
  if (m->force_cos && m->force_sin && m->obstacles && (m->masses || !value_is_list(v, KEY_MODEL_MASS)))
    return 0;
  lattice_model_clear(m);
  return -1;
}

void lattice_model_clear(lattice_model *m) {
  free(m->masses);
  free(m->force_cos);
  free(m->force_sin);
  free(m->obstacles);
  *m = (lattice_model){0};
}

double lattice_model_value(const study_values *v, study_key key, size_t particle) {
  return value_number(v, key, value_is_list(v, key) ? particle : 0);
}

static void read_springs(ric_lattice *lattice, const study_values *v) {
  lattice->on_site = (ric_spring){.linear = value_number(v, KEY_MODEL_STIFFNESS, 0),
                                  .quadratic = value_number(v, KEY_MODEL_QUADRATIC, 0),
                                  .cubic = value_number(v, KEY_MODEL_CUBIC, 0),
                                  .damping = value_number(v, KEY_MODEL_DAMPING, 0)};
  lattice->link = (ric_spring){.linear = value_number(v, KEY_MODEL_GAMMA, 0),
                               .quadratic = value_number(v, KEY_MODEL_LINK_QUADRATIC, 0),
                               .cubic = value_number(v, KEY_MODEL_LINK_CUBIC, 0),
                               .damping = value_number(v, KEY_MODEL_LINK_DAMPING, 0)};
}

/* A cos(w t + phase) = A cos(phase) cos(w t) - A sin(phase) sin(w t); no force at all is cheaper than one of zeros. */
static void read_force(lattice_model *m, const study_values *v) {
  const double phase = value_number(v, KEY_MODEL_PHASE, 0);
  int any = 0;
  for (size_t i = 0; i < m->lattice.particles; i++) {
    const double amplitude = lattice_model_value(v, KEY_MODEL_FORCE, i);
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
    const double position = lattice_model_value(v, key, i);
    if (position > -INFINITY)
      m->obstacles[m->obstacle_count++] =
          (ric_obstacle){.coordinate = i,
                         .side = side,
                         .position = position,
                         .restitution = lattice_model_value(v, KEY_MODEL_RESTITUTION, i),
                         .stiffness = hertz > 0 ? hertz : INFINITY};
  }
}

void lattice_model_read(lattice_model *m, const study_values *v) {
  m->lattice.ends = chain_model_ends(v);
  if (!m->masses)
    m->lattice.mass = value_number(v, KEY_MODEL_MASS, 0);
  for (size_t i = 0; m->masses && i < m->lattice.particles; i++)
    m->masses[i] = value_number(v, KEY_MODEL_MASS, i);
  m->lattice.masses = m->masses;
  read_springs(&m->lattice, v);
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

/* What chains and Duffing chains have in common: a lattice. */
#include "lattice_model.h"

#include <math.h>
#include <ricochet/elementary.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static bool lists_springs(const study_values *v) {
  static const study_key keys[] = {KEY_MODEL_STIFFNESS, KEY_MODEL_QUADRATIC, KEY_MODEL_CUBIC, KEY_MODEL_DAMPING};
  for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
    if (value_is_list(v, keys[i]))
      return true;
  return false;
}

int lattice_model_init(lattice_model *m, const study_values *v) {
  const size_t n = (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
  const bool masses = value_is_list(v, KEY_MODEL_MASS);
  const bool springs = model_of(study_values_of(v))->lists_springs || lists_springs(v);
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

ric_spring lattice_model_spring(const study_values *v, size_t particle) {
  return (ric_spring){.linear = value_of_particle(v, KEY_MODEL_STIFFNESS, particle),
                      .quadratic = value_of_particle(v, KEY_MODEL_QUADRATIC, particle),
                      .cubic = value_of_particle(v, KEY_MODEL_CUBIC, particle),
                      .damping = value_of_particle(v, KEY_MODEL_DAMPING, particle)};
}

/* A cos(w t + phase) = A cos(phase) cos(w t) - A sin(phase) sin(w t); no force at all is cheaper than one of zeros. */
static void read_force(lattice_model *m, const study_values *v) {
  const double phase = value_number(v, KEY_MODEL_PHASE, 0);
  int any = 0;
  for (size_t i = 0; i < m->lattice.particles; i++) {
    const double amplitude = value_of_particle(v, KEY_MODEL_FORCE, i);
    double sine, cosine;
    ric_sincos(phase, &sine, &cosine);
    m->force_cos[i] = amplitude * cosine;
    m->force_sin[i] = -amplitude * sine;
    any = any || amplitude != 0;
  }
  m->lattice.frequency = value_number(v, KEY_MODEL_FREQUENCY, 0);
  m->lattice.force_cos = any ? m->force_cos : NULL;
  m->lattice.force_sin = any ? m->force_sin : NULL;
}

/* The obstacles of one side; null means none. */
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
  for (size_t i = 0; m->springs && i < m->lattice.particles; i++)
    m->springs[i] = lattice_model_spring(v, i);
  model_of(study_values_of(v))->read_springs(m, v);
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

size_t lattice_model_hit(const lattice_model *m, size_t particle) {
  const size_t floor = lattice_model_obstacle(m, particle, +1);
  return floor != SIZE_MAX ? floor : lattice_model_obstacle(m, particle, -1);
}

ric_status lattice_model_hits(const lattice_model *m, const study_values *v, study_key key, size_t *hits,
                              ric_error *error) {
  for (size_t i = 0; i < value_count(v, key); i++) {
    const size_t particle = (size_t)value_number(v, key, i);
    hits[i] = lattice_model_hit(m, particle);
    if (hits[i] == SIZE_MAX)
      return ric_fail(error, RIC_EINVAL, "particle %zu has no obstacle to hit", particle);
  }
  return RIC_OK;
}

/* --- its keys --- */

size_t lattice_particles(const study *s) {
  return (size_t)study_number(s, KEY_MODEL_PARTICLES);
}

bool lattice_has_obstacle(const study *s, size_t particle) {
  static const study_key sides[] = {KEY_MODEL_FLOOR, KEY_MODEL_WALL};
  bool has = false;
  for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
    const typed_value *at = study_value(s, sides[i]);
    const long item = study_item(s, sides[i], particle);
    has = has || (item >= 0 && (size_t)item < at->count &&
                  (at->numbers[item] > -INFINITY || sweep_over(s, sides[i], at->list ? item : -1)));
  }
  return has;
}

static int refuse_particle(const study *s, const document *d, int node, const char *label, double particle,
                           message *why) {
  return document_refuse(d, node, why, "%s = %.0f is out of range, expected a particle from 0 to %zu", label, particle,
                         lattice_particles(s) - 1);
}

int lattice_check_particle(const study *s, const document *d, study_key key, size_t i, message *why) {
  char label[64];
  const double particle = study_value(s, key)->numbers[i];
  if (particle < (double)lattice_particles(s))
    return 0;
  snprintf(label, sizeof label, "%s[%zu]", key->path, i);
  return refuse_particle(s, d, typed_item_node(d, study_value(s, key), i), label, particle, why);
}

int lattice_check_swept_particles(const study *s, const document *d, study_key key, message *why) {
  char label[128];
  for (size_t i = 0; i < s->sweep_count; i++) {
    const sweep_entry *e = &s->sweeps[i];
    snprintf(label, sizeof label, "swept %s", e->view.name);
    for (size_t j = 0; e->view.key == key && j < e->view.points; j++)
      if (!(e->values[j] < (double)lattice_particles(s)))
        return refuse_particle(s, d, sweep_value_node(d, e, j), label, e->values[j], why);
  }
  return 0;
}

#include "modal_motion.h"

#include "support.h"

modal_motion modal_motion_create(const ric_chain *chain) {
  size_t n = chain->particles;
  modal_motion m = {.n = n, .shape = calloc(n * n + 3 * n, sizeof *m.shape)};
  assert_non_null(m.shape);
  m.omega = m.shape + n * n;
  m.position = m.omega + n;
  m.speed = m.position + n;
  for (size_t j = 0; j < n; j++) {
    m.omega[j] = ric_chain_frequency(chain, j);
    for (size_t i = 0; i < n; i++)
      m.shape[j * n + i] = ric_chain_mode_shape(chain, j, i);
  }
  return m;
}

void modal_motion_clear(modal_motion *m) {
  free(m->shape);
  *m = (modal_motion){0};
}

void modal_motion_set(modal_motion *m, const double *q, const double *v) {
  for (size_t j = 0; j < m->n; j++) {
    m->position[j] = m->speed[j] = 0;
    for (size_t i = 0; i < m->n; i++) {
      m->position[j] += m->shape[j * m->n + i] * q[i];
      m->speed[j] += m->shape[j * m->n + i] * v[i];
    }
  }
}

void modal_motion_state(modal_motion *m, double time, double *q, double *v) {
  for (size_t i = 0; i < m->n; i++)
    q[i] = 0;
  for (size_t i = 0; v && i < m->n; i++)
    v[i] = 0;
  for (size_t j = 0; j < m->n; j++) {
    double w = m->omega[j], c = cos(w * time), s = sin(w * time), *shape = m->shape + j * m->n;
    double x = m->position[j] * c + m->speed[j] / w * s, y = m->speed[j] * c - w * m->position[j] * s;
    for (size_t i = 0; i < m->n; i++)
      q[i] += shape[i] * x;
    for (size_t i = 0; v && i < m->n; i++)
      v[i] += shape[i] * y;
  }
}

double modal_motion_particle(const modal_motion *m, size_t particle, double time, double *speed) {
  double q = 0, v = 0;
  for (size_t j = 0; j < m->n; j++) {
    double w = m->omega[j], c = cos(w * time), s = sin(w * time), shape = m->shape[j * m->n + particle];
    q += shape * (m->position[j] * c + m->speed[j] / w * s);
    v += shape * (m->speed[j] * c - w * m->position[j] * s);
  }
  if (speed)
    *speed = v;
  return q;
}

double modal_motion_bound(const modal_motion *m, int power) {
  double sum = 0, fastest = 0;
  for (size_t j = 0; j < m->n; j++) {
    double amplitude = hypot(m->position[j], m->speed[j] / m->omega[j]);
    sum += amplitude * amplitude;
    fastest = fmax(fastest, m->omega[j]);
  }
  return sqrt(sum) * pow(fastest, power);
}

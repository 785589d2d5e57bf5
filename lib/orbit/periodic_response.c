#include "periodic_response.h"
#include "numeric/constants.h"

#include <math.h>
#include <string.h>

/* Term of S; infinite at a resonance. */
static double term(const ric_impact_modes *m, size_t j, double period) {
  double half = m->frequency[j] * period / 2;
  return m->seen[j] == 0 ? 0 : m->seen[j] * m->seen[j] * cos(half) / (2 * m->frequency[j] * sin(half));
}

double response_balance(const ric_impact_modes *modes, double period) {
  double sum = 0, size = 0;
  for (size_t j = 0; j < modes->n; j++) {
    double value = term(modes, j, period);
    sum += value;
    size += fabs(value);
  }
  return sum / size;
}

/* l where w_j T = 2 pi l, otherwise 0. */
static double harmonic_of(const ric_impact_modes *m, size_t j, double period, double tolerance) {
  double turns = m->frequency[j] * period / (2 * pi), l = round(turns);
  bool is = fabs(turns - l) <= tolerance || sin(m->frequency[j] * period / 2) == 0;
  return is ? l : 0;
}

static void find_resonance(const ric_impact_modes *m, double tolerance, periodic_response *r) {
  for (size_t j = 0; j < m->n; j++) {
    double l = harmonic_of(m, j, r->period, tolerance);
    bool moves = m->seen[j] != 0;
    if (l < 1 || (r->carried && !moves))
      continue;
    r->carried = moves;
    r->free = !moves;
    r->mode = j;
    r->harmonic = (unsigned)l;
  }
}

/* The limit: modes at resonance share the way to the obstacle as phi_j(k)^2 / w_j^2, the ratio of the poles of S. */
static void set_carried(ric_impact_modes *m, double tolerance, const periodic_response *r) {
  double reached = 0, position = m->obstacles[m->obstacle].position;
  for (size_t j = 0; j < m->n; j++) {
    bool is = m->seen[j] != 0 && harmonic_of(m, j, r->period, tolerance) >= 1;
    double share = is ? m->seen[j] / (m->frequency[j] * m->frequency[j]) : 0;
    reached += share * m->seen[j];
    m->amplitude[j] = share;
  }
  for (size_t j = 0; j < m->n; j++)
    m->amplitude[j] *= position / reached * copysign(1, cos(m->frequency[j] * r->period / 2));
}

static void set_driven(ric_impact_modes *m, periodic_response *r) {
  double sum = 0;
  for (size_t j = 0; j < m->n; j++)
    sum += term(m, j, r->period);
  r->impulse = m->obstacles[m->obstacle].position / sum;
  for (size_t j = 0; j < m->n; j++)
    m->amplitude[j] =
        m->seen[j] == 0 ? 0 : r->impulse * m->seen[j] / (2 * m->frequency[j] * sin(m->frequency[j] * r->period / 2));
}

void response_find(ric_impact_modes *modes, double period, double resonance_tol, periodic_response *response) {
  size_t n = modes->n;
  double most = 0;
  *response = (periodic_response){.period = period};
  find_resonance(modes, resonance_tol, response);
  if (response->carried)
    set_carried(modes, resonance_tol, response);
  else
    set_driven(modes, response);
  memset(modes->reach, 0, n * sizeof *modes->reach);
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; modes->amplitude[j] != 0 && i < n; i++)
      modes->reach[i] += fabs(modes->amplitude[j] * modes->shape[j * n + i]);
  for (size_t i = 0; i < n; i++)
    most = modes->reach[i] <= most ? most : modes->reach[i]; /* keeps a NaN */
  response->condition = most / fabs(modes->obstacles[modes->obstacle].position);
}

void response_state(const ric_impact_modes *modes, const periodic_response *response, double t, double *q, double *v) {
  size_t n = modes->n;
  memset(q, 0, n * sizeof *q);
  if (v)
    memset(v, 0, n * sizeof *v);
  for (size_t j = 0; j < n; j++) {
    double phase = modes->frequency[j] * (response->period / 2 - t);
    double along = modes->amplitude[j] * cos(phase), rate = modes->amplitude[j] * modes->frequency[j] * sin(phase);
    for (size_t i = 0; modes->amplitude[j] != 0 && i < n; i++) {
      q[i] += along * modes->shape[j * n + i];
      if (v)
        v[i] += rate * modes->shape[j * n + i];
    }
  }
}

double response_gap_rate(const ric_impact_modes *modes, const periodic_response *response) {
  return modes->obstacles[modes->obstacle].side * response->impulse * modes->mobility[modes->hit] / 2;
}

double response_energy(const ric_impact_modes *modes) {
  double twice = 0;
  for (size_t j = 0; j < modes->n; j++) {
    double rate = modes->amplitude[j] * modes->frequency[j];
    twice += rate * rate;
  }
  return twice / 2;
}

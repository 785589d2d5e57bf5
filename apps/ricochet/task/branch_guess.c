#include "branch_guess.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chain_model.h"

static const double pi = 3.14159265358979323846;

int branch_guess_init(branch_guess *g, size_t particles) {
  *g = (branch_guess){.q = calloc(particles, sizeof *g->q), .v = calloc(particles, sizeof *g->v)};
  return g->q && g->v ? 0 : -1;
}

void branch_guess_clear(branch_guess *g) {
  free(g->q);
  free(g->v);
  *g = (branch_guess){0};
}

static size_t particles_of(const study_values *v) {
  return (size_t)value_number(v, KEY_MODEL_PARTICLES, 0);
}

/* Frequency of a particle alone without its nonlinear terms; 1 where it has none. */
static double frequency_alone(const study_values *v) {
  const double square = value_number(v, KEY_MODEL_STIFFNESS, 0) / lattice_model_value(v, KEY_MODEL_MASS, 0);
  return square > 0 ? sqrt(square) : 1;
}

static void take_state(branch_guess *g, const study_values *v) {
  for (size_t i = 0; i < particles_of(v); i++) {
    g->q[i] = lattice_model_value(v, KEY_START_Q, i);
    g->v[i] = lattice_model_value(v, KEY_START_V, i);
  }
}

/* q'' + w^2 q + c q^3 = 0 has the frequency w (1 + 3/8 c a^2 / w^2) at small amplitudes a. */
static ric_status excite(branch_guess *g, const study_values *v, ric_error *error) {
  const double w = frequency_alone(v), cubic = value_number(v, KEY_MODEL_CUBIC, 0) / (w * w);
  const double square = 8.0 / 3 * (1 - w * g->period / (2 * pi)) / cubic;
  if (!(square > 0 && square < INFINITY))
    return ric_fail(error, RIC_EINVAL,
                    "a particle alone has the period %.6g at no amplitude (model.cubic = %g; linear: %.6g)", g->period,
                    value_number(v, KEY_MODEL_CUBIC, 0), 2 * pi / w);
  for (size_t i = 0; i < value_count(v, KEY_ORBIT_EXCITED); i++)
    g->q[(size_t)value_number(v, KEY_ORBIT_EXCITED, i)] = sqrt(square);
  return RIC_OK;
}

/* Depth at which the work of Hertz's force, 2/5 k d^(5/2), has taken the kinetic energy v^2 / 2. */
static double depth(double speed, double stiffness) {
  return pow(5 * speed * speed / (4 * stiffness), 0.4);
}

/* Particles that press a Hertz floor at t = 0 turn around there. */
static void press(branch_guess *g, const study_values *v) {
  const double hertz = value_number(v, KEY_MODEL_HERTZ, 0);
  for (size_t k = 0; hertz > 0 && k < value_count(v, KEY_ORBIT_AT_START); k++) {
    const size_t i = (size_t)value_number(v, KEY_ORBIT_AT_START, k);
    g->q[i] =
        lattice_model_value(v, KEY_MODEL_FLOOR, i) - depth(g->v[i], hertz / lattice_model_value(v, KEY_MODEL_MASS, i));
    g->v[i] = 0;
  }
}

static ric_status solve_chain(const chain_model *m, const study_values *v, double period, ric_poll poll,
                              ric_orbit *orbit, ric_error *error) {
  ric_orbit_options options = ric_orbit_options_default();
  ric_orbit_solver *solver = NULL;
  ric_pattern *pattern = NULL;
  options.poll = poll;
  ric_status status = chain_model_pattern(v, &pattern, error);
  if (status == RIC_OK)
    status = ric_orbit_init(orbit, m->chain.particles, ric_pattern_impacts(pattern), error);
  if (status == RIC_OK)
    status = ric_orbit_solver_create(&options, &solver, error);
  if (status == RIC_OK)
    status = ric_orbit_solve(solver, &m->chain, pattern, period, orbit, error);
  if (status == RIC_OK && !isfinite(orbit->q[0]))
    status = ric_fail(error, RIC_EINVAL, "no first guess: the linear chain has no such orbit: %.150s", orbit->reason);
  ric_orbit_solver_destroy(&solver);
  ric_pattern_destroy(&pattern);
  return status;
}

/* The orbit of the linear chain, in units of time in which a particle alone has the frequency 1. */
static ric_status take_orbit(branch_guess *g, const study_values *v, ric_poll poll, ric_error *error) {
  const size_t n = particles_of(v);
  const double w = frequency_alone(v);
  chain_model chain;
  ric_orbit orbit = {0};
  if (chain_model_init(&chain, v) != 0)
    return ric_fail(error, RIC_ENOMEM, "no memory for the floors");
  chain.chain.gamma /= lattice_model_value(v, KEY_MODEL_MASS, 0) * w * w;
  ric_status status = solve_chain(&chain, v, w * g->period, poll, &orbit, error);
  for (size_t i = 0; i < n && status == RIC_OK; i++) {
    g->q[i] = orbit.q[i];
    g->v[i] = w * orbit.v[i];
  }
  if (status == RIC_OK)
    press(g, v);
  ric_orbit_clear(&orbit);
  chain_model_clear(&chain);
  return status;
}

ric_status branch_guess_find(branch_guess *g, const study_values *v, bool from_state, ric_poll poll, ric_error *error) {
  g->period = branch_family_period(v);
  memset(g->q, 0, particles_of(v) * sizeof *g->q);
  memset(g->v, 0, particles_of(v) * sizeof *g->v);
  if (from_state)
    take_state(g, v);
  else if (value_count(v, KEY_ORBIT_EXCITED) > 0)
    return excite(g, v, error);
  else if (value_count(v, KEY_ORBIT_AT_START) + value_count(v, KEY_ORBIT_AT_HALF) > 0)
    return take_orbit(g, v, poll, error);
  return RIC_OK;
}

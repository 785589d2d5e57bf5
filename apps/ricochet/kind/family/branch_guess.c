#include "branch_guess.h"
#include "kind/keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "even_start.h"
#include "mode_touch.h"

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
static double frequency_alone(const study_values *v, size_t particle) {
  const double square =
      value_of_particle(v, KEY_MODEL_STIFFNESS, particle) / value_of_particle(v, KEY_MODEL_MASS, particle);
  return square > 0 ? sqrt(square) : 1;
}

static void take_state(branch_guess *g, const study_values *v) {
  for (size_t i = 0; i < particles_of(v); i++) {
    g->q[i] = value_of_particle(v, KEY_START_Q, i);
    g->v[i] = value_of_particle(v, KEY_START_V, i);
  }
}

/* q'' + w^2 q + c q^3 = 0 has the frequency w (1 + 3/8 c a^2 / w^2) at small amplitudes a. */
static ric_status swing(const study_values *v, double period, size_t particle, double *amplitude, ric_error *error) {
  const double w = frequency_alone(v, particle), cubic = value_of_particle(v, KEY_MODEL_CUBIC, particle);
  const double square = 8.0 / 3 * (1 - w * period / (2 * pi)) * (w * w) / cubic;
  if (!(square > 0 && square < INFINITY))
    return ric_fail(error, RIC_EINVAL,
                    "a particle alone has the period %.6g at no amplitude (model.cubic = %g; linear: %.6g)", period,
                    cubic, 2 * pi / w);
  *amplitude = sqrt(square);
  return RIC_OK;
}

static ric_status excite(branch_guess *g, const study_values *v, ric_error *error) {
  for (size_t k = 0; k < value_count(v, KEY_ORBIT_EXCITED); k++) {
    const size_t i = (size_t)value_number(v, KEY_ORBIT_EXCITED, k);
    RIC_TRY(swing(v, g->period, i, &g->q[i], error));
  }
  return RIC_OK;
}

/* --- normal modes --- */

/* At rest at its turning point: w^2 a^2 / 2 is the energy of a mode with the amplitude a in normal coordinates. */
static ric_status take_mode(branch_guess *g, const branch_family *b, ric_error *error) {
  const size_t n = particles_of(b->values), mode = (size_t)value_number(b->values, KEY_ORBIT_MODE, 0);
  const double energy = value_number(b->values, KEY_ORBIT_ENERGY, 0);
  double *frequency = calloc(n, sizeof *frequency), *shape = calloc(n * n, sizeof *shape);
  ric_status status = frequency && shape ? ric_normal_modes(b->system, frequency, shape, error)
                                         : ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu particles", n);
  const double w = status == RIC_OK ? frequency[mode] : 0;
  if (status == RIC_OK && !(energy > 0 && w > 0))
    status = ric_fail(error, RIC_EINVAL,
                      "no first guess: mode %zu has the frequency %g, and no motion of the energy %g", mode, w, energy);
  for (size_t i = 0; i < n && status == RIC_OK; i++)
    g->q[i] = sqrt(2 * energy) / w * shape[mode * n + i];
  if (status == RIC_OK)
    g->period = 2 * pi / w;
  free(frequency);
  free(shape);
  return status;
}

/* --- motions with impacts at t = 0 and T/2 --- */

/* Depth at which the work of Hertz's force, 2/5 k d^(5/2), has taken the kinetic energy v^2 / 2. */
static double depth(double speed, double stiffness) {
  return pow(5 * speed * speed / (4 * stiffness), 0.4);
}

/* Particles that press a Hertz contact at t = 0 turn around there. */
static void press(branch_guess *g, const branch_family *b, const ric_shooting_problem *motion) {
  const double hertz = value_number(b->values, KEY_MODEL_HERTZ, 0);
  for (size_t k = 0; hertz > 0 && k < motion->start_count; k++) {
    const ric_obstacle *o = &b->model.obstacles[motion->at_start[k]];
    const size_t i = o->coordinate;
    g->q[i] = o->position - o->side * depth(g->v[i], hertz / value_of_particle(b->values, KEY_MODEL_MASS, i));
    g->v[i] = 0;
  }
}

/* The first state of an even motion: positions, but speeds of coordinates that are hit at t = 0. */
static void take_unknowns(branch_guess *g, const branch_family *b, const ric_shooting_problem *motion,
                          const double *z) {
  memcpy(g->q, z, particles_of(b->values) * sizeof *z);
  for (size_t k = 0; k < motion->start_count; k++) {
    const ric_obstacle *o = &b->model.obstacles[motion->at_start[k]];
    g->q[o->coordinate] = o->position;
    g->v[o->coordinate] = z[o->coordinate];
  }
}

static ric_status take_orbit(branch_guess *g, const branch_family *b, ric_error *error) {
  ric_shooting_problem motion = branch_family_motion(b, true);
  even_start e;
  const bool all = motion.count == 0;
  motion.count = 0; /* impacts in between have times of their own, which are no linear unknowns */
  ric_status status = even_start_begin(&e, &b->model, &motion, g->period, error);
  if (status == RIC_OK && all)
    status = even_start_continue(&e, error);
  if (status == RIC_OK) {
    take_unknowns(g, b, &motion, e.z);
    press(g, b, &motion);
  }
  even_start_clear(&e);
  return status;
}

/* A mode that touches the obstacle. */
static ric_status take_touch(branch_guess *g, const branch_family *b, ric_error *error) {
  const size_t n = particles_of(b->values);
  const ric_shooting_problem motion = branch_family_motion(b, true);
  mode_touch touch = {.mode = (size_t)value_number(b->values, KEY_ORBIT_MODE, 0),
                      .swings = (size_t)value_number(b->values, KEY_ORBIT_SWINGS, 0),
                      .z = calloc(n, sizeof *touch.z)};
  const ric_status status = touch.z ? mode_touch_find(&touch, &b->model, &motion, error)
                                    : ric_fail(error, RIC_ENOMEM, "no memory for a motion of %zu particles", n);
  if (status == RIC_OK) {
    take_unknowns(g, b, &motion, touch.z);
    g->period = touch.period;
    g->rise = touch.rise;
  }
  free(touch.z);
  return status;
}

/* --- */

ric_status branch_guess_find(branch_guess *g, const branch_family *b, bool from_state, ric_error *error) {
  const study_values *v = b->values;
  g->period = branch_family_period(v);
  g->rise = 0;
  memset(g->q, 0, particles_of(v) * sizeof *g->q);
  memset(g->v, 0, particles_of(v) * sizeof *g->v);
  if (from_state)
    take_state(g, v);
  else if (value_count(v, KEY_ORBIT_EXCITED) > 0)
    return excite(g, v, error);
  else if (value_number(v, KEY_ORBIT_MODE, 0) > -INFINITY)
    return value_count(v, KEY_ORBIT_AT_START) > 0 ? take_touch(g, b, error) : take_mode(g, b, error);
  else if (value_count(v, KEY_ORBIT_AT_START) + value_count(v, KEY_ORBIT_AT_HALF) > 0)
    return take_orbit(g, b, error);
  return RIC_OK;
}

/* Takes the solution of the equations at the period. */
static ric_status take_solution(branch_guess *g, const branch_family *b, const double *z, double *energy,
                                ric_error *error) {
  const size_t n = particles_of(b->values);
  ric_orbit orbit = {0};
  ric_status status = ric_orbit_init_for(&orbit, b->system, ric_shooting_impacts(b->first), error);
  if (status == RIC_OK)
    status = ric_shooting_orbit(b->first, z, g->period, &orbit, error);
  if (status == RIC_OK) {
    memcpy(g->q, orbit.q, n * sizeof *g->q);
    memcpy(g->v, orbit.v, n * sizeof *g->v);
    *energy = orbit.energy;
  }
  ric_orbit_clear(&orbit);
  return status;
}

ric_status branch_guess_settle(branch_guess *g, const branch_family *b, double *energy, ric_error *error) {
  double *z = calloc(ric_shooting_unknowns(b->first), sizeof *z);
  ric_status status = z ? ric_shooting_guess(b->first, g->q, g->v, b->times, g->period, z, error)
                        : ric_fail(error, RIC_ENOMEM, "no memory for the motion at the start");
  if (status == RIC_OK)
    status = ric_shooting_solve(b->first, z, g->period, 0, NULL, error);
  if (status == RIC_OK)
    status = take_solution(g, b, z, energy, error);
  free(z);
  return status;
}

ric_status branch_guess_solve(const branch_guess *g, const branch_family *b, double *z, double *parameter,
                              int *iterations, ric_error *error) {
  *parameter = branch_family_parameter(b, value_number(b->values, KEY_BRANCH_FROM, 0));
  return ric_family_start(b->family, *parameter, g->q, g->v, b->times, g->period, z, iterations, error);
}

#include "ricochet/impact_modes.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "impact_response.h"
#include "model/normal_modes.h"
#include "numeric/constants.h"
#include "numeric/number_block.h"
#include "ricochet/normal_modes.h"
#include "verdict.h"

/* Squares of frequencies nearer than this to each other, relative to the largest, are those of one space of modes: ten
 * times and more what rounding makes of equal ones, also with a mass matrix. Slow modes of stiff systems would be
 * far apart then: they must be nearer than slow_tol relative to themselves, or than rounding. */
static const double same_tol = 1e-12, slow_tol = 1e-9;
/* Shares of M^-1_kk (their roots) below it are rounding of modes that do not move k. */
static const double hidden_tol = 1e-11;

/* An obstacle in the same place is touched by every orbit: rounding would decide whether it is passed. */
static ric_status check_others(const ric_system *system, size_t obstacle, ric_error *error) {
  const ric_obstacle *hit = &system->obstacles[obstacle];
  for (size_t j = 0; j < system->obstacle_count; j++) {
    const ric_obstacle *o = &system->obstacles[j];
    if (j != obstacle && o->coordinate == hit->coordinate && o->side == hit->side && o->position == hit->position)
      return ric_fail(
          error, RIC_EINVAL,
          "obstacle %zu: position = %g, coordinate and side are those of obstacle %zu, expected another place", j,
          o->position, obstacle);
  }
  return RIC_OK;
}

static ric_status check_obstacle(const ric_system *system, size_t obstacle, ric_error *error) {
  if (obstacle >= system->obstacle_count)
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected less than %zu", obstacle, system->obstacle_count);
  const ric_obstacle *o = &system->obstacles[obstacle];
  if (isfinite(o->stiffness))
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: stiffness = %g, expected a rigid one", obstacle, o->stiffness);
  if (o->restitution != 1)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: restitution = %g, expected 1", obstacle, o->restitution);
  if (o->position == 0)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu: position = 0, expected it away from the state of rest", obstacle);
  return check_others(system, obstacle, error);
}

static ric_status allocate_modes(ric_impact_modes *m, ric_error *error) {
  size_t n = m->n, vectors = n + 12 + MODES_ORDER;
  if (n < SIZE_MAX / sizeof(double) / vectors)
    m->block = calloc(n * vectors, sizeof *m->block);
  m->obstacles = malloc(m->obstacle_count * sizeof *m->obstacles);
  if (!m->block || !m->obstacles)
    return ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu coordinates", n);
  double *store = m->block;
  m->shape = number_store_take(&store, n * n);
  m->frequency = number_store_take(&store, n);
  m->seen = number_store_take(&store, n);
  m->mobility = number_store_take(&store, n);
  m->amplitude = number_store_take(&store, n);
  m->reach = number_store_take(&store, n);
  m->q = number_store_take(&store, n);
  m->v = number_store_take(&store, n);
  m->cosine = number_store_take(&store, n);
  m->sine = number_store_take(&store, n);
  m->even = number_store_take(&store, n);
  m->odd = number_store_take(&store, n);
  m->series = number_store_take(&store, (MODES_ORDER + 1) * n);
  return RIC_OK;
}

static bool are_one(const ric_impact_modes *m, double slower, double faster) {
  double below = slower / m->fastest, above = faster / m->fastest; /* whose squares do not underflow */
  double rounding = 8 * DBL_EPSILON * (double)m->n;                /* as in normal_modes.c */
  return above * above - below * below <= fmax(rounding, fmin(same_tol, slow_tol * above * above));
}

/* Number of modes from `first` on that belong to one frequency. */
static size_t multiplicity(const ric_impact_modes *m, size_t first) {
  size_t count = 1;
  const double *w = m->frequency + first;
  while (first + count < m->n && are_one(m, w[count - 1], w[count]))
    count++;
  return count;
}

/* A mode of a frequency that several have may be any of a space. Those are chosen of which only the first moves k: a
 * reflection takes the shapes' components at k, in s, to the first of them. */
static void gather(ric_impact_modes *m, size_t first, size_t count) {
  size_t n = m->n;
  double *shape = m->shape + first * n, *s = m->q, length = 0, mean = 0;
  for (size_t a = 0; a < count; a++) {
    s[a] = shape[a * n + m->hit];
    length = hypot(length, s[a]);
    mean += m->frequency[first + a] / (double)count;
  }
  for (size_t a = 0; a < count; a++)
    m->frequency[first + a] = mean;
  if (!(length > 0))
    return;
  s[0] += copysign(length, s[0]);
  double square = 2 * length * fabs(s[0]); /* of s now, which is the reflection's axis */
  for (size_t i = 0; i < n; i++) {
    double along = 0;
    for (size_t a = 0; a < count; a++)
      along += s[a] * shape[a * n + i];
    for (size_t a = 0; a < count; a++)
      shape[a * n + i] -= 2 * along / square * s[a];
  }
  for (size_t a = 1; a < count; a++)
    shape[a * n + m->hit] = 0;
}

/* Which modes move k, and M^-1 e_k = sum_j phi_j phi_j(k). */
static void look_at_modes(ric_impact_modes *m) {
  size_t n = m->n, count;
  m->fastest = m->frequency[n - 1];
  for (size_t j = 0; j < n; j += count) {
    count = multiplicity(m, j);
    if (count > 1)
      gather(m, j, count);
  }
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      m->mobility[i] += m->shape[j * n + i] * m->shape[j * n + m->hit];
  for (size_t j = 0; j < n; j++) {
    double phi = m->shape[j * n + m->hit];
    m->seen[j] = fabs(phi) > hidden_tol * sqrt(m->mobility[m->hit]) ? phi : 0;
  }
}

static ric_status build(ric_impact_modes *m, const ric_system *system, ric_error *error) {
  RIC_TRY(allocate_modes(m, error));
  memcpy(m->obstacles, system->obstacles, m->obstacle_count * sizeof *m->obstacles);
  RIC_TRY(ric_normal_modes(system, m->frequency, m->shape, error));
  if (!(m->frequency[0] > 0))
    return ric_fail(error, RIC_EINVAL, "frequency of the slowest mode = %g, expected > 0: the stiffness is singular",
                    m->frequency[0]);
  look_at_modes(m);
  return RIC_OK;
}

ric_status ric_impact_modes_create(const ric_system *system, size_t obstacle, ric_impact_modes **modes,
                                   ric_error *error) {
  *modes = NULL;
  RIC_TRY(linear_part_is_all(system, error));
  RIC_TRY(check_obstacle(system, obstacle, error));
  ric_impact_modes *m = calloc(1, sizeof *m);
  if (!m)
    return ric_fail(error, RIC_ENOMEM, "no memory for impact modes");
  m->n = system->coordinates;
  m->obstacle_count = system->obstacle_count;
  m->obstacle = obstacle;
  m->hit = system->obstacles[obstacle].coordinate;
  m->options = ric_orbit_options_default();
  ric_status status = build(m, system, error);
  if (status == RIC_OK)
    *modes = m;
  else
    ric_impact_modes_destroy(&m);
  return status;
}

void ric_impact_modes_destroy(ric_impact_modes **modes) {
  if (!modes || !*modes)
    return;
  free((*modes)->block);
  free((*modes)->obstacles);
  free(*modes);
  *modes = NULL;
}

const double *ric_impact_modes_frequencies(const ric_impact_modes *modes) {
  return modes->frequency;
}

const double *ric_impact_modes_shape(const ric_impact_modes *modes, size_t mode) {
  return mode < modes->n ? modes->shape + mode * modes->n : NULL;
}

static ric_status check_period(const ric_impact_modes *m, double period, ric_error *error) {
  if (!(period > 0 && period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected a finite number > 0", period);
  double harmonics = m->fastest * period / (2 * pi);
  if (!(harmonics <= RIC_MOST_HARMONICS))
    return ric_fail(error, RIC_ELIMIT, "%.3g oscillations per period, expected at most %.3g", harmonics,
                    (double)RIC_MOST_HARMONICS);
  return RIC_OK;
}

/* --- the orbit of a period ---------------------------------------------------------------------------------------- */

static void fill_clearance(const ric_impact_modes *m, const least_gap *free, ric_orbit *orbit) {
  bool any = free->value < INFINITY;
  orbit->clearance = any ? free->value : NAN;
  orbit->clearance_time = free->time;
  orbit->clearance_particle = any ? (long long)m->obstacles[free->obstacle].coordinate : -1;
}

static void fill(const ric_impact_modes *m, const periodic_response *r, const impact_verdict *v, ric_orbit *orbit) {
  size_t bytes = m->n * sizeof *m->q;
  const ric_obstacle *hit = &m->obstacles[m->obstacle];
  memcpy(orbit->q, m->q, bytes);
  memcpy(orbit->v, m->v, bytes);
  response_state(m, r, r->period / 2, orbit->q_half, orbit->v_half);
  orbit->impulse[0] = r->carried ? 0 : hit->side * r->impulse; /* no -0 */
  orbit->gap_rate[0] = r->carried ? 0 : -response_gap_rate(m, r);
  orbit->energy = response_energy(m);
  orbit->residual = fabs(m->q[m->hit] - hit->position);
  fill_clearance(m, &v->free, orbit);
}

static ric_status check_room(const ric_impact_modes *m, const ric_orbit *orbit, ric_error *error) {
  if (orbit->particles == m->n && orbit->speeds == m->n && orbit->impacts == 1)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "orbit with room for %zu coordinates and %zu impacts, expected %zu and 1",
                  orbit->particles, orbit->impacts, m->n);
}

ric_status ric_impact_modes_orbit(ric_impact_modes *modes, double period, ric_orbit *orbit, ric_error *error) {
  periodic_response response;
  impact_verdict verdict;
  RIC_TRY(check_room(modes, orbit, error));
  RIC_TRY(check_period(modes, period, error));
  impact_verdict_find(modes, period, &response, &verdict);
  if (verdict.outcome == RIC_SINGULAR)
    verdict_without_state(orbit, RIC_SINGULAR);
  else
    fill(modes, &response, &verdict, orbit);
  bool special = verdict.outcome != RIC_SINGULAR && (response.carried || response.free);
  orbit->outcome = verdict.outcome;
  memcpy(orbit->reason, verdict.reason, sizeof orbit->reason);
  orbit->period = period;
  orbit->impact_time[0] = 0;
  orbit->impact_obstacle[0] = modes->obstacle;
  orbit->condition = response.condition;
  orbit->mode = special ? (long long)response.mode : -1;
  orbit->harmonic = special ? response.harmonic : 0;
  return RIC_OK;
}

ric_status ric_impact_modes_state(ric_impact_modes *modes, double period, double t, double *q, double *v,
                                  ric_error *error) {
  periodic_response response;
  RIC_TRY(check_period(modes, period, error));
  if (!isfinite(t))
    return ric_fail(error, RIC_EINVAL, "t = %g, expected a finite number", t);
  response_find(modes, period, modes->options.resonance_tol, &response);
  if (!(response.condition < modes->options.singular_condition))
    return ric_fail(error, RIC_EINVAL, "period = %.17g: amplitudes blow up, there is no state", period);
  double folded = fmod(t, period);
  response_state(modes, &response, folded < 0 ? folded + period : folded, q, v);
  return RIC_OK;
}

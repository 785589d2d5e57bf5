/* Orbits of linear systems with one impact per period: their modes, motion, gaps and verdict. */
#include "impact_modes.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/normal_modes.h"
#include "numeric/constants.h"
#include "numeric/number_block.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "ricochet/elementary.h"
#include "ricochet/normal_modes.h"
#include "ricochet/polynomial.h"

/* Squares of frequencies nearer than this to each other, relative to the largest, are those of one eigenspace: ten
 * times and more the rounding of equal ones, also with a mass matrix. By this alone distinct slow modes of stiff
 * systems would count as equal: they must also be nearer than slow_tol relative to themselves, or than rounding. */
static const double same_tol = 1e-12, slow_tol = 1e-9;
/* Contributions to M^-1_kk (their roots) below it are rounding of modes that do not move k. */
static const double moving_tol = 1e-11;

/* Two obstacles in the same place: every orbit would graze the other one, and rounding would decide on its sign. */
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
  m->obstacles = malloc(m->names.count * sizeof *m->obstacles);
  if (!m->block || !m->obstacles)
    return ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu coordinates", n);
  double *store = m->block;
  m->shape = number_store_take(&store, n * n);
  m->frequency = number_store_take(&store, n);
  m->phi_hit = number_store_take(&store, n);
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

static bool are_equal(const ric_impact_modes *m, double slower, double faster) {
  double below = slower / m->fastest, above = faster / m->fastest; /* whose squares do not underflow */
  double rounding = 8 * DBL_EPSILON * (double)m->n;                /* as in normal_modes.c */
  return above * above - below * below <= fmax(rounding, fmin(same_tol, slow_tol * above * above));
}

/* Number of modes from `first` on that have one frequency. */
static size_t multiplicity(const ric_impact_modes *m, size_t first) {
  size_t count = 1;
  const double *w = m->frequency + first;
  while (first + count < m->n && are_equal(m, w[count - 1], w[count]))
    count++;
  return count;
}

/* Modes of a multiple frequency are any basis of their eigenspace. This chooses the one of which only the first mode
 * moves k: a reflection maps the shapes' components at k, in s, to the first of them. */
static void separate_multiple(ric_impact_modes *m, size_t first, size_t count) {
  size_t n = m->n;
  double *shape = m->shape + first * n, *s = m->q, length = 0, mean = 0;
  for (size_t a = 0; a < count; a++) {
    s[a] = shape[a * n + m->hit];
    length = ric_hypot(length, s[a]);
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

/* Finds the modes that move k, and M^-1 e_k = sum_j phi_j phi_j(k). */
static void find_moving_modes(ric_impact_modes *m) {
  size_t n = m->n, count;
  m->fastest = m->frequency[n - 1];
  for (size_t j = 0; j < n; j += count) {
    count = multiplicity(m, j);
    if (count > 1)
      separate_multiple(m, j, count);
  }
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      m->mobility[i] += m->shape[j * n + i] * m->shape[j * n + m->hit];
  for (size_t j = 0; j < n; j++) {
    double phi = m->shape[j * n + m->hit];
    m->phi_hit[j] = fabs(phi) > moving_tol * sqrt(m->mobility[m->hit]) ? phi : 0;
  }
}

static ric_status build_modes(ric_impact_modes *m, const ric_system *system, ric_error *error) {
  RIC_TRY(allocate_modes(m, error));
  memcpy(m->obstacles, system->obstacles, m->names.count * sizeof *m->obstacles);
  m->names.obstacles = m->obstacles;
  RIC_TRY(ric_normal_modes(system, m->frequency, m->shape, error));
  if (!(m->frequency[0] > 0))
    return ric_fail(error, RIC_EINVAL, "frequency of the slowest mode = %g, expected > 0: the stiffness is singular",
                    m->frequency[0]);
  find_moving_modes(m);
  return RIC_OK;
}

ric_status ric_impact_modes_create(const ric_system *system, size_t obstacle, ric_impact_modes **modes,
                                   ric_error *error) {
  REQUIRE(error, {"system", system}, {"modes", modes});
  *modes = NULL;
  RIC_TRY(linear_part_is_all(system, error));
  RIC_TRY(check_obstacle(system, obstacle, error));
  ric_impact_modes *m = calloc(1, sizeof *m);
  if (!m)
    return ric_fail(error, RIC_ENOMEM, "no memory for impact modes");
  m->n = system->coordinates;
  m->names = obstacle_names_of(system);
  m->obstacle = obstacle;
  m->hit = system->obstacles[obstacle].coordinate;
  m->options = ric_orbit_options_default();
  ric_status status = build_modes(m, system, error);
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

/* --- the motion of a period --------------------------------------------------------------------------------------- */

/* The response of a period; its C_j are in modes->amplitude. */
typedef struct periodic_response {
  double period;
  double impulse;       /* p on the coordinate, 0 at a resonance; positive: upwards */
  double condition;     /* bound of the largest displacement over |b| */
  bool without_impulse; /* modes at resonance reach the obstacle without an impulse: `mode` is the fastest of them */
  bool free;            /* `mode` is at resonance and does not move k: its amplitude is free */
  size_t mode;          /* of `without_impulse` and `free` */
  unsigned harmonic;    /* its l */
} periodic_response;

/* Term of S; infinite at a resonance. */
static double term(const ric_impact_modes *m, size_t j, double period) {
  if (m->phi_hit[j] == 0)
    return 0;
  double sine, cosine;
  ric_sincos(m->frequency[j] * period / 2, &sine, &cosine);
  return m->phi_hit[j] * m->phi_hit[j] * cosine / (2 * m->frequency[j] * sine);
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
  bool is = fabs(turns - l) <= tolerance || ric_sin(m->frequency[j] * period / 2) == 0;
  return is ? l : 0;
}

static void find_resonance(const ric_impact_modes *m, double tolerance, periodic_response *r) {
  for (size_t j = 0; j < m->n; j++) {
    double l = harmonic_of(m, j, r->period, tolerance);
    bool moves = m->phi_hit[j] != 0;
    if (l < 1 || (r->without_impulse && !moves))
      continue;
    r->without_impulse = moves;
    r->free = !moves;
    r->mode = j;
    r->harmonic = (unsigned)l;
  }
}

/* The limit at a resonance: displacements of the resonant modes at k have the ratio phi_j(k)^2 / w_j^2, that of the
 * poles of S. */
static void set_resonant_amplitudes(ric_impact_modes *m, double tolerance, const periodic_response *r) {
  double reached = 0, position = m->obstacles[m->obstacle].position;
  for (size_t j = 0; j < m->n; j++) {
    bool is = m->phi_hit[j] != 0 && harmonic_of(m, j, r->period, tolerance) >= 1;
    double share = is ? m->phi_hit[j] / (m->frequency[j] * m->frequency[j]) : 0;
    reached += share * m->phi_hit[j];
    m->amplitude[j] = share;
  }
  for (size_t j = 0; j < m->n; j++)
    m->amplitude[j] *= position / reached * copysign(1, ric_cos(m->frequency[j] * r->period / 2));
}

static void set_driven_amplitudes(ric_impact_modes *m, periodic_response *r) {
  double sum = 0;
  for (size_t j = 0; j < m->n; j++)
    sum += term(m, j, r->period);
  r->impulse = m->obstacles[m->obstacle].position / sum;
  for (size_t j = 0; j < m->n; j++)
    m->amplitude[j] = m->phi_hit[j] == 0 ? 0
                                         : r->impulse * m->phi_hit[j] /
                                               (2 * m->frequency[j] * ric_sin(m->frequency[j] * r->period / 2));
}

/** @param resonance_tol  on |w_j T / (2 pi) - l|; 0: only periods at which a sine is zero are resonant. Sets
 *  modes->amplitude and modes->reach; they may be infinite. */
static void response_find(ric_impact_modes *modes, double period, double resonance_tol, periodic_response *response) {
  size_t n = modes->n;
  double most = 0;
  *response = (periodic_response){.period = period};
  find_resonance(modes, resonance_tol, response);
  if (response->without_impulse)
    set_resonant_amplitudes(modes, resonance_tol, response);
  else
    set_driven_amplitudes(modes, response);
  memset(modes->reach, 0, n * sizeof *modes->reach);
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; modes->amplitude[j] != 0 && i < n; i++)
      modes->reach[i] += fabs(modes->amplitude[j] * modes->shape[j * n + i]);
  for (size_t i = 0; i < n; i++)
    most = modes->reach[i] <= most ? most : modes->reach[i]; /* keeps a NaN */
  response->condition = most / fabs(modes->obstacles[modes->obstacle].position);
}

/* State at 0 <= t <= T, at 0 after the impact; v may be NULL. */
static void response_state(const ric_impact_modes *modes, const periodic_response *response, double t, double *q,
                           double *v) {
  size_t n = modes->n;
  memset(q, 0, n * sizeof *q);
  if (v)
    memset(v, 0, n * sizeof *v);
  for (size_t j = 0; j < n; j++) {
    double sine, cosine;
    ric_sincos(modes->frequency[j] * (response->period / 2 - t), &sine, &cosine);
    double along = modes->amplitude[j] * cosine, rate = modes->amplitude[j] * modes->frequency[j] * sine;
    for (size_t i = 0; modes->amplitude[j] != 0 && i < n; i++) {
      q[i] += along * modes->shape[j * n + i];
      if (v)
        v[i] += rate * modes->shape[j * n + i];
    }
  }
}

/* Gap rate of the obstacle that is hit, after the impact. */
static double response_gap_rate(const ric_impact_modes *modes, const periodic_response *response) {
  return modes->obstacles[modes->obstacle].side * response->impulse * modes->mobility[modes->hit] / 2;
}

static double response_energy(const ric_impact_modes *modes) {
  double twice = 0;
  for (size_t j = 0; j < modes->n; j++) {
    double rate = modes->amplitude[j] * modes->frequency[j];
    twice += rate * rate;
  }
  return twice / 2;
}

/* Longest segment, in angles of the fastest mode: its truncation error is 2.2^25 / 25! = 2e-17 of the amplitude. */
static const double longest_angle = 2.2;

typedef struct half_period {
  size_t segments;
  double length;
} half_period;

static half_period cut_half_period(ric_impact_modes *m, double period) {
  double segments = ceil(period / 2 * m->fastest / longest_angle);
  half_period h = {.segments = (size_t)segments, .length = period / 2 / segments};
  for (size_t j = 0; j < m->n; j++) {
    double angle = m->frequency[j] * h.length, power = 1;
    for (size_t d = 0; d <= MODES_ORDER; d++) {
      m->series[d * m->n + j] = d / 2 % 2 ? -power : power;
      power *= angle / (double)(d + 1);
    }
  }
  return h;
}

static void begin_segment(ric_impact_modes *m, double period, double start) {
  for (size_t j = 0; j < m->n; j++)
    ric_sincos(m->frequency[j] * (period / 2 - start), &m->sine[j], &m->cosine[j]);
}

/* cos(phase - angle x) = cos(phase) cos(angle x) + sin(phase) sin(angle x), mode by mode. */
static void expand(const ric_impact_modes *m, const ric_obstacle *o, double *c) {
  size_t n = m->n;
  for (size_t j = 0; j < n; j++) {
    double amplitude = m->amplitude[j] * m->shape[j * n + o->coordinate];
    m->even[j] = amplitude * m->cosine[j];
    m->odd[j] = amplitude * m->sine[j];
  }
  for (size_t d = 0; d <= MODES_ORDER; d++) {
    const double *part = d % 2 ? m->odd : m->even, *series = m->series + d * n;
    double sum = 0;
    for (size_t j = 0; j < n; j++)
      sum += part[j] * series[j];
    c[d] = o->side * sum;
  }
  c[0] -= o->side * o->position;
}

/* --- gaps --------------------------------------------------------------------------------------------------------- */

/* A lower bound for the whole motion. */
static double bound(const ric_impact_modes *m, size_t obstacle) {
  const ric_obstacle *o = &m->obstacles[obstacle];
  return -o->side * o->position - m->reach[o->coordinate];
}

static void watch_segment(ric_impact_modes *m, double start, double length, gap_watch *w) {
  double c[RIC_POLY_DEGREE + 1];
  for (size_t j = 0; j < m->names.count; j++) {
    bool hit = j == m->obstacle, divided = hit && start == 0;
    if (!gap_watch_cares(w, hit, bound(m, j), start))
      continue;
    expand(m, &m->obstacles[j], c);
    gap_watch_value(w, &(gap_piece){.c = c + divided,
                                    .degree = MODES_ORDER - divided,
                                    .start = start,
                                    .length = length,
                                    .to = 1,
                                    .obstacle = j,
                                    .hit = hit,
                                    .divided = divided});
  }
}

/* On minima, relative: rounding of the polynomials. */
static const double minimum_tol = 1e-14;

/* As in orbit.h: displacements at 0 and T/2, and speeds over the largest frequency, which stand for the times
 * between. */
static double largest_displacement(ric_impact_modes *m, const periodic_response *r) {
  response_state(m, r, r->period / 2, m->q, NULL);
  double at_half = largest(m->q, m->n);
  response_state(m, r, 0, m->q, m->v);
  return fmax(fmax(at_half, largest(m->q, m->n)), largest(m->v, m->n) / m->fastest);
}

/* @param zero  gaps below -zero are violations, relative to the largest displacement, which is returned; afterwards
 * m->q and m->v are the state at 0 */
static double find_gaps(ric_impact_modes *m, const periodic_response *r, double zero, gap_watch *w) {
  double scale = largest_displacement(m, r);
  half_period h = cut_half_period(m, r->period);
  gap_watch_begin(w, minimum_tol * scale / 2, zero * scale, INFINITY);
  for (size_t s = 0; s < h.segments; s++) {
    double start = (double)s * h.length;
    begin_segment(m, r->period, start);
    watch_segment(m, start, h.length, w);
  }
  return scale;
}

double impact_modes_margin(ric_impact_modes *modes, double period, gap_found *least) {
  periodic_response response;
  gap_watch gaps;
  response_find(modes, period, 0, &response);
  double scale = find_gaps(modes, &response, INFINITY, &gaps);
  if (least)
    *least = *gap_watch_least(&gaps);
  return gap_watch_least(&gaps)->value / scale;
}

/* --- the orbit of a period ---------------------------------------------------------------------------------------- */

static void fill_orbit(const ric_impact_modes *m, const periodic_response *r, ric_orbit *orbit) {
  size_t bytes = m->n * sizeof *m->q;
  const ric_obstacle *hit = &m->obstacles[m->obstacle];
  memcpy(orbit->q, m->q, bytes);
  memcpy(orbit->v, m->v, bytes);
  response_state(m, r, r->period / 2, orbit->q_half, orbit->v_half);
  orbit->impulse[0] = r->without_impulse ? 0 : hit->side * r->impulse; /* no -0 */
  orbit->gap_rate[0] = r->without_impulse ? 0 : -response_gap_rate(m, r);
  orbit->energy = response_energy(m);
  orbit->residual = fabs(m->q[m->hit] - hit->position);
}

/* Impulses of the shortest periods underflow: then the residual shows that the obstacle is not reached. */
static void set_outcome(ric_impact_modes *m, const periodic_response *r, ric_orbit *orbit) {
  gap_watch gaps;
  double scale = find_gaps(m, r, m->options.grazing_tol, &gaps), allowed = m->options.residual_tol * scale;
  const orbit_facts f = {.names = m->names, .gaps = &gaps, .slow = gaps.zero * m->fastest};
  fill_orbit(m, r, orbit);
  admissibility_clearance(&f, orbit);
  if (!(orbit->residual <= allowed)) {
    admissibility_violated(orbit, orbit->residual, allowed);
  } else if (r->without_impulse || r->free) {
    admissibility_resonant(orbit, r->without_impulse, r->mode, r->harmonic);
    admissibility_add_violation(&f, orbit);
  } else {
    admissibility_find(&f, orbit);
  }
}

static ric_status check_room(const ric_impact_modes *m, const ric_orbit *orbit, ric_error *error) {
  if (orbit->particles == m->n && orbit->speeds == m->n && orbit->impacts == 1)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "orbit with room for %zu coordinates and %zu impacts, expected %zu and 1",
                  orbit->particles, orbit->impacts, m->n);
}

ric_status ric_impact_modes_orbit(ric_impact_modes *modes, double period, ric_orbit *orbit, ric_error *error) {
  REQUIRE(error, {"modes", modes}, {"orbit", orbit});
  periodic_response response;
  RIC_TRY(check_room(modes, orbit, error));
  RIC_TRY(check_period(modes, period, error));
  response_find(modes, period, modes->options.resonance_tol, &response);
  bool singular = !(response.condition < modes->options.singular_condition);
  if (singular) {
    admissibility_without_state(orbit, RIC_SINGULAR);
    snprintf(orbit->reason, sizeof orbit->reason,
             "an impulse does not move coordinate %zu at its contact: amplitudes blow up (condition %.3g)", modes->hit,
             response.condition);
  }
  orbit->period = period;
  orbit->condition = response.condition;
  orbit->mode = -1;
  orbit->harmonic = 0;
  orbit->impact_time[0] = 0;
  orbit->impact_obstacle[0] = modes->obstacle;
  if (!singular)
    set_outcome(modes, &response, orbit);
  return RIC_OK;
}

ric_status ric_impact_modes_state(ric_impact_modes *modes, double period, double t, double *q, double *v,
                                  ric_error *error) {
  REQUIRE(error, {"modes", modes}, {"q", q});
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

/* The motion of a chain over half a period, as segments, and states of an orbit at any time. */
#include "motion.h"

#include <math.h>
#include <stdlib.h>

#include "solver.h"
#include "numeric/required.h"

enum { ORDER = 24 };

/* Longest step whose truncation error, (omega h)^25 / 25! relative to the amplitude, is below 1e-16. */
static double longest_step(const ric_chain *chain) {
  return 2.2 / ric_chain_frequency_max(chain);
}

ric_status motion_prepare(motion *m, size_t particles, ric_error *error) {
  ric_lattice linear = ric_lattice_default(particles, RIC_ENDS_PERIODIC);
  if (!m->series)
    RIC_TRY(lattice_series_create(&linear, ORDER, LATTICE_SERIES_BLOCK, &m->series, error));
  if (particles <= m->capacity)
    return RIC_OK;
  free(m->store);
  m->capacity = 0;
  m->store = malloc(6 * particles * sizeof *m->store);
  if (!m->store)
    return ric_fail(error, RIC_ENOMEM, "no memory for the motion of %zu particles", particles);
  m->capacity = particles;
  return RIC_OK;
}

void motion_clear(motion *m) {
  lattice_series_destroy(&m->series);
  free(m->store);
  *m = (motion){0};
}

/* One of the two runs: its steps, and the states it moves between. */
typedef struct run {
  bool from_half;
  double start, length;
  size_t steps;
  const double *q, *v;   /* state at the start */
  double *q_end, *v_end; /* state at T/4 */
  double *q_spare, *v_spare;
} run;

/* One step of all blocks from (q, v) to (q_next, v_next). */
static void step_motion(motion *m, const ric_chain *chain, const run *r, size_t index, const double *q, const double *v,
                        double *q_next, double *v_next, motion_visit visit, void *user) {
  double start = r->start + (double)index * r->length;
  for (size_t first = 0; first < chain->particles; first += LATTICE_SERIES_BLOCK) {
    size_t rest = chain->particles - first, count = rest < LATTICE_SERIES_BLOCK ? rest : LATTICE_SERIES_BLOCK;
    motion_piece piece = {.from_half = r->from_half, .at_contact = index == 0};
    piece.segment = lattice_series_segment(m->series, q, v, start, r->length, first, count);
    if (visit)
      visit(&piece, user);
    ric_segment_state(&piece.segment, 1, q_next + first, v_next + first);
  }
}

static ric_status advance_motion(motion *m, const ric_chain *chain, const run *r, motion_visit visit, void *user,
                                 ric_poll poll, ric_error *error) {
  const double *q = r->q, *v = r->v;
  for (size_t i = 0; i < r->steps; i++) {
    if (ric_poll_stops(poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped at t = %g", r->start + (double)i * r->length);
    bool to_end = (r->steps - 1 - i) % 2 == 0; /* the last step lands in q_end */
    double *q_next = to_end ? r->q_end : r->q_spare, *v_next = to_end ? r->v_end : r->v_spare;
    step_motion(m, chain, r, i, q, v, q_next, v_next, visit, user);
    q = q_next;
    v = v_next;
  }
  return RIC_OK;
}

static double largest_difference(const double *a, const double *b, size_t n) {
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    double d = fabs(a[i] - b[i]);
    largest = d <= largest ? largest : d; /* keeps a NaN */
  }
  return largest;
}

ric_status motion_run(motion *m, const ric_chain *chain, double period, const boundary_state *state, motion_visit visit,
                      void *user, double *mismatch, ric_poll poll, ric_error *error) {
  size_t n = chain->particles;
  double quarter = period / 4, *store = m->store;
  size_t steps = (size_t)ceil(quarter / longest_step(chain));
  run forward = {.start = 0,
                 .length = quarter / (double)steps,
                 .steps = steps,
                 .q = state->q,
                 .v = state->v,
                 .q_end = store,
                 .v_end = store + n,
                 .q_spare = store + 2 * n,
                 .v_spare = store + 3 * n};
  run backward = forward;
  backward.from_half = true;
  backward.start = period / 2;
  backward.length = -forward.length;
  backward.q = state->q_half;
  backward.v = state->v_half;
  backward.q_end = store + 4 * n;
  backward.v_end = store + 5 * n;
  m->lattice = ric_lattice_of_chain(chain);
  RIC_TRY(lattice_series_begin(m->series, &m->lattice, NULL, error));
  RIC_TRY(advance_motion(m, chain, &forward, visit, user, poll, error));
  RIC_TRY(advance_motion(m, chain, &backward, visit, user, poll, error));
  if (mismatch) {
    double in_q = largest_difference(forward.q_end, backward.q_end, n);
    double in_v = largest_difference(forward.v_end, backward.v_end, n) / ric_chain_frequency_max(chain);
    *mismatch = isnan(in_q) || isnan(in_v) ? NAN : fmax(in_q, in_v);
  }
  return RIC_OK;
}

/* States of an orbit at any time, from the segments of its half period. */

typedef struct request {
  const ric_orbit *orbit;
  const double *times;
  size_t count;
  double *q, *v;
} request;

/* Time folded into [0, T/2] by periodicity and evenness; `sign` is that of the velocities. Instants of impact belong to
 * the state after the impact. */
static double fold(const ric_orbit *orbit, double time, double *sign) {
  double t = fmod(time, orbit->period);
  if (t < 0)
    t += orbit->period;
  *sign = 1;
  if (t >= orbit->period)
    t = 0;
  if (2 * t >= orbit->period) {
    t = orbit->period - t;
    *sign = -1;
  }
  return t;
}

/* Steps overlap by this much in x, so that rounding leaves no time between two of them. */
static const double slack = 1e-9;

static void write_requests(const motion_piece *piece, void *user) {
  const request *r = user;
  const ric_segment *s = &piece->segment;
  double q[LATTICE_SERIES_BLOCK], v[LATTICE_SERIES_BLOCK];
  for (size_t a = 0; a < r->count; a++) {
    double sign, t = fold(r->orbit, r->times[a], &sign), x = (t - s->start) / s->length;
    bool in_this_run = (4 * t > r->orbit->period) == piece->from_half;
    if (!in_this_run || !(x >= -slack && x <= 1 + slack))
      continue;
    ric_segment_state(s, x, q, v);
    for (size_t i = 0; i < s->coordinates; i++) {
      r->q[a * r->orbit->particles + s->first + i] = q[i];
      if (r->v)
        r->v[a * r->orbit->particles + s->first + i] = sign * v[i];
    }
  }
}

ric_status ric_orbit_states(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                            const double *times, size_t count, double *q, double *v, ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"chain", chain}, {"orbit", orbit}, {"times", unless_empty(count, times)},
          {"q", unless_empty(count, q)});
  RIC_TRY(ric_chain_check(chain, error));
  if (orbit->particles != chain->particles)
    return ric_fail(error, RIC_EINVAL, "orbit of %zu particles, expected %zu", orbit->particles, chain->particles);
  if (orbit->outcome == RIC_FAILED || !(orbit->period > 0) || !isfinite(orbit->energy))
    return ric_fail(error, RIC_EINVAL, "orbit without a state: %s", ric_outcome_name(orbit->outcome));
  for (size_t a = 0; a < count; a++)
    if (!isfinite(times[a]))
      return ric_fail(error, RIC_EINVAL, "times[%zu] = %g, expected a finite time", a, times[a]);
  request r = {.orbit = orbit, .times = times, .count = count, .q = q, .v = v};
  boundary_state state = {.q = orbit->q, .v = orbit->v, .q_half = orbit->q_half, .v_half = orbit->v_half};
  RIC_TRY(motion_prepare(&solver->motion, chain->particles, error));
  return motion_run(&solver->motion, chain, orbit->period, &state, write_requests, &r, NULL, solver->options.poll,
                    error);
}

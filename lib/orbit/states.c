/* States of an orbit at any time, from the segments of its half period. */
#include <math.h>

#include "solver.h"

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

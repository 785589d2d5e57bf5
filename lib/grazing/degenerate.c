#include "degenerate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "family/family_parts.h"

enum { SAMPLES = 129 };

static const double largest_tol = 1e-2; /* that trajectories take */

/* Times this near to each other, over the period, are one. */
static const double time_tol = 1e-5;

static double sample_range(const ric_system *s, size_t obstacle, double period, const double *q) {
  double low = INFINITY, high = -INFINITY;
  for (size_t k = 0; k < SAMPLES; k++) {
    const double gap = ric_system_gap(s, obstacle, period * (double)k / (SAMPLES - 1), q + k * s->coordinates);
    low = fmin(low, gap);
    high = fmax(high, gap);
  }
  return high - low;
}

ric_status degenerate_size(ric_shooting *s, const double *z, double given, size_t obstacle, double *size,
                           ric_error *error) {
  const ric_system *system = s->system;
  const double period = arcs_period(&s->arcs, z, given);
  double *q = malloc(SAMPLES * s->arcs.size * sizeof *q);
  if (!q)
    return ric_fail(error, RIC_ENOMEM, "no memory for %d states of %zu numbers", SAMPLES, s->arcs.size);
  const ric_status status = ric_shooting_states(s, z, given, SAMPLES, q, q + SAMPLES * system->coordinates, error);
  if (status == RIC_OK)
    *size = sample_range(system, obstacle, period, q);
  free(q);
  RIC_TRY(status);
  if (*size > 0 && *size < INFINITY)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "the gap of obstacle %zu changes by %g along the motion: it is at rest",
                  obstacle, *size);
}

ric_status degenerate_acceleration(const touch *k, double period, double size, const ric_grazing_options *o,
                                   ric_error *error) {
  if (k->acceleration * period * period > o->degenerate * size)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "A_g near zero: the gap of obstacle %zu has the second derivative %.3g at t = %g", k->obstacle,
                  k->acceleration, k->time);
}

/* What an event-driven run meets that is not the touch itself. */
typedef struct meetings {
  const ric_grazing *g;
  double slowest; /* gap rates of transversal impacts are larger */
  char found[160];
} meetings;

static bool is_touch(const ric_grazing *g, const ric_event *e) {
  const double apart = fabs(remainder(e->time - g->time, g->period));
  return e->obstacle == g->local.obstacle && apart <= time_tol * g->period;
}

static int see(const ric_event *e, void *user) {
  meetings *w = user;
  if (is_touch(w->g, e))
    return 0;
  if (e->kind == RIC_EVENT_GRAZING)
    snprintf(w->found, sizeof w->found, "two grazing points at once: obstacle %zu comes within %.3g at t = %g, too",
             e->obstacle, e->depth, e->time);
  else if (e->kind != RIC_EVENT_CONTACT && e->kind != RIC_EVENT_PARTING &&
           !(e->kind == RIC_EVENT_TRANSVERSAL && -e->gap_rate > w->slowest))
    snprintf(w->found, sizeof w->found, "an impact that is not transversal: %s, obstacle %zu, at t = %g",
             ric_event_name(e->kind), e->obstacle, e->time);
  return w->found[0] != 0;
}

static ric_status run(ric_trajectory *t, const ric_shooting *s, const double *x, double from, meetings *w,
                      ric_error *error) {
  const ric_observer observer = {.event = see, .user = w};
  ric_run run;
  RIC_TRY(ric_trajectory_start(t, from, x, x + s->arcs.coordinates, error));
  RIC_TRY(ric_trajectory_run(t, from + w->g->period * (1 - time_tol), &observer, &run, error));
  if (run.outcome == RIC_RUN_COMPLETED || run.outcome == RIC_RUN_ENDED)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "%s at t = %g: %s", ric_run_outcome_name(run.outcome), run.time, run.reason);
}

ric_status degenerate_motion(ric_family *f, const double *z, const ric_grazing *g, double size,
                             const ric_grazing_options *o, ric_error *error) {
  ric_shooting *s = f->shooting;
  meetings w = {.g = g, .slowest = o->transversal * size / g->period};
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_trajectory *t = NULL;
  options.flow = f->problem.motion.flow;
  options.grazing_tol = fmin(o->touch_tol * size, largest_tol);
  options.poll = s->poll;
  double *x = malloc(g->numbers * sizeof *x);
  const double from = g->time + time_tol * g->period; /* just after the touch, which may be an impact by rounding */
  ric_status status = x ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for %zu numbers", g->numbers);
  if (status == RIC_OK)
    status = ric_shooting_transfer(s, z, g->given, from, from, x, NULL, error);
  if (status == RIC_OK)
    status = ric_trajectory_create(s->system, &options, &t, error);
  if (status == RIC_OK)
    status = run(t, s, x, from, &w, error);
  ric_trajectory_destroy(&t);
  free(x);
  RIC_TRY(status);
  return w.found[0] ? ric_fail(error, RIC_ENUMERIC, "%s", w.found) : RIC_OK;
}

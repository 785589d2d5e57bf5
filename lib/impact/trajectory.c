/* Event-driven motions: the main loop, its options and outcomes, and samples. */
#include "trajectory.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/trajectory.h"
#include "numeric/required.h"

/* Position of a time in a piece. */
static double position(const ric_segment *piece, double time) {
  double x = (time - piece->start) / piece->length;
  return x < 0 ? 0 : x > 1 ? 1 : x;
}

static void fill(const ric_sampler *s, const ric_segment *piece, size_t k) {
  size_t speeds = piece->speeds ? piece->speeds : piece->coordinates;
  double *u = s->u && s->speeds ? s->u + k * s->speeds + (speeds == piece->coordinates ? piece->first : 0) : NULL;
  ric_segment_state(piece, position(piece, s->times[k]), s->q + k * s->coordinates + piece->first, u);
}

/* Times in [start, end of the part): the end belongs to the next part. */
int ric_sampler_segment(const ric_segment *piece, double end, void *sampler) {
  ric_sampler *s = sampler;
  double until = piece->start + end * piece->length;
  size_t k = s->next;
  for (; k < s->count && s->times[k] < until; k++)
    fill(s, piece, k);
  if (piece->first + piece->coordinates == s->coordinates) /* the last piece of the step */
    s->next = k;
  return 0;
}

const double *ric_trajectory_q(const ric_trajectory *trajectory) {
  return trajectory->flow->q;
}

const double *ric_trajectory_u(const ric_trajectory *trajectory) {
  return trajectory->flow->u;
}

double ric_trajectory_time(const ric_trajectory *trajectory) {
  return trajectory->flow->time;
}

void ric_sampler_finish(ric_sampler *sampler, const ric_trajectory *trajectory) {
  const double *q = ric_trajectory_q(trajectory), *u = ric_trajectory_u(trajectory);
  for (; sampler->next < sampler->count && sampler->times[sampler->next] <= ric_trajectory_time(trajectory);
       sampler->next++) {
    memcpy(sampler->q + sampler->next * sampler->coordinates, q, sampler->coordinates * sizeof *q);
    if (sampler->u && sampler->speeds)
      memcpy(sampler->u + sampler->next * sampler->speeds, u, sampler->speeds * sizeof *u);
  }
}

const char *ric_run_outcome_name(ric_run_outcome outcome) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_RUN_OUTCOME_LIST(X)
#undef X
  };
  return (unsigned)outcome < RIC_RUN_OUTCOMES ? names[outcome] : "unknown outcome";
}

ric_trajectory_options ric_trajectory_options_default(void) {
  return (ric_trajectory_options){.flow = ric_flow_options_default(),
                                  .event_time_tol = 1e-12,
                                  .grazing_tol = 1e-10,
                                  .chatter_tol = 1e-4,
                                  .rest_tol = 1e-13,
                                  .events_per_time = 1e5};
}

static ric_status check_range(const char *name, double value, double most, ric_error *error) {
  if (value >= 0 && value <= most)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "%s = %g, expected 0 to %g", name, value, most);
}

static ric_status check_options(const ric_trajectory_options *o, ric_error *error) {
  RIC_TRY(check_range("event_time_tol", o->event_time_tol, 1e-3, error));
  RIC_TRY(check_range("grazing_tol", o->grazing_tol, 1e-2, error));
  RIC_TRY(check_range("chatter_tol", o->chatter_tol, 1e-1, error));
  RIC_TRY(check_range("rest_tol", o->rest_tol, 1e-2, error));
  if (!(o->events_per_time > 0))
    return ric_fail(error, RIC_EINVAL, "events_per_time = %g, expected > 0", o->events_per_time);
  return RIC_OK;
}

/* Obstacles that are ignored (pass_rigid) need no room. */
static ric_status check_room(const ric_trajectory *tr, ric_error *error) {
  return tr->options.pass_rigid ? RIC_OK : system_check_room(tr->system, error);
}

static ric_status build_trajectory(ric_trajectory *tr, ric_error *error) {
  const ric_system *s = tr->system;
  size_t states = s->coordinates + s->speeds, count = s->obstacle_count;
  RIC_TRY(check_room(tr, error));
  RIC_TRY(ric_flow_create(s, &tr->options.flow, &tr->flow, error));
  tr->noise = fmax(tr->options.rest_tol, 10 * tr->flow->options.tolerance);
  RIC_TRY(locator_init(&tr->locator, tr->flow, tr->options.grazing_tol, error));
  RIC_TRY(impact_solver_init(&tr->law, s, error));
  tr->resting = calloc(count ? count : 1, 1);
  tr->rates = malloc(2 * states * sizeof *tr->rates);
  if (!tr->resting || !tr->rates)
    return ric_fail(error, RIC_ENOMEM, "no memory for a trajectory of %zu states", states);
  tr->shifted = tr->rates + states;
  return RIC_OK;
}

void ric_trajectory_destroy(ric_trajectory **trajectory) {
  if (!trajectory || !*trajectory)
    return;
  ric_trajectory *tr = *trajectory;
  ric_flow_destroy(&tr->flow);
  locator_clear(&tr->locator);
  impact_solver_clear(&tr->law);
  free(tr->resting);
  free(tr->rates);
  free(tr->impacts);
  free(tr->held.items);
  free(tr->departing.items);
  free(tr->settling.items);
  free(tr->closed.items);
  free(tr->accelerations);
  free(tr->forces);
  free(tr->coming);
  impact_tangents_clear(&tr->tangents);
  free(tr);
  *trajectory = NULL;
}

ric_status ric_trajectory_create(const ric_system *system, const ric_trajectory_options *options,
                                 ric_trajectory **trajectory, ric_error *error) {
  REQUIRE(error, {"system", system}, {"trajectory", trajectory});
  ric_trajectory_options o = options ? *options : ric_trajectory_options_default();
  *trajectory = NULL;
  RIC_TRY(check_options(&o, error));
  ric_trajectory *tr = calloc(1, sizeof *tr);
  if (!tr)
    return ric_fail(error, RIC_ENOMEM, "no memory for a trajectory");
  tr->system = system;
  tr->options = o;
  ric_status status = build_trajectory(tr, error);
  if (status == RIC_OK)
    *trajectory = tr;
  else
    ric_trajectory_destroy(&tr);
  return status;
}

static ric_status check_start(const ric_trajectory *tr, double t, const double *q, ric_error *error) {
  const ric_system *s = tr->system;
  RIC_TRY(check_room(tr, error));
  for (size_t j = 0; j < s->obstacle_count; j++) {
    double gap = contact_is_passed(tr, j) ? 0 : ric_system_gap(s, j, t, q);
    if (isnan(gap))
      return ric_fail(error, RIC_ECALLBACK, "at t = %g: the gap of obstacle %zu could not be evaluated", t, j);
    if (gap < -tr->options.grazing_tol && !system_complies(s, j))
      return ric_fail(error, RIC_EINVAL, "start: the gap of obstacle %zu%s is %g, expected >= 0", j,
                      s->obstacles ? (s->obstacles[j].side > 0 ? " (a floor)" : " (a wall)") : "", gap);
  }
  return RIC_OK;
}

ric_status ric_trajectory_start(ric_trajectory *tr, double t, const double *q, const double *u, ric_error *error) {
  REQUIRE(error, {"trajectory", tr}, {"q", q});
  tr->started = false;
  contacts_reset(tr);
  tr->tangents.kind = RIC_SALTATION_DIFFERENTIABLE;
  RIC_TRY(ric_flow_start(tr->flow, t, q, u, error));
  RIC_TRY(check_start(tr, t, q, error));
  tr->started = tr->fresh = true;
  tr->window_start = t;
  tr->window_events = 0;
  return RIC_OK;
}

ric_status trajectory_set_clock(ric_trajectory *tr, double time, ric_error *error) {
  double later = time - tr->flow->time;
  tr->flow->time = tr->flow->end = time;
  tr->window_start += later;
  for (size_t i = 0; i < tr->coming_count; i++)
    tr->coming[i].time += later;
  return flow_restart(tr->flow, error);
}

ric_event event_of(const ric_trajectory *tr, ric_event_kind kind, size_t obstacle) {
  const ric_obstacle *o = tr->system->obstacles;
  return (ric_event){.kind = kind,
                     .time = tr->flow->time,
                     .obstacle = obstacle,
                     .coordinate = o ? o[obstacle].coordinate : SIZE_MAX,
                     .depth = NAN,
                     .accumulation = NAN};
}

void trajectory_show(ric_trajectory *tr, const ric_event *event) {
  tr->run->events[event->kind]++;
  if (tr->observer && tr->observer->event && tr->observer->event(event, tr->observer->user) != 0)
    tr->ended = true;
}

void trajectory_show_kind(ric_trajectory *tr, ric_event_kind kind, size_t obstacle) {
  ric_event event = event_of(tr, kind, obstacle);
  trajectory_show(tr, &event);
}

static void show_pieces(ric_trajectory *tr, double x) {
  if (!tr->observer || !tr->observer->segment || !(x > 0))
    return;
  for (size_t i = 0; i < ric_flow_pieces(tr->flow); i++) {
    ric_segment piece = ric_flow_piece(tr->flow, i);
    if (tr->observer->segment(&piece, x, tr->observer->user) != 0)
      tr->ended = true;
  }
}

static void show_grazes(ric_trajectory *tr, double start, double length) {
  for (size_t i = 0; i < tr->locator.grazes.count; i++) {
    const contact_root *h = &tr->locator.grazes.hits[i];
    ric_event event = event_of(tr, RIC_EVENT_GRAZING, h->obstacle);
    event.time = start + h->x * length;
    event.depth = h->depth;
    trajectory_show(tr, &event);
    impact_tangents_lose(tr, h->obstacle, event.time, RIC_SALTATION_GRAZING);
  }
}

/* Simultaneous events count once. */
static void count_event_time(ric_trajectory *tr) {
  if (tr->flow->time - tr->window_start > 1) {
    tr->window_start = tr->flow->time;
    tr->window_events = 0;
  }
  tr->window_events++;
}

/* Accepted part of a step: up to the first roots, or to the near miss at which tangent vectors become undefined. */
static double extent(ric_trajectory *tr, bool *meets) {
  locator *l = &tr->locator;
  double x = l->roots.count > 0 ? l->first : l->horizon;
  *meets = l->roots.count > 0;
  if (tr->flow->tangent.columns == 0 || l->grazes.count == 0)
    return x;
  *meets = false;
  l->grazes.count = 1;
  return l->grazes.hits[0].x;
}

/* One step of the flow, up to its first event. */
static ric_status advance_trajectory(ric_trajectory *tr, double end, ric_error *error) {
  ric_flow *f = tr->flow;
  bool meets, moved;
  RIC_TRY(ric_flow_step(f, contacts_next_rest(tr, end), error));
  RIC_TRY(locator_scan(&tr->locator, f, tr->options.event_time_tol * (1 + fabs(f->time)), error));
  double x = extent(tr, &meets), start = f->time, length = f->length;
  show_pieces(tr, x);
  ric_flow_accept(f, x);
  show_grazes(tr, start, length);
  if (tr->held.count + tr->departing.count > 0)
    contacts_measure(tr); /* the state may have grown since the last event */
  RIC_TRY(contacts_depart(tr, error));
  RIC_TRY(contacts_keep_on(tr, &moved, error));
  if (meets) {
    RIC_TRY(contacts_onset(tr, error));
    count_event_time(tr);
  } else if (moved)
    RIC_TRY(flow_restart(f, error));
  contacts_come_to_rest(tr);
  return RIC_OK;
}

static void conclude(ric_trajectory *tr, ric_run_outcome outcome, const char *reason) {
  tr->run->outcome = outcome;
  snprintf(tr->run->reason, sizeof tr->run->reason, "%s", reason);
}

/* Whether tangent vectors are lost, which ends the run. */
static ric_status check_tangents(ric_trajectory *tr, bool *lost, ric_error *error) {
  ric_saltation_kind kind = tr->tangents.kind;
  *lost = kind != RIC_SALTATION_DIFFERENTIABLE;
  if (!*lost)
    return RIC_OK;
  conclude(tr, kind == RIC_SALTATION_GRAZING ? RIC_RUN_GRAZING : RIC_RUN_NOT_DIFFERENTIABLE, "");
  return impact_tangents_end(tr, tr->run->reason, sizeof tr->run->reason, error);
}

/* Whether the run is over, and how. */
static bool is_over(ric_trajectory *tr, double end) {
  char reason[128];
  if (tr->ended)
    conclude(tr, RIC_RUN_ENDED, "the observer asked for the end");
  else if (tr->window_events > tr->options.events_per_time) {
    snprintf(reason, sizeof reason, "events at more than %g times between t = %g and %g", tr->options.events_per_time,
             tr->window_start, tr->flow->time);
    conclude(tr, RIC_RUN_EVENT_LIMIT, reason);
    tr->window_start = tr->flow->time; /* a continued run gets a new allowance */
    tr->window_events = 0;
  } else if (!(tr->flow->time < end))
    conclude(tr, RIC_RUN_COMPLETED, "");
  else
    return false;
  return true;
}

static ric_status move(ric_trajectory *tr, double end, ric_error *error) {
  bool lost = false;
  if (tr->fresh) {
    tr->fresh = false;
    RIC_TRY(contacts_begin(tr, error));
  }
  RIC_TRY(check_tangents(tr, &lost, error));
  while (!lost && !is_over(tr, end)) {
    if (ric_poll_stops(tr->options.poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped at t = %g", tr->flow->time);
    RIC_TRY(advance_trajectory(tr, end, error));
    RIC_TRY(check_tangents(tr, &lost, error));
  }
  return RIC_OK;
}

static double energy_now(const ric_trajectory *tr) {
  return ric_system_energy(tr->system, tr->flow->time, tr->flow->q, tr->flow->u);
}

static ric_flow_counts counts_since(const ric_flow *flow, ric_flow_counts before) {
  ric_flow_counts now = ric_flow_counted(flow);
  return (ric_flow_counts){.steps = now.steps - before.steps,
                           .force_evaluations = now.force_evaluations - before.force_evaluations,
                           .starts = now.starts - before.starts};
}

ric_status ric_trajectory_run(ric_trajectory *tr, double end, const ric_observer *observer, ric_run *run,
                              ric_error *error) {
  REQUIRE(error, {"trajectory", tr}, {"run", run});
  ric_error local = {0};
  if (!tr->started)
    return ric_fail(error, RIC_EINVAL, "the trajectory has not been started");
  RIC_TRY(flow_check_revision(tr->flow, error));
  if (!(end >= tr->flow->time && end < INFINITY))
    return ric_fail(error, RIC_EINVAL, "end = %g, expected a finite time from t = %g on", end, tr->flow->time);
  *run = (ric_run){.energy_start = energy_now(tr)};
  tr->observer = observer;
  tr->run = run;
  tr->ended = false;
  ric_flow_counts before = ric_flow_counted(tr->flow);
  ric_status status = move(tr, end, &local);
  run->time = tr->flow->time;
  run->energy_end = energy_now(tr);
  run->flow = counts_since(tr->flow, before);
  if (status == RIC_ENUMERIC || status == RIC_ECALLBACK || status == RIC_ELIMIT) {
    conclude(tr,
             status == RIC_ENUMERIC    ? RIC_RUN_BLOW_UP
             : status == RIC_ECALLBACK ? RIC_RUN_CALLBACK_FAILED
                                       : RIC_RUN_UNRESOLVED,
             local.message);
    return RIC_OK;
  }
  if (status != RIC_OK && error)
    *error = local;
  return status;
}

int ric_trajectory_rests(const ric_trajectory *trajectory, size_t obstacle) {
  return flow_contact(trajectory->flow, obstacle) == CONTACT_HELD;
}

#include "arc_runner.h"

#include <string.h>

#include "impact/trajectory_state.h"

ric_status arc_runner_init(arc_runner *r, const ric_system *system, const ric_flow_options *flow, ric_poll poll,
                           ric_error *error) {
  *r = (arc_runner){.system = system, .poll = poll};
  if (system_compliant_obstacles(system) == 0)
    return ric_flow_create(system, flow, &r->flow, error);
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow = *flow;
  options.pass_rigid = true;
  options.poll = poll;
  return ric_trajectory_create(system, &options, &r->trajectory, error);
}

void arc_runner_clear(arc_runner *r) {
  ric_flow_destroy(&r->flow);
  ric_trajectory_destroy(&r->trajectory);
}

ric_flow *arc_runner_flow(const arc_runner *r) {
  return r->flow ? r->flow : r->trajectory->flow;
}

static void keep_state(const arc_runner *r, const ric_flow *flow, double *x, size_t columns, double *d) {
  size_t n = r->system->coordinates, m = r->system->speeds;
  memcpy(x, flow->q, n * sizeof *x);
  if (m > 0)
    memcpy(x + n, flow->u, m * sizeof *x);
  if (columns == 0)
    return;
  memcpy(d, flow->tangent.q, n * columns * sizeof *d);
  if (m > 0)
    memcpy(d + n * columns, flow->tangent.u, m * columns * sizeof *d);
}

static void show(ric_flow *flow, const arc_watch *watcher) {
  for (size_t i = 0; watcher && i < ric_flow_pieces(flow); i++) {
    ric_segment piece = ric_flow_piece(flow, i);
    (void)watcher->segment(&piece, 1, watcher->user);
  }
}

static ric_status check_steps(const arc_runner *r, ric_error *error) {
  const ric_flow *flow = arc_runner_flow(r);
  if (r->last_step == 0 || ric_flow_counted(flow).steps < r->last_step)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "the motion takes too many steps; given up at t = %g", ric_flow_time(flow));
}

static ric_status flow_along(arc_runner *r, double from, double to, double *x, size_t columns, double *d,
                             const arc_watch *watcher, ric_error *error) {
  size_t n = r->system->coordinates;
  RIC_TRY(ric_flow_start(r->flow, from, x, x + n, error));
  if (columns > 0)
    RIC_TRY(ric_flow_carry(r->flow, columns, d, d + n * columns, error));
  while (ric_flow_time(r->flow) != to) {
    if (ric_poll_stops(r->poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped at t = %g", ric_flow_time(r->flow));
    RIC_TRY(check_steps(r, error));
    RIC_TRY(ric_flow_step(r->flow, to, error));
    show(r->flow, watcher);
    ric_flow_accept(r->flow, 1);
  }
  keep_state(r, r->flow, x, columns, d);
  return RIC_OK;
}

static ric_status run_along(arc_runner *r, double from, double to, double *x, size_t columns, double *d,
                            const arc_watch *watcher, ric_error *error) {
  size_t n = r->system->coordinates;
  ric_observer observer = {.segment = watcher ? watcher->segment : NULL, .user = watcher ? watcher->user : NULL};
  ric_run run;
  if (to < from)
    return ric_fail(error, RIC_ENUMERIC, "an arc would run backwards, from t = %g to %g", from, to);
  RIC_TRY(ric_trajectory_start(r->trajectory, from, x, x + n, error));
  if (columns > 0)
    RIC_TRY(ric_trajectory_carry(r->trajectory, columns, d, d + n * columns, error));
  RIC_TRY(ric_trajectory_run(r->trajectory, to, &observer, &run, error));
  if (run.outcome != RIC_RUN_COMPLETED)
    return ric_fail(error, RIC_ENUMERIC, "%s at t = %g: %s", ric_run_outcome_name(run.outcome), run.time, run.reason);
  keep_state(r, r->trajectory->flow, x, columns, d);
  return RIC_OK;
}

ric_status arc_runner_move(arc_runner *r, double from, double to, double *x, size_t columns, double *d,
                           const arc_watch *watcher, ric_error *error) {
  if (!(from < INFINITY && from > -INFINITY && to < INFINITY && to > -INFINITY))
    return ric_fail(error, RIC_ENUMERIC, "an arc from t = %g to %g", from, to);
  return r->flow ? flow_along(r, from, to, x, columns, d, watcher, error)
                 : run_along(r, from, to, x, columns, d, watcher, error);
}

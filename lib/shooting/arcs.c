/* Arcs of a motion between impacts: indices of their unknowns, and the integration of one. */
#include "arcs.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "impact/trajectory.h"

enum { MOST_PIECES = 10000 };

static ric_status check_obstacle(const ric_system *s, const char *where, size_t obstacle, ric_error *error) {
  if (obstacle >= s->obstacle_count)
    return ric_fail(error, RIC_EINVAL, "%s names obstacle %zu, expected one below %zu", where, obstacle,
                    s->obstacle_count);
  if (system_complies(s, obstacle))
    return ric_fail(error, RIC_EINVAL, "%s names obstacle %zu, which is compliant, expected a rigid one", where,
                    obstacle);
  return RIC_OK;
}

static ric_status check_sequence(const ric_system *s, const ric_shooting_problem *p, ric_error *error) {
  for (size_t i = 0; i < p->count; i++)
    RIC_TRY(check_obstacle(s, "sequence", p->sequence[i], error));
  return RIC_OK;
}

static ric_status check_problem(const ric_system *s, const ric_shooting_problem *p, ric_error *error) {
  bool even = p->kind == RIC_MOTION_EVEN;
  if ((int)p->kind < RIC_MOTION_EVEN || p->kind > RIC_MOTION_CONSERVATIVE)
    return ric_fail(error, RIC_EINVAL, "kind = %d, expected even, forced, autonomous or conservative", (int)p->kind);
  if (p->energy_given && !even && p->kind != RIC_MOTION_CONSERVATIVE)
    return ric_fail(error, RIC_EINVAL,
                    "the energy is given, expected the period: only even and conservative motions "
                    "have families along their energy");
  if (p->pieces > MOST_PIECES)
    return ric_fail(error, RIC_EINVAL, "pieces = %zu, expected at most %d", p->pieces, MOST_PIECES);
  if (!even && p->start_count + p->half_count > 0)
    return ric_fail(error, RIC_EINVAL,
                    "impacts at t = 0 or T/2 of a motion that is not even: they belong to the "
                    "sequence");
  if (even && (!s->obstacles && s->obstacle_count > 0))
    return ric_fail(error, RIC_EINVAL, "an even motion needs obstacles at coordinates");
  if (even && (s->taylor == SYSTEM_USER || s->coordinates != s->speeds))
    return ric_fail(error, RIC_EINVAL, "an even motion needs a lattice or an M-C-K system");
  if (even && !s->uncoupled)
    return ric_fail(error, RIC_EINVAL, "an even motion needs a diagonal mass matrix");
  return check_sequence(s, p, error);
}

/* Sets the obstacle that each coordinate hits at an end of the half period. */
static ric_status set_hits(const ric_system *s, const char *where, const size_t *obstacles, size_t count,
                           size_t *of_coordinate, ric_error *error) {
  for (size_t i = 0; i < s->coordinates; i++)
    of_coordinate[i] = NO_UNKNOWN;
  for (size_t k = 0; k < count; k++) {
    RIC_TRY(check_obstacle(s, where, obstacles[k], error));
    size_t i = s->obstacles[obstacles[k]].coordinate;
    if (of_coordinate[i] != NO_UNKNOWN)
      return ric_fail(error, RIC_EINVAL, "%s: coordinate %zu hits obstacle %zu and obstacle %zu at one time", where, i,
                      of_coordinate[i], obstacles[k]);
    of_coordinate[i] = obstacles[k];
  }
  return RIC_OK;
}

static ric_status allocate_plan(arc_plan *a, const ric_shooting_problem *p, size_t arcs, size_t cuts,
                                ric_error *error) {
  a->pieces = calloc(arcs * cuts, sizeof *a->pieces);
  a->impacts = calloc(p->count + 1, sizeof *a->impacts);
  a->sequence = calloc(p->count + 1, sizeof *a->sequence);
  a->at_start = calloc(2 * a->coordinates, sizeof *a->at_start);
  if (!a->pieces || !a->impacts || !a->sequence || !a->at_start)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu arcs", arcs);
  a->at_half = a->at_start + a->coordinates;
  if (p->count > 0)
    memcpy(a->sequence, p->sequence, p->count * sizeof *a->sequence);
  return RIC_OK;
}

size_t arcs_first_numbers(const arc_plan *a) {
  return a->kind == RIC_MOTION_EVEN ? a->coordinates : a->size;
}

/* Indices of the unknowns after the states: times, the period, lambda. */
static void place_unknowns(arc_plan *a) {
  bool even = a->kind == RIC_MOTION_EVEN, fixed_origin = !even && a->kind != RIC_MOTION_FORCED;
  size_t next = arcs_first_numbers(a) + (a->count - 1) * a->size;
  for (size_t k = 0; k < a->sequence_count; k++)
    a->impacts[k] = (event_time){fixed_origin && k == 0 ? NO_UNKNOWN : next++, 0};
  a->period = a->energy_given || a->kind == RIC_MOTION_AUTONOMOUS ? next++ : NO_UNKNOWN;
  a->lambda = a->kind == RIC_MOTION_CONSERVATIVE ? next++ : NO_UNKNOWN;
  a->unknowns = next;
}

/* Beginning and end of an arc. */
static void arc_times(const arc_plan *a, size_t arc, event_time *begin, event_time *end) {
  static const event_time zero = {NO_UNKNOWN, 0}, half = {NO_UNKNOWN, 0.5}, whole = {NO_UNKNOWN, 1};
  size_t K = a->sequence_count;
  if (a->kind == RIC_MOTION_EVEN) {
    *begin = arc == 0 ? zero : a->impacts[arc - 1];
    *end = arc == K ? half : a->impacts[arc];
  } else if (K == 0) {
    *begin = zero;
    *end = whole;
  } else {
    *begin = a->impacts[arc];
    *end = a->impacts[(arc + 1) % K];
    end->of_period = arc + 1 == K ? 1 : 0;
  }
}

static piece_end end_of_arc(const arc_plan *a, size_t arc) {
  if (a->kind == RIC_MOTION_EVEN)
    return arc == a->sequence_count ? PIECE_HALF : PIECE_IMPACT;
  return a->sequence_count > 0 ? PIECE_IMPACT : PIECE_CUT;
}

/* The obstacle at the end of an arc that ends with an impact. */
static size_t obstacle_of_arc(const arc_plan *a, size_t arc) {
  return a->kind == RIC_MOTION_EVEN ? a->sequence[arc] : a->sequence[(arc + 1) % a->sequence_count];
}

static size_t rows_of(const arc_plan *a, const arc_piece *p) {
  return p->how == PIECE_HALF ? a->coordinates : a->size + (p->how == PIECE_IMPACT ? 1 : 0);
}

static void lay_out_plan(arc_plan *a, size_t arc_count, size_t cuts) {
  size_t state = 0, row = 0;
  for (size_t k = 0; k < arc_count * cuts; k++) {
    arc_piece *p = &a->pieces[k];
    size_t arc = k / cuts, part = k % cuts;
    arc_times(a, arc, &p->begin, &p->end);
    p->from = (double)part / (double)cuts;
    p->to = (double)(part + 1) / (double)cuts;
    p->how = part + 1 == cuts ? end_of_arc(a, arc) : PIECE_CUT;
    p->obstacle = p->how == PIECE_IMPACT ? obstacle_of_arc(a, arc) : NO_UNKNOWN;
    p->closes = a->kind != RIC_MOTION_EVEN && k + 1 == arc_count * cuts;
    p->state = state;
    p->row = row;
    state += k == 0 ? arcs_first_numbers(a) : a->size;
    row += rows_of(a, p);
  }
  bool fixed_origin = a->kind == RIC_MOTION_AUTONOMOUS || a->kind == RIC_MOTION_CONSERVATIVE;
  a->phase_row = fixed_origin && a->sequence_count == 0 ? row++ : NO_UNKNOWN;
  a->energy_row = a->energy_given ? row++ : NO_UNKNOWN;
}

ric_status arcs_init(arc_plan *a, const ric_system *system, const ric_shooting_problem *problem, ric_error *error) {
  size_t n = system->coordinates, m = system->speeds, cuts = problem->pieces ? problem->pieces : 1;
  *a = (arc_plan){.coordinates = n,
                  .speeds = m,
                  .size = n + m,
                  .kind = problem->kind,
                  .energy_given = problem->energy_given,
                  .sequence_count = problem->count,
                  .start_count = problem->start_count,
                  .half_count = problem->half_count};
  RIC_TRY(check_problem(system, problem, error));
  bool even = a->kind == RIC_MOTION_EVEN;
  size_t arc_count = even ? problem->count + 1 : problem->count > 0 ? problem->count : 1;
  RIC_TRY(allocate_plan(a, problem, arc_count, cuts, error));
  a->count = arc_count * cuts;
  a->arc_count = arc_count;
  if (even) {
    RIC_TRY(set_hits(system, "at_start", problem->at_start, problem->start_count, a->at_start, error));
    RIC_TRY(set_hits(system, "at_half", problem->at_half, problem->half_count, a->at_half, error));
  }
  place_unknowns(a);
  lay_out_plan(a, arc_count, cuts);
  return RIC_OK;
}

void arcs_clear(arc_plan *a) {
  free(a->pieces);
  free(a->impacts);
  free(a->sequence);
  free(a->at_start);
  *a = (arc_plan){0};
}

double arcs_period(const arc_plan *a, const double *z, double given) {
  return a->period == NO_UNKNOWN ? given : z[a->period];
}

double arcs_time(event_time e, const double *z, double period) {
  return (e.index == NO_UNKNOWN ? 0 : z[e.index]) + e.of_period * period;
}

static double time_within(const arc_piece *p, double part, const double *z, double period) {
  double begin = arcs_time(p->begin, z, period), end = arcs_time(p->end, z, period);
  return part == 0 ? begin : part == 1 ? end : begin + part * (end - begin);
}

double piece_begin(const arc_piece *p, const double *z, double period) {
  return time_within(p, p->from, z, period);
}

double piece_finish(const arc_piece *p, const double *z, double period) {
  return time_within(p, p->to, z, period);
}

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

static void copy_state(const arc_runner *r, const ric_flow *flow, double *x, size_t columns, double *d) {
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

static void report_segments(ric_flow *flow, const arc_watch *watcher) {
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

static ric_status run_flow(arc_runner *r, double from, double to, double *x, size_t columns, double *d,
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
    report_segments(r->flow, watcher);
    ric_flow_accept(r->flow, 1);
  }
  copy_state(r, r->flow, x, columns, d);
  return RIC_OK;
}

static ric_status run_trajectory(arc_runner *r, double from, double to, double *x, size_t columns, double *d,
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
  copy_state(r, r->trajectory->flow, x, columns, d);
  return RIC_OK;
}

ric_status arc_runner_move(arc_runner *r, double from, double to, double *x, size_t columns, double *d,
                           const arc_watch *watcher, ric_error *error) {
  if (!(from < INFINITY && from > -INFINITY && to < INFINITY && to > -INFINITY))
    return ric_fail(error, RIC_ENUMERIC, "an arc from t = %g to %g, expected finite times", from, to);
  return r->flow ? run_flow(r, from, to, x, columns, d, watcher, error)
                 : run_trajectory(r, from, to, x, columns, d, watcher, error);
}

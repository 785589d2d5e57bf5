/* Windows of periodic motions along a parameter: the motion of a run, shooting, and what ends the window. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/family.h"
#include "ricochet/motion_window.h"
#include "numeric/required.h"

/* The data that shooting needs of a forced motion on its attractor. */

/** A motion over its period. */
typedef struct motion_record {
  size_t count;     /* impacts */
  size_t *sequence; /* [count] their obstacles */
  double *times;    /* [count] increasing, the first one in [0, period) */
  double *q, *u;    /* [n], [m] after the first impact; without impacts at t = 0 */
} motion_record;

/* Data of the observer of a run. */
typedef struct impact_recorder {
  motion_record *record;
  size_t impacts;
  bool records;       /* records the impacts, else only counts them */
  bool ends_at_first; /* ends the run at the first impact */
  const char *what;   /* an event that rules out shooting, and its time; NULL: none */
  double when;
} impact_recorder;

static int on_event(const ric_event *event, void *user) {
  impact_recorder *l = user;
  if (event->kind == RIC_EVENT_CHATTER || event->kind == RIC_EVENT_REST || event->kind == RIC_EVENT_RELEASE) {
    l->what = ric_event_name(event->kind);
    l->when = event->time;
    return 1;
  }
  if (!ric_event_jumps(event))
    return 0;
  if (l->records) {
    l->record->sequence[l->impacts] = event->obstacle;
    l->record->times[l->impacts] = event->time;
  }
  l->impacts++;
  return l->ends_at_first;
}

static ric_status run_to(ric_trajectory *trajectory, double end, impact_recorder *l, ric_error *error) {
  const ric_observer observer = {.event = on_event, .user = l};
  ric_run run;
  RIC_TRY(ric_trajectory_run(trajectory, end, &observer, &run, error));
  if (l->what)
    return ric_fail(error, RIC_ENUMERIC, "%s at t = %.9g: expected a motion with isolated impacts", l->what, l->when);
  if (run.outcome == RIC_RUN_COMPLETED || (run.outcome == RIC_RUN_ENDED && l->ends_at_first))
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "the motion stops at t = %.9g: %s %.150s", run.time,
                  ric_run_outcome_name(run.outcome), run.reason);
}

static void copy_state(motion_record *record, const ric_trajectory *trajectory, const ric_system *system) {
  memcpy(record->q, ric_trajectory_q(trajectory), ric_system_coordinates(system) * sizeof *record->q);
  if (ric_system_speeds(system) > 0)
    memcpy(record->u, ric_trajectory_u(trajectory), ric_system_speeds(system) * sizeof *record->u);
}

static ric_status allocate_record(motion_record *record, const ric_system *system, ric_error *error) {
  record->sequence = calloc(record->count + 1, sizeof *record->sequence);
  record->times = calloc(record->count + 1, sizeof *record->times);
  record->q = calloc(ric_system_coordinates(system), sizeof *record->q);
  record->u = calloc(ric_system_speeds(system) + 1, sizeof *record->u);
  if (record->sequence && record->times && record->q && record->u)
    return RIC_OK;
  return ric_fail(error, RIC_ENOMEM, "no memory for a motion with %zu impacts", record->count);
}

/* Shifts times so that the first impact is in the first period. */
static void fold_times(motion_record *record, double period) {
  const double origin = floor(record->times[0] / period) * period;
  for (size_t k = 0; k < record->count; k++)
    record->times[k] -= origin;
}

/* Counts the impacts in one run and records them in another: both runs are identical. */
static ric_status record_motion(motion_record *record, ric_trajectory *trajectory, const ric_system *system,
                                double period, double t, const double *q, const double *u, ric_error *error) {
  impact_recorder counter = {.record = record}, writer = {.record = record, .records = true, .ends_at_first = true};
  RIC_TRY(ric_trajectory_start(trajectory, t, q, u, error));
  RIC_TRY(run_to(trajectory, t + period, &counter, error));
  record->count = counter.impacts;
  RIC_TRY(allocate_record(record, system, error));
  RIC_TRY(ric_trajectory_start(trajectory, t, q, u, error));
  if (record->count == 0) {
    RIC_TRY(run_to(trajectory, ceil(t / period) * period, &counter, error));
    copy_state(record, trajectory, system);
    return RIC_OK;
  }
  RIC_TRY(run_to(trajectory, t + period, &writer, error));
  copy_state(record, trajectory, system);
  writer.ends_at_first = false;
  RIC_TRY(run_to(trajectory, t + period, &writer, error));
  fold_times(record, period);
  return RIC_OK;
}

/** Integrates it from (t, q, u) over a period.
 *  @param motion  options of the flow and the poll of its runs
 *  @returns RIC_ENUMERIC for a run that fails, for chatter and sticking; as ric_trajectory_create, _start, _run;
 *  RIC_ENOMEM; always to be cleared */
static ric_status motion_record_run(motion_record *record, const ric_system *system, const ric_shooting_problem *motion,
                                    double period, double t, const double *q, const double *u, ric_error *error) {
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_trajectory *trajectory = NULL;
  *record = (motion_record){0};
  options.flow = motion->flow;
  options.poll = motion->poll;
  RIC_TRY(ric_trajectory_create(system, &options, &trajectory, error));
  ric_status status = record_motion(record, trajectory, system, period, t, q, u, error);
  ric_trajectory_destroy(&trajectory);
  return status;
}

static void motion_record_clear(motion_record *record) {
  free(record->sequence);
  free(record->times);
  free(record->q);
  free(record->u);
  *record = (motion_record){0};
}

enum { MOST_TRIES = 5 };

/* If a continuation run has passed the end of the window without a special point, its last step is repeated, shorter
 * by this factor. */
static const double shorter = 0.25;

/* A motion of a shorter period returns within it, over the largest number of its states. */
static const double same = 1e-8;

/* Special points are located to this accuracy, relative to p. */
static const double locate_tol = 1e-12;

/* The family, with the parameter p / scale: lengths of its curve are then relative to p. */
typedef struct search {
  const ric_family_problem *problem; /* of the caller */
  double scale, p, low, high;
  size_t periods;
  ric_family_problem scaled;
  ric_family_options options;
  motion_record record;
  size_t unknowns;
  double *z, *last; /* [unknowns] the motion at p, and the last stable one of the run */
  double last_at;   /* parameter of the latter, over the scale */
  ric_motion_window window;
} search;

static ric_status set_scaled(ric_system *system, const double *parameters, double *given, void *user,
                             ric_error *error) {
  const search *s = user;
  const double p[2] = {parameters[0] * s->scale, s->problem->second};
  if (s->problem->set)
    return s->problem->set(system, p, given, s->problem->user, error);
  *given = p[0];
  return RIC_OK;
}

/* --- the motion --------------------------------------------------------------------------------------------------- */

static ric_status check_window(const ric_family_problem *problem, size_t periods, double p, double low, double high,
                               double t, ric_error *error) {
  REQUIRE(error, {"system", problem->system});
  if (problem->motion.kind != RIC_MOTION_FORCED)
    return ric_fail(error, RIC_EINVAL, "motion.kind = %d, expected forced motions", (int)problem->motion.kind);
  if (periods < 1)
    return ric_fail(error, RIC_EINVAL, "periods = 0, expected at least 1");
  if (!isfinite(p))
    return ric_fail(error, RIC_EINVAL, "p = %g, expected a finite number", p);
  if (!(low < p))
    return ric_fail(error, RIC_EINVAL, "low = %.9g, expected less than p = %.9g", low, p);
  if (!(high > p))
    return ric_fail(error, RIC_EINVAL, "high = %.9g, expected more than p = %.9g", high, p);
  if (!isfinite(t))
    return ric_fail(error, RIC_EINVAL, "t = %g, expected a finite number", t);
  return RIC_OK;
}

static void set_up(search *s, const ric_family_options *options) {
  s->scale = s->p != 0 ? fabs(s->p) : fmin(1, s->high - s->low);
  s->scaled = *s->problem;
  s->scaled.set = set_scaled;
  s->scaled.user = s;
  s->scaled.parameters = 1;
  s->scaled.periods = s->periods;
  s->options = options ? *options : ric_family_options_default();
  if (!options) {
    s->options.curve.step = 1e-3;
    s->options.curve.locate_tol = locate_tol;
    s->options.curve.poll = s->problem->motion.poll;
  }
  s->options.multipliers = true;
}

/* The period of the forcing times the number of periods. */
static ric_status find_period(search *s, double *period, ric_error *error) {
  const double at = s->p / s->scale;
  double given = s->problem->given;
  RIC_TRY(set_scaled(s->problem->system, &at, &given, s, error));
  *period = given * (double)s->periods;
  if (!(*period > 0 && isfinite(*period)))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected a finite number > 0", given);
  return RIC_OK;
}

static double distance(const double *a, const double *b, size_t count, double *largest) {
  double most = 0;
  for (size_t i = 0; i < count; i++) {
    most = fmax(most, fabs(a[i] - b[i]));
    *largest = fmax(*largest, fabs(a[i]));
  }
  return most;
}

/* The multipliers of a motion traversed several times are powers of its own, and the end of its window would get a
 * wrong kind. The states compared are half a forcing period after the first one, which may be at an impact. */
static ric_status check_least(const search *s, ric_shooting *shooting, double period, ric_error *error) {
  const size_t n = ric_system_coordinates(s->problem->system), m = ric_system_speeds(s->problem->system);
  const size_t count = 2 * s->periods + 1;
  double *q = calloc(count * (n + m), sizeof *q), *u = q ? q + count * n : NULL;
  size_t least = s->periods;
  if (!q)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu states", count);
  ric_status status = ric_shooting_states(shooting, s->z, period, count, q, m > 0 ? u : NULL, error);
  for (size_t part = 1; part < least && status == RIC_OK; part++) {
    const size_t k = 1 + 2 * part;
    double largest = 0;
    const double apart = fmax(distance(q + n, q + k * n, n, &largest), distance(u + m, u + k * m, m, &largest));
    if (s->periods % part == 0 && apart <= same * largest)
      least = part;
  }
  free(q);
  if (status == RIC_OK && least < s->periods)
    return ric_fail(error, RIC_EINVAL, "periods = %zu: the motion at p = %.9g repeats after %zu", s->periods, s->p,
                    least);
  return status;
}

/* Solves the equations of shooting. */
static ric_status find_motion(search *s, double period, ric_error *error) {
  const motion_record *r = &s->record;
  ric_family *family = NULL;
  RIC_TRY(ric_family_create(&s->scaled, &s->options, &family, error));
  s->unknowns = ric_shooting_unknowns(ric_family_shooting(family));
  s->z = calloc(2 * s->unknowns, sizeof *s->z);
  s->last = s->z ? s->z + s->unknowns : NULL;
  ric_status status = s->z ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for a motion of %zu impacts", r->count);
  if (status == RIC_OK)
    status = ric_family_start(family, s->p / s->scale, r->q, r->u, r->times, period, s->z, NULL, error);
  if (status == RIC_OK && s->periods > 1)
    status = check_least(s, ric_family_shooting(family), period, error);
  ric_family_destroy(&family);
  return status;
}

/* --- its edges ---------------------------------------------------------------------------------------------------- */

typedef struct edge_search {
  search *s;
  ric_motion_edge edge;
  bool begun, again, found, late; /* again: from a later point of the run */
} edge_search;

static bool ends_window(ric_family_kind kind) {
  switch (kind) {
  case RIC_FAMILY_FOLD:
  case RIC_FAMILY_BRANCH_POINT:
  case RIC_FAMILY_PERIOD_DOUBLING:
  case RIC_FAMILY_TORUS:
  case RIC_FAMILY_GRAZING:
  case RIC_FAMILY_IMPACT_LOST:
  case RIC_FAMILY_IMPULSE_SIGN:
  case RIC_FAMILY_ORDER:
    return true;
  default:
    return false;
  }
}

static bool is_stable(const ric_family_point *point) {
  return point->orbit->outcome == RIC_ADMISSIBLE && point->multipliers->stable == RIC_STABLE;
}

/* Whether a special point is beyond the end of the window: a multiplier had left the unit circle before it, and its
 * test function did not change sign. Where an impact is lost multipliers are infinite. */
static bool is_beyond_edge(const ric_family_point *point) {
  switch (point->kind) {
  case RIC_FAMILY_REGULAR:
    return point->orbit->outcome == RIC_INADMISSIBLE || point->multipliers->stable == RIC_UNSTABLE;
  case RIC_FAMILY_IMPACT_LOST:
  case RIC_FAMILY_IMPULSE_SIGN:
    return true;
  default:
    return ends_window(point->kind) &&
           point->multipliers->real_above + point->multipliers->real_below + point->multipliers->complex_outside > 0;
  }
}

static int check_start(edge_search *w, const ric_family_point *point) {
  ric_motion_window *window = &w->s->window;
  w->begun = true;
  window->stable = is_stable(point);
  window->largest = point->multipliers->count > 0 ? point->multipliers->mu[0] : (ric_complex){NAN, NAN};
  if (!window->stable)
    snprintf(w->edge.reason, sizeof w->edge.reason, "%s, %s", ric_outcome_name(point->orbit->outcome),
             ric_stability_name(point->multipliers->stable));
  return !window->stable;
}

/* At later points, next to an edge, the verdict may be undecided. */
static int visit_point(const ric_family_point *point, void *user) {
  edge_search *w = user;
  search *s = w->s;
  w->edge = (ric_motion_edge){.kind = point->kind, .p = point->parameter * s->scale};
  if (!w->begun && !w->again)
    return check_start(w, point);
  if (point->kind == RIC_FAMILY_REGULAR && is_stable(point)) {
    memcpy(s->last, point->z, s->unknowns * sizeof *s->last);
    s->last_at = point->parameter;
  }
  w->found = ends_window(point->kind);
  w->late = is_beyond_edge(point);
  return w->found || w->late;
}

/* Follows the family from the last stable motion. */
static ric_status follow_edge(search *s, edge_search *w, const ric_family_options *options, ric_error *error) {
  ric_family *family = NULL;
  ric_curve_run run;
  w->found = w->late = false;
  RIC_TRY(ric_family_create(&s->scaled, options, &family, error));
  ric_status status = ric_family_follow(family, s->last, s->last_at, NULL, visit_point, w, &run, error);
  ric_family_destroy(&family);
  RIC_TRY(status);
  if (!s->window.stable)
    return ric_fail(error, RIC_ENUMERIC, "the motion at p = %.9g is not a stable one: %s", s->p, w->edge.reason);
  if (w->late)
    snprintf(w->edge.reason, sizeof w->edge.reason, "multipliers may have left the unit circle before");
  else if (!w->found && run.end != RIC_CURVE_BOUND)
    snprintf(w->edge.reason, sizeof w->edge.reason, "%s%s%.80s", ric_curve_end_name(run.end), run.reason[0] ? ": " : "",
             run.reason);
  if (!w->found)
    w->edge.kind = RIC_FAMILY_REGULAR;
  return RIC_OK;
}

/* If the end may have been passed, as zeros of a test function in pairs are, the last step is repeated, shorter. */
static ric_status find_edge(search *s, double direction, ric_motion_edge *edge, ric_error *error) {
  ric_family_options options = s->options;
  edge_search w = {.s = s};
  memcpy(s->last, s->z, s->unknowns * sizeof *s->z);
  s->last_at = s->p / s->scale;
  options.curve.direction = direction;
  options.curve.p_low = s->low / s->scale;
  options.curve.p_high = s->high / s->scale;
  for (int k = 0; k < MOST_TRIES && (k == 0 || w.late); k++) {
    RIC_TRY(follow_edge(s, &w, &options, error));
    w.again = true;
    options.curve.step_most *= shorter;
    options.curve.step = fmin(options.curve.step, options.curve.step_most);
  }
  *edge = w.edge;
  return RIC_OK;
}

/* --- windows ------------------------------------------------------------------------------------------------------ */

static ric_status find_window(search *s, double t, const double *q, const double *u, ric_error *error) {
  double period;
  RIC_TRY(find_period(s, &period, error));
  RIC_TRY(motion_record_run(&s->record, s->problem->system, &s->problem->motion, period, t, q, u, error));
  s->scaled.motion.sequence = s->record.sequence;
  s->scaled.motion.count = s->record.count;
  s->window = (ric_motion_window){.periods = s->periods, .impacts = s->record.count, .p = s->p};
  RIC_TRY(find_motion(s, period, error));
  RIC_TRY(find_edge(s, -1, &s->window.low, error));
  return find_edge(s, 1, &s->window.high, error);
}

ric_status ric_motion_window_find(const ric_family_problem *problem, size_t periods, double p, double low, double high,
                                  double t, const double *q, const double *u, const ric_family_options *options,
                                  ric_motion_window *window, ric_error *error) {
  REQUIRE(error, {"problem", problem}, {"q", q}, {"window", window});
  search s = {.problem = problem, .periods = periods, .p = p, .low = low, .high = high};
  RIC_TRY(check_window(problem, periods, p, low, high, t, error));
  set_up(&s, options);
  ric_status status = find_window(&s, t, q, u, error);
  if (status == RIC_OK)
    *window = s.window;
  motion_record_clear(&s.record);
  free(s.z);
  return status;
}

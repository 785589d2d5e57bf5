#include "walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kind/family/curve_trace.h"

/* --- curves in two parameters --- */

/* The special point that a curve goes through. */
typedef struct curve_origin {
  ric_family *family;
  const ric_family_point *point;
} curve_origin;

/* Whether the study wants curves through special points of this kind. */
static bool is_traced(const branch_family *b, ric_family_kind what) {
  const char *words = KEY_BRANCH_TRACE_KINDS->words, *name = ric_family_kind_name(what);
  const long place = schema_find_word(name, strlen(name), words);
  for (size_t i = 0; b->traced && i < value_count(b->values, KEY_BRANCH_TRACE_KINDS); i++)
    if (value_number(b->values, KEY_BRANCH_TRACE_KINDS, i) == (double)place)
      return true;
  return false;
}

static int add_curve_point(const ric_family_curve_point *point, void *user) {
  curve_trace *t = user;
  branch_curve_point found = {
      .energy = point->orbit->energy, .outcome = (int)point->orbit->outcome, .iterations = point->iterations};
  return curve_trace_add(t, point->parameter, point->second, point->orbit->period, &found.common);
}

static ric_status follow_curve(curve_trace *t, const ric_curve_options *options, void *user, ric_curve_run *run,
                               ric_error *error) {
  const curve_origin *from = user;
  return ric_family_trace(from->family, from->point, options, NULL, add_curve_point, t, run, error);
}

/* The curve through a special point, both ways. @returns RIC_OK, RIC_ESTOPPED or RIC_ENOMEM */
static ric_status trace_curve(branch_family *b, ric_family *family, const ric_family_point *point, long long special,
                              const kind_plan *plan, records *tails, branch_result *result) {
  curve_origin from = {family, point};
  curve_trace t = {.b = b,
                   .layout = &plan->tails[BRANCH_CURVES].records,
                   .end_layout = &plan->tails[BRANCH_CURVE_ENDS].records,
                   .points = &tails[BRANCH_CURVES],
                   .ends = &tails[BRANCH_CURVE_ENDS],
                   .special = special};
  const ric_status status = curve_trace_follow(&t, follow_curve, &from);
  result->iterations += t.iterations;
  result->jacobians += t.jacobians;
  return status;
}

/* Families meet at one point, which both may find: it is gone over once. Its numbers agree to this, relative to 1. */
static const double same_point = 1e-6;

/* A segment that waits to be followed, or was. */
typedef struct segment {
  branch_origin origin;
  long long special; /* of the task, at which it begins */
  ric_family *family;
  bool owned; /* the family is another one than that of the start */
  double *z, *tangent;
  double parameter;
  ric_status status; /* of what led there */
  char reason[CURVE_REASON_BYTES];
} segment;

/* Where families met. */
typedef struct meeting {
  double parameter, period, energy;
} meeting;

typedef struct walk {
  branch_family *b;
  const kind_plan *plan;
  records *tails;
  bool even, states, crosses, switches;
  segment *segments; /* [most] */
  meeting *meetings; /* [most] */
  size_t count, most, met;
  size_t current;
  size_t points, specials; /* of the task */
  branch_result *result;
  ric_status status; /* of the callback: RIC_OK, RIC_ENOMEM, RIC_ESTOPPED */
} walk;

static void keep_reason(char *to, const char *reason) {
  snprintf(to, CURVE_REASON_BYTES, "%.*s", CURVE_REASON_BYTES - 1, reason);
}

/* A new record of a tail; NULL, and the walk ends, when there is no memory. */
static unsigned char *add_record(walk *w, size_t which) {
  unsigned char *record = records_add(&w->tails[which]);
  if (!record)
    w->status = RIC_ENOMEM;
  return record;
}

/* --- points --- */

/* The impacts of a motion; with its first state they say all of it. @param at, special  -1: not that */
static void add_impacts(walk *w, const ric_orbit *o, long long at, long long special) {
  for (size_t k = 0; k < o->impacts; k++) {
    unsigned char *record = add_record(w, BRANCH_IMPACTS);
    if (!record)
      return;
    const ric_obstacle *hit = &w->b->model.obstacles[o->impact_obstacle[k]];
    row_store(&w->plan->tails[BRANCH_IMPACTS].records, record,
              &(branch_impact){.point = at,
                               .special = special,
                               .time = o->impact_time[k],
                               .particle = (long long)hit->coordinate,
                               .side = hit->side > 0 ? 0 : 1,
                               .gap_rate = o->gap_rate[k],
                               .impulse = o->impulse[k]});
  }
}

/* Largest displacement; NaN, and the walk may end, when the motion cannot be run once more. */
static double amplitude(walk *w, const ric_family_point *point) {
  double most = NAN;
  ric_shooting *shooting = ric_family_shooting(w->segments[w->current].family);
  const ric_status status = ric_shooting_amplitude(shooting, point->z, point->given, &most, NULL);
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    w->status = status;
  return status == RIC_OK ? most : NAN;
}

/* States over the period, in their places in the record; NaN where the motion cannot be run once more. */
static void fill_history(walk *w, const ric_family_point *point, const branch_point *to) {
  if (!to->history_q || !to->history_v)
    return;
  const size_t samples = (size_t)value_number(w->b->values, KEY_BRANCH_SAMPLES, 0);
  const ric_status status = ric_shooting_states(ric_family_shooting(w->segments[w->current].family), point->z,
                                                point->given, samples, to->history_q, to->history_v, NULL);
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    w->status = status;
}

/* All of them, in their places in the record; NaN where they are not known. */
static void fill_multipliers(const walk *w, const ric_multipliers *found, ric_complex *to) {
  for (size_t i = 0; to && i < 2 * w->b->model.lattice.particles; i++)
    to[i] = found && i < found->count ? found->mu[i] : (ric_complex){NAN, NAN};
}

static void add_point(walk *w, const ric_family_point *point) {
  const table *t = &w->plan->tails[BRANCH_POINTS].records;
  const ric_orbit *o = point->orbit;
  const ric_multipliers *m = point->multipliers;
  branch_point found = {0};
  unsigned char *record = add_record(w, BRANCH_POINTS);
  if (!record)
    return;
  row_load(t, record, &found);
  found.segment = (long long)w->current;
  found.parameter = branch_family_value(w->b, point->parameter);
  found.outcome = (int)o->outcome;
  found.energy = o->energy;
  found.period = o->period;
  found.amplitude = amplitude(w, point);
  found.multiplier_max = m ? m->largest : NAN;
  found.stable = m ? (int)m->stable : (int)RIC_STABILITY_UNKNOWN;
  found.clearance = o->clearance;
  found.arclength = point->arclength;
  found.iterations = point->iterations;
  found.residual = o->residual;
  found.q = o->q;
  found.v = o->v;
  fill_multipliers(w, m, found.multipliers);
  fill_history(w, point, &found);
  row_store(t, record, &found);
  if (w->states)
    add_impacts(w, o, (long long)w->points, -1);
  w->points++;
}

static void add_special(walk *w, const ric_family_point *point) {
  const ric_orbit *o = point->orbit;
  const bool any = point->obstacle < w->b->model.obstacle_count;
  unsigned char *record = add_record(w, BRANCH_SPECIAL);
  if (!record)
    return;
  const branch_special found = {.kind = (int)point->kind,
                                .segment = (long long)w->current,
                                .parameter = branch_family_value(w->b, point->parameter),
                                .point = (long long)w->points - 1,
                                .obstacle = any ? (long long)point->obstacle : -1,
                                .particle = any ? (long long)w->b->model.obstacles[point->obstacle].coordinate : -1,
                                .time = point->time,
                                .order = point->order,
                                .period = o->period,
                                .energy = o->energy,
                                .amplitude = amplitude(w, point),
                                .clearance = o->clearance,
                                .multiplier_max = point->multipliers ? point->multipliers->largest : NAN,
                                .arclength = point->arclength,
                                .q = o->q,
                                .v = o->v};
  row_store(&w->plan->tails[BRANCH_SPECIAL].records, record, &found);
  add_impacts(w, o, -1, (long long)w->specials);
  w->specials++;
}

/* --- further segments --- */

static bool is_near(double a, double b) {
  return fabs(a - b) <= same_point * (1 + fabs(b));
}

/* Whether families met here before; notes it. */
static bool was_met(walk *w, const ric_family_point *point) {
  const meeting m = {point->parameter, point->orbit->period, point->orbit->energy};
  for (size_t i = 0; i < w->met; i++)
    if (is_near(m.parameter, w->meetings[i].parameter) && is_near(m.period, w->meetings[i].period) &&
        is_near(m.energy, w->meetings[i].energy))
      return true;
  w->meetings[w->met++] = m;
  return false;
}

/* Notes that a segment begins at the special point just told. */
static segment *add_segment(walk *w, branch_origin origin, const ric_family_point *point) {
  segment *s = &w->segments[w->count++];
  *s = (segment){.origin = origin, .special = (long long)w->specials - 1, .parameter = point->parameter};
  return s;
}

static void keep_trouble(segment *s, ric_status status, const ric_error *error) {
  s->status = status;
  if (status != RIC_OK)
    keep_reason(s->reason, error->message);
}

/* The family on the other side, ready to be followed. */
typedef ric_status (*way_over)(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                               ric_error *error);

static void go_over(walk *w, branch_origin origin, const ric_family_point *point, way_over way) {
  ric_family_junction junction = {0};
  ric_error error = {0};
  const ric_status status = way(w->segments[w->current].family, point, &junction, &error);
  segment *s = add_segment(w, origin, point);
  keep_trouble(s, status, &error);
  if (status != RIC_OK) {
    ric_family_junction_clear(&junction);
    return;
  }
  s->family = junction.family;
  s->owned = true;
  s->z = junction.z;
  s->tangent = junction.tangent;
  s->parameter = junction.parameter;
}

static double *copied(const double *numbers, size_t count, double factor) {
  double *copy = malloc(count * sizeof *copy);
  for (size_t i = 0; copy && i < count; i++)
    copy[i] = factor * numbers[i];
  return copy;
}

/* Both halves of the branch that crosses here. */
static void switch_over(walk *w, const ric_family_point *point) {
  ric_error error = {0};
  ric_family *family = w->segments[w->current].family;
  double *other = calloc(point->unknowns + 1, sizeof *other);
  const ric_status status =
      other ? ric_family_switch(family, point->z, point->parameter, point->tangent, other, &error) : RIC_ENOMEM;
  for (int side = +1; side >= -1 && w->count < w->most; side -= 2) {
    segment *s = add_segment(w, BRANCH_FROM_BRANCH_POINT, point);
    keep_trouble(s, status, &error);
    if (status != RIC_OK)
      break;
    s->family = family;
    s->z = copied(point->z, point->unknowns, 1);
    s->tangent = copied(other, point->unknowns + 1, side);
  }
  free(other);
}

static void look_further(walk *w, const ric_family_point *point) {
  const ric_family_kind what = point->kind;
  const bool crosses = w->crosses && (what == RIC_FAMILY_GRAZING || what == RIC_FAMILY_IMPACT_LOST);
  const bool doubles = what == RIC_FAMILY_PERIOD_DOUBLING && !w->even; /* of even motions both halves change */
  const bool switches = w->switches && (what == RIC_FAMILY_BRANCH_POINT || doubles);
  if (w->count >= w->most || !(crosses || switches) || was_met(w, point))
    return;
  if (what == RIC_FAMILY_BRANCH_POINT)
    switch_over(w, point);
  else if (what == RIC_FAMILY_PERIOD_DOUBLING)
    go_over(w, BRANCH_FROM_PERIOD_DOUBLING, point, ric_family_double);
  else
    go_over(w, what == RIC_FAMILY_GRAZING ? BRANCH_FROM_GRAZING : BRANCH_FROM_IMPACT_LOST, point, ric_family_cross);
}

static void trace(walk *w, const ric_family_point *point) {
  if (w->status == RIC_OK && is_traced(w->b, point->kind))
    w->status = trace_curve(w->b, w->segments[w->current].family, point, (long long)w->specials - 1, w->plan, w->tails,
                            w->result);
}

static int see(const ric_family_point *point, void *user) {
  walk *w = user;
  if (point->kind == RIC_FAMILY_REGULAR)
    add_point(w, point);
  else {
    add_special(w, point);
    look_further(w, point);
    trace(w, point);
  }
  return w->status != RIC_OK;
}

/* --- segments --- */

static void put_segment(walk *w, const segment *s, int outcome, const char *reason, size_t missed) {
  unsigned char *record = add_record(w, BRANCH_SEGMENTS);
  if (!record)
    return;
  row_store(
      &w->plan->tails[BRANCH_SEGMENTS].records, record,
      &(branch_segment){.origin = (int)s->origin,
                        .special = s->special,
                        .outcome = outcome,
                        .reason = reason,
                        .impacts = s->family ? (long long)ric_shooting_impacts(ric_family_shooting(s->family)) : 0,
                        .missed = (long long)missed});
}

ric_status branch_put_unborn(const kind_plan *plan, records *tails, int outcome, const char *reason) {
  walk w = {.plan = plan, .tails = tails};
  const segment s = {.origin = BRANCH_FROM_START, .special = -1};
  put_segment(&w, &s, outcome, reason, 0);
  return w.status;
}

/* Along one segment, whose z is a point of it. @returns RIC_OK, RIC_ESTOPPED or RIC_ENOMEM */
static ric_status follow(walk *w, segment *s, branch_result *result) {
  ric_error error = {0};
  ric_curve_run run = {0};
  ric_status status = s->status;
  const char *reason = s->reason;
  if (status == RIC_OK) {
    status = s->z && (s->tangent || s->origin == BRANCH_FROM_START)
                 ? ric_family_follow(s->family, s->z, s->parameter, s->tangent, see, w, &run, &error)
                 : RIC_ENOMEM;
    reason = status == RIC_OK ? run.reason : error.message;
  }
  if (w->status != RIC_OK || status == RIC_ENOMEM || status == RIC_ESTOPPED)
    return w->status != RIC_OK ? w->status : status;
  const int outcome = status == RIC_OK ? (int)run.end : CURVE_FAILED_START;
  put_segment(w, s, outcome, reason, run.missed);
  result->iterations += run.iterations;
  result->jacobians += run.jacobians;
  if (s->origin == BRANCH_FROM_START) {
    result->outcome = outcome;
    keep_reason(result->reason, reason);
  }
  return w->status;
}

static ric_status follow_all(walk *w, const branch_guess *guess, branch_result *result) {
  segment *first = &w->segments[w->count++];
  ric_error error = {0};
  int iterations = 0;
  *first = (segment){.origin = BRANCH_FROM_START, .special = -1, .family = w->b->family};
  first->z = calloc(ric_shooting_unknowns(ric_family_shooting(first->family)), sizeof *first->z);
  if (!first->z)
    return RIC_ENOMEM;
  const ric_status started = branch_guess_solve(guess, w->b, first->z, &first->parameter, &iterations, &error);
  if (started == RIC_ESTOPPED)
    return started;
  keep_trouble(first, started, &error);
  result->iterations += (unsigned long long)iterations;
  ric_status status = RIC_OK;
  for (; w->current < w->count && status == RIC_OK; w->current++)
    status = follow(w, &w->segments[w->current], result);
  return status;
}

static void clear(walk *w) {
  for (size_t i = 0; i < w->count; i++) {
    if (w->segments[i].owned)
      ric_family_destroy(&w->segments[i].family);
    free(w->segments[i].z);
    free(w->segments[i].tangent);
  }
  free(w->segments);
  free(w->meetings);
}

ric_status branch_walk(branch_family *b, const branch_guess *guess, const kind_plan *plan, records *tails,
                       branch_result *result) {
  walk w = {.b = b,
            .plan = plan,
            .tails = tails,
            .result = result,
            .even = strcmp(value_word(b->values, KEY_ORBIT_MOTION), "even") == 0,
            .states = value_flag(b->values, KEY_BRANCH_STATES),
            .crosses = value_flag(b->values, KEY_BRANCH_CROSS),
            .switches = value_flag(b->values, KEY_BRANCH_SWITCH),
            .most = (size_t)value_number(b->values, KEY_BRANCH_SEGMENTS, 0)};
  w.segments = calloc(w.most, sizeof *w.segments);
  w.meetings = calloc(w.most, sizeof *w.meetings);
  const ric_status status = w.segments && w.meetings ? follow_all(&w, guess, result) : RIC_ENOMEM;
  result->points = w.points;
  result->segments = w.count;
  clear(&w);
  return status;
}

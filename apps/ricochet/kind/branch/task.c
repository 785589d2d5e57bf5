/* kind: branch. A family of periodic motions along one parameter, at every grid point of the others; if the study asks
 * for them, the families that begin at its special points, and curves of special points in two parameters. */
#include "branch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kind/family/curve_trace.h"
#include "kind/family/family_task.h"
#include "kind/family/family_check.h"
#include "kind/machine.h"

struct worker {
  family_task task;
};

/* The rows of a task. */
typedef struct branch_rows {
  branch_family *b;
  const kind_plan *plan;
  records *tails; /* [plan->tail_count], with the records of earlier tasks before those of this one */
  bool states;    /* with the impacts of every point */
  int outcome;    /* of the first segment: ric_curve_end and beyond */
  char reason[CURVE_REASON_BYTES];
  size_t points, specials, segments; /* of the task */
  unsigned long long iterations, jacobians;
  ric_status status; /* RIC_OK, RIC_ENOMEM when records do not fit, RIC_ESTOPPED */
} branch_rows;

/* --- before the tasks --- */

static int refuse_multipliers(const study *s, const study_values *v, message *why) {
  char place[256];
  const double n = value_number(v, KEY_MODEL_PARTICLES, 0);
  if (strcmp(value_word(v, KEY_BRANCH_MULTIPLIERS), "false") == 0 || 2 * n <= RIC_FAMILY_NUMBERS)
    return 0;
  study_place(s, KEY_BRANCH_MULTIPLIERS, place, sizeof place);
  return refuse(why, EXIT_USAGE, "%s = %s with %.0f particles, expected at most %d (or false)", place,
                value_word(v, KEY_BRANCH_MULTIPLIERS), n, RIC_FAMILY_NUMBERS / 2);
}

static void branch_close(worker **w) {
  if (!w || !*w)
    return;
  family_task_clear(&(*w)->task);
  free(*w);
  *w = NULL;
}

static int branch_open(const study *s, ric_poll poll, worker **out, message *why) {
  worker *w = *out = calloc(1, sizeof *w);
  if (!w)
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  const int code = family_task_init(&w->task, s, poll, why);
  if (code)
    branch_close(out);
  return code;
}

static int branch_plan(const study *s, kind_plan *plan, message *why) {
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  *plan = (kind_plan){0};
  int code = refuse_multipliers(s, v, why);
  plan->memory = family_task_bytes(v);
  if (!code)
    code = machine_refuse_size(s, "a branch", plan->memory, why);
  if (!code)
    branch_lay_out(v, family_followed(s)->name, family_traced(s) ? family_traced(s)->name : NULL, plan);
  study_values_destroy(&v);
  return code ? code : family_task_check(s, why);
}

/* --- points --- */

static void keep_reason(char *to, const char *reason) {
  snprintf(to, CURVE_REASON_BYTES, "%.*s", CURVE_REASON_BYTES - 1, reason);
}

/* A new record of a ragged table; without memory NULL, and the task ends. */
static unsigned char *add_record(branch_rows *w, size_t which) {
  unsigned char *record = records_add(&w->tails[which]);
  if (!record)
    w->status = ric_fail(NULL, RIC_ENOMEM, "no memory for a record");
  return record;
}

/* Adds the impacts of a motion, which with its first state determine it. @param at, special  point or special point of
 * the task, -1: none */
static void add_impacts(branch_rows *w, const ric_orbit *o, long long at, long long special) {
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

/* Largest displacement; NaN if the motion cannot be run again; then the task may end. */
static double amplitude(branch_rows *w, ric_family *family, const ric_family_point *point) {
  double most = NAN;
  const ric_status status = ric_shooting_amplitude(ric_family_shooting(family), point->z, point->given, &most, NULL);
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    w->status = status;
  return status == RIC_OK ? most : NAN;
}

/* Writes states over the period into the record; they stay NaN if the motion cannot be run again. */
static void fill_history(branch_rows *w, ric_family *family, const ric_family_point *point, const branch_point *to) {
  if (!to->history_q || !to->history_v)
    return;
  const size_t samples = (size_t)value_number(w->b->values, KEY_BRANCH_SAMPLES, 0);
  const ric_status status = ric_shooting_states(ric_family_shooting(family), point->z, point->given, samples,
                                                to->history_q, to->history_v, NULL);
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    w->status = status;
}

/* Writes all multipliers into the record; NaN if unknown. */
static void fill_multipliers(const branch_rows *w, const ric_multipliers *found, ric_complex *to) {
  for (size_t i = 0; to && i < 2 * w->b->model.lattice.particles; i++)
    to[i] = found && i < found->count ? found->mu[i] : (ric_complex){NAN, NAN};
}

static void add_point(branch_rows *w, const ric_explore_segment *segment, const ric_family_point *point) {
  const table *t = &w->plan->tails[BRANCH_POINTS].records;
  const ric_orbit *o = point->orbit;
  const ric_multipliers *m = point->multipliers;
  branch_point found = {0};
  unsigned char *record = add_record(w, BRANCH_POINTS);
  if (!record)
    return;
  row_load(t, record, &found);
  found.segment = (long long)segment->index;
  found.parameter = branch_family_value(w->b, point->parameter);
  found.outcome = (int)o->outcome;
  found.energy = o->energy;
  found.period = o->period;
  found.amplitude = amplitude(w, segment->family, point);
  found.multiplier_max = m ? m->largest : NAN;
  found.stable = m ? (int)m->stable : (int)RIC_STABILITY_UNKNOWN;
  found.clearance = o->clearance;
  found.arclength = point->arclength;
  found.iterations = point->iterations;
  found.residual = o->residual;
  found.q = o->q;
  found.v = o->v;
  fill_multipliers(w, m, found.multipliers);
  fill_history(w, segment->family, point, &found);
  row_store(t, record, &found);
  if (w->states)
    add_impacts(w, o, (long long)w->points, -1);
  w->points++;
}

static void add_special(branch_rows *w, const ric_explore_segment *segment, const ric_family_point *point) {
  const ric_orbit *o = point->orbit;
  const bool any = point->obstacle < w->b->model.obstacle_count;
  unsigned char *record = add_record(w, BRANCH_SPECIAL);
  if (!record)
    return;
  const branch_special found = {.kind = (int)point->kind,
                                .segment = (long long)segment->index,
                                .parameter = branch_family_value(w->b, point->parameter),
                                .point = (long long)w->points - 1,
                                .obstacle = any ? (long long)point->obstacle : -1,
                                .particle = any ? (long long)w->b->model.obstacles[point->obstacle].coordinate : -1,
                                .time = point->time,
                                .order = point->order,
                                .period = o->period,
                                .energy = o->energy,
                                .amplitude = amplitude(w, segment->family, point),
                                .clearance = o->clearance,
                                .multiplier_max = point->multipliers ? point->multipliers->largest : NAN,
                                .arclength = point->arclength,
                                .q = o->q,
                                .v = o->v};
  row_store(&w->plan->tails[BRANCH_SPECIAL].records, record, &found);
  add_impacts(w, o, -1, (long long)w->specials);
  w->specials++;
}

/* --- curves in two parameters --- */

/* The special point that a curve goes through. */
typedef struct curve_origin {
  ric_family *family;
  const ric_family_point *point;
} curve_origin;

/* Whether the study asks for curves through special points of this kind. */
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

/* The curve through the special point added last, both ways. @returns RIC_OK, RIC_ESTOPPED or RIC_ENOMEM */
static ric_status trace_curve(branch_rows *w, ric_family *family, const ric_family_point *point) {
  curve_origin from = {family, point};
  curve_trace t = {.b = w->b,
                   .layout = &w->plan->tails[BRANCH_CURVES].records,
                   .end_layout = &w->plan->tails[BRANCH_CURVE_ENDS].records,
                   .points = &w->tails[BRANCH_CURVES],
                   .ends = &w->tails[BRANCH_CURVE_ENDS],
                   .special = (long long)w->specials - 1};
  const ric_status status = curve_trace_follow(&t, follow_curve, &from);
  w->iterations += t.iterations;
  w->jacobians += t.jacobians;
  return status;
}

/* --- segments --- */

/* The outcome of the first segment is that of the task. */
static void add_segment(branch_rows *w, const ric_explore_segment *s, int outcome) {
  unsigned char *record = add_record(w, BRANCH_SEGMENTS);
  if (s->origin == RIC_EXPLORE_START) {
    w->outcome = outcome;
    keep_reason(w->reason, s->reason);
  }
  w->segments++;
  w->iterations += s->run.iterations;
  w->jacobians += s->run.jacobians;
  if (!record)
    return;
  row_store(
      &w->plan->tails[BRANCH_SEGMENTS].records, record,
      &(branch_segment){.origin = (int)s->origin,
                        .special = s->special < SIZE_MAX ? (long long)s->special : -1,
                        .outcome = outcome,
                        .reason = s->reason,
                        .impacts = s->family ? (long long)ric_shooting_impacts(ric_family_shooting(s->family)) : 0,
                        .missed = (long long)s->run.missed});
}

/* A branch that cannot start is a row with its reason.
 * @param family  NULL where there is none  @returns RIC_OK, RIC_ESTOPPED or RIC_ENOMEM */
static ric_status add_failed_start(branch_rows *w, ric_family *family, ric_status status, const ric_error *error,
                                   int outcome) {
  const ric_explore_segment none = {
      .origin = RIC_EXPLORE_START, .special = SIZE_MAX, .family = family, .reason = error->message};
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    return status;
  add_segment(w, &none, outcome);
  return w->status;
}

static int visit_point(const ric_explore_segment *segment, const ric_family_point *point, void *user) {
  branch_rows *w = user;
  if (point->kind == RIC_FAMILY_REGULAR)
    add_point(w, segment, point);
  else {
    add_special(w, segment, point);
    if (w->status == RIC_OK && is_traced(w->b, point->kind))
      w->status = trace_curve(w, segment->family, point);
  }
  return w->status != RIC_OK;
}

static int visit_end(const ric_explore_segment *segment, void *user) {
  branch_rows *w = user;
  add_segment(w, segment, segment->status == RIC_OK ? (int)segment->run.end : CURVE_FAILED_START);
  return w->status != RIC_OK;
}

/* --- a task --- */

/* From a start at z [unknowns]. */
static ric_status explore(branch_rows *w, const family_task *t, double *z) {
  const study_values *v = t->values;
  const ric_explore_visitor visitor = {.point = visit_point, .end = visit_end, .user = w};
  ric_explore_options options = ric_explore_options_default();
  ric_error error = {0};
  double parameter;
  int iterations = 0;
  options.cross = value_flag(v, KEY_BRANCH_CROSS);
  options.branches = value_flag(v, KEY_BRANCH_SWITCH);
  options.segments = (size_t)value_number(v, KEY_BRANCH_SEGMENTS, 0);
  ric_status status = family_task_solve(t, z, &parameter, &iterations, &error);
  w->iterations += (unsigned long long)iterations;
  if (status != RIC_OK)
    return add_failed_start(w, t->family.family, status, &error, CURVE_FAILED_START);
  status = ric_family_explore(t->family.family, z, parameter, &options, &visitor, &error);
  return w->status != RIC_OK ? w->status : status;
}

static ric_status follow(branch_rows *w, family_task *t) {
  ric_error error = {0};
  ric_status status = family_task_open(t, &error);
  if (status != RIC_OK)
    return add_failed_start(w, NULL, status, &error, CURVE_REFUSED);
  status = family_task_begin(t, &error);
  if (status != RIC_OK)
    return add_failed_start(w, NULL, status, &error, CURVE_FAILED_START);
  double *z = calloc(ric_shooting_unknowns(ric_family_shooting(t->family.family)), sizeof *z);
  status = z ? explore(w, t, z) : ric_fail(NULL, RIC_ENOMEM, "no memory for a start");
  free(z);
  return status;
}

static void fill_row(const branch_rows *w, unsigned char *row) {
  row_fill(&w->plan->rows, row,
           &(branch_row){.outcome = w->outcome,
                         .reason = w->reason,
                         .points = (long long)w->points,
                         .segments = (long long)w->segments,
                         .iterations = (long long)w->iterations,
                         .jacobians = (long long)w->jacobians});
}

static int branch_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *row, records *tails) {
  branch_rows found = {
      .b = &w->task.family, .plan = plan, .tails = tails, .states = value_flag(w->task.values, KEY_BRANCH_STATES)};
  study_values_at(w->task.values, tasks.first);
  ric_status status = follow(&found, &w->task);
  family_task_close(&w->task);
  if (status == RIC_ESTOPPED)
    return -1;
  fill_row(&found, row);
  return 0;
}

/* --- its keys --- */

bool branch_restarts(const study *s) {
  return study_is_kind(s, "branch") && study_value(s, KEY_RESTART_FILE)->present;
}

/* Before a restart is resolved its values are unknown, so its keys are checked afterwards. */
static int check_restart(const study *s, const document *d, message *why) {
  const bool special = study_has(s, KEY_RESTART_SPECIAL), point = study_has(s, KEY_RESTART_POINT);
  if (special != point)
    return 0;
  return document_refuse(d, check_node_of_key(s, special ? KEY_RESTART_SPECIAL : KEY_RESTART_FILE), why,
                         "restart has %s special %s point, expected one of the two", special ? "both" : "neither",
                         special ? "and" : "nor");
}

static int branch_check(const study *s, const document *d, message *why) {
  return branch_restarts(s) ? check_restart(s, d, why) : family_check(s, d, why);
}

static bool branch_wants(const study *s, const document *d, study_key key) {
  return !(key == KEY_ORBIT_PERIOD && branch_restarts(s)) && family_wants(s, d, key);
}

const kind kind_branch = {.choice = {.name = "branch",
                                     .summary = "a family of periodic motions along a parameter",
                                     .groups = "pattern|start|family|trace|branch",
                                     .features = MODEL_SYSTEM,
                                     .complete = family_complete_study,
                                     .wants = branch_wants,
                                     .check = branch_check},
                          .resolve = branch_resolve,
                          .lists = {branch_lists},
                          .plan = branch_plan,
                          .open = branch_open,
                          .evaluate = branch_evaluate,
                          .close = branch_close,
                          .extra = kind_no_extra};

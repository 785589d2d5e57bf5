/* kind: branch. A family of periodic motions along one parameter, at every grid point of the others. */
#include "branch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "walk.h"
#include "kind/family/family_task.h"
#include "kind/family/family_check.h"
#include "kind/machine.h"

struct worker {
  family_task task;
};

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
  *plan = (kind_plan){.outcome = "outcome"};
  int code = refuse_multipliers(s, v, why);
  plan->memory = family_task_bytes(v);
  if (!code)
    code = machine_refuse_size(s, "a branch", plan->memory, why);
  if (!code)
    branch_lay_out(v, family_followed(s)->name, family_traced(s) ? family_traced(s)->name : NULL, plan);
  study_values_destroy(&v);
  return code ? code : family_task_check(s, why);
}

/* --- a task --- */

/* A branch that does not begin is a row with its reason. */
static ric_status note_unborn(const kind_plan *plan, records *tails, ric_status status, const ric_error *error,
                              int outcome, branch_result *result) {
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    return status;
  result->outcome = outcome;
  result->segments = 1;
  snprintf(result->reason, sizeof result->reason, "%.*s", CURVE_REASON_BYTES - 1, error->message);
  return branch_put_unborn(plan, tails, outcome, result->reason);
}

static ric_status follow(worker *w, const kind_plan *plan, records *tails, branch_result *result) {
  ric_error error = {0};
  ric_status status = family_task_open(&w->task, &error);
  if (status != RIC_OK)
    return note_unborn(plan, tails, status, &error, CURVE_REFUSED, result);
  status = family_task_begin(&w->task, &error);
  if (status != RIC_OK)
    return note_unborn(plan, tails, status, &error, CURVE_FAILED_START, result);
  return branch_walk(&w->task.family, &w->task.guess, plan, tails, result);
}

static void fill_row(const branch_result *result, const table *t, unsigned char *row) {
  row_fill(t, row,
           &(branch_row){.outcome = result->outcome,
                         .reason = result->reason,
                         .points = (long long)result->points,
                         .segments = (long long)result->segments,
                         .iterations = (long long)result->iterations,
                         .jacobians = (long long)result->jacobians});
}

static int branch_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *row, records *tails) {
  branch_result result = {0};
  uint64_t before[BRANCH_TAILS_WITH_CURVES];
  for (size_t k = 0; k < plan->tail_count; k++)
    before[k] = tails[k].count;
  study_values_at(w->task.values, tasks.first);
  ric_status status = follow(w, plan, tails, &result);
  branch_family_close(&w->task.family);
  if (status == RIC_ESTOPPED)
    return -1;
  if (status != RIC_OK) { /* of a branch that does not fit, nothing is kept */
    for (size_t k = 0; k < plan->tail_count; k++)
      records_cut(&tails[k], before[k]);
    result = (branch_result){.outcome = CURVE_REFUSED, .reason = "no memory for its points"};
  }
  fill_row(&result, &plan->rows, row);
  return 0;
}

/* --- its keys --- */

bool branch_restarts(const study *s) {
  return study_is_kind(s, "branch") && study_value(s, KEY_RESTART_FILE)->present;
}

/* Where a branch restarts, what it takes from there is not known yet, and how its keys fit together not checked. */
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

extern const kind kind_branch;
extern const char chapter_branch[];

const kind kind_branch = {.choice = {.name = "branch",
                                     .summary = "a family of periodic motions along a parameter",
                                     .chapter = chapter_branch,
                                     .groups = "pattern|start|family|trace|branch",
                                     .features = MODEL_SYSTEM,
                                     .complete = family_complete,
                                     .wants = branch_wants,
                                     .check = branch_check},
                          .resolve = branch_resolve,
                          .plan = branch_plan,
                          .open = branch_open,
                          .evaluate = branch_evaluate,
                          .close = branch_close,
                          .extra = kind_no_extra};

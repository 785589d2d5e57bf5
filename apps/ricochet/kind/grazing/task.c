/* kind: grazing. The first grazing point of a family of periodic motions, and its bifurcation, at every grid point. */
#include "grazing.h"

#include <stdlib.h>
#include <string.h>

#include "kind/family/family_task.h"
#include "kind/family/family_check.h"
#include "kind/machine.h"

struct worker {
  family_task task;
};

static void grazing_close(worker **w) {
  if (!w || !*w)
    return;
  family_task_clear(&(*w)->task);
  free(*w);
  *w = NULL;
}

static int grazing_open(const study *s, ric_poll poll, worker **out, message *why) {
  worker *w = *out = calloc(1, sizeof *w);
  if (!w)
    return refuse(why, EXIT_RUN, "%s: no memory for a task", study_name(s));
  const int code = family_task_init(&w->task, s, poll, why);
  w->task.family.multipliers = false; /* the multipliers of L are used instead */
  if (code)
    grazing_close(out);
  return code;
}

/* The row, the family, and matrices of the criterion and of the orbits of the map. */
static double bytes_of(const study_values *v, const table *rows) {
  const double c = grazing_coordinates(v);
  return family_task_bytes(v) + table_row_bytes(rows) + 8 * 12 * c * c;
}

static int grazing_plan(const study *s, kind_plan *plan, message *why) {
  study_values *v = study_values_create(s);
  if (!v)
    return refuse(why, EXIT_RUN, "%s: no memory for the values of a task", study_name(s));
  *plan = (kind_plan){0};
  grazing_lay_out(v, family_followed(s)->name, family_traced(s) ? family_traced(s)->name : NULL, plan);
  plan->memory = bytes_of(v, &plan->rows);
  const int code = machine_refuse_size(s, "a grazing motion", plan->memory, why);
  study_values_destroy(&v);
  return code ? code : family_task_check(s, why);
}

/* --- a task ------------------------------------------------------------------------------------------------------- */

/* From the start of an open family. @param z  [unknowns] */
static ric_status follow(const family_task *t, grazing_task *g, double *z, records *tails) {
  double parameter;
  ric_error error = {0};
  ric_status status = family_task_solve(t, z, &parameter, NULL, &error);
  if (status != RIC_OK)
    return grazing_end(g, GRAZING_FAILED_START, status, &error);
  RIC_TRY(grazing_find(g, z, parameter));
  if (g->outcome == GRAZING_FOUND)
    RIC_TRY(grazing_judge(g));
  return g->outcome == GRAZING_FOUND && g->b->traced ? grazing_trace(g, tails) : RIC_OK;
}

static ric_status compute(family_task *t, grazing_task *g, records *tails) {
  ric_error error = {0};
  ric_status status = family_task_open(t, &error);
  if (status != RIC_OK)
    return grazing_end(g, GRAZING_REFUSED, status, &error);
  status = family_task_begin(t, &error);
  if (status != RIC_OK)
    return grazing_end(g, GRAZING_FAILED_START, status, &error);
  ric_shooting *shooting = ric_family_shooting(g->b->family);
  double *z = calloc(ric_shooting_unknowns(shooting), sizeof *z);
  status = z ? ric_grazing_init(&g->grazing, shooting, &error) : ric_fail(&error, RIC_ENOMEM, "no memory for a start");
  if (status == RIC_OK)
    status = follow(t, g, z, tails);
  ric_grazing_clear(&g->grazing);
  free(z);
  return status;
}

static void finish_row(grazing_task *g) {
  g->found.outcome = (int)g->outcome;
  g->found.reason = g->reason;
  if (g->outcome == GRAZING_DEGENERATE) { /* no criterion, for the same reason */
    g->found.verdict = RIC_GRAZING_UNDECIDED;
    g->found.verdict_reason = g->reason;
  }
  row_store(&g->plan->rows, g->row, &g->found);
}

static int grazing_evaluate(worker *w, const kind_plan *plan, task_range tasks, unsigned char *row, records *tails) {
  grazing_task g = {.b = &w->task.family, .plan = plan, .row = row, .outcome = GRAZING_FAILED};
  uint64_t before[GRAZING_TAILS];
  for (size_t k = 0; k < plan->tail_count; k++)
    before[k] = tails[k].count;
  study_values_at(w->task.values, tasks.first);
  g.found = grazing_clear_row(&plan->rows, row);
  const ric_status status = compute(&w->task, &g, tails);
  family_task_close(&w->task);
  if (status == RIC_ESTOPPED)
    return -1;
  if (status != RIC_OK) { /* out of memory: all records of the task are dropped */
    for (size_t k = 0; k < plan->tail_count; k++)
      records_cut(&tails[k], before[k]);
    g.found = grazing_clear_row(&plan->rows, row);
    grazing_end(&g, GRAZING_FAILED, RIC_EINVAL, &(ric_error){.message = "no memory for it"});
  }
  finish_row(&g);
  return 0;
}

/* --- its keys --- */

/* The return map needs motions that are solved for over a whole period. */
static int grazing_complete(study *s, const document *d, message *why) {
  static const char text[] = "orbit.motion = even, but kind: grazing needs forced, conservative or autonomous motions";
  const int node = check_node_of_key(s, KEY_ORBIT_MOTION);
  if (strcmp(study_word(s, KEY_ORBIT_MOTION), "even") != 0)
    return family_complete_study(s, d, why);
  return node ? document_refuse(d, node, why, "%s", text) : check_refuse(s, why, "%s", text);
}

const kind kind_grazing = {.choice = {.name = "grazing",
                                      .summary = "where a family first grazes an obstacle, and what follows there",
                                      .groups = "pattern|start|family|trace|grazing",
                                      .features = MODEL_SYSTEM,
                                      .complete = grazing_complete,
                                      .wants = family_wants,
                                      .check = family_check},
                           .show = grazing_show,
                           .lists = {grazing_lists},
                           .plan = grazing_plan,
                           .open = grazing_open,
                           .evaluate = grazing_evaluate,
                           .close = grazing_close,
                           .extra = kind_no_extra};

#include "branch_trace.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A part of a curve on its way. */
typedef struct trace {
  branch_family *b;
  const kind_plan *plan;
  records *tails;
  long long special;
  int part;
  uint64_t points;
  char reason[BRANCH_REASON_BYTES]; /* that the callback has ended it; "" */
  ric_status status;                /* of the callback: RIC_OK or RIC_ENOMEM */
} trace;

bool branch_trace_wanted(const branch_family *b, ric_family_kind what) {
  const char *words = schema_row(KEY_BRANCH_TRACE_KINDS)->words, *name = ric_family_kind_name(what);
  const long place = schema_find_word(name, strlen(name), words);
  for (size_t i = 0; b->traced && i < value_count(b->values, KEY_BRANCH_TRACE_KINDS); i++)
    if (value_number(b->values, KEY_BRANCH_TRACE_KINDS, i) == (double)place)
      return true;
  return false;
}

/* Whether the branch's parameter leaves its bounds; says so. */
static bool leaves(trace *t, double value) {
  const double low = value_number(t->b->values, KEY_BRANCH_TRACE_FIRST_LOW, 0);
  const double high = value_number(t->b->values, KEY_BRANCH_TRACE_FIRST_HIGH, 0); /* minus infinity: none */
  const bool below = value < low;
  const bool above = high > -INFINITY && value > high;
  if (below || above)
    snprintf(t->reason, sizeof t->reason, "%s = %.9g would be %s %.9g", t->b->followed->name, value,
             below ? "below" : "above", below ? low : high);
  return below || above;
}

static int add_point(const ric_family_curve_point *point, void *user) {
  trace *t = user;
  const double value = branch_family_value(t->b, point->parameter);
  if (t->points > 0 && leaves(t, value))
    return 1;
  unsigned char *record = records_add(&t->tails[BRANCH_CURVES]);
  if (!record) {
    t->status = RIC_ENOMEM;
    return 1;
  }
  branch_put_curve_point(&t->plan->tails[BRANCH_CURVES].records, point, t->special, t->part, value, record);
  t->points++;
  return 0;
}

static ric_status add_end(trace *t, int outcome, const char *reason) {
  unsigned char *record = records_add(&t->tails[BRANCH_CURVE_ENDS]);
  if (!record)
    return RIC_ENOMEM;
  branch_put_curve_end(&t->plan->tails[BRANCH_CURVE_ENDS].records, t->special, t->part, outcome, reason, t->points,
                       record);
  return RIC_OK;
}

/* One way. @param closed  whether the curve has come back to its start */
static ric_status trace_part(trace *t, ric_family *family, const ric_family_point *point, bool *closed,
                             branch_result *result) {
  const ric_curve_options options = branch_family_curve_options(t->b, t->part == 0 ? +1 : -1);
  ric_curve_run run = {0};
  ric_error error = {0};
  const ric_status status = ric_family_trace(family, point, &options, NULL, add_point, t, &run, &error);
  *closed = status == RIC_OK && run.end == RIC_CURVE_CLOSED;
  if (t->status != RIC_OK || status == RIC_ENOMEM || status == RIC_ESTOPPED)
    return t->status != RIC_OK ? t->status : status;
  result->iterations += run.iterations;
  result->jacobians += run.jacobians;
  if (status != RIC_OK)
    return add_end(t, BRANCH_FAILED_START, error.message);
  return add_end(t, (int)run.end, *t->reason ? t->reason : run.reason);
}

ric_status branch_trace(branch_family *b, ric_family *family, const ric_family_point *point, long long special,
                        const kind_plan *plan, records *tails, branch_result *result) {
  ric_status status = RIC_OK;
  bool closed = false; /* the other way leads over the same points */
  for (int part = 0; part < 2 && status == RIC_OK && !closed; part++) {
    trace t = {.b = b, .plan = plan, .tails = tails, .special = special, .part = part};
    status = trace_part(&t, family, point, &closed, result);
  }
  return status;
}

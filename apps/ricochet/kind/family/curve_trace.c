#include "curve_trace.h"

#include <math.h>
#include <stdio.h>

const char *const curve_outcome_names[CURVE_OUTCOMES] = {
#define X(name, text) text,
    RIC_CURVE_END_LIST(X)
#undef X
        "failed_start",
    "refused"};

#define CURVE .source = "F(z, p) = 0"

const column curve_end_columns[CURVE_END_COLUMNS] = {
    COLUMN("curve_end_special", INTEGER(curve_end, special), "special point of the task that the curve goes through",
           CURVE),
    COLUMN("curve_end_part", INTEGER(curve_end, part), "part of the curve", CURVE,
           .doc = "part of the curve; a closed curve has part 0 only"),
    COLUMN("curve_end_outcome", WORD(curve_end, outcome, curve_outcome_names), "how it ended", CURVE,
           .doc = "as `/branch/outcome`: `bound` is one of the second parameter, `ended` one of the first "
                  "(`first_low`, `first_high`); `not_converged` also if a curve ends at a point that is special twice, "
                  "`ended` also if the criterion of grazing cannot be evaluated"),
    COLUMN("curve_end_reason", TEXT(curve_end, reason, CURVE_REASON_BYTES),
           "why; empty when the outcome speaks for itself", CURVE,
           .doc = "what failed last; empty if the outcome needs no reason"),
    COLUMN("curve_end_points", INTEGER(curve_end, points), "number of its points", .source = "count",
           .doc = "number of its points, folds of the curve included"),
};

const column curve_point_columns[CURVE_POINT_COLUMNS] = {
    COLUMN("curve_special", INTEGER(curve_point, special), "special point of the task that the curve goes through",
           CURVE),
    COLUMN("curve_part", INTEGER(curve_point, part),
           "0: from there towards larger values of the second parameter, 1: towards smaller ones", CURVE,
           .doc = "0: towards larger values of the second parameter, 1: towards smaller ones; both begin with the "
                  "special point, or the grazing point of the task"),
    COLUMN("curve_parameter", NUMBER(curve_point, parameter), "parameter that is followed", CURVE,
           .doc = "the parameter that the family is followed in; its key is the attribute `parameter`"),
    COLUMN("curve_second", NUMBER(curve_point, second), "second parameter", CURVE,
           .doc = "the second parameter; its key is the attribute `parameter`"),
    COLUMN("curve_period", NUMBER(curve_point, period), "period", CURVE),
};

void curve_trace_lay_out(const column_list lists[CURVE_LISTS], const char *followed, const char *traced,
                         const table_axis *axes, size_t axis_count, tail tails[CURVE_TAILS]) {
  kind_lay_out_tail(&tails[0], &lists[0], NULL, 0);
  table_add(&tails[0].records, &lists[1], axes, axis_count);
  table_lay_out(&tails[0].records);
  table_put_parameter(&tails[0].records, "curve_parameter", followed);
  table_put_parameter(&tails[0].records, "curve_second", traced);
  kind_lay_out_tail(&tails[1], &lists[2], NULL, 0);
}

/* Whether the first parameter leaves its bounds; says so. */
static bool leaves(curve_trace *t, double value) {
  const double low = value_number(t->b->values, KEY_BRANCH_TRACE_FIRST_LOW, 0);
  const double high = value_number(t->b->values, KEY_BRANCH_TRACE_FIRST_HIGH, 0); /* minus infinity: none */
  const bool below = value < low;
  const bool above = high > -INFINITY && value > high;
  if (below || above)
    snprintf(t->reason, sizeof t->reason, "%s = %.9g would be %s %.9g", t->b->followed->name, value,
             below ? "below" : "above", below ? low : high);
  return below || above;
}

int curve_trace_add(curve_trace *t, double parameter, double second, double period, curve_point *point) {
  const double value = branch_family_value(t->b, parameter);
  if (t->count > 0 && leaves(t, value))
    return 1;
  unsigned char *record = records_add(t->points);
  if (!record) {
    t->status = ric_fail(NULL, RIC_ENOMEM, "no memory for a point");
    return 1;
  }
  *point = (curve_point){t->special, t->part, value, second, period};
  row_store(t->layout, record, point);
  t->count++;
  return 0;
}

static ric_status add_end(const curve_trace *t, int outcome, const char *reason) {
  unsigned char *record = records_add(t->ends);
  if (!record)
    return ric_fail(NULL, RIC_ENOMEM, "no memory for an end");
  row_store(
      t->end_layout, record,
      &(curve_end){
          .special = t->special, .part = t->part, .outcome = outcome, .reason = reason, .points = (long long)t->count});
  return RIC_OK;
}

/* One way. @param closed  whether the curve has come back to its start */
static ric_status follow_part(curve_trace *t, curve_way way, void *user, bool *closed) {
  const ric_curve_options options = branch_family_curve_options(t->b, t->part == 0 ? +1 : -1);
  ric_curve_run run = {0};
  ric_error error = {0};
  const ric_status status = way(t, &options, user, &run, &error);
  *closed = status == RIC_OK && run.end == RIC_CURVE_CLOSED;
  if (t->status != RIC_OK || status == RIC_ENOMEM || status == RIC_ESTOPPED)
    return t->status != RIC_OK ? t->status : status;
  t->iterations += run.iterations;
  t->jacobians += run.jacobians;
  if (status != RIC_OK)
    return add_end(t, t->count > 0 ? RIC_CURVE_ENDED : CURVE_FAILED_START, error.message);
  return add_end(t, (int)run.end, *t->reason ? t->reason : run.reason);
}

ric_status curve_trace_follow(curve_trace *t, curve_way way, void *user) {
  ric_status status = RIC_OK;
  bool closed = false; /* the other way leads over the same points */
  t->iterations = t->jacobians = 0;
  for (t->part = 0; t->part < 2 && status == RIC_OK && !closed; t->part++) {
    t->count = 0;
    t->reason[0] = '\0';
    t->status = RIC_OK;
    status = follow_part(t, way, user, &closed);
  }
  return status;
}

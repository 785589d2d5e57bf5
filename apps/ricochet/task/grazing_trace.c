/* The grazing point of a task in two parameters. */
#include "curve_trace.h"
#include "grazing.h"

static int add_point(const ric_grazing_curve_point *point, void *user) {
  curve_trace *t = user;
  const table *layout = t->layout;
  const ric_grazing *g = point->grazing;
  const ric_grazing_criterion *k = point->criterion;
  unsigned char *record = curve_trace_add(t, g->parameter, g->second, g->period);
  if (!record)
    return 1;
  row_put_number(record, table_column(layout, "curve_phase"), g->phase);
  row_put_number(record, table_column(layout, "curve_A_g"), g->local.acceleration);
  row_put_word(record, table_column(layout, "curve_verdict"), (int)k->verdict);
  row_put_integer(record, table_column(layout, "curve_first_negative"),
                  k->first_negative == SIZE_MAX ? -1 : (long long)k->first_negative);
  row_put_numbers(record, table_column(layout, "curve_multiplier"), (double[]){k->dominant.re, k->dominant.im});
  row_put_numbers(record, table_column(layout, "curve_coefficient"), point->coefficients);
  row_put_integer(record, table_column(layout, "curve_change"), point->zero == SIZE_MAX ? -1 : (long long)point->zero);
  return 0;
}

static ric_status follow(curve_trace *t, const ric_curve_options *options, void *user, ric_curve_run *run,
                         ric_error *error) {
  const grazing_task *g = user;
  const size_t count = (size_t)value_number(g->b->values, KEY_GRAZING_COEFFICIENTS, 0);
  return ric_grazing_trace(g->b->family, &g->grazing, options, count, add_point, t, run, error);
}

ric_status grazing_trace(grazing_task *g, records *tails) {
  curve_trace t = {.b = g->b,
                   .layout = &g->plan->tails[GRAZING_CURVES].records,
                   .end_layout = &g->plan->tails[GRAZING_CURVE_ENDS].records,
                   .points = &tails[GRAZING_CURVES],
                   .ends = &tails[GRAZING_CURVE_ENDS]};
  return curve_trace_follow(&t, follow, g);
}

/* The grazing point of a task in two parameters. */
#include "kind/family/curve_trace.h"
#include "grazing.h"

/* A point: what the kind adds to those of any curve. */
static int add_point(const ric_grazing_curve_point *point, void *user) {
  const ric_grazing *g = point->grazing;
  const ric_grazing_criterion *k = point->criterion;
  grazing_curve_point found = {.phase = g->phase,
                               .A_g = g->local.acceleration,
                               .verdict = (int)k->verdict,
                               .first_negative = k->first_negative == SIZE_MAX ? -1 : (long long)k->first_negative,
                               .multiplier = k->dominant,
                               .coefficient = point->coefficients,
                               .change = point->zero == SIZE_MAX ? -1 : (long long)point->zero};
  return curve_trace_add(user, g->parameter, g->second, g->period, &found.common);
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

#include "trace.h"

#include <string.h>

#include "kind/family/curve_trace.h"

/* The special point that a curve goes through. */
typedef struct origin {
  ric_family *family;
  const ric_family_point *point;
} origin;

bool branch_trace_wanted(const branch_family *b, ric_family_kind what) {
  const char *words = schema_row(KEY_BRANCH_TRACE_KINDS)->words, *name = ric_family_kind_name(what);
  const long place = schema_find_word(name, strlen(name), words);
  for (size_t i = 0; b->traced && i < value_count(b->values, KEY_BRANCH_TRACE_KINDS); i++)
    if (value_number(b->values, KEY_BRANCH_TRACE_KINDS, i) == (double)place)
      return true;
  return false;
}

static int add_point(const ric_family_curve_point *point, void *user) {
  curve_trace *t = user;
  branch_curve_point found = {
      .energy = point->orbit->energy, .outcome = (int)point->orbit->outcome, .iterations = point->iterations};
  return curve_trace_add(t, point->parameter, point->second, point->orbit->period, &found.common);
}

static ric_status follow(curve_trace *t, const ric_curve_options *options, void *user, ric_curve_run *run,
                         ric_error *error) {
  const origin *from = user;
  return ric_family_trace(from->family, from->point, options, NULL, add_point, t, run, error);
}

ric_status branch_trace(branch_family *b, ric_family *family, const ric_family_point *point, long long special,
                        const kind_plan *plan, records *tails, branch_result *result) {
  origin from = {family, point};
  curve_trace t = {.b = b,
                   .layout = &plan->tails[BRANCH_CURVES].records,
                   .end_layout = &plan->tails[BRANCH_CURVE_ENDS].records,
                   .points = &tails[BRANCH_CURVES],
                   .ends = &tails[BRANCH_CURVE_ENDS],
                   .special = special};
  const ric_status status = curve_trace_follow(&t, follow, &from);
  result->iterations += t.iterations;
  result->jacobians += t.jacobians;
  return status;
}

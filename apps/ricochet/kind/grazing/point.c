/* The grazing point of a task: its coefficients, verdict and windows. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "grazing.h"
#include "kind/family/curve_trace.h"

/* --- the point in two parameters --- */

/* Adds the kind's own columns to a point of a curve. */
static int add_curve_point(const ric_grazing_curve_point *point, void *user) {
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

static ric_status follow_curve(curve_trace *t, const ric_curve_options *options, void *user, ric_curve_run *run,
                               ric_error *error) {
  const grazing_task *g = user;
  const size_t count = (size_t)value_number(g->b->values, KEY_GRAZING_COEFFICIENTS, 0);
  return ric_grazing_trace(g->b->family, &g->grazing, options, count, add_curve_point, t, run, error);
}

ric_status grazing_trace(grazing_task *g, records *tails) {
  curve_trace t = {.b = g->b,
                   .layout = &g->plan->tails[GRAZING_CURVES].records,
                   .end_layout = &g->plan->tails[GRAZING_CURVE_ENDS].records,
                   .points = &tails[GRAZING_CURVES],
                   .ends = &tails[GRAZING_CURVE_ENDS]};
  return curve_trace_follow(&t, follow_curve, g);
}

ric_status grazing_end(grazing_task *g, grazing_outcome outcome, ric_status status, const ric_error *error) {
  if (status == RIC_ESTOPPED || status == RIC_ENOMEM)
    return status;
  g->outcome = outcome;
  snprintf(g->reason, sizeof g->reason, "%.*s", GRAZING_REASON_BYTES - 1, error->message);
  return RIC_OK;
}

/* --- the point ---------------------------------------------------------------------------------------------------- */

/* Stores the values in the row; pointers then point into the row only. */
static void keep(grazing_task *g) {
  row_store(&g->plan->rows, g->row, &g->found);
  row_load(&g->plan->rows, g->row, &g->found);
}

static void put_obstacle(grazing_task *g, size_t obstacle) {
  const ric_obstacle *grazed = &g->b->model.obstacles[obstacle];
  g->found.obstacle = (long long)obstacle;
  g->found.particle = (long long)grazed->coordinate;
  g->found.side = grazed->side > 0 ? 0 : 1;
}

static void put_when(grazing_task *g, double parameter, double period, double time) {
  g->found.parameter = branch_family_value(g->b, parameter);
  g->found.period = period;
  g->found.time = time;
  g->found.phase = time / period;
}

/* By the study's parameter; the family's own may be its logarithm. */
static double slope_of(const grazing_task *g) {
  return g->grazing.slope / (g->b->log ? branch_family_value(g->b, g->grazing.parameter) : 1);
}

static void put_point(grazing_task *g) {
  const ric_grazing *found = &g->grazing;
  put_when(g, found->parameter, found->period, found->time);
  put_obstacle(g, found->local.obstacle);
  g->found.slope = slope_of(g);
  g->found.A_g = found->local.acceleration;
  g->found.restitution = found->local.restitution;
  g->found.q = found->x;
  g->found.v = found->x + found->numbers / 2;
  keep(g);
}

/* Outcomes of a search, in their order. */
static const grazing_outcome outcomes[RIC_GRAZING_SEARCH_OUTCOMES] = {GRAZING_FOUND, GRAZING_NONE, GRAZING_DEGENERATE,
                                                                      GRAZING_FAILED, GRAZING_FAILED_START};

/* Reason for no grazing point: the end of the family, in the study's parameter. */
static void put_end(grazing_task *g, double from, const ric_grazing_search *found) {
  snprintf(g->reason, sizeof g->reason,
           "no obstacle is touched from %s = %.9g to %.9g, where the family ends: %s%s%.60s", g->b->followed->name,
           branch_family_value(g->b, from), branch_family_value(g->b, found->reached),
           ric_curve_end_name(found->run.end), found->run.reason[0] ? ": " : "", found->run.reason);
}

ric_status grazing_find(grazing_task *g, double *z, double parameter) {
  ric_grazing_search found;
  ric_error error = {0};
  const ric_status status = ric_grazing_search_along(g->b->family, z, parameter, NULL, &found, &g->grazing, &error);
  if (status != RIC_OK)
    return grazing_end(g, GRAZING_FAILED_START, status, &error);
  g->outcome = outcomes[found.outcome];
  if (g->outcome == GRAZING_FOUND) {
    put_point(g);
    return RIC_OK;
  }
  snprintf(g->reason, sizeof g->reason, "%.*s", GRAZING_REASON_BYTES - 1, found.reason);
  if (found.obstacle < SIZE_MAX) { /* the point of the family, which could not be refined */
    put_when(g, found.parameter, found.period, found.time);
    put_obstacle(g, found.obstacle);
    keep(g);
  } else if (found.ended)
    put_end(g, parameter, &found);
  return RIC_OK;
}

/* --- the coefficients --------------------------------------------------------------------------------------------- */

static long long place_or_none(size_t i) {
  return i == SIZE_MAX ? -1 : (long long)i;
}

static void put_map(grazing_task *g, const ric_grazing_map *map) {
  g->found.eta = map->eta;
  g->found.xi = map->xi;
  g->found.kappa = map->kappa;
  g->found.L = map->L;
  g->found.stretch = map->stretch;
  keep(g);
}

static void put_criterion(grazing_task *g, const ric_grazing_criterion *k) {
  grazing_row *r = &g->found;
  r->verdict = (int)k->verdict;
  r->verdict_reason = k->reason;
  r->regime = (int)k->regime;
  r->first_negative = place_or_none(k->first_negative);
  r->first_zero = place_or_none(k->first_zero);
  r->settled = place_or_none(k->settled);
  r->multiplier = k->dominant;
  r->second = k->second;
  r->alpha = k->alpha;
  keep(g);
}

/* All eigenvalues of L, trivial ones included. */
static ric_status put_multipliers(const grazing_task *g, const ric_grazing_map *map, ric_error *error) {
  ric_multipliers found;
  RIC_TRY(ric_multipliers_init(&found, map->size, error));
  const ric_status status = ric_multipliers_of_matrix(map->L, map->size, 0, NULL, &found, error);
  if (status == RIC_OK)
    memcpy(g->found.multipliers, found.mu, map->size * sizeof *found.mu);
  ric_multipliers_clear(&found);
  return status;
}

/* --- the windows -------------------------------------------------------------------------------------------------- */

static void put_edges(const grazing_task *g, const ric_grazing_window *window, size_t i) {
  const grazing_row *r = &g->found;
  const double parameter = branch_family_value(g->b, g->grazing.parameter), slope = slope_of(g);
  r->window_low[i] = parameter - window->low.d / slope;
  r->window_high[i] = parameter - window->high.d / slope;
  r->window_low_d[i] = window->low.d;
  r->window_high_d[i] = window->high.d;
  r->window_low_kind[i] = (unsigned char)window->low.kind;
  r->window_high_kind[i] = (unsigned char)window->high.kind;
}

/* No window: no orbit of this period is admissible and stable, or its equations are singular. */
static ric_status put_window(const grazing_task *g, const ric_grazing_map *map, const ric_grazing_criterion *k,
                             size_t period, ric_error *error) {
  const grazing_row *r = &g->found;
  const size_t i = period - 1;
  ric_grazing_window window = {0};
  const ric_status status = ric_grazing_window_find(map, period, &window, error);
  if (status != RIC_OK && status != RIC_ENUMERIC)
    return status;
  const bool exists = status == RIC_OK && window.exists;
  r->window_period[i] = (int64_t)period;
  r->window_exists[i] = exists;
  if (exists)
    put_edges(g, &window, i);
  if (k->verdict == RIC_GRAZING_CONTINUOUS && period >= 2)
    RIC_TRY(
        ric_grazing_predict_window(k, map->stretch, period, r->predicted_border_d + i, r->predicted_flip_d + i, error));
  return RIC_OK;
}

static ric_status put_windows(const grazing_task *g, const ric_grazing_map *map, const ric_grazing_criterion *k,
                              ric_error *error) {
  const size_t most = (size_t)value_number(g->b->values, KEY_GRAZING_WINDOWS, 0);
  for (size_t period = 1; period <= most; period++) {
    if (ric_poll_stops(g->b->poll))
      return RIC_ESTOPPED;
    RIC_TRY(put_window(g, map, k, period, error));
  }
  return RIC_OK;
}

/* --- together ----------------------------------------------------------------------------------------------------- */

static ric_status judge(grazing_task *g, ric_grazing_map *map, ric_error *error) {
  const ric_grazing_plane plane = {.time = value_number(g->b->values, KEY_GRAZING_SECTION, 0) * g->grazing.period};
  const size_t count = (size_t)value_number(g->b->values, KEY_GRAZING_COEFFICIENTS, 0);
  ric_grazing_criterion criterion;
  RIC_TRY(ric_grazing_section(g->b->family, &g->grazing, &plane, map, NULL, error));
  put_map(g, map);
  RIC_TRY(put_multipliers(g, map, error));
  RIC_TRY(ric_grazing_criterion_find(map, NULL, &criterion, g->found.coefficient, count, g->found.departure, error));
  put_criterion(g, &criterion);
  return put_windows(g, map, &criterion, error);
}

ric_status grazing_judge(grazing_task *g) {
  ric_grazing_map map;
  ric_error error = {0};
  RIC_TRY(ric_grazing_map_init(&map, ric_grazing_coordinates(&g->grazing, ric_family_shooting(g->b->family)), &error));
  const ric_status status = judge(g, &map, &error);
  ric_grazing_map_clear(&map);
  return status == RIC_OK ? RIC_OK : grazing_end(g, GRAZING_FAILED, status, &error);
}

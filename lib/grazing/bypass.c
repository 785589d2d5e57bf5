#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bypass_parts.h"

/* A minimum within this part of the reach, as the rate and its derivative foretell it, is the nearest: motions are
 * smooth over a part of the reach that is larger by far. */
static const double near_part = 1e-6;

/* A minimum that Newton's method does not settle within this part of the reach is none. */
static const double settled_part = 1e-6;

/* An impact may leave the gap rate below zero by this, as a part of what it was, and absolutely: rates of users' gaps
 * come from differences. */
static const double turn_tol = 1e-6, turn_rounding = 1e-10;

/* A short way is as good as this part of the flow's tolerance, which the flow takes at every step of a way. */
static const double leap_part = 0.01;

enum { NEWTON_STEPS = 12 };

ric_bypass_options ric_bypass_options_default(void) {
  return (ric_bypass_options){.flow = ric_flow_options_default(), .reach = 1};
}

static ric_status check(const ric_system *system, size_t obstacle, const ric_bypass_options *o, ric_error *error) {
  RIC_TRY(grazing_check_obstacle(system, obstacle, error));
  if (!(o->reach > 0 && o->reach < INFINITY))
    return ric_fail(error, RIC_EINVAL, "reach = %g, expected a finite number > 0", o->reach);
  for (size_t j = 0; j < system->obstacle_count; j++)
    if (system_complies(system, j))
      return ric_fail(error, RIC_EINVAL,
                      "obstacle %zu: stiffness = %g, expected rigid ones only: the map runs back in time, and "
                      "compliant contacts do not",
                      j, system->obstacles[j].stiffness);
  return RIC_OK;
}

static ric_status build(ric_bypass *b, const ric_bypass_options *options, ric_error *error) {
  RIC_TRY(arc_runner_init(&b->runner, b->system, &options->flow, (ric_poll){0}, error));
  b->leaps = arc_runner_flow(&b->runner)->options.method == RIC_FLOW_CVODES;
  RIC_TRY(leap_init(&b->leap, b->system, error));
  RIC_TRY(gap_search_init(&b->search, arc_runner_flow(&b->runner), b->obstacle, error));
  RIC_TRY(impact_solver_init(&b->law, b->system, error));
  RIC_TRY(impact_solver_reserve(&b->law, 1, error));
  b->x = malloc(2 * b->size * sizeof *b->x);
  if (!b->x)
    return ric_fail(error, RIC_ENOMEM, "no memory for states of %zu numbers", b->size);
  b->rates = b->x + b->size;
  return RIC_OK;
}

ric_status ric_bypass_create(ric_system *system, size_t obstacle, const ric_bypass_options *options,
                             ric_bypass **bypass, ric_error *error) {
  ric_bypass_options o = options ? *options : ric_bypass_options_default();
  *bypass = NULL;
  RIC_TRY(check(system, obstacle, &o, error));
  ric_bypass *b = calloc(1, sizeof *b);
  if (!b)
    return ric_fail(error, RIC_ENOMEM, "no memory for a bypass map");
  b->system = system;
  b->obstacle = obstacle;
  b->size = system->coordinates + system->speeds;
  b->reach = o.reach;
  ric_status status = build(b, &o, error);
  if (status == RIC_OK)
    *bypass = b;
  else
    ric_bypass_destroy(&b);
  return status;
}

void ric_bypass_destroy(ric_bypass **bypass) {
  if (!bypass || !*bypass)
    return;
  ric_bypass *b = *bypass;
  gap_search_clear(&b->search);
  leap_clear(&b->leap);
  impact_solver_clear(&b->law);
  arc_runner_clear(&b->runner);
  free(b->x);
  free(b);
  *bypass = NULL;
}

/* Along the free motion. */
static ric_status move_to(ric_bypass *b, double time, ric_error *error) {
  double tolerance = leap_part * arc_runner_flow(&b->runner)->options.tolerance, from = b->time;
  if (b->leaps && leap_move(&b->leap, from, time - from, b->x, tolerance)) {
    b->time = time;
    return RIC_OK;
  }
  RIC_TRY(arc_runner_move(&b->runner, b->time, time, b->x, 0, NULL, NULL, error));
  b->time = time;
  return RIC_OK;
}

static ric_status read_rates(ric_bypass *b, double *rate, double *acceleration, ric_error *error) {
  return grazing_rates(b->system, b->obstacle, b->time, b->x, b->rates, rate, acceleration, error);
}

static ric_status read_gap(const ric_bypass *b, double *gap, ric_error *error) {
  const char *trouble = b->system->model->gap(b->system, b->obstacle, b->time, b->x, gap);
  return trouble ? grazing_blame(b->time, b->obstacle, trouble, error) : RIC_OK;
}

/* The minimum nearest in time, NaN without one: downhill first, then uphill, as far as it would be nearer there. */
static ric_status find_nearest(ric_bypass *b, double *time, ric_error *error) {
  double rate, acceleration, sense, span = b->reach, other;
  RIC_TRY(read_rates(b, &rate, &acceleration, error));
  *time = b->time - rate / acceleration;
  if (acceleration > 0 && fabs(rate) <= near_part * b->reach * acceleration)
    return RIC_OK;
  sense = rate > 0 ? -1 : 1;
  RIC_TRY(gap_search_minimum(&b->search, b->time, b->x, sense * span, rate, time, error));
  if (!isnan(*time))
    span = fabs(*time - b->time);
  if (span == 0)
    return RIC_OK;
  RIC_TRY(gap_search_minimum(&b->search, b->time, b->x, -sense * span, rate, &other, error));
  if (!isnan(other))
    *time = other;
  return RIC_OK;
}

/* Newton's method on the gap rate, until rounding is all that is left of it. */
static ric_status settle_minimum(ric_bypass *b, double *curvature, ric_error *error) {
  double rate, last = INFINITY, least = settled_part * b->reach;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    RIC_TRY(read_rates(b, &rate, curvature, error));
    double step = -rate / *curvature;
    if (!(*curvature > 0) || (k > 0 && !(fabs(step) < last / 2)))
      break;
    last = fabs(step);
    if (b->time + step == b->time)
      break;
    RIC_TRY(move_to(b, b->time + step, error));
  }
  if (*curvature > 0 && last <= least)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "obstacle %zu: the gap has a degenerate minimum near t = %g: its second derivative is %.3g",
                  b->obstacle, b->time, *curvature);
}

/* Leaves b->x at the minimum. */
static ric_status go_to_minimum(ric_bypass *b, double t, const double *x, ric_bypass_seen *seen, ric_error *error) {
  double time;
  size_t n = b->system->coordinates;
  RIC_TRY(ric_flow_start(arc_runner_flow(&b->runner), t, x, x + n, error)); /* refuses what is not finite */
  memcpy(b->x, x, b->size * sizeof *x);
  b->time = t;
  RIC_TRY(find_nearest(b, &time, error));
  if (isnan(time))
    return ric_fail(error, RIC_ENUMERIC, "obstacle %zu: the gap has no minimum within %g of t = %g", b->obstacle,
                    b->reach, t);
  RIC_TRY(move_to(b, time, error));
  *seen = (ric_bypass_seen){.t_C = NAN};
  RIC_TRY(settle_minimum(b, &seen->curvature, error));
  seen->tau = b->time - t;
  return read_gap(b, &seen->psi, error);
}

ric_status ric_bypass_look(ric_bypass *b, double t, const double *x, ric_bypass_seen *seen, ric_error *error) {
  ric_bypass_seen found;
  RIC_TRY(go_to_minimum(b, t, x, &found, error));
  *seen = found;
  return RIC_OK;
}

/* Newton's method on the gap, from where the search has found it open. So near to grazing that the gap's rounding
 * decides about the time, the search knows better: it has the rates. */
static ric_status settle_contact(ric_bypass *b, double tau, ric_error *error) {
  double rate, gap, last = fabs(b->time - tau) / 4;
  for (int k = 0; k < NEWTON_STEPS; k++) {
    RIC_TRY(read_gap(b, &gap, error));
    rate = ric_system_gap_rate(b->system, b->obstacle, b->time, b->x, b->x + b->system->coordinates);
    double step = -gap / rate;
    if (!(fabs(step) < last / 2) || b->time + step == b->time)
      return RIC_OK;
    last = fabs(step);
    RIC_TRY(move_to(b, b->time + step, error));
  }
  return RIC_OK;
}

/* From the minimum back to where the obstacle is reached, [FN97] (4.11) with the minus sign: on the way in. */
static ric_status go_to_contact(ric_bypass *b, const ric_bypass_seen *seen, ric_error *error) {
  double time, tau = b->time;
  RIC_TRY(gap_search_opening(&b->search, tau, b->x, -b->reach, seen->psi, &time, error));
  if (isnan(time))
    return ric_fail(error, RIC_ENUMERIC,
                    "obstacle %zu: the gap is %.3g at its minimum, t = %g, and does not open within %g before it",
                    b->obstacle, seen->psi, tau, b->reach);
  RIC_TRY(move_to(b, time, error));
  return settle_contact(b, tau, error);
}

static ric_status hit(ric_bypass *b, double *gap_rate, ric_error *error) {
  size_t n = b->system->coordinates;
  impact c = {.obstacle = b->obstacle, .restitution = b->system->model->restitution(b->system, b->obstacle)};
  RIC_TRY(impact_apply(&b->law, b->time, b->x, b->x + n, &c, 1, error));
  *gap_rate = fmin(c.rate, 0);
  if (c.rate_end >= turn_tol * *gap_rate - turn_rounding)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "obstacle %zu: an impact turns the gap rate %g into %g, expected >= 0",
                  b->obstacle, c.rate, c.rate_end);
}

ric_status ric_bypass_map(ric_bypass *b, double t, const double *x, double *image, ric_bypass_seen *seen,
                          ric_error *error) {
  ric_bypass_seen found;
  RIC_TRY(go_to_minimum(b, t, x, &found, error));
  if (found.psi <= 0) { /* [FN97] (4.2) */
    RIC_TRY(go_to_contact(b, &found, error));
    found.t_C = b->time - t;
    RIC_TRY(hit(b, &found.gap_rate, error));
    RIC_TRY(move_to(b, t, error));
    memcpy(image, b->x, b->size * sizeof *image);
  } else
    memmove(image, x, b->size * sizeof *image);
  if (seen)
    *seen = found;
  return RIC_OK;
}

ric_status ric_bypass_leading(ric_bypass *b, const ric_grazing_local *at_grazing, double t, const double *x,
                              double *image, ric_bypass_seen *seen, ric_error *error) {
  ric_bypass_seen found;
  RIC_TRY(grazing_check_local(at_grazing, b->system, error));
  RIC_TRY(go_to_minimum(b, t, x, &found, error));
  double y = sqrt(fmax(-found.psi, 0)), s = sqrt(2 * at_grazing->acceleration);
  for (size_t i = 0; i < b->size; i++)
    image[i] = x[i] + y * s * at_grazing->xi[i]; /* [FN97] (4.19) */
  if (seen)
    *seen = found;
  return RIC_OK;
}

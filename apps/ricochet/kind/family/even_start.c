#include "even_start.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Most steps of the walk. Where the motion goes on they are a dozen, near other families a hundred; more are a motion
 * that runs away, which costs and leads nowhere. */
enum { MOST_STEPS = 300 };

/* The parameter is the factor of the nonlinear terms. */
static ric_status set_factor(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  const even_start *e = user;
  (void)given;
  return lattice_model_rescale(e->model, p[0], system, error);
}

static ric_status make_family(even_start *e, const ric_shooting_problem *motion, double period, ric_error *error) {
  const ric_family_problem problem = {
      .system = e->system, .motion = *motion, .set = set_factor, .user = e, .parameters = 1, .given = period};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.p_low = 0;
  options.curve.p_high = 1;
  options.curve.direction = 1;
  options.curve.step = 0.25;
  options.curve.step_most = 1;
  options.curve.points = MOST_STEPS;
  options.curve.poll = motion->poll;
  return ric_family_create(&problem, &options, &e->family, error);
}

static ric_status solve_linear(even_start *e, double period, ric_error *error) {
  ric_error why = {0};
  double *rest = calloc(e->model->lattice.particles, sizeof *rest);
  const ric_status status = rest ? ric_family_start(e->family, 0, rest, rest, NULL, period, e->z, NULL, &why)
                                 : ric_fail(&why, RIC_ENOMEM, "no memory for a state");
  free(rest);
  if (status == RIC_ENUMERIC)
    return ric_fail(error, RIC_EINVAL, "no first guess: the linear part has no such motion: %.150s", why.message);
  return status == RIC_OK ? RIC_OK : ric_fail(error, status, "%s", why.message);
}

ric_status even_start_begin(even_start *e, const lattice_model *model, const ric_shooting_problem *motion,
                            double period, ric_error *error) {
  const size_t n = model->lattice.particles;
  *e = (even_start){.model = model, .period = period, .z = calloc(n, sizeof *e->z)};
  if (!e->z)
    return ric_fail(error, RIC_ENOMEM, "no memory for a motion of %zu particles", n);
  RIC_TRY(lattice_model_scaled(model, 0, &e->system, error));
  RIC_TRY(make_family(e, motion, period, error));
  return solve_linear(e, period, error);
}

/* At a fold the walk is over: beyond it energies grow without bound as the factor goes back to zero. */
static int keep_last(const ric_family_point *point, void *user) {
  even_start *e = user;
  memcpy(e->z, point->z, point->unknowns * sizeof *e->z);
  e->factor = point->parameter;
  return point->kind == RIC_FAMILY_FOLD;
}

/* Why the walk did not come to all nonlinear terms. */
static ric_status tell_end(const even_start *e, const ric_curve_run *run, ric_error *error) {
  static const char *const what = "no motion of the period %.6g goes on from that of the linear part: with growing "
                                  "nonlinear terms ";
  char begin[RIC_REASON_BYTES];
  snprintf(begin, sizeof begin, what, e->period);
  if (run->end == RIC_CURVE_ENDED)
    return ric_fail(error, RIC_ENUMERIC, "%sthe family turns back at %.4g of them", begin, e->factor);
  return ric_fail(error, RIC_ENUMERIC, "%sit comes to %.4g of them: %.80s", begin, e->factor,
                  run->reason[0] ? run->reason : "its steps are used up");
}

ric_status even_start_continue(even_start *e, ric_error *error) {
  ric_curve_run run = {0};
  ric_error why = {0};
  if (lattice_model_is_linear(e->model))
    return RIC_OK;
  const ric_status status = ric_family_follow(e->family, e->z, 0, NULL, keep_last, e, &run, &why);
  if (status != RIC_OK)
    return ric_fail(error, status, "the motion of the linear part does not go on: %.150s", why.message);
  if (run.end != RIC_CURVE_BOUND || e->factor != 1)
    return tell_end(e, &run, error);
  return lattice_model_rescale(e->model, 1, e->system, error);
}

void even_start_clear(even_start *e) {
  ric_family_destroy(&e->family);
  ric_system_destroy(&e->system);
  free(e->z);
  *e = (even_start){0};
}

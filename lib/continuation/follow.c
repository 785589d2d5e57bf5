/* The continuation run. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "corrector.h"
#include "ricochet/elementary.h"
#include "step.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Special points closer to a start with a given tangent, relative to the first step, are the start itself: a branch
 * point or a fold, accurate to rounding only. */
static const double start_itself = 1e-3;

/* Failed steps are shortened by this factor. Not by 1/2: the following steps would end at the same singular point. */
static const double shorter = 0.4;

/* Steps grow as long as the tangent turns by less than this fraction of the allowed angle. */
static const double turn_wanted = 0.7;

typedef struct curve_follower {
  ric_curve *c;
  int (*point)(const ric_curve_point *point, void *user);
  void *user;
  ric_curve_run *run;
  double h;   /* next step */
  bool along; /* the first step, along a given tangent */
  bool over;
  ric_error why; /* of the last failure */
} curve_follower;

static void end(curve_follower *w, ric_curve_end how, const char *reason) {
  w->run->end = how;
  w->over = true;
  snprintf(w->run->reason, sizeof w->run->reason, "%s", reason);
}

/* Passes a point to the caller. */
static void report_node(curve_follower *w, const curve_node *node, double step) {
  size_t n = w->c->problem.unknowns;
  const ric_curve_point point = {.kind = node->kind,
                                 .which = node->which,
                                 .p = node->x[n],
                                 .u = node->x,
                                 .t_u = node->t,
                                 .t_p = node->t[n],
                                 .arclength = node->arclength,
                                 .tests = w->c->problem.tests ? node->tests : NULL,
                                 .iterations = node->iterations,
                                 .step = step};
  if (w->point && w->point(&point, w->user) != 0)
    end(w, RIC_CURVE_ENDED, "");
}

static ric_status begin_along(ric_curve *c, const double *tangent, ric_error *error) {
  curve_node *node = &c->from;
  double length = curve_norm(c, tangent);
  if (!(length > 0 && length < INFINITY))
    return ric_fail(error, RIC_EINVAL, "tangent of length %g, expected a finite length > 0", length);
  if (c->options.natural && tangent[c->problem.unknowns] == 0)
    return ric_fail(error, RIC_EINVAL,
                    "natural steps with a tangent whose parameter component t_p = 0, expected pseudo-arclength");
  for (size_t i = 0; i < c->linear.size; i++)
    node->t[i] = tangent[i] / length;
  step_set_row(c);
  node->iterations = 0;
  ric_status status = bordered_factor(&c->linear, node->x, c->row, error);
  node->det = status == RIC_OK ? bordered_det(&c->linear) : (bordered_determinant){0};
  return status == RIC_ENUMERIC && c->linear.singular ? RIC_OK : status;
}

static ric_status begin_at(ric_curve *c, ric_error *error) {
  curve_node *node = &c->from;
  curve_parameter_row(c, c->options.direction, c->row);
  ric_status status = corrector_run(c, c->row, node->x, false, &node->iterations, error);
  if (status == RIC_ENUMERIC && c->linear.singular)
    return ric_fail(error, status, "the start at p = %.9g is singular: a tangent is required",
                    node->x[c->linear.size - 1]);
  RIC_TRY(status);
  return corrector_tangent(c, node->t, &node->det, error);
}

/* The first point. */
static ric_status begin_curve(curve_follower *w, double *u, double p, const double *tangent, ric_error *error) {
  ric_curve *c = w->c;
  size_t n = c->problem.unknowns;
  if (!(p >= c->options.p_low && p <= c->options.p_high && isfinite(p)))
    return ric_fail(error, RIC_EINVAL, "p = %g, expected a number in [%g, %g]", p, c->options.p_low, c->options.p_high);
  memcpy(c->from.x, u, n * sizeof *u);
  c->from.x[n] = p;
  RIC_TRY(tangent ? begin_along(c, tangent, error) : begin_at(c, error));
  c->from.kind = RIC_CURVE_REGULAR;
  c->from.sigma = c->from.arclength = 0;
  RIC_TRY(curve_tests(c, &c->from, error));
  curve_node_copy(c, &c->start, &c->from);
  memcpy(u, c->from.x, n * sizeof *u);
  c->pasts = 0;
  w->h = c->options.step;
  w->along = tangent != NULL;
  report_node(w, &c->from, 0);
  return RIC_OK;
}

/* Steps to `to`, with shorter and shorter steps until one succeeds. @param shortened  whether the first did not */
static ric_status step_curve(curve_follower *w, bool *landed, bool *closed, bool *shortened) {
  ric_curve *c = w->c;
  *shortened = *landed = *closed = false;
  for (;; w->h *= shorter, *shortened = true) {
    if (w->h < c->options.step_least)
      break;
    ric_status status = step_try(c, w->h, landed, &w->why);
    if (status == RIC_OK)
      status = step_close(c, closed, &w->why);
    if (status != RIC_ENUMERIC)
      return status;
  }
  end(w, RIC_CURVE_NOT_CONVERGED, w->why.message);
  return RIC_OK;
}

/* With a quarter of the allowed corrections the step length is kept; with two less it doubles, unless the tangent has
 * turned too much. Longer steps with more corrections each do not reduce the cost per length. */
static void choose_next(curve_follower *w, bool shortened) {
  const ric_curve_options *o = &w->c->options;
  double turn = step_turn(w->c), wanted = fmax(1, o->iterations / 4.0);
  double factor = ric_exp2((wanted - w->c->to.iterations) / 2);
  if (turn > 0)
    factor = fmin(factor, turn_wanted * o->turn / turn);
  factor = fmax(0.5, fmin(factor, shortened ? 1 : 2));
  w->h = fmin(o->step_most, fmax(o->step_least, factor * w->h));
}

/* Locates and reports the special points of the step. */
static ric_status show_special(curve_follower *w) {
  ric_curve *c = w->c;
  size_t count;
  RIC_TRY(locate_special(c, &count, &w->run->missed, &w->why));
  for (size_t k = 0; k < count && !w->over; k++) {
    if (w->along && c->found[k].sigma < start_itself * c->to.sigma)
      continue;
    w->run->special++;
    report_node(w, &c->found[k], c->found[k].sigma);
  }
  return RIC_OK;
}

/* One step, reported; sets the end if it is the last. */
static ric_status advance_curve(curve_follower *w) {
  ric_curve *c = w->c;
  bool landed, closed, shortened, keep = !w->along; /* a given tangent may be a guess */
  c->from.sigma = 0;
  step_set_row(c);
  RIC_TRY(step_curve(w, &landed, &closed, &shortened));
  if (w->over)
    return RIC_OK;
  c->to.kind = RIC_CURVE_REGULAR;
  RIC_TRY(show_special(w));
  w->along = false;
  if (w->over)
    return RIC_OK;
  w->run->points++;
  report_node(w, &c->to, c->to.sigma);
  if (!w->over && (landed || closed || w->run->points >= c->options.points))
    end(w, landed ? RIC_CURVE_BOUND : closed ? RIC_CURVE_CLOSED : RIC_CURVE_POINTS, "");
  choose_next(w, shortened);
  predictor_advance(c, keep);
  return RIC_OK;
}

/* Whether the curve leaves its range where it starts. */
static bool starts_outward(const ric_curve *c) {
  double p = c->from.x[c->problem.unknowns], t_p = c->from.t[c->problem.unknowns];
  return (p == c->options.p_high && t_p > 0) || (p == c->options.p_low && t_p < 0);
}

static ric_status run_to_end(curve_follower *w, double *u, double p, const double *tangent) {
  RIC_TRY(begin_curve(w, u, p, tangent, &w->why));
  if (!w->over && starts_outward(w->c))
    end(w, RIC_CURVE_BOUND, "");
  while (!w->over)
    RIC_TRY(advance_curve(w));
  return RIC_OK;
}

ric_status ric_curve_follow(ric_curve *curve, double *u, double p, const double *tangent,
                            int (*point)(const ric_curve_point *point, void *user), void *user, ric_curve_run *run,
                            ric_error *error) {
  REQUIRE(error, {"curve", curve}, {"u", u}, {"run", run});
  curve_follower w = {.c = curve, .point = point, .user = user, .run = run};
  *run = (ric_curve_run){0};
  curve->iterations = curve->linear.jacobians = 0;
  keep_gsl_quiet();
  ric_status status = run_to_end(&w, u, p, tangent);
  run->iterations = curve->iterations;
  run->jacobians = curve->linear.jacobians;
  if (status != RIC_OK && error)
    *error = w.why;
  return status;
}

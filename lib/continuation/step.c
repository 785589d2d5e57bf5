#include "step.h"

#include <math.h>
#include <string.h>

#include "corrector.h"
#include "cubic.h"
#include "predictor.h"

/* More than cubic_mismatch can be, over the chord, on a curve that turns by less than 1: the corrector has found
 * another curve. */
static const double other_curve = 0.1;

/* A step that ends so much nearer to a singular point than it begins has a tangent that is rounding. Walks in round
 * numbers meet branch points exactly. */
static const double too_near = 1e-3;

/* How near the cubic of a step must come to the start of the curve, over the step, for a look at whether it has closed;
 * and for taking it as closed where the corrector does not converge, at a branch point. */
static const double near_start = 1e-2, at_start = 1e-4;

static double parameter(const ric_curve *c, const curve_node *node) {
  return node->x[c->problem.unknowns];
}

void step_set_row(ric_curve *c) {
  if (c->options.natural)
    curve_parameter_row(c, c->from.t[c->problem.unknowns], c->row);
  else
    curve_tangent_row(c, c->from.t, c->row);
}

/* By the chord between the tangents: their product loses small angles. */
static double angle(const ric_curve *c, const double *a, const double *b) {
  return 2 * asin(fmin(1, curve_distance(c, a, b) / 2));
}

double step_turn(const ric_curve *c) {
  return angle(c, c->from.t, c->to.t);
}

static cubic step_cubic(const ric_curve *c) {
  return (cubic){c, c->row, &c->from, &c->to};
}

/* Whether `to` with its tangent can be the next point. */
static ric_status judge(const ric_curve *c, ric_error *error) {
  double turn = step_turn(c), chord = curve_distance(c, c->from.x, c->to.x);
  double rounding = sqrt(c->options.newton_tol) * (1 + curve_norm(c, c->to.x));
  cubic q = step_cubic(c);
  if (c->from.det.sign && !(c->to.det.least >= too_near * c->from.det.least))
    return ric_fail(error, RIC_ENUMERIC, "the step ends at a singular point, p = %.9g", parameter(c, &c->to));
  if (!(turn <= c->options.turn))
    return ric_fail(error, RIC_ENUMERIC, "the tangent turns by %.3g at p = %.9g", turn, parameter(c, &c->to));
  if (!(cubic_mismatch(&q) <= other_curve * chord + rounding))
    return ric_fail(error, RIC_ENUMERIC, "Newton's method finds another curve at p = %.9g", parameter(c, &c->to));
  return RIC_OK;
}

static void measure(ric_curve *c) {
  cubic q = step_cubic(c);
  c->to.arclength = c->from.arclength + cubic_length(&q);
}

static bool beyond(const ric_curve *c, double p) {
  return p > c->options.p_high || p < c->options.p_low;
}

/* The end of the range that p is beyond. */
static double bound_before(const ric_curve *c, double p) {
  return p > c->options.p_high ? c->options.p_high : c->options.p_low;
}

static void predict(ric_curve *c, double h) {
  c->to.sigma = predictor_point(c, h, c->to.x);
  c->to.iterations = 0;
}

/* Corrects `to` in the hyperplane of a row. */
static ric_status correct(ric_curve *c, const double *row, ric_error *error) {
  int before = c->to.iterations;
  RIC_TRY(corrector_run(c, row, c->to.x, true, &c->to.iterations, error));
  c->to.iterations += before;
  return corrector_tangent(c, c->to.t, &c->to.det, error);
}

/* Corrects `to` at the end of the range, near a prediction there. @param most  the progress that is allowed */
static ric_status correct_at_bound(ric_curve *c, double bound, double most, ric_error *error) {
  double *p = &c->to.x[c->problem.unknowns];
  *p = bound;
  curve_parameter_row(c, bound == c->options.p_high ? 1 : -1, c->bound_row);
  RIC_TRY(correct(c, c->bound_row, error));
  *p = bound;
  c->to.sigma = curve_progress(c, c->to.x);
  if (!(c->to.sigma > 0 && c->to.sigma <= most))
    return ric_fail(error, RIC_ENUMERIC, "the end of the range, p = %.9g, is not met in the step", bound);
  return RIC_OK;
}

/* A step whose tangent leaves the range goes to its end at once: the problem may be undefined beyond. */
static ric_status step_to_bound(ric_curve *c, double h, ric_error *error) {
  double p = parameter(c, &c->from), bound = bound_before(c, parameter(c, &c->to));
  predict(c, h * (bound - p) / (parameter(c, &c->to) - p));
  RIC_TRY(correct_at_bound(c, bound, 2 * h, error));
  return judge(c, error);
}

static ric_status step_freely(ric_curve *c, double h, ric_error *error) {
  predict(c, h);
  RIC_TRY(correct(c, c->row, error));
  return judge(c, error);
}

/* A step that has left the range is moved back to its end along the cubic. */
static ric_status move_to_bound(ric_curve *c, ric_error *error) {
  double from = parameter(c, &c->from), to = parameter(c, &c->to), bound = bound_before(c, to), end = c->to.sigma;
  cubic q = step_cubic(c);
  cubic_point(&q, (bound - from) / (to - from) * end, c->trial.x);
  memcpy(c->to.x, c->trial.x, c->linear.size * sizeof *c->to.x);
  return correct_at_bound(c, bound, end, error);
}

/* Where the end of the range is not met, the curve may bend back before it. */
ric_status step_try(ric_curve *c, double h, bool *landed, ric_error *error) {
  predict(c, h);
  *landed = beyond(c, parameter(c, &c->to));
  ric_status status = *landed ? step_to_bound(c, h, error) : RIC_ENUMERIC;
  if (status == RIC_ENUMERIC) {
    RIC_TRY(step_freely(c, h, error));
    *landed = beyond(c, parameter(c, &c->to));
    status = *landed ? move_to_bound(c, error) : RIC_OK;
  }
  RIC_TRY(status);
  measure(c);
  return curve_tests(c, &c->to, error);
}

/* Whether the curve comes back to its start at `trial`, which is on the cubic of the step. */
static ric_status meets_start(ric_curve *c, bool *meets, ric_error *error) {
  const curve_node *start = &c->start;
  double *x = c->trial.x, gap = curve_distance(c, x, start->x), step = c->to.sigma;
  int iterations;
  if (!(gap <= near_start * step && angle(c, c->trial.t, start->t) <= c->options.turn))
    return RIC_OK;
  ric_status status = corrector_run(c, c->row, x, true, &iterations, error);
  if (status == RIC_OK)
    *meets = curve_distance(c, x, start->x) <= sqrt(c->options.newton_tol) * (1 + curve_norm(c, x));
  else if (status == RIC_ENUMERIC)
    *meets = gap <= at_start * step;
  return status == RIC_ENUMERIC ? RIC_OK : status;
}

ric_status step_close(ric_curve *c, bool *closed, ric_error *error) {
  double sigma = curve_progress(c, c->start.x), end = c->to.sigma;
  int iterations = c->to.iterations;
  cubic q = step_cubic(c);
  *closed = false;
  if (!(sigma > 0 && sigma <= end * (1 + at_start)))
    return RIC_OK;
  cubic_point(&q, sigma, c->trial.x);
  cubic_tangent(&q, sigma, c->trial.t);
  RIC_TRY(meets_start(c, closed, error));
  if (!*closed)
    return RIC_OK;
  curve_node_copy(c, &c->to, &c->start);
  c->to.sigma = sigma;
  c->to.iterations = iterations;
  measure(c);
  return RIC_OK;
}

/* One step along the curve: prediction, correction, and the cubic through two points. */
#include "step.h"

#include <math.h>
#include <string.h>

#include "corrector.h"
#include "ricochet/elementary.h"

/* d x_i / d sigma at both ends */
typedef struct slopes {
  double scale_a, scale_b, length;
} slopes;

static slopes slopes_of(const cubic *q) {
  return (slopes){.scale_a = 1 / curve_row_dot(q->c, q->row, q->a->t),
                  .scale_b = 1 / curve_row_dot(q->c, q->row, q->b->t),
                  .length = q->b->sigma - q->a->sigma};
}

void cubic_point(const cubic *q, double sigma, double *x) {
  slopes s = slopes_of(q);
  double f = (sigma - q->a->sigma) / s.length, g = 1 - f;
  double to_b = f * f * (3 - 2 * f), of_a = f * g * g * s.length * s.scale_a, of_b = -f * f * g * s.length * s.scale_b;
  for (size_t i = 0; i < q->c->linear.size; i++)
    x[i] = q->a->x[i] + to_b * (q->b->x[i] - q->a->x[i]) + of_a * q->a->t[i] + of_b * q->b->t[i];
}

static void derivative(const cubic *q, double sigma, double *t) {
  slopes s = slopes_of(q);
  double f = (sigma - q->a->sigma) / s.length, g = 1 - f;
  double chord = 6 * f * g / s.length, of_a = g * (1 - 3 * f) * s.scale_a, of_b = f * (3 * f - 2) * s.scale_b;
  for (size_t i = 0; i < q->c->linear.size; i++)
    t[i] = chord * (q->b->x[i] - q->a->x[i]) + of_a * q->a->t[i] + of_b * q->b->t[i];
}

void cubic_tangent(const cubic *q, double sigma, double *t) {
  derivative(q, sigma, t);
  double length = curve_norm(q->c, t);
  for (size_t i = 0; i < q->c->linear.size; i++)
    t[i] /= length;
}

double cubic_length(const cubic *q) {
  slopes s = slopes_of(q);
  derivative(q, q->a->sigma + s.length / 2, q->c->z);
  return s.length * (fabs(s.scale_a) + 4 * curve_norm(q->c, q->c->z) + fabs(s.scale_b)) / 6;
}

/** Deviation of the chord from the mean of the end tangents: (turn)^2 / 12 of it on a circle, more if the ends lie on
 *  different curves. */
static double cubic_mismatch(const cubic *q) {
  slopes s = slopes_of(q);
  double *z = q->c->z;
  for (size_t i = 0; i < q->c->linear.size; i++)
    z[i] = q->b->x[i] - q->a->x[i] - s.length / 2 * (s.scale_a * q->a->t[i] + s.scale_b * q->b->t[i]);
  return curve_norm(q->c, z);
}

/* Variable of the polynomial: p for natural steps; otherwise arclength, in which a circle is smoothest. (In the
 * progress sigma its sixth derivative is 45 times as large.) */
static double place_of(const ric_curve *c, const curve_node *node) {
  size_t n = c->problem.unknowns;
  return c->options.natural ? c->row[n] * (node->x[n] - c->from.x[n]) : node->arclength - c->from.arclength;
}

static double scale_of(const ric_curve *c, const curve_node *node) {
  return c->options.natural ? 1 / curve_row_dot(c, c->row, node->t) : 1;
}

/* Hermite's polynomial through the last points along their tangents, by its basis. */
static void extrapolate(const ric_curve *c, size_t count, double h, double *x) {
  const curve_node *nodes[1 + CURVE_PAST] = {&c->from};
  double at[1 + CURVE_PAST] = {0};
  for (size_t k = 1; k < count; k++) {
    nodes[k] = &c->past[k - 1];
    at[k] = place_of(c, nodes[k]);
  }
  memset(x, 0, c->linear.size * sizeof *x);
  for (size_t k = 0; k < count; k++) {
    double l = 1, slope = 0, ahead = h - at[k];
    for (size_t j = 0; j < count; j++)
      if (j != k) {
        l *= (h - at[j]) / (at[k] - at[j]);
        slope += 1 / (at[k] - at[j]);
      }
    double of_x = (1 - 2 * slope * ahead) * l * l, of_t = ahead * l * l * scale_of(c, nodes[k]);
    for (size_t i = 0; i < c->linear.size; i++)
      x[i] += of_x * nodes[k]->x[i] + of_t * nodes[k]->t[i];
  }
}

/** The point ahead of `from` by h, in arclength or, for natural steps, in p: on the tangent, or on the polynomial
 * through `from` and points before it along their tangents, of the highest degree that changes the prediction by less
 * than half as much as the previous degree did.
 *  @param x  [n + 1] set
 *  @returns its progress over c->row, which is > 0 */
static double predictor_point(ric_curve *c, double h, double *x) {
  extrapolate(c, 1, h, x);
  double change = h, rounding = c->options.newton_tol * (1 + curve_norm(c, x));
  size_t count = 1;
  for (; count <= c->pasts; count++) {
    double before = change;
    extrapolate(c, count + 1, h, c->z);
    change = curve_distance(c, c->z, x);
    if (!(change > rounding && change < before / 2))
      break;
    memcpy(x, c->z, c->linear.size * sizeof *x);
  }
  return c->options.natural || count == 1 ? h : curve_progress(c, x);
}

/* Swaps the nodes without copying. */
void predictor_advance(ric_curve *c, bool keep) {
  curve_node oldest = c->past[CURVE_PAST - 1];
  for (size_t k = CURVE_PAST - 1; k > 0; k--)
    c->past[k] = c->past[k - 1];
  c->past[0] = c->from;
  c->from = c->to;
  c->to = oldest;
  c->pasts = !keep ? 0 : c->pasts < CURVE_PAST ? c->pasts + 1 : CURVE_PAST;
}

/* Upper bound of cubic_mismatch, relative to the chord, on a curve that turns by less than 1; above it the corrector
 * has found another curve. */
static const double other_curve = 0.1;

/* A step that ends closer to a singular point by this factor than it begins has a tangent dominated by rounding. Runs
 * in round numbers hit branch points exactly. */
static const double too_near = 1e-3;

/* Distance of the cubic of a step from the start of the curve, relative to the step, below which closing is tested; and
 * below which the curve counts as closed if the corrector does not converge, at a branch point. */
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

/* From the chord between the tangents: the inner product loses small angles. */
static double angle(const ric_curve *c, const double *a, const double *b) {
  return 2 * ric_asin(fmin(1, curve_distance(c, a, b) / 2));
}

double step_turn(const ric_curve *c) {
  return angle(c, c->from.t, c->to.t);
}

static cubic step_cubic(const ric_curve *c) {
  return (cubic){c, c->row, &c->from, &c->to};
}

/* Whether `to` with its tangent can be the next point. */
static ric_status check_next_point(const ric_curve *c, ric_error *error) {
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

/* The bound that p has passed. */
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

/* Corrects `to` at the end of the range, near a prediction there. @param most  largest allowed progress */
static ric_status correct_at_bound(ric_curve *c, double bound, double most, ric_error *error) {
  double *p = &c->to.x[c->problem.unknowns];
  *p = bound;
  curve_parameter_row(c, bound == c->options.p_high ? 1 : -1, c->bound_row);
  RIC_TRY(correct(c, c->bound_row, error));
  *p = bound;
  c->to.sigma = curve_progress(c, c->to.x);
  if (!(c->to.sigma > 0 && c->to.sigma <= most))
    return ric_fail(error, RIC_ENUMERIC, "the bound p = %.9g is not reached in the step", bound);
  return RIC_OK;
}

/* A step whose tangent leaves the range goes directly to the bound: the problem may be undefined beyond it. */
static ric_status step_to_bound(ric_curve *c, double h, ric_error *error) {
  double p = parameter(c, &c->from), bound = bound_before(c, parameter(c, &c->to));
  predict(c, h * (bound - p) / (parameter(c, &c->to) - p));
  RIC_TRY(correct_at_bound(c, bound, 2 * h, error));
  return check_next_point(c, error);
}

static ric_status step_freely(ric_curve *c, double h, ric_error *error) {
  predict(c, h);
  RIC_TRY(correct(c, c->row, error));
  return check_next_point(c, error);
}

/* A step that has left the range is moved back to the bound along the cubic. */
static ric_status move_to_bound(ric_curve *c, ric_error *error) {
  double from = parameter(c, &c->from), to = parameter(c, &c->to), bound = bound_before(c, to), end = c->to.sigma;
  cubic q = step_cubic(c);
  cubic_point(&q, (bound - from) / (to - from) * end, c->trial.x);
  memcpy(c->to.x, c->trial.x, c->linear.size * sizeof *c->to.x);
  return correct_at_bound(c, bound, end, error);
}

/* If the bound is not reached, the curve may bend back before it. */
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

/* Whether the curve returns to its start at `trial`, which is on the cubic of the step. */
static ric_status returns_to_start(ric_curve *c, bool *returns, ric_error *error) {
  const curve_node *start = &c->start;
  double *x = c->trial.x, gap = curve_distance(c, x, start->x), step = c->to.sigma;
  int iterations;
  if (!(gap <= near_start * step && angle(c, c->trial.t, start->t) <= c->options.turn))
    return RIC_OK;
  ric_status status = corrector_run(c, c->row, x, true, &iterations, error);
  if (status == RIC_OK)
    *returns = curve_distance(c, x, start->x) <= sqrt(c->options.newton_tol) * (1 + curve_norm(c, x));
  else if (status == RIC_ENUMERIC)
    *returns = gap <= at_start * step;
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
  RIC_TRY(returns_to_start(c, closed, error));
  if (!*closed)
    return RIC_OK;
  curve_node_copy(c, &c->to, &c->start);
  c->to.sigma = sigma;
  c->to.iterations = iterations;
  measure(c);
  return RIC_OK;
}

#include "ricochet/cycle_window.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include "cycle_equations.h"
#include "ricochet/elementary.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

enum { MOST_STEPS = 100000, MOST_TRIALS = 200 };

/* Steps, in lengths of the curve: the largest, the smallest, and their factors of growth and reduction. */
static const double longest = 0.1, shortest = 1e-11, growth = 1.5, shrink = 0.5;

/* Steps are accepted where Newton's method changes their end by less than this part, and the tangent turns by less. */
static const double most_moved = 0.1, most_turn = 0.3;

/* A step from multipliers inside the unit circle to multipliers this large is repeated with a shorter length, unless
 * it is this short: several multipliers may have left the unit circle. */
static const double too_large = 2, short_step = 1e-6;

/* Zeros in one step that are nearer than this part of it count as one. */
static const double same_place = 1e-9;

/* Tests that end a window; those of the borders of the iterates follow. The curve turns where a multiplier is 1.
 * Where a cycle bifurcates from one of half its period the curve turns too: it continues as the same cycle, shifted
 * by half a period, and is stable on both sides. */
enum { TEST_MULTIPLIERS, TEST_TURN, TEST_ITERATES };

/* A point of the curve. Its tests are positive while the cycle is admissible and stable, and before the curve turns. */
typedef struct cycle_point {
  double *x, *tangent; /* [N + 1] */
  double *tests;       /* [TEST_ITERATES + period] */
  double place;        /* along the tangent of the point before it */
} cycle_point;

typedef struct edge_search {
  cycle_equations equations;
  cycle_curve curve;
  cycle_point from, before, here, next, trial; /* the first point of the run; the points of the present step */
  double *row, *block;                         /* [N + 1] <tangent, .>; owns all arrays */
  size_t tests, which;                         /* number of tests; the one whose zero is searched */
  double direction;                            /* of the parameter: -1, 1 */
  gsl_root_fsolver *root;
  ric_poll poll;
  ric_status status; /* of the last trial */
  ric_error *error;
} edge_search;

/* --- life --------------------------------------------------------------------------------------------------------- */

static ric_status allocate_points(edge_search *w, ric_error *error) {
  size_t size = w->curve.size, each = 2 * size + w->tests;
  cycle_point *points[] = {&w->from, &w->before, &w->here, &w->next, &w->trial};
  w->root = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  w->block = calloc(5 * each + size, sizeof *w->block);
  if (!(w->root && w->block))
    return ric_fail(error, RIC_ENOMEM, "no memory for points of %zu unknowns", size);
  for (int k = 0; k < 5; k++) {
    double *from = w->block + (size_t)k * each;
    *points[k] = (cycle_point){.x = from, .tangent = from + size, .tests = from + 2 * size};
  }
  w->row = w->block + 5 * each;
  return RIC_OK;
}

static ric_status edge_search_init(edge_search *w, const ric_map_line *line, double p, size_t period, double step,
                                   const double *z, ric_error *error) {
  *w = (edge_search){.tests = TEST_ITERATES + period, .error = error};
  RIC_TRY(cycle_equations_init(&w->equations, line, p, period, z, error));
  RIC_TRY(cycle_curve_init(&w->curve, &w->equations, p, step, error));
  return allocate_points(w, error);
}

static void edge_search_clear(edge_search *w) {
  gsl_root_fsolver_free(w->root);
  free(w->block);
  cycle_curve_clear(&w->curve);
  cycle_equations_clear(&w->equations);
}

static void copy(const edge_search *w, cycle_point *to, const cycle_point *from) {
  memcpy(to->x, from->x, w->curve.size * sizeof *to->x);
  memcpy(to->tangent, from->tangent, w->curve.size * sizeof *to->x);
  memcpy(to->tests, from->tests, w->tests * sizeof *to->x);
  to->place = from->place;
}

static double parameter_of(const edge_search *w, const cycle_point *a) {
  return a->x[w->curve.size - 1];
}

/* --- the tests ---------------------------------------------------------------------------------------------------- */

/* Tests of a solution with its tangent; the map must be that of its parameter. Multipliers are infinite at y = 0. */
static ric_status evaluate_point(edge_search *w, cycle_point *a, ric_error *error) {
  cycle_equations_at(&w->equations, a->x, w->curve.beside, NULL, 0, a->tests + TEST_ITERATES);
  ric_status status = cycle_equations_spectrum(&w->equations, a->x, error);
  double largest = w->equations.multipliers.largest;
  if (status != RIC_OK && status != RIC_ENUMERIC)
    return status;
  a->tests[TEST_MULTIPLIERS] = status == RIC_OK ? (1 - largest) / (1 + largest) : -1;
  a->tests[TEST_TURN] = w->direction * a->tangent[w->curve.size - 1] / w->curve.scale[w->curve.size - 1];
  return RIC_OK;
}

/* --- the cycle at a parameter ------------------------------------------------------------------------------------- */

static ric_status check_found(edge_search *w, const cycle_point *a, ric_error *error) {
  const cycle_equations *e = &w->equations;
  for (size_t k = 0; k < e->period; k++) {
    double clearance = a->tests[TEST_ITERATES + k];
    if (!(e->hits[k] ? clearance >= 0 : clearance > 0))
      return ric_fail(error, RIC_ENUMERIC, "the cycle at p = %.9g has another itinerary: iterate %zu %s", e->parameter,
                      k, e->hits[k] ? "has no impact" : "has an impact");
  }
  size_t least = cycle_equations_least_period(&w->equations, a->x);
  if (least < e->period)
    return ric_fail(error, RIC_EINVAL, "period = %zu: the cycle at p = %.9g has the period %zu", e->period,
                    e->parameter, least);
  return RIC_OK;
}

static ric_status start(edge_search *w, double p, double *z, ric_cycle_window *window, ric_error *error) {
  cycle_point *a = &w->here;
  cycle_equations_guess(&w->equations, z, a->x);
  a->x[w->curve.size - 1] = p;
  cycle_curve_measure(&w->curve, a->x);
  RIC_TRY(cycle_curve_correct(&w->curve, a->x, NULL, NULL, error));
  RIC_TRY(evaluate_point(w, a, error));
  RIC_TRY(check_found(w, a, error));
  memcpy(z, a->x, w->equations.map.size * sizeof *z);
  const bool known = a->tests[TEST_MULTIPLIERS] > -1;
  *window = (ric_cycle_window){.period = w->equations.period,
                               .impacts = w->equations.impacts,
                               .p = p,
                               .stable = a->tests[TEST_MULTIPLIERS] > 0,
                               .largest = known ? w->equations.multipliers.mu[0] : (ric_complex){INFINITY, 0}};
  return RIC_OK;
}

ric_status ric_cycle_find(const ric_map_line *line, double p, size_t period, double *z, ric_cycle_window *window,
                          ric_error *error) {
  REQUIRE(error, {"line", line}, {"z", z}, {"window", window});
  edge_search w;
  keep_gsl_quiet();
  ric_status status = edge_search_init(&w, line, p, period, 1, z, error);
  if (status == RIC_OK)
    status = start(&w, p, z, window, error);
  edge_search_clear(&w);
  return status;
}

/* --- a step ------------------------------------------------------------------------------------------------------- */

/* The next point `length` ahead, or at the bound if that is nearer. */
static ric_status step_to(edge_search *w, double length, double bound, bool *good, ric_error *error) {
  cycle_curve *c = &w->curve;
  const size_t last = c->size - 1;
  const double rate = w->here.tangent[last], left = (bound - w->here.x[last]) / rate;
  const bool ends = rate != 0 && left >= 0 && length >= left;
  double moved;
  if (ends)
    length = left;
  for (size_t i = 0; i <= last; i++)
    w->next.x[i] = w->here.x[i] + length * w->here.tangent[i];
  if (ends)
    w->next.x[last] = bound;
  RIC_TRY(cycle_curve_correct(c, w->next.x, ends ? NULL : w->row, &moved, error));
  RIC_TRY(cycle_curve_tangent(c, w->next.x, w->row, w->next.tangent, error));
  RIC_TRY(evaluate_point(w, &w->next, error));
  w->next.place = 0;
  for (size_t i = 0; i <= last; i++)
    w->next.place += w->row[i] * (w->next.x[i] - w->here.x[i]);
  *good = moved <= most_moved * length && w->next.place > 0 &&
          cycle_curve_product(c, w->here.tangent, w->next.tangent) >= ric_cos(most_turn);
  return RIC_OK;
}

static bool is_past(const cycle_point *a, size_t test) {
  return !(a->tests[test] > 0);
}

static bool ends_window(const edge_search *w, const cycle_point *a) {
  for (size_t k = 0; k < w->tests; k++)
    if (is_past(a, k))
      return true;
  return false;
}

/* The place of a minimum below 0 in (0, next) of the parabola through three values of a test; 0: none. */
static double parabola_minimum(double before, double next, const double *values) {
  const double left = (values[1] - values[0]) / -before, right = (values[2] - values[1]) / next;
  const double curvature = (right - left) / (next - before), slope = left - curvature * before;
  const double place = -slope / (2 * curvature);
  if (!(curvature > 0 && place > 0 && place < next))
    return 0;
  return values[1] + slope * place / 2 < 0 ? place : 0;
}

/* The first place in the step at which a test may be negative between two positive values; 0: none. */
static double find_hidden_minimum(const edge_search *w) {
  double first = 0;
  for (size_t k = 0; k < w->tests && w->before.place < 0; k++) {
    const double values[] = {w->before.tests[k], w->here.tests[k], w->next.tests[k]};
    const double place = parabola_minimum(w->before.place, w->next.place, values);
    if (place > 0 && (first == 0 || place < first))
      first = place;
  }
  return first;
}

/* The length that the last step should have had: its own, or a shorter one. */
static double preferred_length(const edge_search *w, double length, bool good) {
  if (!good)
    return shrink * length;
  if (length <= short_step)
    return length;
  if (w->next.tests[TEST_MULTIPLIERS] < (1 - too_large) / (1 + too_large))
    return shrink * length;
  const double minimum = ends_window(w, &w->next) ? 0 : find_hidden_minimum(w);
  return minimum > 0 ? fmin(fmax(minimum, 0.1 * length), shrink * length) : length;
}

/* Makes a step, and sets the length of the next one. */
static ric_status step_window(edge_search *w, double *length, double bound, ric_error *error) {
  for (;;) {
    bool good = false;
    if (ric_poll_stops(w->poll))
      return ric_fail(error, RIC_ESTOPPED, "stopped at p = %.9g", parameter_of(w, &w->here));
    ric_status status = step_to(w, *length, bound, &good, error);
    if (status != RIC_OK && status != RIC_ENUMERIC && status != RIC_EINVAL)
      return status;
    const double better = preferred_length(w, *length, status == RIC_OK && good);
    if (better == *length) {
      *length = fmin(growth * *length, longest);
      return RIC_OK;
    }
    *length = better;
    if (!(*length >= shortest))
      return ric_fail(error, RIC_ENUMERIC, "the cycle cannot be followed beyond p = %.17g", parameter_of(w, &w->here));
  }
}

/* --- edges -------------------------------------------------------------------------------------------------------- */

/* The point at a place between `here` and `next`. */
static ric_status evaluate_place(edge_search *w, double place) {
  const double part = place / w->next.place;
  for (size_t i = 0; i < w->curve.size; i++)
    w->trial.x[i] = w->here.x[i] + part * (w->next.x[i] - w->here.x[i]);
  RIC_TRY(cycle_curve_correct(&w->curve, w->trial.x, w->row, NULL, w->error));
  RIC_TRY(cycle_curve_tangent(&w->curve, w->trial.x, w->row, w->trial.tangent, w->error));
  w->trial.place = place;
  return evaluate_point(w, &w->trial, w->error);
}

static double test_at(double place, void *user) {
  edge_search *w = user;
  w->status = evaluate_place(w, place);
  return w->status == RIC_OK ? w->trial.tests[w->which] : NAN;
}

/* The zero of one test up to a place at which it is not positive; sets the trial point to it. */
static ric_status find_zero(edge_search *w, double to) {
  gsl_function f = {test_at, w};
  double root = to;
  if (!(test_at(0, w) > 0) || test_at(to, w) > 0) /* their signs differ by rounding only */
    return w->status;
  int code = gsl_root_fsolver_set(w->root, &f, 0, to);
  for (int k = 0; k < MOST_TRIALS && code == GSL_SUCCESS; k++) {
    code = gsl_root_fsolver_iterate(w->root);
    root = gsl_root_fsolver_root(w->root);
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(w->root), gsl_root_fsolver_x_upper(w->root), 0,
                               4 * DBL_EPSILON) == GSL_SUCCESS)
      break;
  }
  RIC_TRY(w->status);
  if (code != GSL_SUCCESS)
    return ric_fail(w->error, gsl_status(code), "the edge near p = %.17g is not found: %s", parameter_of(w, &w->trial),
                    gsl_text(code));
  return evaluate_place(w, root);
}

static ric_grazing_edge_kind kind_of(ric_complex mu) {
  return mu.im != 0 ? RIC_EDGE_COMPLEX : mu.re > 0 ? RIC_EDGE_FOLD : RIC_EDGE_FLIP;
}

/* Whether a test has a zero in the step before the trial point, to which it then sets the trial point. A test that
 * is positive at the trial point has none; of zeros that count as one the first is kept. */
static ric_status find_zero_before(edge_search *w, size_t test, size_t *first, bool *found) {
  const double to = w->trial.place;
  *found = false;
  if (test == *first || !is_past(&w->trial, test))
    return RIC_OK;
  w->which = test;
  RIC_TRY(find_zero(w, to));
  *found = w->trial.place < to * (1 - same_place) || *first == SIZE_MAX;
  if (*found)
    *first = test;
  return RIC_OK;
}

/* The first zero of all tests in the step. Tests may be positive at both ends of the step and negative in between,
 * as those of the multipliers near y = 0: after each zero all tests are repeated. */
static ric_status find_first(edge_search *w, ric_cycle_edge *edge) {
  size_t first = SIZE_MAX;
  bool found = true;
  copy(w, &w->trial, &w->next);
  for (size_t pass = 0; pass < w->tests && found; pass++) {
    found = false;
    for (size_t k = 0; k < w->tests && !found; k++) /* borders before multipliers */
      RIC_TRY(find_zero_before(w, (k + TEST_ITERATES) % w->tests, &first, &found));
  }
  edge->p = parameter_of(w, &w->trial);
  edge->iterate = first >= TEST_ITERATES ? first - TEST_ITERATES : 0;
  edge->kind = first >= TEST_ITERATES ? RIC_EDGE_BORDER
               : first == TEST_TURN   ? RIC_EDGE_FOLD
                                      : kind_of(w->equations.multipliers.mu[0]);
  return RIC_OK;
}

/* The next point becomes the present one. */
static void accept(edge_search *w) {
  cycle_curve *c = &w->curve;
  copy(w, &w->before, &w->here);
  copy(w, &w->here, &w->next);
  cycle_curve_measure(c, w->here.x);
  const double length = sqrt(cycle_curve_product(c, w->here.tangent, w->here.tangent));
  for (size_t i = 0; i < c->size; i++)
    w->here.tangent[i] /= length;
  cycle_curve_row(c, w->here.tangent, w->row);
  w->before.place = 0;
  for (size_t i = 0; i < c->size; i++)
    w->before.place += w->row[i] * (w->before.x[i] - w->here.x[i]);
}

/* Follows the curve from `here` to the edge in the direction of a bound. */
static ric_status find_edge(edge_search *w, double bound, double step_in_p, ric_cycle_edge *edge, ric_error *error) {
  cycle_curve *c = &w->curve;
  const size_t last = c->size - 1;
  RIC_TRY(cycle_equations_set(&w->equations, w->here.x[last], error));
  cycle_curve_measure(c, w->here.x);
  RIC_TRY(cycle_curve_tangent(c, w->here.x, NULL, w->here.tangent, error));
  w->direction = bound < w->here.x[last] ? -1 : 1;
  for (size_t i = 0; i < c->size; i++)
    w->here.tangent[i] *= w->direction;
  w->here.tests[TEST_TURN] = fabs(w->here.tangent[last]) / c->scale[last];
  cycle_curve_row(c, w->here.tangent, w->row);
  w->before.place = 0;
  double length = fmin(step_in_p / fabs(w->here.tangent[last]), longest);
  for (size_t k = 0; k < MOST_STEPS; k++) {
    RIC_TRY(step_window(w, &length, bound, error));
    if (ends_window(w, &w->next))
      return find_first(w, edge);
    if (parameter_of(w, &w->next) == bound) {
      *edge = (ric_cycle_edge){.kind = RIC_EDGE_OPEN, .p = bound};
      return RIC_OK;
    }
    accept(w);
  }
  return ric_fail(error, RIC_ENUMERIC, "no edge within %d steps up to p = %.9g", MOST_STEPS, parameter_of(w, &w->here));
}

/* --- the window --------------------------------------------------------------------------------------------------- */

static ric_status find_window(edge_search *w, double low, double high, double step_in_p, double *z,
                              ric_cycle_window *window, ric_error *error) {
  ric_cycle_window found;
  const double p = w->equations.parameter;
  RIC_TRY(start(w, p, z, &found, error));
  if (!found.stable)
    return ric_fail(error, RIC_EINVAL, "the cycle at p = %.9g is not stable: multiplier %.9g%+.9gi", p,
                    found.largest.re, found.largest.im);
  copy(w, &w->from, &w->here);
  w->curve.low = low;
  w->curve.high = high;
  RIC_TRY(find_edge(w, low, step_in_p, &found.low, error));
  copy(w, &w->here, &w->from);
  RIC_TRY(find_edge(w, high, step_in_p, &found.high, error));
  *window = found;
  return RIC_OK;
}

ric_status ric_cycle_window_find(const ric_map_line *line, double p, size_t period, double low, double high,
                                 double step, double *z, ric_poll poll, ric_cycle_window *window, ric_error *error) {
  REQUIRE(error, {"line", line}, {"z", z}, {"window", window});
  edge_search w;
  ric_error own;
  if (!(low < p))
    return ric_fail(error, RIC_EINVAL, "low = %.9g, expected less than p = %.9g", low, p);
  if (!(high > p))
    return ric_fail(error, RIC_EINVAL, "high = %.9g, expected more than p = %.9g", high, p);
  if (!(step >= 0 && isfinite(step)))
    return ric_fail(error, RIC_EINVAL, "step = %g, expected a finite number >= 0", step);
  const double first = step > 0 ? step : 1e-3;
  keep_gsl_quiet();
  ric_status status = edge_search_init(&w, line, p, period, first, z, error ? error : &own);
  w.poll = poll;
  if (status == RIC_OK)
    status = find_window(&w, low, high, first * (p != 0 ? fabs(p) : 1), z, window, error);
  edge_search_clear(&w);
  return status;
}

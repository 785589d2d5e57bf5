/* The discontinuity mapping (bypass map): the minimum of the gap, the map itself, and kappa, its second order. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "impact/impact_law.h"
#include "impact/locate.h"
#include "grazing.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "shooting/arcs.h"

/* Search for the minimum of the gap of the free motion, and for its opening, forwards and backwards in time.
 *
 * The search uses the gap rate: in a short motion the gap may vary by less than its rounding while the rate varies by
 * many times its own. Rates are polynomials on the segments of the flow; certified searches (polynomial.h) are applied
 * to their integrals. */

typedef struct gap_search {
  ric_flow *flow; /* borrowed */
  size_t obstacle;
  gap_reader reader;
} gap_search;

/* A short interval of the free motion in one step.
 *
 * A flow with variable order starts with short steps of low order, each with an error up to its tolerance: after an
 * interval of 1e-6 the gap of a motion that grazes by 1e-13 is lost in this error. Here Gragg's midpoint rule is
 * extrapolated (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.9). Over intervals that
 * are short for the motion its error is rounding only; otherwise it reports failure. */

typedef struct gragg {
  const ric_system *system;
  double *rows;                /* [GRAGG_ROWS][n + m] extrapolations of one row, replacing those of the previous row */
  double *before, *now, *rate; /* [n + m] displacements from the start; rates of change */
  double *point;               /* [n + m] */
} gragg;

enum { GRAGG_ROWS = 9 }; /* of 2, 4, 6, ... midpoint steps */

static const double least_state = 1e-3; /* of a state, as in flows */

static ric_status gragg_init(gragg *l, const ric_system *system, ric_error *error) {
  size_t size = system->coordinates + system->speeds;
  *l = (gragg){.system = system, .rows = malloc((GRAGG_ROWS + 4) * size * sizeof *l->rows)};
  if (!l->rows)
    return ric_fail(error, RIC_ENOMEM, "no memory for states of %zu numbers", size);
  l->before = l->rows + GRAGG_ROWS * size;
  l->now = l->before + size;
  l->rate = l->now + size;
  l->point = l->rate + size;
  return RIC_OK;
}

static void gragg_clear(gragg *l) {
  free(l->rows);
}

static bool gragg_rate(gragg *l, double t) {
  const ric_system *s = l->system;
  size_t n = s->coordinates;
  return s->model->rate(s, NULL, t, l->point, l->point + n, l->rate, l->rate + n) == NULL;
}

/* The displacement from x after `steps` steps, in l->now. */
static bool gragg_midpoint(gragg *l, double t, double dt, const double *x, int steps) {
  size_t size = l->system->coordinates + l->system->speeds;
  double h = dt / steps;
  memset(l->before, 0, size * sizeof *l->before);
  memset(l->now, 0, size * sizeof *l->now);
  for (int k = 0; k < steps; k++) {
    for (size_t i = 0; i < size; i++)
      l->point[i] = x[i] + l->now[i];
    if (!gragg_rate(l, t + k * h))
      return false;
    for (size_t i = 0; i < size; i++) {
      double next = l->before[i] + (k == 0 ? h : 2 * h) * l->rate[i];
      l->before[i] = l->now[i];
      l->now[i] = next;
    }
  }
  return true;
}

/* Adds row `row` to the Aitken-Neville scheme, whose last row is kept, highest order first; returns the change by the
 * highest order. */
static double gragg_extrapolate(gragg *l, int row) {
  size_t size = l->system->coordinates + l->system->speeds;
  double change = 0;
  for (int order = 1; order <= row; order++) {
    double ratio = (double)(row + 1) / (row + 1 - order), divisor = ratio * ratio - 1;
    double *coarse = l->rows + (size_t)(order - 1) * size; /* of the previous row; replaced by that of this row */
    change = 0;
    for (size_t i = 0; i < size; i++) {
      double fine = l->now[i], step = (fine - coarse[i]) / divisor;
      coarse[i] = fine;
      l->now[i] = fine + step;
      change = fmax(change, fabs(step));
    }
  }
  memcpy(l->rows + (size_t)row * size, l->now, size * sizeof *l->now);
  return row > 0 ? change : INFINITY;
}

/** Integrates a state over dt, if callbacks succeed and the extrapolation converges to `tolerance` times the size of
 *  the state, or times 1e-3 if that is larger. @returns whether it has; x is unchanged otherwise. */
static bool gragg_move(gragg *l, double t, double dt, double *x, double tolerance) {
  size_t size = l->system->coordinates + l->system->speeds;
  double scale = fmax(largest(x, size), least_state), change, best = INFINITY;
  for (int row = 0; row < GRAGG_ROWS && !(best <= DBL_EPSILON / 4 * scale); row++) {
    if (!gragg_midpoint(l, t, dt, x, 2 * (row + 1)))
      return false;
    change = gragg_extrapolate(l, row);
    if (row > 0 && !(change < best)) /* rounding, or no convergence */
      break;
    best = change;
  }
  if (!(best <= tolerance * scale))
    return false;
  for (size_t i = 0; i < size; i++)
    x[i] += l->now[i];
  return true;
}

/* The discontinuity mapping of one obstacle. */

struct ric_bypass {
  ric_system *system;
  size_t obstacle, size; /* n + m */
  double reach;
  arc_runner runner;
  bool short_intervals; /* short intervals are not integrated by the flow */
  gragg gragg;
  gap_search search;
  impact_solver law;
  double *x, *rates; /* [n + m] a state of the free motion; rates of change */
  double time;       /* of x */
};

enum { HALVINGS = 30 }; /* of a segment on which the gap rate is not resolved */

static ric_status gap_search_init(gap_search *s, ric_flow *flow, size_t obstacle, ric_error *error) {
  *s = (gap_search){.flow = flow, .obstacle = obstacle};
  return gap_reader_init(&s->reader, flow, error);
}

static void gap_search_clear(gap_search *s) {
  gap_reader_clear(&s->reader);
}

/* One search along the motion; slopes are in the direction of the search, also backwards in time. */
typedef struct gap_path {
  gap_search *s;
  bool opening;        /* otherwise a minimum */
  double level, slope; /* of the gap, where the last part ended */
  double time;         /* found */
  const char *trouble;
} gap_path;

/* The gap [degree + 2] on a part, from its rate there. */
static int integrate(const gap_part *rate, double length, double level, double *c) {
  double width = (rate->to - rate->from) * length;
  c[0] = level;
  for (int j = 0; j <= rate->degree; j++)
    c[j + 1] = rate->c[j] * width / (j + 1);
  return rate->degree + 1;
}

static bool finds(const gap_path *w, const double *c, int degree, double *at) {
  double value, below[RIC_POLY_DEGREE + 2];
  if (w->opening) {
    for (int j = 0; j <= degree; j++)
      below[j] = -c[j];
    return ric_poly_first_root(below, degree, at);
  }
  if (w->slope < 0 && c[1] > 0) { /* between the last part and this one */
    *at = 0;
    return true;
  }
  return ric_poly_first_minimum(c, degree, INFINITY, at, &value);
}

static bool search_part(gap_path *w, const ric_segment *piece, const gap_part *rate) {
  double c[RIC_POLY_DEGREE + 2], at;
  int degree = integrate(rate, piece->length, w->level, c);
  if (finds(w, c, degree, &at)) {
    w->time = piece->start + (rate->from + at * (rate->to - rate->from)) * piece->length;
    return true;
  }
  w->level = ric_poly_value(c, degree, 1, &w->slope);
  return false;
}

/* Whether it is found on [from, to] of a piece, or an error occurs. */
static bool search_segment(gap_path *w, const ric_segment *piece, double from, double to, double before, int halvings) {
  gap_part rate;
  w->trouble = gap_read(&w->s->reader, piece, w->s->obstacle, WATCH_RATE, from, to, &rate);
  if (w->trouble)
    return true;
  if (gap_is_resolved(&rate, before) || halvings == 0)
    return search_part(w, piece, &rate);
  double middle = (from + to) / 2;
  return search_segment(w, piece, from, middle, rate.residual, halvings - 1) ||
         search_segment(w, piece, middle, to, rate.residual, halvings - 1);
}

static bool search_step(gap_path *w) {
  ric_flow *flow = w->s->flow;
  const ric_system *system = flow->system;
  for (size_t i = 0; i < ric_flow_pieces(flow); i++) {
    ric_segment piece = ric_flow_piece(flow, i);
    size_t coordinate = system->obstacles ? system->obstacles[w->s->obstacle].coordinate : 0;
    if (coordinate < piece.first || coordinate - piece.first >= piece.coordinates)
      continue;
    gap_reader_reset(&w->s->reader);
    if (search_segment(w, &piece, 0, 1, INFINITY, HALVINGS))
      return true;
  }
  return false;
}

static ric_status search_interval(gap_path *w, double t, const double *x, double span, ric_error *error) {
  ric_flow *flow = w->s->flow;
  double end = t + span;
  RIC_TRY(ric_flow_start(flow, t, x, x + flow->system->coordinates, error));
  while (ric_flow_time(flow) != end) {
    ric_status status = ric_flow_step(flow, end, error);
    if (status == RIC_ENUMERIC) /* nothing is found where the motion ends */
      return RIC_OK;
    RIC_TRY(status);
    if (search_step(w))
      break;
    ric_flow_accept(flow, 1);
  }
  if (w->trouble)
    return ric_fail(error, RIC_ECALLBACK, "from t = %g, obstacle %zu: %s", t, w->s->obstacle, w->trouble);
  return RIC_OK;
}

/** First local minimum of the gap along the motion from a state.
 *  @param span  signed length of the interval, not 0
 *  @param rate  gap rate at the state
 *  @param time  set; NaN if there is none, or the motion ends before
 *  @returns RIC_ECALLBACK, RIC_EINVAL as ric_flow_start. */
static ric_status gap_search_minimum(gap_search *s, double t, const double *x, double span, double rate, double *time,
                                     ric_error *error) {
  gap_path w = {.s = s, .slope = copysign(1, span) * rate, .time = NAN};
  RIC_TRY(search_interval(&w, t, x, span, error));
  *time = w.time;
  return RIC_OK;
}

/** First time at which the gap, `depth` <= 0 at the state, is zero again; parameters as above. */
static ric_status gap_search_opening(gap_search *s, double t, const double *x, double span, double depth, double *time,
                                     ric_error *error) {
  gap_path w = {.s = s, .opening = true, .level = depth, .time = NAN};
  RIC_TRY(search_interval(&w, t, x, span, error));
  *time = w.time;
  return RIC_OK;
}

/* A minimum predicted by the gap rate and its derivative within this fraction of the reach is the nearest one: motions
 * are smooth over much larger fractions of the reach. */
static const double near_part = 1e-6;

/* A minimum that Newton's method does not refine within this fraction of the reach is rejected. */
static const double converged_part = 1e-6;

/* Tolerated negative gap rate after an impact, relative to that before it and absolute: rates of user gaps come from
 * differences. */
static const double turn_tol = 1e-6, turn_rounding = 1e-10;

/* Accuracy on a short interval as a fraction of the flow's tolerance, which applies to every step of the flow. */
static const double gragg_part = 0.01;

enum { NEWTON_STEPS = 12 };

ric_bypass_options ric_bypass_options_default(void) {
  return (ric_bypass_options){.flow = ric_flow_options_default(), .reach = 1};
}

static ric_status check_bypass(const ric_system *system, size_t obstacle, const ric_bypass_options *o,
                               ric_error *error) {
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

static ric_status build_bypass(ric_bypass *b, const ric_bypass_options *options, ric_error *error) {
  RIC_TRY(arc_runner_init(&b->runner, b->system, &options->flow, (ric_poll){0}, error));
  b->short_intervals = arc_runner_flow(&b->runner)->options.method == RIC_FLOW_CVODES;
  RIC_TRY(gragg_init(&b->gragg, b->system, error));
  RIC_TRY(gap_search_init(&b->search, arc_runner_flow(&b->runner), b->obstacle, error));
  RIC_TRY(impact_solver_init(&b->law, b->system, error));
  RIC_TRY(impact_solver_reserve(&b->law, 1, error));
  b->x = malloc(2 * b->size * sizeof *b->x);
  if (!b->x)
    return ric_fail(error, RIC_ENOMEM, "no memory for states of %zu numbers", b->size);
  b->rates = b->x + b->size;
  return RIC_OK;
}

void ric_bypass_destroy(ric_bypass **bypass) {
  if (!bypass || !*bypass)
    return;
  ric_bypass *b = *bypass;
  gap_search_clear(&b->search);
  gragg_clear(&b->gragg);
  impact_solver_clear(&b->law);
  arc_runner_clear(&b->runner);
  free(b->x);
  free(b);
  *bypass = NULL;
}

ric_status ric_bypass_create(ric_system *system, size_t obstacle, const ric_bypass_options *options,
                             ric_bypass **bypass, ric_error *error) {
  REQUIRE(error, {"system", system}, {"bypass", bypass});
  ric_bypass_options o = options ? *options : ric_bypass_options_default();
  *bypass = NULL;
  RIC_TRY(check_bypass(system, obstacle, &o, error));
  ric_bypass *b = calloc(1, sizeof *b);
  if (!b)
    return ric_fail(error, RIC_ENOMEM, "no memory for a bypass map");
  b->system = system;
  b->obstacle = obstacle;
  b->size = system->coordinates + system->speeds;
  b->reach = o.reach;
  ric_status status = build_bypass(b, &o, error);
  if (status == RIC_OK)
    *bypass = b;
  else
    ric_bypass_destroy(&b);
  return status;
}

/* Along the free motion. */
static ric_status move_to(ric_bypass *b, double time, ric_error *error) {
  double tolerance = gragg_part * arc_runner_flow(&b->runner)->options.tolerance, from = b->time;
  if (b->short_intervals && gragg_move(&b->gragg, from, time - from, b->x, tolerance)) {
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
  return trouble ? grazing_callback_error(b->time, b->obstacle, trouble, error) : RIC_OK;
}

/* The minimum nearest in time, NaN without one: downhill first, then uphill, as far as a minimum there would be nearer.
 */
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

/* Newton's method on the gap rate, down to rounding. */
static ric_status refine_minimum(ric_bypass *b, double *curvature, ric_error *error) {
  double rate, last = INFINITY, least = converged_part * b->reach;
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
static ric_status move_to_minimum(ric_bypass *b, double t, const double *x, ric_bypass_seen *seen, ric_error *error) {
  double time;
  size_t n = b->system->coordinates;
  RIC_TRY(ric_flow_start(arc_runner_flow(&b->runner), t, x, x + n, error)); /* fails for states that are not finite */
  memcpy(b->x, x, b->size * sizeof *x);
  b->time = t;
  RIC_TRY(find_nearest(b, &time, error));
  if (isnan(time))
    return ric_fail(error, RIC_ENUMERIC, "obstacle %zu: the gap has no minimum within %g of t = %g", b->obstacle,
                    b->reach, t);
  RIC_TRY(move_to(b, time, error));
  *seen = (ric_bypass_seen){.t_C = NAN};
  RIC_TRY(refine_minimum(b, &seen->curvature, error));
  seen->tau = b->time - t;
  return read_gap(b, &seen->psi, error);
}

ric_status ric_bypass_look(ric_bypass *b, double t, const double *x, ric_bypass_seen *seen, ric_error *error) {
  REQUIRE(error, {"bypass", b}, {"x", x}, {"seen", seen});
  ric_bypass_seen found;
  RIC_TRY(move_to_minimum(b, t, x, &found, error));
  *seen = found;
  return RIC_OK;
}

/* Newton's method on the gap, from the time at which the search found it open. If grazing is so close that the rounding
 * of the gap determines the time, the result of the search is kept: it uses the rates. */
static ric_status refine_contact(ric_bypass *b, double tau, ric_error *error) {
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
static ric_status move_to_contact(ric_bypass *b, const ric_bypass_seen *seen, ric_error *error) {
  double time, tau = b->time;
  RIC_TRY(gap_search_opening(&b->search, tau, b->x, -b->reach, seen->psi, &time, error));
  if (isnan(time))
    return ric_fail(error, RIC_ENUMERIC,
                    "obstacle %zu: the gap is %.3g at its minimum, t = %g, and does not open within %g before it",
                    b->obstacle, seen->psi, tau, b->reach);
  RIC_TRY(move_to(b, time, error));
  return refine_contact(b, tau, error);
}

static ric_status hit(ric_bypass *b, double *gap_rate, ric_error *error) {
  size_t n = b->system->coordinates;
  impact c = {.obstacle = b->obstacle, .restitution = b->system->model->restitution(b->system, b->obstacle)};
  RIC_TRY(impact_apply(&b->law, b->time, b->x, b->x + n, &c, 1, error));
  *gap_rate = fmin(c.rate, 0);
  if (c.rate_end >= turn_tol * *gap_rate - turn_rounding)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "obstacle %zu: an impact changes the gap rate %g to %g, expected >= 0",
                  b->obstacle, c.rate, c.rate_end);
}

ric_status ric_bypass_map(ric_bypass *b, double t, const double *x, double *image, ric_bypass_seen *seen,
                          ric_error *error) {
  REQUIRE(error, {"bypass", b}, {"x", x}, {"image", image});
  ric_bypass_seen found;
  RIC_TRY(move_to_minimum(b, t, x, &found, error));
  if (found.psi <= 0) { /* [FN97] (4.2) */
    RIC_TRY(move_to_contact(b, &found, error));
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
  REQUIRE(error, {"bypass", b}, {"at_grazing", at_grazing}, {"x", x}, {"image", image});
  ric_bypass_seen found;
  RIC_TRY(grazing_check_local(at_grazing, b->system, error));
  RIC_TRY(move_to_minimum(b, t, x, &found, error));
  double y = sqrt(fmax(-found.psi, 0)), s = sqrt(2 * at_grazing->acceleration);
  for (size_t i = 0; i < b->size; i++)
    image[i] = x[i] + y * s * at_grazing->xi[i]; /* [FN97] (4.19) */
  if (seen)
    *seen = found;
  return RIC_OK;
}

/* kappa, the coefficient of y^2 in the discontinuity mapping.
 *
 * At x = x* - y^2 n with eta n = 1, psi(x) = -y^2 + O(y^4), and (C(x) - x) / y^2 - s xi / y = kappa + O(y) is a series
 * in y. Another n moves x along the surface psi = const by O(y^2), and that changes C - x by O(y |x - x*|), which is
 * O(y^3): kappa does not depend on it. Here n is along eta.
 *
 * Neville's scheme gives the limit y -> 0, as far as rounding allows: that of psi over y^3, and the error of s over y,
 * whose A_g comes from differences for user gaps. Without s, as the slope of (C(x) - x) / y, kappa has three digits
 * less: one order is lost at each level. */

enum { LEVELS = 7, SKIPPED = 8 }; /* halvings of y; and those before the map can be evaluated */

/* Time of the first state behind the obstacle until the minimum, as a fraction of the reach, but no more than for a
 * motion with times of order one. */
static const double first_part = 0.25;

/* Neville's scheme towards y = 0, one row per level of y. */
typedef struct scheme {
  ric_bypass *b;
  const ric_grazing_local *at;
  double t;
  const double *x;
  double *row, *last;      /* [LEVELS][n + m] orders of this level and of the previous one */
  double *state, *image;   /* [n + m] */
  double *best;            /* [n + m] best result so far */
  double y[LEVELS], error; /* of best */
  int level;
} scheme;

/* (C(z) - z) / y^2 - s xi / y at z = x - depth eta / |eta|^2. */
static ric_status sample(scheme *k, double depth, ric_error *error) {
  const ric_grazing_local *at = k->at;
  size_t size = k->b->size;
  double square = 0, s = sqrt(2 * at->acceleration);
  ric_bypass_seen seen;
  for (size_t i = 0; i < size; i++)
    square += at->eta[i] * at->eta[i];
  for (size_t i = 0; i < size; i++)
    k->state[i] = k->x[i] - depth * at->eta[i] / square;
  RIC_TRY(ric_bypass_map(k->b, k->t, k->state, k->image, &seen, error));
  double y = k->y[k->level] = sqrt(fmax(-seen.psi, 0));
  if (!(y > 0))
    return ric_fail(error, RIC_ENUMERIC, "the gap is %.3g at a state %.3g beyond grazing, expected a negative gap",
                    seen.psi, depth);
  for (size_t i = 0; i < size; i++)
    k->row[i] = ((k->image[i] - k->state[i]) / y - s * at->xi[i]) / y;
  return RIC_OK;
}

static double difference(const double *a, const double *b, size_t size) {
  double most = 0;
  for (size_t i = 0; i < size; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* The orders of this level. The error of an entry is its difference from the two entries it is computed from: beyond
 * the best one rounding dominates. */
static void extrapolate(scheme *k) {
  size_t size = k->b->size;
  for (int order = 1; order <= k->level; order++) {
    const double *fine = k->row + (size_t)(order - 1) * size, *coarse = k->last + (size_t)(order - 1) * size;
    double *now = k->row + (size_t)order * size, ratio = k->y[k->level - order] / k->y[k->level];
    for (size_t i = 0; i < size; i++)
      now[i] = fine[i] + (fine[i] - coarse[i]) / (ratio - 1);
    double error = fmax(difference(now, fine, size), difference(now, coarse, size));
    if (!(error < k->error))
      continue;
    k->error = error;
    memcpy(k->best, now, size * sizeof *now);
  }
}

static ric_status run_scheme(scheme *k, ric_error *error) {
  double time = first_part * fmin(1, k->b->reach), rate = k->at->acceleration / 2;
  for (int skipped = 0; k->level < LEVELS; time /= 2) {
    ric_status status = sample(k, rate * time * time, error);
    if (status == RIC_ENUMERIC && k->level == 0 && skipped++ < SKIPPED)
      continue;
    RIC_TRY(status);
    extrapolate(k);
    double *row = k->row;
    k->row = k->last;
    k->last = row;
    k->level++;
  }
  return RIC_OK;
}

ric_status ric_bypass_second(ric_bypass *b, const ric_grazing_local *at_grazing, double t, const double *x,
                             double *kappa, ric_error *error) {
  REQUIRE(error, {"bypass", b}, {"at_grazing", at_grazing}, {"x", x}, {"kappa", kappa});
  RIC_TRY(grazing_check_local(at_grazing, b->system, error));
  double *work = malloc((2 * LEVELS + 3) * b->size * sizeof *work);
  if (!work)
    return ric_fail(error, RIC_ENOMEM, "no memory for an extrapolation of %zu numbers", b->size);
  scheme k = {.b = b, .at = at_grazing, .t = t, .x = x, .row = work, .error = INFINITY};
  k.last = k.row + LEVELS * b->size;
  k.state = k.last + LEVELS * b->size;
  k.image = k.state + b->size;
  k.best = k.image + b->size;
  ric_status status = run_scheme(&k, error);
  if (status == RIC_OK)
    memcpy(kappa, k.best, b->size * sizeof *kappa);
  free(work);
  return status;
}

/* Windows of d in which one-impact orbits are admissible and stable; pairs of multipliers on the unit circle. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_min.h>
#include <gsl/gsl_roots.h>

#include "numeric/constants.h"
#include "one_impact.h"
#include "ricochet/elementary.h"
#include "ricochet/grazing_map.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Where pairs of complex multipliers of one-impact orbits lie on the unit circle.
 *
 * exp(i theta) is a multiplier of the orbit of y where, with t = s / (2 y), mu = exp(i theta) and r = L^(n-1),
 *
 *   1 + t A + B = 0,     A = eta (mu I - L^n)^-1 r xi,     B = eta (mu I - L^n)^-1 r kappa.
 *
 * t is real where Im((1 + B) conj A) = 0. Times |det(mu I - L^n)|^2 / sin theta that is a polynomial in cos theta of
 * degree m - 1: its signs on a grid finer than its oscillations, and the dips in between, locate all its zeros. */

enum { CELLS_PER_SIZE = 16, MOST_ITERATIONS = 200, DIP_STEPS = 60 };

/* Angles closer than this to 0 and pi are excluded: there the pair is at 1 or -1, a fold or a flip. */
static const double end_angle = 1e-6;

typedef struct search {
  const one_impact *orbits;
  gsl_matrix *factors; /* [2 m][2 m] of mu I - L^n, real parts before imaginary ones */
  gsl_vector *reflectors, *vector;
  gsl_root_fsolver *root;
  gsl_min_fminimizer *least;
  double sign; /* of the function in a dip: 1 or -1 */
  double *y;
  size_t count;
} search;

/* Terms of the equation at an angle. */
typedef struct terms {
  double A[2], B[2];  /* real, imaginary; B with its 1 */
  double determinant; /* |det(mu I - L^n)|^2, the determinant of the real matrix */
} terms;

/* Q R of mu I - L^n. Not complex LU: that of GSL allocates without checking. */
static double factorise(search *s, double theta) {
  const gsl_matrix *power = s->orbits->power;
  size_t m = power->size1;
  double determinant = 1, sine, cosine;
  ric_sincos(theta, &sine, &cosine);
  gsl_matrix_set_zero(s->factors);
  for (size_t i = 0; i < m; i++) {
    for (size_t j = 0; j < m; j++) {
      double entry = (i == j) * cosine - gsl_matrix_get(power, i, j);
      gsl_matrix_set(s->factors, i, j, entry);
      gsl_matrix_set(s->factors, m + i, m + j, entry);
    }
    gsl_matrix_set(s->factors, i, m + i, -sine);
    gsl_matrix_set(s->factors, m + i, i, sine);
  }
  gsl_linalg_QR_decomp(s->factors, s->reflectors);
  for (size_t i = 0; i < 2 * m; i++)
    determinant *= fabs(gsl_matrix_get(s->factors, i, i));
  return determinant;
}

/* eta (mu I - L^n)^-1 b, real and imaginary part. */
static void project(search *s, const gsl_vector *b, double *value) {
  const double *eta = s->orbits->map->eta;
  size_t m = s->orbits->map->size;
  for (size_t i = 0; i < m; i++) {
    gsl_vector_set(s->vector, i, gsl_vector_get(b, i));
    gsl_vector_set(s->vector, m + i, 0);
  }
  gsl_linalg_QR_svx(s->factors, s->reflectors, s->vector);
  value[0] = value[1] = 0;
  for (size_t i = 0; i < m; i++) {
    value[0] += eta[i] * gsl_vector_get(s->vector, i);
    value[1] += eta[i] * gsl_vector_get(s->vector, m + i);
  }
}

static terms terms_at(search *s, double theta) {
  terms x = {.determinant = factorise(s, theta)};
  project(s, s->orbits->xi, x.A);
  project(s, s->orbits->kappa, x.B);
  x.B[0] += 1;
  return x;
}

/* The polynomial, at cos theta. */
static double mismatch(double theta, void *user) {
  terms x = terms_at(user, theta);
  return x.determinant * (x.B[1] * x.A[0] - x.B[0] * x.A[1]) / ric_sin(theta);
}

static double depth_of_dip(double theta, void *user) {
  return ((search *)user)->sign * mismatch(theta, user);
}

/* The zero between two angles at which the signs differ. */
static void refine_zero(search *s, double low, double high) {
  gsl_function f = {mismatch, s};
  if (s->count == s->orbits->map->size || gsl_root_fsolver_set(s->root, &f, low, high) != GSL_SUCCESS)
    return;
  for (int i = 0; i < MOST_ITERATIONS; i++)
    if (gsl_root_fsolver_iterate(s->root) != GSL_SUCCESS ||
        gsl_root_test_interval(gsl_root_fsolver_x_lower(s->root), gsl_root_fsolver_x_upper(s->root), 0,
                               4 * DBL_EPSILON) == GSL_SUCCESS)
      break;
  terms x = terms_at(s, gsl_root_fsolver_root(s->root));
  double t = -(x.B[0] * x.A[0] + x.B[1] * x.A[1]) / (x.A[0] * x.A[0] + x.A[1] * x.A[1]);
  if (t > 0 && isfinite(t))
    s->y[s->count++] = s->orbits->map->stretch / (2 * t);
}

/* Searches two zeros between grid points, where the function dips towards 0 without a sign change. */
static void search_dip(search *s, const double *theta, const double *value) {
  s->sign = copysign(1, value[1]);
  gsl_function f = {depth_of_dip, s};
  if (gsl_min_fminimizer_set_with_values(s->least, &f, theta[1], fabs(value[1]), theta[0], fabs(value[0]), theta[2],
                                         fabs(value[2])) != GSL_SUCCESS)
    return;
  for (int i = 0; i < DIP_STEPS && gsl_min_fminimizer_f_minimum(s->least) > 0; i++)
    if (gsl_min_fminimizer_iterate(s->least) != GSL_SUCCESS)
      return;
  if (!(gsl_min_fminimizer_f_minimum(s->least) < 0))
    return;
  double middle = gsl_min_fminimizer_x_minimum(s->least);
  refine_zero(s, theta[0], middle);
  refine_zero(s, middle, theta[2]);
}

static void scan(search *s) {
  size_t cells = CELLS_PER_SIZE * s->orbits->map->size;
  double theta[3] = {0}, value[3] = {0};
  for (size_t i = 0; i <= cells; i++) {
    theta[0] = theta[1], theta[1] = theta[2];
    value[0] = value[1], value[1] = value[2];
    theta[2] = fmin(fmax(pi * (double)i / (double)cells, end_angle), pi - end_angle);
    value[2] = mismatch(theta[2], s);
    if (i >= 1 && value[1] * value[2] <= 0 && value[1] != 0)
      refine_zero(s, theta[1], theta[2]);
    if (i >= 2 && fabs(value[1]) < fabs(value[0]) && fabs(value[1]) < fabs(value[2]) && value[0] * value[1] > 0 &&
        value[1] * value[2] > 0)
      search_dip(s, theta, value);
  }
}

/** @param y  [size of the map] in no order, all > 0  @param count  set  @returns RIC_ENOMEM */
static ric_status circle_crossings_find(const one_impact *o, double *y, size_t *count, ric_error *error) {
  size_t m = o->map->size;
  *count = 0;
  if (m < 2)
    return RIC_OK; /* one multiplier: no pair */
  search s = {.orbits = o,
              .factors = gsl_matrix_alloc(2 * m, 2 * m),
              .reflectors = gsl_vector_alloc(2 * m),
              .vector = gsl_vector_alloc(2 * m),
              .root = gsl_root_fsolver_alloc(gsl_root_fsolver_brent),
              .least = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent),
              .y = y};
  bool has_room = s.factors && s.reflectors && s.vector && s.root && s.least;
  if (has_room)
    scan(&s);
  gsl_matrix_free(s.factors);
  gsl_vector_free(s.reflectors);
  gsl_vector_free(s.vector);
  gsl_root_fsolver_free(s.root);
  gsl_min_fminimizer_free(s.least);
  *count = s.count;
  return has_room ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", 2 * m);
}

const char *ric_grazing_edge_name(ric_grazing_edge_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_GRAZING_EDGE_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_GRAZING_EDGES ? names[kind] : "unknown edge";
}

/* Where the orbits of a period change: at an edge of their admissible range, or with a multiplier on the circle. */
typedef struct cuts {
  ric_grazing_edge *list; /* [size of the map + 4] by y, smallest first */
  size_t count;
} cuts;

/* The orbits are admissible where steady_j + slope_j y > 0 for all j: on one range of y at most. */
static bool find_admissible(const one_impact *o, ric_grazing_edge *low, ric_grazing_edge *high) {
  *low = (ric_grazing_edge){.kind = RIC_EDGE_ZERO, .y = 0};
  *high = (ric_grazing_edge){.kind = RIC_EDGE_OPEN, .y = INFINITY};
  for (size_t j = 1; j < o->period; j++) {
    double steady, slope;
    one_impact_clearance(o, j, &steady, &slope);
    double y = -steady / slope;
    if (slope == 0 && !(steady > 0))
      return false;
    if (slope > 0 && y > low->y)
      *low = (ric_grazing_edge){.kind = RIC_EDGE_BORDER, .y = y, .iterate = j};
    if (slope < 0 && y < high->y)
      *high = (ric_grazing_edge){.kind = RIC_EDGE_BORDER, .y = y, .iterate = j};
  }
  return low->y < high->y;
}

/* Adds a cut inside the admissible range, which is given by the first two of the list. */
static void add_cut(cuts *c, ric_grazing_edge_kind kind, double y) {
  if (y > c->list[0].y && y < c->list[1].y)
    c->list[c->count++] = (ric_grazing_edge){.kind = kind, .y = y};
}

/* The multiplier -1: s / (2 y) eta (I + L^n)^-1 r xi + eta (I + L^n)^-1 r kappa = 1. */
static ric_status find_flip(one_impact *o, double *y, ric_error *error) {
  double first, second;
  for (size_t i = 0; i < o->map->size; i++)
    gsl_vector_set(o->vector, i, o->map->eta[i]);
  RIC_TRY(one_impact_solve(o, 1, true, o->vector, error));
  gsl_blas_ddot(o->vector, o->xi, &first);
  gsl_blas_ddot(o->vector, o->kappa, &second);
  *y = o->map->stretch * first / (2 * (1 - second));
  return RIC_OK;
}

static int by_y(const void *a, const void *b) {
  double first = ((const ric_grazing_edge *)a)->y, second = ((const ric_grazing_edge *)b)->y;
  return (first > second) - (first < second);
}

static ric_status find_cuts(one_impact *o, cuts *c, double *crossings, ric_error *error) {
  size_t n = o->period, found;
  double flip;
  c->count = 0;
  if (!find_admissible(o, &c->list[0], &c->list[1]))
    return RIC_OK;
  c->count = 2;
  RIC_TRY(find_flip(o, &flip, error));
  add_cut(c, RIC_EDGE_FLIP, flip);
  add_cut(c, RIC_EDGE_FOLD, -o->first[n - 1] / (2 * (1 + o->second[n - 1]))); /* d' = 0 */
  RIC_TRY(circle_crossings_find(o, crossings, &found, error));
  for (size_t i = 0; i < found; i++)
    add_cut(c, RIC_EDGE_COMPLEX, crossings[i]);
  qsort(c->list, c->count, sizeof *c->list, by_y);
  for (size_t i = 0; i < c->count; i++)
    c->list[i].d = one_impact_d(o, c->list[i].y);
  return RIC_OK;
}

static double middle_of(double low, double high) {
  if (high == INFINITY)
    return low > 0 ? 2 * low : 1;
  return low > 0 ? sqrt(low) * sqrt(high) : high / 2;
}

/* Width in ln d; infinite if the range contains or touches d = 0. */
static double width_of(double low, double high) {
  return low * high > 0 ? fabs(ric_log(high / low)) : INFINITY;
}

/* No multiplier crosses the unit circle between two cuts: one orbit decides for all. At a cut with both sides stable a
 * pair has only touched the circle. */
static ric_status choose_widest(one_impact *o, const cuts *c, ric_grazing_window *window, ric_error *error) {
  const ric_grazing_edge *from = NULL, *chosen = NULL;
  double widest = 0;
  for (size_t i = 1; i < c->count; i++) {
    const ric_grazing_edge *a = &c->list[i - 1], *b = &c->list[i];
    if (!(a->y < b->y))
      continue;
    RIC_TRY(one_impact_multipliers(o, middle_of(a->y, b->y), error));
    bool stable = o->multipliers.largest < 1;
    from = !stable ? NULL : from && a->kind != RIC_EDGE_FOLD ? from : a;
    if (!from || from->d == b->d)
      continue;
    double width = width_of(from->d, b->d);
    if (!(width > widest || chosen == from))
      continue;
    chosen = from;
    widest = width;
    window->exists = true;
    window->low = from->d < b->d ? *from : *b;
    window->high = from->d < b->d ? *b : *from;
  }
  return RIC_OK;
}

ric_status ric_grazing_window_find(const ric_grazing_map *map, size_t period, ric_grazing_window *window,
                                   ric_error *error) {
  REQUIRE(error, {"map", map}, {"window", window});
  one_impact orbits;
  cuts c = {0};
  double *crossings = NULL;
  ric_grazing_window found = {.period = period};
  keep_gsl_quiet();
  ric_status status = one_impact_init(&orbits, map, period, error);
  if (status != RIC_OK)
    goto out;
  c.list = calloc(map->size + 4, sizeof *c.list);
  crossings = calloc(map->size, sizeof *crossings);
  if (!c.list || !crossings) {
    status = ric_fail(error, RIC_ENOMEM, "no memory for %zu edges of windows", map->size + 4);
    goto out;
  }
  status = find_cuts(&orbits, &c, crossings, error);
  if (status == RIC_OK)
    status = choose_widest(&orbits, &c, &found, error);
  if (status == RIC_OK)
    *window = found;
out:
  free(crossings);
  free(c.list);
  one_impact_clear(&orbits);
  return status;
}

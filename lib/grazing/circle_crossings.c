#include "circle_crossings.h"
#include "numeric/constants.h"

#include <float.h>
#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_min.h>
#include <gsl/gsl_roots.h>

enum { CELLS_PER_SIZE = 16, MOST_ITERATIONS = 200, DIP_STEPS = 60 };

/* Angles next to 0 and pi that are left out: there the pair is at 1 or -1, a fold or a flip. */
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

/* What the equation is made of at an angle. */
typedef struct terms {
  double A[2], B[2];  /* real, imaginary; B with its 1 */
  double determinant; /* |det(mu I - L^n)|^2, the determinant of the real matrix */
} terms;

/* Q R of mu I - L^n. Not complex LU: GSL's takes memory, and does not look whether there is any. */
static double factorise(search *s, double theta) {
  const gsl_matrix *power = s->orbits->power;
  size_t m = power->size1;
  double determinant = 1;
  gsl_matrix_set_zero(s->factors);
  for (size_t i = 0; i < m; i++) {
    for (size_t j = 0; j < m; j++) {
      double entry = (i == j) * cos(theta) - gsl_matrix_get(power, i, j);
      gsl_matrix_set(s->factors, i, j, entry);
      gsl_matrix_set(s->factors, m + i, m + j, entry);
    }
    gsl_matrix_set(s->factors, i, m + i, -sin(theta));
    gsl_matrix_set(s->factors, m + i, i, sin(theta));
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
  return x.determinant * (x.B[1] * x.A[0] - x.B[0] * x.A[1]) / sin(theta);
}

static double depth_of_dip(double theta, void *user) {
  return ((search *)user)->sign * mismatch(theta, user);
}

/* The zero between two angles at which the signs differ. */
static void take_zero(search *s, double low, double high) {
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

/* Two zeros between grid points: where the function dips towards 0 without a change of its sign there. */
static void look_into_dip(search *s, const double *theta, const double *value) {
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
  take_zero(s, theta[0], middle);
  take_zero(s, middle, theta[2]);
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
      take_zero(s, theta[1], theta[2]);
    if (i >= 2 && fabs(value[1]) < fabs(value[0]) && fabs(value[1]) < fabs(value[2]) && value[0] * value[1] > 0 &&
        value[1] * value[2] > 0)
      look_into_dip(s, theta, value);
  }
}

ric_status circle_crossings_find(const one_impact *o, double *y, size_t *count, ric_error *error) {
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

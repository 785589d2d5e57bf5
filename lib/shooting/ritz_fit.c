/* The functions of Ritz's method against a motion found by shooting: the best fit, and the measured error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "numeric/constants.h"
#include "ricochet/elementary.h"
#include "ritz.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Fits omit functions that are linear combinations of others, up to this part of the first one. */
static const double rank_tol = 1e-12;

/* Number of values of w that the fit compares, from half of 2 pi / T up to it: the conditioning gets worse below. */
enum { TRIED = 50 };

/* Samples per function and period of the error: 32 per wave of the fastest one. */
enum { SAMPLES = 32 };

/* @returns RIC_EINVAL unless the equations are those of even motions of the same system with the one impact. */
static ric_status ritz_check_shooting(const ric_ritz *r, const ric_shooting *s, ric_error *error) {
  const arc_plan *a = &s->arcs;
  if (s->system != r->system)
    return ric_fail(error, RIC_EINVAL, "shooting is for another system");
  if (a->kind != RIC_MOTION_EVEN || a->energy_given)
    return ric_fail(error, RIC_EINVAL, "shooting is for other motions, expected even ones with a given period");
  if (a->start_count != 1 || a->half_count != 0 || a->sequence_count != 0 || a->at_start[r->hit] != r->obstacle)
    return ric_fail(error, RIC_EINVAL, "shooting is for other impacts, expected the one of obstacle %zu at t = 0",
                    r->obstacle);
  return RIC_OK;
}

/* --- samples of the motion ---------------------------------------------------------------------------------------- */

/* Displacements at the points of the quadrature: each in the segment that its time is in. */
typedef struct node_samples {
  const ric_ritz *r;
  double period;
  size_t next; /* point */
  double *q;   /* [points][n] */
} node_samples;

static void sample_nodes(const ric_segment *piece, double end, void *user) {
  node_samples *s = user;
  for (; s->next < s->r->points; s->next++) {
    double x = (s->r->tau[s->next] * s->period - piece->start) / piece->length;
    if (x > end)
      return;
    ric_segment_state(piece, fmax(x, 0), s->q + s->next * s->r->coordinates, NULL);
  }
}

/* The points rise. Where the last segment ends, at T/2 but for rounding, there is none near. */
static ric_status sample_motion(ric_ritz *r, ric_shooting *shooting, const double *z, double period, double *q,
                                ric_error *error) {
  node_samples samples = {.r = r, .period = period, .q = q};
  const shooting_observer observer = {.segment = sample_nodes, .user = &samples};
  return shooting_evaluate(shooting, z, period, shooting->residual, NULL, NULL, &observer, error);
}

/* --- fit ---------------------------------------------------------------------------------------------------------- */

typedef struct fit {
  ric_ritz *r;
  double period;
  double *q;                         /* [points][n] */
  gsl_matrix *functions;             /* [points][N'] */
  gsl_vector *values;                /* [points] */
  gsl_vector *tau, *norm, *solution; /* [N'] */
  gsl_permutation *order;
} fit;

static ric_status fit_init(fit *f, ric_error *error) {
  size_t points = f->r->points, width = ritz_width(f->r);
  f->q = malloc(points * f->r->coordinates * sizeof *f->q);
  f->functions = gsl_matrix_alloc(points, width);
  f->values = gsl_vector_alloc(points);
  f->tau = gsl_vector_alloc(width);
  f->norm = gsl_vector_alloc(width);
  f->solution = gsl_vector_alloc(width);
  f->order = gsl_permutation_alloc(width);
  if (f->q && f->functions && f->values && f->tau && f->norm && f->solution && f->order)
    return RIC_OK;
  return ric_fail(error, RIC_ENOMEM, "no memory to fit %zu functions at %zu points", width, points);
}

static void fit_clear(fit *f) {
  gsl_matrix_free(f->functions);
  gsl_vector_free(f->values);
  gsl_vector_free(f->tau);
  gsl_vector_free(f->norm);
  gsl_vector_free(f->solution);
  gsl_permutation_free(f->order);
  free(f->q);
}

/* Rows of the fit, weighted so that sums of squares are means over the period. */
static void fill_rows(fit *f, size_t coordinate, double w) {
  ric_ritz *r = f->r;
  for (size_t p = 0; p < r->points; p++) {
    const double *row = r->psi + p * r->stride;
    double root = sqrt(r->weight[p]);
    if (coordinate == r->hit) {
      ritz_functions_at(r, w * f->period * (0.5 - r->tau[p]), r->cosine, r->sine);
      row = r->cosine;
    }
    for (size_t m = 0; m < ritz_width(r); m++)
      gsl_matrix_set(f->functions, p, m, root * row[m]);
    gsl_vector_set(f->values, p, root * f->q[p * r->coordinates + coordinate]);
  }
}

/* The triangular system of f->functions and f->values, as far as it has rank. */
static void substitute_back(fit *f) {
  size_t width = ritz_width(f->r), rank = 0;
  double least = rank_tol * fabs(gsl_matrix_get(f->functions, 0, 0));
  gsl_vector_set_zero(f->solution);
  while (rank < width && fabs(gsl_matrix_get(f->functions, rank, rank)) > least)
    rank++;
  for (size_t i = rank; i-- > 0;) {
    double sum = gsl_vector_get(f->values, i);
    for (size_t j = i + 1; j < rank; j++)
      sum -= gsl_matrix_get(f->functions, i, j) * gsl_vector_get(f->solution, j);
    gsl_vector_set(f->solution, i, sum / gsl_matrix_get(f->functions, i, i));
  }
}

/* Least squares by QR with pivots. */
static ric_status fit_coordinate(fit *f, size_t coordinate, double w, double *c, ric_error *error) {
  size_t width = ritz_width(f->r);
  int sign;
  fill_rows(f, coordinate, w);
  if (gsl_linalg_QRPT_decomp(f->functions, f->tau, f->order, &sign, f->norm) != 0 ||
      gsl_linalg_QR_QTvec(f->functions, f->tau, f->values) != 0)
    return ric_fail(error, RIC_ENUMERIC, "the fit of coordinate %zu fails", coordinate);
  substitute_back(f);
  for (size_t m = 0; m < width; m++)
    c[coordinate * width + gsl_permutation_get(f->order, m)] = gsl_vector_get(f->solution, m);
  return RIC_OK;
}

/* |F| with the equations of motion over (2 pi / T)^2, displacements like the last one: no w is the best for a unit of
 * time alone. */
static double size_of_residual(const double *F, size_t last, double period) {
  double size = fabs(F[last]), rate = two_pi / period;
  for (size_t i = 0; i < last; i++)
    size = ric_hypot(size, F[i] / rate / rate);
  return size;
}

/* Refits the coordinate that is hit with every w. @param c  the others fitted; set for the best */
static ric_status try_frequencies(fit *f, double *c, ric_error *error) {
  ric_ritz *r = f->r;
  size_t last = ric_ritz_unknowns(r) - 1;
  double best = 0, least = INFINITY, *F = r->spare;
  for (size_t k = 0; k < TRIED; k++) {
    c[last] = two_pi / f->period * (0.5 + 0.5 * ((double)k + 0.5) / TRIED);
    RIC_TRY(fit_coordinate(f, r->hit, c[last], c, error));
    RIC_TRY(ric_ritz_residual(r, c, f->period, F, NULL, NULL, error));
    double size = size_of_residual(F, last, f->period);
    if (size < least) {
      least = size;
      best = c[last];
    }
  }
  c[last] = best;
  return fit_coordinate(f, r->hit, best, c, error);
}

static ric_status fit_all(fit *f, double frequency, double *c, ric_error *error) {
  const ric_ritz *r = f->r;
  for (size_t j = 0; j < r->coordinates; j++)
    if (j != r->hit)
      RIC_TRY(fit_coordinate(f, j, 0, c, error));
  if (frequency == 0)
    return try_frequencies(f, c, error);
  c[ric_ritz_unknowns(r) - 1] = frequency;
  return fit_coordinate(f, r->hit, frequency, c, error);
}

ric_status ric_ritz_fit(ric_ritz *r, ric_shooting *shooting, const double *z, double period, double frequency,
                        double *c, ric_error *error) {
  REQUIRE(error, {"ritz", r}, {"shooting", shooting}, {"z", z}, {"c", c});
  fit f = {.r = r, .period = period};
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(ritz_check_shooting(r, shooting, error));
  if (!(frequency >= 0 && (frequency == 0 || frequency * period < two_pi)))
    return ric_fail(error, RIC_EINVAL, "frequency = %g, expected 0 to 2 pi / T = %g", frequency, two_pi / period);
  keep_gsl_quiet();
  ric_status status = fit_init(&f, error);
  if (status == RIC_OK)
    status = sample_motion(r, shooting, z, period, f.q, error);
  if (status == RIC_OK)
    status = fit_all(&f, frequency, c, error);
  fit_clear(&f);
  return status;
}

/* --- error -------------------------------------------------------------------------------------------------------- */

typedef struct comparison {
  ric_ritz *r;
  const double *c;
  double period, error_q, error_v;
} comparison;

static void compare(const ric_segment *piece, double end, void *user) {
  comparison *k = user;
  ric_ritz *r = k->r;
  size_t n = r->coordinates;
  double step = k->period / (double)(SAMPLES * (r->functions + 1));
  size_t samples = 1 + (size_t)(fabs(piece->length) * end / step);
  for (size_t s = 0; s <= samples; s++) {
    double x = end * (double)s / (double)samples;
    ric_segment_state(piece, x, r->q, r->v);
    ritz_motion(r, k->c, k->period, (piece->start + x * piece->length) / k->period, r->bend, r->rate, NULL);
    for (size_t i = 0; i < n; i++) {
      k->error_q = fmax(k->error_q, fabs(r->q[i] - r->bend[i]));
      k->error_v = fmax(k->error_v, fabs(r->v[i] - r->rate[i]));
    }
  }
}

ric_status ric_ritz_error(ric_ritz *r, const double *c, double period, ric_shooting *shooting, const double *z,
                          double *error_q, double *error_v, ric_error *error) {
  REQUIRE(error, {"ritz", r}, {"c", c}, {"shooting", shooting}, {"z", z});
  comparison k = {.r = r, .c = c, .period = period};
  const shooting_observer observer = {.segment = compare, .user = &k};
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(ritz_check_shooting(r, shooting, error));
  RIC_TRY(ritz_check_numbers(r, c, period, error));
  RIC_TRY(shooting_evaluate(shooting, z, period, shooting->residual, NULL, NULL, &observer, error));
  if (error_q)
    *error_q = k.error_q;
  if (error_v)
    *error_v = k.error_v;
  return RIC_OK;
}

/* The criterion at a grazing bifurcation: signs of coefficients, and the proof that all further ones are positive. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>

#include "dominant.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/linear.h"
#include "numeric/number_block.h"
#include "ricochet/elementary.h"
#include "ricochet/grazing_criterion.h"
#include "numeric/gsl_quiet.h"

/* The proof that all coefficients from some index on have the sign of alpha.
 *
 * With lambda, the dominant multiplier, and its projector P, c_i = lambda^i (alpha + e B^i w), B = (I - P) (L / lambda)
 * (I - P), e = eta (I - P), w = (I - P) xi. In coordinates in which B contracts, |B| < 1,
 *
 *   |e B^i w| <= |e B^j| |B^j w|   for all i >= 2 j,
 *
 * with a right-hand side that decreases with j, asymptotically like (second multiplier / lambda)^(2j). Such coordinates
 * are C^T z with C C^T = X = sum over i < N of (B^i)^T B^i / s^(2i), |B^N / s^N| <= 1/2: there |B| <= s, chosen between
 * second / lambda and 1. |B| < 1 is verified, whatever the rounding of X. */

typedef struct tail_proof {
  size_t n;
  double *B;        /* [n][n] */
  double *row, *w;  /* [n] e B^j and B^j w */
  double *work;     /* [n] */
  bool contracting; /* whether |B| < 1 is certain; otherwise there is no bound */
} tail_proof;

/* B^N with N = 2 to this is the last power computed: multipliers whose moduli differ by less than 1e-9 are not
 * separated.
 */
enum { most_doublings = 32 };

static double length(const double *x, size_t n) {
  gsl_vector_const_view view = gsl_vector_const_view_array(x, n);
  return gsl_blas_dnrm2(&view.vector);
}

/* C = A^T B or A B, optionally plus C. */
static void multiply(CBLAS_TRANSPOSE_t transposed, const double *a, const double *b, bool add, double *c, size_t n) {
  gsl_matrix_const_view A = gsl_matrix_const_view_array(a, n, n), B = gsl_matrix_const_view_array(b, n, n);
  gsl_matrix_view C = gsl_matrix_view_array(c, n, n);
  gsl_blas_dgemm(transposed, CblasNoTrans, 1, &A.matrix, &B.matrix, add ? 1 : 0, &C.matrix);
}

/* x becomes B x or x B. */
static void apply(const tail_proof *t, CBLAS_TRANSPOSE_t transposed, double *x) {
  gsl_matrix_const_view B = gsl_matrix_const_view_array(t->B, t->n, t->n);
  gsl_vector_const_view from = gsl_vector_const_view_array(x, t->n);
  gsl_vector_view to = gsl_vector_view_array(t->work, t->n);
  gsl_blas_dgemv(transposed, 1, &B.matrix, &from.vector, 0, &to.vector);
  memcpy(x, t->work, t->n * sizeof *x);
}

/* --- B, e and w --------------------------------------------------------------------------------------------------- */

/* x minus its component (dual . x) along `along`; dual . along = 1. */
static void project(double *x, size_t stride, const double *dual, const double *along, size_t n) {
  double part = 0;
  for (size_t k = 0; k < n; k++)
    part += dual[k] * x[k * stride];
  for (size_t k = 0; k < n; k++)
    x[k * stride] -= part * along[k];
}

static void build_rest(tail_proof *t, const balanced_map *map, const dominant_multiplier *d) {
  size_t n = t->n;
  for (size_t k = 0; k < n * n; k++)
    t->B[k] = map->L[k] / d->value.re;
  for (size_t k = 0; k < n; k++)
    project(t->B + k, n, d->left, d->right, n);
  for (size_t k = 0; k < n; k++)
    project(t->B + k * n, 1, d->right, d->left, n);
  memcpy(t->row, map->eta, n * sizeof *t->row);
  memcpy(t->w, map->xi, n * sizeof *t->w);
  project(t->row, 1, d->right, d->left, n);
  project(t->w, 1, d->left, d->right, n);
}

/* --- coordinates in which B contracts ----------------------------------------------------------------------------- */

/* Workspace of their search, [n][n] each. */
typedef struct contraction {
  double *X, *A, *scratch;
} contraction;

/* X of 2N powers from X of N: X + A^T X A with A = (B / s)^N; then A is squared. */
static void double_powers(const contraction *c, size_t n) {
  multiply(CblasNoTrans, c->X, c->A, false, c->scratch, n);
  multiply(CblasTrans, c->A, c->scratch, true, c->X, n);
  multiply(CblasNoTrans, c->A, c->A, false, c->scratch, n);
  memcpy(c->A, c->scratch, n * n * sizeof *c->A);
}

static void sum_powers(const tail_proof *t, double rate, const contraction *c) {
  size_t n = t->n;
  memset(c->X, 0, n * n * sizeof *c->X);
  for (size_t k = 0; k < n; k++)
    c->X[k * n + k] = 1;
  for (size_t k = 0; k < n * n; k++)
    c->A[k] = t->B[k] / rate;
  for (int k = 0; k < most_doublings && length(c->A, n * n) > 0.5 && isfinite(length(c->X, n * n)); k++)
    double_powers(c, n);
}

/* Transforms B to C^T B C^-T, row and w accordingly. */
static void change_coordinates(tail_proof *t, const double *C) {
  size_t n = t->n;
  gsl_matrix_view B = gsl_matrix_view_array(t->B, n, n);
  gsl_matrix_const_view factor = gsl_matrix_const_view_array(C, n, n);
  gsl_vector_view w = gsl_vector_view_array(t->w, n);
  gsl_blas_dtrmm(CblasLeft, CblasLower, CblasTrans, CblasNonUnit, 1, &factor.matrix, &B.matrix);
  gsl_blas_dtrsm(CblasRight, CblasLower, CblasTrans, CblasNonUnit, 1, &factor.matrix, &B.matrix);
  gsl_blas_dtrmv(CblasLower, CblasTrans, CblasNonUnit, &factor.matrix, &w.vector);
  cholesky_solve_lower(C, n, n, t->row);
}

/* I - B^T B is positive definite by more than `margin`. NaN fails. */
static bool contracts(const tail_proof *t, double margin, double *rest) {
  size_t n = t->n;
  multiply(CblasTrans, t->B, t->B, false, rest, n);
  for (size_t k = 0; k < n * n; k++)
    rest[k] = (k % (n + 1) == 0 ? 1 - margin : 0) - rest[k];
  return isfinite(length(rest, n * n)) && cholesky_factor(rest, n);
}

/* As X >= I, errors of B grow by no more than |C| in the new coordinates. The error of the projector need not be added:
 * the complementary part of the exact L is similar to a matrix that close to B, by a matrix that differs from I by
 * dominant->accuracy. */
static void contract(tail_proof *t, const dominant_multiplier *d, const contraction *c) {
  size_t n = t->n;
  double ratio = d->second / d->modulus, unit = 10 * (double)n * DBL_EPSILON;
  double error = unit * length(t->B, n * n) + d->rounding;
  sum_powers(t, sqrt(fmax(ratio, 0.25)), c);
  if (!isfinite(length(c->X, n * n)) || !cholesky_factor(c->X, n))
    return;
  for (size_t k = 0; k < n; k++)
    memset(c->X + k * n + k + 1, 0, (n - k - 1) * sizeof *c->X);
  change_coordinates(t, c->X);
  t->contracting = contracts(t, unit + 2 * error * length(c->X, n * n), c->scratch);
}

/** At j = 0. The multiplier must be real, simple and resolved. @returns RIC_ENOMEM, with nothing to clear */
static ric_status tail_proof_init(tail_proof *t, const balanced_map *map, const dominant_multiplier *d,
                                  ric_error *error) {
  size_t n = map->n, used = 0;
  double *block = balanced_map_room(n, 1, 3), *work = balanced_map_room(n, 3, 1);
  *t = (tail_proof){.n = n};
  if (!block || !work) {
    free(block);
    free(work);
    return ric_fail(error, RIC_ENOMEM, "no memory for the proof of a map of size %zu", n);
  }
  t->B = number_block_take(block, &used, n * n);
  t->row = number_block_take(block, &used, n);
  t->w = number_block_take(block, &used, n);
  t->work = number_block_take(block, &used, n);
  build_rest(t, map, d);
  contract(t, d, &(contraction){work, work + n * n, work + 2 * n * n});
  free(work);
  return RIC_OK;
}

static void tail_proof_clear(tail_proof *t) {
  free(t->B);
  *t = (tail_proof){0};
}

/** |e B^j| |B^j w|: bounds |c_i / lambda^i - alpha| for i >= 2 j. Infinite unless contracting. */
/* --- the bound ---------------------------------------------------------------------------------------------------- */

static double tail_proof_bound(const tail_proof *t) {
  return t->contracting ? length(t->row, t->n) * length(t->w, t->n) : INFINITY;
}

/** Advances to j + 1. */
static void tail_proof_advance(tail_proof *t) {
  apply(t, CblasTrans, t->row);
  apply(t, CblasNoTrans, t->w);
}

/* Moduli above 1 minus this lie on the unit circle or outside; as multiplier_tol of ric_multiplier_options. */
static const double circle_tol = 1e-9;

/* Margin between the bound and alpha in the proof: rounding in alpha is below a hundredth of each of its factors. */
static const double tail_margin = 0.1;

const char *ric_grazing_verdict_name(ric_grazing_verdict verdict) {
  switch (verdict) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_GRAZING_VERDICT_LIST(X)
#undef X
  case RIC_GRAZING_VERDICTS:
    break;
  }
  return "unknown verdict";
}

const char *ric_grazing_regime_name(ric_grazing_regime regime) {
  switch (regime) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_GRAZING_REGIME_LIST(X)
#undef X
  case RIC_GRAZING_REGIMES:
    break;
  }
  return "unknown regime";
}

ric_grazing_criterion_options ric_grazing_criterion_options_default(void) {
  return (ric_grazing_criterion_options){.zero_tol = 1e-9, .apart_tol = 1e-6, .most = 100000};
}

static ric_status check_options(const ric_grazing_criterion_options *o, ric_error *error) {
  if (!(o->zero_tol >= 0 && o->zero_tol < 1))
    return ric_fail(error, RIC_EINVAL, "zero_tol = %g, expected 0 <= zero_tol < 1", o->zero_tol);
  if (!(o->apart_tol >= 0 && o->apart_tol < 1))
    return ric_fail(error, RIC_EINVAL, "apart_tol = %g, expected 0 <= apart_tol < 1", o->apart_tol);
  if (o->most < 1)
    return ric_fail(error, RIC_EINVAL, "most = 0, expected at least 1 coefficient");
  return RIC_OK;
}

/* Workspace of one call. */
typedef struct criterion_work {
  const ric_grazing_criterion_options *options;
  balanced_map map;
  dominant_multiplier dominant;
  tail_proof tail;
  coefficient_run run;
  double alpha;  /* of the balanced map */
  bool provable; /* whether the proof for all further coefficients can be tried */
} criterion_work;

/* --- signs -------------------------------------------------------------------------------------------------------- */

static bool tail_is_proved(criterion_work *w) {
  return w->provable && tail_proof_bound(&w->tail) < (1 - tail_margin) * w->alpha;
}

/* Checks the coefficients until one is negative, the others are proved positive, or their largest number is reached. */
static void check_coefficients(criterion_work *w, ric_grazing_criterion *c) {
  coefficient_run *run = &w->run;
  for (;;) {
    int sign = coefficient_run_sign(run, w->options->zero_tol);
    if (sign == 0 && c->first_zero == SIZE_MAX)
      c->first_zero = run->i;
    if (sign < 0) {
      c->first_negative = run->i;
      return;
    }
    if (c->settled == SIZE_MAX && tail_is_proved(w))
      c->settled = 2 * run->i;
    if ((c->settled != SIZE_MAX && run->i + 1 >= c->settled) || run->i + 1 >= w->options->most ||
        coefficient_run_over(run))
      return;
    coefficient_run_advance(run);
    if (w->provable && c->settled == SIZE_MAX)
      tail_proof_advance(&w->tail);
  }
}

/* --- the verdict -------------------------------------------------------------------------------------------------- */

static void name_multiplier(ric_complex z, char *text, size_t size) {
  if (z.im == 0)
    snprintf(text, size, "%.9g", z.re);
  else
    snprintf(text, size, "%.9g %+.9gi", z.re, z.im);
}

/* Tests conditions on the dominant multiplier. @returns whether one fails */
static bool spectrum_fails(const criterion_work *w, ric_grazing_criterion *c) {
  const dominant_multiplier *d = &w->dominant;
  double modulus = ric_hypot(c->dominant.re, c->dominant.im);
  char name[64];
  name_multiplier(c->dominant, name, sizeof name);
  if (!(modulus < 1 - circle_tol))
    snprintf(c->reason, sizeof c->reason, "multiplier %s of modulus %.9g does not lie inside the unit circle", name,
             modulus);
  else if (modulus == 0)
    snprintf(c->reason, sizeof c->reason, "all multipliers are zero, so c_i = 0 from some i on");
  else if (!d->real)
    snprintf(c->reason, sizeof c->reason, "the dominant multiplier %s is complex", name);
  else if (!d->alone)
    snprintf(c->reason, sizeof c->reason, "the dominant multiplier %s is not simple: another one has the modulus %.9g",
             name, c->second);
  else if (d->value.re < 0)
    snprintf(c->reason, sizeof c->reason, "the dominant multiplier %s is negative", name);
  else if (!dominant_is_resolved(d))
    snprintf(c->reason, sizeof c->reason,
             "the dominant multiplier %s cannot be separated from others: rounding is %.3g of the distance", name,
             d->accuracy);
  else
    return false;
  return true;
}

/* The same for the components of eta and xi along its eigenvectors. */
static bool component_fails(const criterion_work *w, ric_grazing_criterion *c) {
  const dominant_multiplier *d = &w->dominant;
  if (dominant_is_coupled(d))
    return false;
  bool observed = fabs(d->observed) > d->observed_tol;
  snprintf(c->reason, sizeof c->reason, "%s the eigenvector of the dominant multiplier %.9g",
           observed ? "xi does not excite" : "eta has no component along", c->dominant.re);
  return true;
}

/* The same for the coefficients. */
static bool coefficients_fail(const criterion_work *w, ric_grazing_criterion *c) {
  if (c->first_zero != SIZE_MAX)
    snprintf(c->reason, sizeof c->reason, "c_%zu is zero within the tolerance: higher orders decide", c->first_zero);
  else if (!(c->alpha > 0))
    snprintf(c->reason, sizeof c->reason, "alpha = %.3g is negative, and none of the first %zu c_i", c->alpha,
             w->run.i + 1);
  else if (!w->tail.contracting)
    snprintf(c->reason, sizeof c->reason, "the terms beyond the dominant multiplier %.9g have no bound above rounding",
             c->dominant.re);
  else if (c->settled == SIZE_MAX || w->run.i + 1 < c->settled)
    snprintf(c->reason, sizeof c->reason,
             "%zu coefficients are positive, but the next multiplier, of modulus %.9g, "
             "may outweigh the dominant one, %.9g, later",
             w->run.i + 1, c->second, c->dominant.re);
  else
    return false;
  return true;
}

static ric_grazing_regime regime_of(double lambda, double apart_tol) {
  const double low = 1.0 / 4, high = 2.0 / 3;
  if (fabs(lambda - low) <= apart_tol * low || fabs(lambda - high) <= apart_tol * high)
    return RIC_REGIME_BORDER;
  if (lambda < low)
    return RIC_REGIME_OVERLAP;
  return lambda < high ? RIC_REGIME_WINDOWS : RIC_REGIME_CHAOS;
}

static void decide(const criterion_work *w, ric_grazing_criterion *c) {
  if (c->first_negative != SIZE_MAX) {
    c->verdict = RIC_GRAZING_DISCONTINUOUS;
    snprintf(c->reason, sizeof c->reason, "c_%zu = %.3g is negative: an impact leads to another, much faster one",
             c->first_negative, coefficient_run_value(&w->run));
  } else if (!spectrum_fails(w, c) && !component_fails(w, c) && !coefficients_fail(w, c)) {
    c->verdict = RIC_GRAZING_CONTINUOUS;
    c->regime = regime_of(c->dominant.re, w->options->apart_tol);
    c->reason[0] = '\0';
  }
  if (c->verdict != RIC_GRAZING_CONTINUOUS)
    c->settled = SIZE_MAX;
}

/* --- the call ----------------------------------------------------------------------------------------------------- */

static void describe_dominant(criterion_work *w, ric_grazing_criterion *c) {
  const dominant_multiplier *d = &w->dominant;
  long exponent = w->map.L_exponent;
  bool known = d->real && d->alone && dominant_is_resolved(d);
  c->dominant = (ric_complex){scalbln(d->value.re, exponent), scalbln(d->value.im, exponent)};
  c->second = scalbln(d->second, exponent);
  w->alpha = known ? d->observed * d->excited : NAN;
  c->alpha = scalbln(w->alpha, w->map.c_exponent);
}

static ric_status decide_criterion(criterion_work *w, const ric_grazing_map *map, ric_grazing_criterion *c,
                                   ric_error *error) {
  const ric_grazing_criterion_options *o = w->options;
  *c = (ric_grazing_criterion){.verdict = RIC_GRAZING_UNDECIDED,
                               .regime = RIC_REGIME_NONE,
                               .first_negative = SIZE_MAX,
                               .first_zero = SIZE_MAX,
                               .settled = SIZE_MAX};
  RIC_TRY(balanced_map_init(&w->map, map, error));
  RIC_TRY(dominant_find(&w->dominant, &w->map, o->zero_tol, o->apart_tol, error));
  RIC_TRY(coefficient_run_init(&w->run, &w->map, &w->dominant, error));
  describe_dominant(w, c);
  if (w->alpha > 0 && w->dominant.value.re > 0) {
    RIC_TRY(tail_proof_init(&w->tail, &w->map, &w->dominant, error));
    w->provable = w->tail.contracting && dominant_is_coupled(&w->dominant);
  }
  check_coefficients(w, c);
  decide(w, c);
  return RIC_OK;
}

static ric_status fill_coefficients(const criterion_work *w, double *coefficients, size_t count, ric_error *error) {
  coefficient_run run;
  RIC_TRY(coefficient_run_init(&run, &w->map, &w->dominant, error));
  for (size_t i = 0; i < count; i++) {
    coefficients[i] = coefficient_run_value(&run);
    coefficient_run_advance(&run);
  }
  coefficient_run_clear(&run);
  return RIC_OK;
}

/* In coordinates of the map. */
static void fill_departure(const criterion_work *w, const ric_grazing_criterion *c, double *departure) {
  size_t n = w->map.n;
  double sum = 0, most;
  for (size_t k = 0; k < n; k++)
    departure[k] = c->first_negative != SIZE_MAX ? w->map.scale[k] * w->run.x[k] : NAN;
  most = largest(departure, n);
  for (size_t k = 0; k < n; k++)
    sum = ric_hypot(sum, departure[k] / most);
  for (size_t k = 0; k < n; k++)
    departure[k] = departure[k] / most / sum;
}

ric_status ric_grazing_criterion_find(const ric_grazing_map *map, const ric_grazing_criterion_options *options,
                                      ric_grazing_criterion *criterion, double *coefficients, size_t count,
                                      double *departure, ric_error *error) {
  REQUIRE(error, {"map", map}, {"criterion", criterion}, {"coefficients", unless_empty(count, coefficients)});
  const ric_grazing_criterion_options o = options ? *options : ric_grazing_criterion_options_default();
  ric_grazing_criterion found;
  criterion_work work = {.options = &o};
  RIC_TRY(ric_grazing_map_check(map, error));
  RIC_TRY(check_options(&o, error));
  keep_gsl_quiet();
  ric_status status = decide_criterion(&work, map, &found, error);
  if (status == RIC_OK)
    status = fill_coefficients(&work, coefficients, count, error);
  if (status == RIC_OK && departure)
    fill_departure(&work, &found, departure);
  if (status == RIC_OK)
    *criterion = found;
  coefficient_run_clear(&work.run);
  tail_proof_clear(&work.tail);
  dominant_clear(&work.dominant);
  balanced_map_clear(&work.map);
  return status;
}

/* --- windows ------------------------------------------------------------------------------------------------------ */

ric_status ric_grazing_predict_window(const ric_grazing_criterion *criterion, double stretch, size_t period,
                                      double *border, double *flip, ric_error *error) {
  REQUIRE(error, {"criterion", criterion}, {"border", border}, {"flip", flip});
  if (criterion->verdict != RIC_GRAZING_CONTINUOUS)
    return ric_fail(error, RIC_EINVAL, "a bifurcation that is %s, expected a continuous one",
                    ric_grazing_verdict_name(criterion->verdict));
  if (!(stretch > 0 && stretch < INFINITY))
    return ric_fail(error, RIC_EINVAL, "stretch = %g, expected a finite number > 0", stretch);
  if (period < 2)
    return ric_fail(error, RIC_EINVAL, "period = %zu, expected at least 2", period);
  double lambda = criterion->dominant.re, reach = criterion->alpha * stretch;
  double at_border = reach * ric_pow(lambda, (double)(period - 2)),
         at_flip = reach * ric_pow(lambda, (double)(period - 1));
  *border = (1 - lambda) * at_border * at_border;
  *flip = 0.75 * at_flip * at_flip;
  return RIC_OK;
}

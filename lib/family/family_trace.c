/* Curves of special points in two parameters.
 *
 * Unknowns are z and the first parameter, equations F = 0 and psi = 0, where psi is the quantity that vanishes at
 * the special point. Its derivatives are central differences: their error affects the convergence of Newton's method
 * only. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "family.h"
#include "ricochet/elementary.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Step of differences of psi, relative to 1 + the size of the variable. */
static const double psi_step = 1e-5;

typedef struct tracer {
  ric_family *f;
  ric_family_kind kind;
  size_t which;        /* its test function; not used for folds */
  double unit;         /* of psi */
  double *z, *J, *F_p; /* [n], [n][n], [n] */
  double *F;           /* [n] */
  double *derivatives; /* [n + 2] derivatives of psi */
  gsl_permutation *order;
  ric_family_curve_tests tests;
  int (*visit)(const ric_family_curve_point *point, void *user);
  void *user;
  ric_status status;
  ric_error *error;
} tracer;

/* --- psi ---------------------------------------------------------------------------------------------------------- */

static ric_status determinant(tracer *t, const double *z, double *value, ric_error *error) {
  size_t n = t->f->unknowns;
  double log = 0;
  int sign;
  RIC_TRY(ric_shooting_residual(t->f->shooting, z, t->f->given, t->F, t->J, NULL, error));
  gsl_matrix_view J = gsl_matrix_view_array(t->J, n, n);
  gsl_linalg_LU_decomp(&J.matrix, t->order, &sign);
  for (size_t i = 0; i < n; i++)
    log += ric_log(fabs(gsl_matrix_get(&J.matrix, i, i)));
  *value = gsl_linalg_LU_sgndet(&J.matrix, sign) * ric_exp(log);
  return RIC_OK;
}

static ric_status psi(tracer *t, const double *z, double first, double second, double *value, ric_error *error) {
  ric_family *f = t->f;
  RIC_TRY(family_set(f, first, second, error));
  if (t->kind == RIC_FAMILY_FOLD) {
    RIC_TRY(determinant(t, z, value, error));
  } else if (t->kind == RIC_FAMILY_PERIOD_DOUBLING) {
    RIC_TRY(shooting_examine(f->shooting, z, f->given, EXAMINE_SPECTRUM, NULL, NULL, NULL, NULL, error));
    *value = shooting_spectrum_tests(f->shooting).minus_one[t->which];
  } else {
    RIC_TRY(ric_shooting_orbit(f->shooting, z, f->given, &f->orbit, error));
    const gap_watch *g = &f->shooting->gaps.watch;
    *value = t->which == TEST_FREE_GAP  ? g->free.value
             : t->which == TEST_OWN_GAP ? g->own.value
                                        : f->orbit.gap_rate[t->which - TEST_IMPACTS];
  }
  *value /= t->unit;
  return isfinite(*value) ? RIC_OK
                          : ric_fail(error, RIC_ENUMERIC, "the test function of the special point has no value");
}

/* Derivatives [n + 2] of psi: by z, by both parameters. */
static ric_status gradient(tracer *t, const double *z, double first, double second, double *derivatives,
                           ric_error *error) {
  size_t n = t->f->unknowns;
  double at[2] = {first, second}, value[2];
  for (size_t i = 0; i < n + 2; i++) {
    double *moved = i < n ? &t->z[i] : &at[i - n], h;
    memcpy(t->z, z, n * sizeof *z);
    const double kept = *moved;
    h = psi_step * (1 + fabs(kept));
    for (int k = 0; k < 2; k++) {
      *moved = kept + (k ? h : -h);
      RIC_TRY(psi(t, t->z, at[0], at[1], &value[k], error));
    }
    *moved = kept;
    derivatives[i] = (value[1] - value[0]) / (2 * h);
  }
  return RIC_OK;
}

/* --- the extended equations --------------------------------------------------------------------------------------- */

static ric_status trace_residual(const double *u, double p, double *F, double *J, double *F_p, void *user,
                                 ric_error *error) {
  tracer *t = user;
  ric_family *f = t->f;
  size_t n = f->unknowns, size = n + 1;
  double first = u[n];
  RIC_TRY(family_set(f, first, p, error));
  RIC_TRY(family_residual(f, u, 0, F, t->J, t->F_p, error));
  for (size_t i = 0; i < n; i++) {
    memcpy(J + i * size, t->J + i * n, n * sizeof *J);
    J[i * size + n] = t->F_p[i];
  }
  RIC_TRY(family_residual(f, u, 1, F, t->J, F_p, error));
  RIC_TRY(gradient(t, u, first, p, t->derivatives, error));
  memcpy(J + n * size, t->derivatives, size * sizeof *J);
  F_p[n] = t->derivatives[size];
  return psi(t, u, first, p, &F[n], error);
}

/* Evaluates the orbit of the point (z, first) of the curve at `second`. */
static ric_status evaluate_point(tracer *t, const double *u, double p, ric_family_curve_point *point,
                                 ric_error *error) {
  ric_family *f = t->f;
  size_t n = f->unknowns;
  RIC_TRY(family_set(f, u[n], p, error));
  RIC_TRY(ric_shooting_orbit(f->shooting, u, f->given, &f->orbit, error));
  *point = (ric_family_curve_point){
      .parameter = u[n], .second = p, .z = u, .given = f->given, .orbit = &f->orbit, .zero = SIZE_MAX};
  return RIC_OK;
}

static ric_status test(const double *u, double p, const double *t_u, double t_p, double *values, void *user,
                       ric_error *error) {
  tracer *t = user;
  ric_family_curve_point point;
  (void)t_u, (void)t_p;
  RIC_TRY(evaluate_point(t, u, p, &point, error));
  const ric_status status = t->tests.values(&point, values, t->tests.user, error);
  family_forget(t->f);
  return status;
}

static int report_curve_point(const ric_curve_point *c, void *user) {
  tracer *t = user;
  ric_family_curve_point point;
  if (c->kind == RIC_CURVE_BRANCH_POINT)
    return 0;
  t->status = evaluate_point(t, c->u, c->p, &point, t->error);
  if (t->status != RIC_OK)
    return 1;
  point.iterations = c->iterations;
  if (c->kind == RIC_CURVE_TEST)
    point.zero = c->which;
  int over = t->visit ? t->visit(&point, t->user) : 0;
  family_forget(t->f);
  return over;
}

/* --- the start ---------------------------------------------------------------------------------------------------- */

static ric_status choose_multiplier(tracer *t, const ric_family_point *point) {
  RIC_TRY(shooting_examine(t->f->shooting, point->z, t->f->given, EXAMINE_SPECTRUM, NULL, NULL, NULL, NULL, t->error));
  spectrum_tests tests = shooting_spectrum_tests(t->f->shooting);
  t->which = fabs(tests.minus_one[1]) < fabs(tests.minus_one[0]) ? 1 : 0;
  return RIC_OK;
}

/* The test function of the gap or impact of the point. */
static ric_status choose_test(tracer *t, const ric_family_point *point) {
  ric_family *f = t->f;
  double least = INFINITY;
  RIC_TRY(ric_shooting_orbit(f->shooting, point->z, f->given, &f->orbit, t->error));
  if (point->kind == RIC_FAMILY_GRAZING) {
    t->which = f->shooting->gaps.hit[point->obstacle] ? TEST_OWN_GAP : TEST_FREE_GAP;
    return RIC_OK;
  }
  for (size_t k = 0; k < f->impacts; k++)
    if (f->orbit.impact_obstacle[k] == point->obstacle && fabs(f->orbit.gap_rate[k]) < least) {
      least = fabs(f->orbit.gap_rate[k]);
      t->which = TEST_IMPACTS + k;
    }
  return RIC_OK;
}

static ric_status choose_psi(tracer *t, const ric_family_point *point) {
  t->kind = point->kind;
  RIC_TRY(family_set(t->f, point->parameter, t->f->problem.second, t->error));
  switch (point->kind) {
  case RIC_FAMILY_FOLD:
    return RIC_OK;
  case RIC_FAMILY_PERIOD_DOUBLING:
    return choose_multiplier(t, point);
  case RIC_FAMILY_GRAZING:
  case RIC_FAMILY_IMPACT_LOST:
  case RIC_FAMILY_IMPULSE_SIGN:
    return choose_test(t, point);
  default:
    return ric_fail(t->error, RIC_EINVAL,
                    "point = %s, expected fold, period_doubling, grazing, impact_lost or impulse_sign",
                    ric_family_kind_name(point->kind));
  }
}

/* A unit in which the derivatives of psi are of order one. */
static ric_status choose_unit(tracer *t, const double *z, double first, double second, double *derivatives) {
  double size = 0;
  t->unit = 1;
  RIC_TRY(gradient(t, z, first, second, derivatives, t->error));
  for (size_t i = 0; i < t->f->unknowns + 2; i++)
    size = fmax(size, fabs(derivatives[i]));
  if (!(size > 0 && size < INFINITY))
    return ric_fail(t->error, RIC_ENUMERIC,
                    "the derivatives of the test function have the size %g, expected a number > 0", size);
  t->unit = size;
  return RIC_OK;
}

static ric_status follow_curve(tracer *t, const ric_family_point *point, const ric_curve_options *options,
                               ric_curve_run *run, double *u) {
  size_t n = t->f->unknowns;
  const ric_curve_problem problem = {.unknowns = n + 1,
                                     .residual = trace_residual,
                                     .tests = t->tests.count,
                                     .test = t->tests.count > 0 ? test : NULL,
                                     .user = t};
  ric_curve *curve = NULL;
  RIC_TRY(choose_psi(t, point));
  memcpy(u, point->z, n * sizeof *u);
  u[n] = point->parameter;
  RIC_TRY(choose_unit(t, point->z, point->parameter, t->f->problem.second, t->derivatives));
  RIC_TRY(ric_curve_create(&problem, options, &curve, t->error));
  ric_status status = ric_curve_follow(curve, u, t->f->problem.second, NULL, report_curve_point, t, run, t->error);
  ric_curve_destroy(&curve);
  return status == RIC_OK ? t->status : status;
}

ric_status ric_family_trace(ric_family *f, const ric_family_point *point, const ric_curve_options *options,
                            const ric_family_curve_tests *tests,
                            int (*visit)(const ric_family_curve_point *point, void *user), void *user,
                            ric_curve_run *run, ric_error *error) {
  REQUIRE(error, {"family", f}, {"point", point}, {"run", run});
  ric_error own;
  size_t n = f->unknowns;
  tracer t = {.f = f, .visit = visit, .user = user, .error = error ? error : &own};
  if (tests)
    t.tests = *tests;
  *run = (ric_curve_run){0};
  if (f->problem.parameters != 2)
    return ric_fail(error, RIC_EINVAL, "a family with one parameter, expected two");
  family_forget(f);
  keep_gsl_quiet();
  t.J = malloc((n * n + 6 * n + 4) * sizeof *t.J);
  t.order = gsl_permutation_alloc(n);
  ric_status status = RIC_ENOMEM;
  if (t.J && t.order) {
    t.F = t.J + n * n;
    t.F_p = t.F + n;
    t.z = t.F_p + n;
    t.derivatives = t.z + n;
    status = follow_curve(&t, point, options ? options : &f->options.curve, run, t.derivatives + n + 2);
  } else
    (void)ric_fail(error, RIC_ENOMEM, "no memory for a curve of %zu unknowns", n + 1);
  family_evaluate_again(f, point);
  gsl_permutation_free(t.order);
  free(t.J);
  return status;
}

/* Solving F(c) = 0, with one number of functions and with more and more. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/largest.h"
#include "numeric/newton.h"
#include "ritz_parts.h"
#include "numeric/constants.h"

/* Of the largest residual, relative to 1 + the largest unknown, without units: rounding of sums over the points. */
static const double newton_tol = 1e-13;

/* Newton's method sees no units of length and time, so that its tolerance means the same in all: coefficients are
 * over the size of the motion, w is over 2 pi / T, residuals of the equations of motion are over both. */
typedef struct at_period {
  ric_ritz *r;
  double period;
  double length, rate; /* the units: the size of the motion, 2 pi / T */
} at_period;

static at_period units_of(ric_ritz *r, const double *c, double period) {
  size_t last = ric_ritz_unknowns(r) - 1;
  double size = fmax(largest(c, last), fabs(r->system->obstacles[r->obstacle].position));
  return (at_period){.r = r, .period = period, .length = size > 0 ? size : 1, .rate = two_pi / period};
}

static void take_units_off(const at_period *a, const double *c, double *z) {
  size_t last = ric_ritz_unknowns(a->r) - 1;
  for (size_t i = 0; i < last; i++)
    z[i] = c[i] / a->length;
  z[last] = c[last] / a->rate;
}

static void put_units_on(const at_period *a, const double *z, double *c) {
  size_t last = ric_ritz_unknowns(a->r) - 1;
  for (size_t i = 0; i < last; i++)
    c[i] = z[i] * a->length;
  c[last] = z[last] * a->rate;
}

/* Of the Jacobian: what row i is over, and column j is times. */
static void scale_slopes(const at_period *a, double *J) {
  size_t unknowns = ric_ritz_unknowns(a->r), last = unknowns - 1;
  for (size_t i = 0; i < unknowns; i++) {
    double *row = J + i * unknowns;
    for (size_t j = 0; j < unknowns && i < last; j++)
      row[j] = row[j] / a->rate / a->rate;
    row[last] = row[last] / a->length * a->rate;
  }
}

static ric_status residual(const double *z, double *F, double *J, void *user, ric_error *error) {
  const at_period *a = user;
  size_t last = ric_ritz_unknowns(a->r) - 1;
  put_units_on(a, z, a->r->spare);
  RIC_TRY(ric_ritz_residual(a->r, a->r->spare, a->period, F, J, NULL, error));
  for (size_t i = 0; i <= last; i++)
    F[i] = i < last ? F[i] / a->length / a->rate / a->rate : F[i] / a->length;
  if (J)
    scale_slopes(a, J);
  return RIC_OK;
}

ric_status ric_ritz_solve(ric_ritz *r, double *c, double period, int *iterations, ric_error *error) {
  int count = 0;
  if (iterations)
    *iterations = 0;
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(ritz_check_numbers(r, c, period, error));
  at_period at = units_of(r, c, period);
  const newton_problem problem = {
      .name = "Ritz's method", .unknowns = ric_ritz_unknowns(r), .residual = residual, .user = &at};
  take_units_off(&at, c, c);
  ric_status status = newton_solve(&problem, c, newton_tol, &count, error);
  put_units_on(&at, c, c);
  double w = ritz_frequency(r, c);
  if (iterations)
    *iterations = count;
  if (status != RIC_OK || (w > 0 && w * period < two_pi))
    return status;
  return ric_fail(error, RIC_ENUMERIC, "Ritz's method converges to w = %g, expected 0 to 2 pi / T = %g", w,
                  two_pi / period);
}

/* --- more and more functions -------------------------------------------------------------------------------------- */

typedef struct ladder {
  ric_ritz *r;
  ric_shooting *shooting;
  const double *z;
  double period;
  double *best;     /* [unknowns of all functions] coefficients of the solution with the smallest error */
  double *tried;    /* [the same] */
  size_t functions; /* of the best; 0: none yet */
  double error_q;   /* of the best */
} ladder;

/* 1, 2, 3, 4, 6, 8, 12, 16 ..., and last the most. */
static size_t next_rung(size_t functions, size_t most) {
  size_t power = 1;
  while (2 * power <= functions)
    power *= 2;
  size_t next = functions < 2 ? functions + 1 : functions + power / 2;
  return functions < most && next > most ? most : next;
}

static bool is_fatal(ric_status status) {
  return status != RIC_OK && status != RIC_ENUMERIC;
}

/* Solves from l->tried, and keeps the solution when it is better than the best. */
static ric_status try_guess(ladder *l, bool *better, ric_error *error) {
  double off;
  *better = false;
  ric_status status = ric_ritz_solve(l->r, l->tried, l->period, NULL, error);
  if (status == RIC_OK)
    status = ric_ritz_error(l->r, l->tried, l->period, l->shooting, l->z, &off, NULL, error);
  if (status != RIC_OK || !(off < l->error_q))
    return is_fatal(status) ? status : RIC_OK;
  memcpy(l->best, l->tried, ric_ritz_unknowns(l->r) * sizeof *l->best);
  l->functions = l->r->functions;
  l->error_q = off;
  *better = true;
  return RIC_OK;
}

/* From the best solution so far; where that leads nowhere, from a fit with the best of tried frequencies. */
static ric_status climb(ladder *l, size_t functions, ric_error *error) {
  bool better = false;
  if (l->functions > 0) {
    RIC_TRY(ric_ritz_use(l->r, l->functions, NULL, error));
    memcpy(l->tried, l->best, ric_ritz_unknowns(l->r) * sizeof *l->tried);
    RIC_TRY(ric_ritz_use(l->r, functions, l->tried, error));
    RIC_TRY(try_guess(l, &better, error));
  }
  if (better)
    return RIC_OK;
  RIC_TRY(ric_ritz_use(l->r, functions, NULL, error));
  RIC_TRY(ric_ritz_fit(l->r, l->shooting, l->z, l->period, 0, l->tried, error));
  return try_guess(l, &better, error);
}

static ric_status judge(const ladder *l, double tolerance, ric_error *error) {
  if (l->functions == 0)
    return ric_fail(error, RIC_ENUMERIC, "Ritz's method converges with no number of functions up to %zu", l->r->most);
  if (tolerance == 0 || l->error_q <= tolerance)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "Ritz's method is off by %.3g with %zu functions, expected %.3g at most",
                  l->error_q, l->functions, tolerance);
}

static ric_status climb_all(ladder *l, double tolerance, double *c, ric_error *error) {
  for (size_t k = 1; k <= l->r->most && !(l->functions > 0 && l->error_q <= tolerance); k = next_rung(k, l->r->most))
    RIC_TRY(climb(l, k, error));
  RIC_TRY(ric_ritz_use(l->r, l->functions > 0 ? l->functions : l->r->most, NULL, error));
  if (l->functions > 0)
    memcpy(c, l->best, ric_ritz_unknowns(l->r) * sizeof *c);
  return judge(l, tolerance, error);
}

ric_status ric_ritz_refine(ric_ritz *r, ric_shooting *shooting, const double *z, double period, double tolerance,
                           double *c, double *error_q, ric_error *error) {
  size_t unknowns = r->coordinates * r->stride + 1;
  ladder l = {.r = r, .shooting = shooting, .z = z, .period = period, .error_q = INFINITY};
  if (!(tolerance >= 0))
    return ric_fail(error, RIC_EINVAL, "tolerance = %g, expected >= 0", tolerance);
  l.best = calloc(2 * unknowns, sizeof *l.best);
  if (!l.best)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu coefficients", unknowns);
  l.tried = l.best + unknowns;
  ric_status status = climb_all(&l, tolerance, c, error);
  free(l.best);
  if (error_q)
    *error_q = l.error_q;
  return status;
}

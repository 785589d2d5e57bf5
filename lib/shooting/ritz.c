/* Ritz's method: trial functions, the solution with a given number of them and with increasing numbers, the motion
 * that results. */
#include "ritz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_integration.h>

#include "model/lattice_system.h"
#include "numeric/constants.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/newton.h"
#include "numeric/number_block.h"
#include "ricochet/elementary.h"
#include "ricochet/ritz.h"
#include "numeric/gsl_quiet.h"

/* The approximated motion at any time, and its residual in the equations of motion. */

/* Samples per function over half a period: 16 per wave of the fastest one. */
enum { SAMPLES = 16 };

void ritz_functions_at(const ric_ritz *r, double phase, double *cosine, double *sine) {
  for (size_t m = 0; m < ritz_width(r); m++)
    ric_sincos(ritz_number(r, m) * phase, &sine[m], &cosine[m]);
}

/* sum_i c_i cos(i phase) over the functions, and its first two derivatives by the phase. */
static void sum_series(const ric_ritz *r, const double *c, double phase, double sums[3]) {
  sums[0] = sums[1] = sums[2] = 0;
  for (size_t m = 0; m < ritz_width(r); m++) {
    double number = ritz_number(r, m), sine, cosine;
    ric_sincos(number * phase, &sine, &cosine);
    sums[0] += c[m] * cosine;
    sums[1] -= number * c[m] * sine;
    sums[2] -= number * number * c[m] * cosine;
  }
}

void ritz_motion(const ric_ritz *r, const double *c, double period, double tau, double *q, double *v, double *bend) {
  for (size_t j = 0; j < r->coordinates; j++) {
    bool hit = j == r->hit;
    double frequency = hit ? -ritz_frequency(r, c) : two_pi / period, sums[3]; /* w (T/2 - t) runs back */
    sum_series(r, c + j * ritz_width(r), hit ? -frequency * period * (0.5 - tau) : two_pi * tau, sums);
    if (q)
      q[j] = sums[0];
    if (v)
      v[j] = frequency * sums[1];
    if (bend)
      bend[j] = frequency * frequency * sums[2];
  }
}

void ric_ritz_state(const ric_ritz *ritz, const double *c, double period, double t, double *q, double *v) {
  ritz_motion(ritz, c, period, t / period, q, v, NULL);
}

double ric_ritz_defect(ric_ritz *r, const double *c, double period) {
  size_t samples = SAMPLES * (r->functions + 1), n = r->coordinates;
  double left = 0, most = 0;
  if (ritz_check_numbers(r, c, period, NULL) != RIC_OK)
    return NAN;
  for (size_t s = 0; s <= samples; s++) {
    ritz_motion(r, c, period, (double)s / (double)(2 * samples), r->q, NULL, r->bend);
    ric_lattice_acceleration(lattice_system_lattice(r->system), 0, r->q, r->nothing, r->rate);
    most = fmax(most, largest(r->bend, n));
    for (size_t i = 0; i < n; i++)
      left = fmax(left, fabs(r->bend[i] - r->rate[i]));
  }
  return left > 0 ? left / most : 0; /* rest is exact */
}

/* Solving F(c) = 0, with a given number of functions and with increasing numbers. */

/* Of the largest residual, relative to 1 + the largest unknown, without units: rounding of sums over the points. */
static const double newton_tol = 1e-13;

/* Newton's method works on numbers without units of length and time, so that its tolerance has one meaning:
 * coefficients are divided by the size of the motion, w by 2 pi / T, residuals of the equations of motion by both. */
typedef struct at_period {
  ric_ritz *r;
  double period;
  double length, rate; /* the units: the size of the motion, 2 pi / T */
} at_period;

size_t ric_ritz_unknowns(const ric_ritz *ritz) {
  return ritz->coordinates * ritz_width(ritz) + 1;
}

static at_period units_of(ric_ritz *r, const double *c, double period) {
  size_t last = ric_ritz_unknowns(r) - 1;
  double size = fmax(largest(c, last), fabs(r->system->obstacles[r->obstacle].position));
  return (at_period){.r = r, .period = period, .length = size > 0 ? size : 1, .rate = two_pi / period};
}

static void remove_units(const at_period *a, const double *c, double *z) {
  size_t last = ric_ritz_unknowns(a->r) - 1;
  for (size_t i = 0; i < last; i++)
    z[i] = c[i] / a->length;
  z[last] = c[last] / a->rate;
}

static void restore_units(const at_period *a, const double *z, double *c) {
  size_t last = ric_ritz_unknowns(a->r) - 1;
  for (size_t i = 0; i < last; i++)
    c[i] = z[i] * a->length;
  c[last] = z[last] * a->rate;
}

/* Scales the Jacobian: row i is divided by the unit of its equation, column j multiplied by that of its unknown. */
static void scale_jacobian(const at_period *a, double *J) {
  size_t unknowns = ric_ritz_unknowns(a->r), last = unknowns - 1;
  for (size_t i = 0; i < unknowns; i++) {
    double *row = J + i * unknowns;
    for (size_t j = 0; j < unknowns && i < last; j++)
      row[j] = row[j] / a->rate / a->rate;
    row[last] = row[last] / a->length * a->rate;
  }
}

static ric_status ritz_residual(const double *z, double *F, double *J, void *user, ric_error *error) {
  const at_period *a = user;
  size_t last = ric_ritz_unknowns(a->r) - 1;
  restore_units(a, z, a->r->spare);
  RIC_TRY(ric_ritz_residual(a->r, a->r->spare, a->period, F, J, NULL, error));
  for (size_t i = 0; i <= last; i++)
    F[i] = i < last ? F[i] / a->length / a->rate / a->rate : F[i] / a->length;
  if (J)
    scale_jacobian(a, J);
  return RIC_OK;
}

static ric_status check_losses(const ric_lattice *l, ric_error *error) {
  for (size_t i = 0; i < l->particles; i++)
    if (ric_lattice_on_site(l, i).damping != 0)
      return ric_fail(error, RIC_EINVAL, "on-site spring %zu: damping = %g, expected 0", i,
                      ric_lattice_on_site(l, i).damping);
  for (size_t i = 0; i <= l->particles; i++)
    if (ric_lattice_link(l, i).damping != 0)
      return ric_fail(error, RIC_EINVAL, "link %zu: damping = %g, expected 0", i, ric_lattice_link(l, i).damping);
  return RIC_OK;
}

static ric_status check_force(const double *force, size_t n, const char *name, ric_error *error) {
  for (size_t i = 0; force && i < n; i++)
    if (force[i] != 0)
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected 0", name, i, force[i]);
  return RIC_OK;
}

ric_status ritz_check_system(ric_ritz *r, ric_error *error) {
  if (r->revision == r->system->revision)
    return RIC_OK;
  const ric_lattice *l = lattice_system_lattice(r->system);
  double e = r->system->obstacles[r->obstacle].restitution;
  if (e != 1)
    return ric_fail(error, RIC_EINVAL, "restitution = %g of obstacle %zu, expected 1", e, r->obstacle);
  RIC_TRY(check_losses(l, error));
  RIC_TRY(check_force(l->force_cos, l->particles, "force_cos", error));
  RIC_TRY(check_force(l->force_sin, l->particles, "force_sin", error));
  r->revision = r->system->revision;
  return RIC_OK;
}

ric_status ric_ritz_solve(ric_ritz *r, double *c, double period, int *iterations, ric_error *error) {
  REQUIRE(error, {"ritz", r}, {"c", c});
  int count = 0;
  if (iterations)
    *iterations = 0;
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(ritz_check_numbers(r, c, period, error));
  at_period at = units_of(r, c, period);
  const newton_problem problem = {
      .name = "Ritz's method", .unknowns = ric_ritz_unknowns(r), .residual = ritz_residual, .user = &at};
  remove_units(&at, c, c);
  ric_status status = newton_solve(&problem, c, newton_tol, &count, error);
  restore_units(&at, c, c);
  double w = ritz_frequency(r, c);
  if (iterations)
    *iterations = count;
  if (status != RIC_OK || (w > 0 && w * period < two_pi))
    return status;
  return ric_fail(error, RIC_ENUMERIC, "Ritz's method converges to w = %g, expected 0 to 2 pi / T = %g", w,
                  two_pi / period);
}

/* --- increasing numbers of functions ------------------------------------------------------------------------------ */

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

/* Solves from l->tried, and keeps the solution if its error is the smallest. */
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

ric_status ric_ritz_use(ric_ritz *r, size_t functions, double *c, ric_error *error) {
  REQUIRE(error, {"ritz", r});
  if (!(functions >= 1 && functions <= r->most))
    return ric_fail(error, RIC_EINVAL, "functions = %zu, expected 1 to %zu", functions, r->most);
  size_t n = r->coordinates, before = ritz_width(r), after = functions + 1 - r->first;
  size_t kept = before < after ? before : after;
  r->functions = functions;
  if (!c)
    return RIC_OK;
  double w = c[n * before];
  for (size_t k = 0; k < n; k++) { /* rows move apart from the last one on, together from the first one on */
    size_t i = after > before ? n - 1 - k : k;
    memmove(c + i * after, c + i * before, kept * sizeof *c);
    memset(c + i * after + kept, 0, (after - kept) * sizeof *c);
  }
  c[n * after] = w;
  return RIC_OK;
}

/* First from the best solution so far; if that fails, from a fit with the best of several frequencies. */
static ric_status solve_rung(ladder *l, size_t functions, ric_error *error) {
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

static ric_status check_convergence(const ladder *l, double tolerance, ric_error *error) {
  if (l->functions == 0)
    return ric_fail(error, RIC_ENUMERIC, "Ritz's method converges with no number of functions up to %zu", l->r->most);
  if (tolerance == 0 || l->error_q <= tolerance)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "the error of Ritz's method is %.3g with %zu functions, expected at most %.3g",
                  l->error_q, l->functions, tolerance);
}

static ric_status solve_rungs(ladder *l, double tolerance, double *c, ric_error *error) {
  for (size_t k = 1; k <= l->r->most && !(l->functions > 0 && l->error_q <= tolerance); k = next_rung(k, l->r->most))
    RIC_TRY(solve_rung(l, k, error));
  RIC_TRY(ric_ritz_use(l->r, l->functions > 0 ? l->functions : l->r->most, NULL, error));
  if (l->functions > 0)
    memcpy(c, l->best, ric_ritz_unknowns(l->r) * sizeof *c);
  return check_convergence(l, tolerance, error);
}

ric_status ric_ritz_refine(ric_ritz *r, ric_shooting *shooting, const double *z, double period, double tolerance,
                           double *c, double *error_q, ric_error *error) {
  REQUIRE(error, {"ritz", r}, {"shooting", shooting}, {"z", z}, {"c", c});
  size_t unknowns = r->coordinates * r->stride + 1;
  ladder l = {.r = r, .shooting = shooting, .z = z, .period = period, .error_q = INFINITY};
  if (!(tolerance >= 0))
    return ric_fail(error, RIC_EINVAL, "tolerance = %g, expected >= 0", tolerance);
  l.best = calloc(2 * unknowns, sizeof *l.best);
  if (!l.best)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu coefficients", unknowns);
  l.tried = l.best + unknowns;
  ric_status status = solve_rungs(&l, tolerance, c, error);
  free(l.best);
  if (error_q)
    *error_q = l.error_q;
  return status;
}

/* Numbers of points for which GSL has Gauss's rule to all digits; others it computes to 1e-10. */
static const size_t rules[] = {32, 64, 96, 100, 128, 256, 512, 1024};

enum { RULES = sizeof rules / sizeof *rules };

ric_ritz_options ric_ritz_options_default(void) {
  return (ric_ritz_options){.functions = 16, .constants = true};
}

/* --- checks ------------------------------------------------------------------------------------------------------- */

static ric_status check_options(const ric_ritz_options *o, ric_error *error) {
  if (!(o->functions >= 1 && o->functions <= RIC_RITZ_MOST))
    return ric_fail(error, RIC_EINVAL, "functions = %zu, expected 1 to %d", o->functions, RIC_RITZ_MOST);
  if (o->points != 0 && !(o->points >= 2 * o->functions && o->points <= rules[RULES - 1]))
    return ric_fail(error, RIC_EINVAL, "points = %zu, expected 0 or %zu to %zu", o->points, 2 * o->functions,
                    rules[RULES - 1]);
  return RIC_OK;
}

/* Properties of the system that a change of its numbers does not change. */
static ric_status check_obstacle(const ric_system *s, size_t obstacle, ric_error *error) {
  if (s->taylor != SYSTEM_LATTICE)
    return ric_fail(error, RIC_EINVAL, "Ritz's method needs a lattice");
  if (!(obstacle < s->obstacle_count))
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected one of %zu", obstacle, s->obstacle_count);
  for (size_t j = 0; j < s->obstacle_count; j++)
    if (system_complies(s, j))
      return ric_fail(error, RIC_EINVAL, "obstacle %zu is compliant (stiffness %g), expected rigid ones", j,
                      s->obstacles[j].stiffness);
  return RIC_OK;
}

/* --- life cycle --------------------------------------------------------------------------------------------------- */

/* F and J have phases of at most i w T / 2 with i = 4 N (three functions of a cubic force, one to project on), below
 * 4 pi N over half a period, cos(k x) with k = 2 pi N on [-1, 1]. A rule of P points leaves Bessel functions J_2P(k),
 * below 1e-16 from 2 P = k + 12 k^(1/3) on. */
static size_t rule_for(size_t functions) {
  double most = 2 * pi * (double)functions;
  return (size_t)ceil(most / 2 + 6 * ric_cbrt(most));
}

static size_t choose_points(const ric_ritz_options *o) {
  size_t wanted = o->points ? o->points : rule_for(o->functions), k = 0;
  while (k + 1 < RULES && rules[k] < wanted)
    k++;
  return rules[k];
}

static void lay_out_ritz(ric_ritz *r, size_t *used) {
  size_t n = r->coordinates, row = r->stride;
  *used = 0;
  r->tau = number_block_take(r->block, used, r->points);
  r->weight = number_block_take(r->block, used, r->points);
  r->psi = number_block_take(r->block, used, r->points * row);
  r->cosine = number_block_take(r->block, used, row);
  r->sine = number_block_take(r->block, used, row);
  r->q = number_block_take(r->block, used, n);
  r->v = number_block_take(r->block, used, n);
  r->bend = number_block_take(r->block, used, n);
  r->rate = number_block_take(r->block, used, n);
  r->stiffness = number_block_take(r->block, used, n * n);
  r->unit = number_block_take(r->block, used, n * n);
  r->nothing = number_block_take(r->block, used, n * n);
  r->spare = number_block_take(r->block, used, n * row + 1);
}

static ric_status allocate_ritz(ric_ritz *r, ric_error *error) {
  size_t used;
  lay_out_ritz(r, &used);
  if (r->coordinates < SIZE_MAX / 64 / r->coordinates)
    r->block = calloc(used, sizeof *r->block);
  if (!r->block)
    return ric_fail(error, RIC_ENOMEM, "no memory for Ritz's method with %zu coordinates", r->coordinates);
  lay_out_ritz(r, &used);
  for (size_t i = 0; i < r->coordinates; i++)
    r->unit[i * r->coordinates + i] = 1;
  return RIC_OK;
}

static ric_status tabulate(ric_ritz *r, ric_error *error) {
  keep_gsl_quiet();
  gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(r->points);
  if (!table)
    return ric_fail(error, RIC_ENOMEM, "no memory for a rule of %zu points", r->points);
  for (size_t p = 0; p < r->points; p++) {
    gsl_integration_glfixed_point(0, 0.5, p, &r->tau[p], &r->weight[p], table);
    r->weight[p] *= 2;
    for (size_t m = 0; m < r->stride; m++)
      r->psi[p * r->stride + m] = ric_cos(2 * pi * ritz_number(r, m) * r->tau[p]);
  }
  gsl_integration_glfixed_table_free(table);
  return RIC_OK;
}

static ric_status build_ritz(ric_ritz *r, ric_error *error) {
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(allocate_ritz(r, error));
  return tabulate(r, error);
}

void ric_ritz_destroy(ric_ritz **ritz) {
  if (!ritz || !*ritz)
    return;
  free((*ritz)->block);
  free(*ritz);
  *ritz = NULL;
}

ric_status ric_ritz_create(const ric_system *system, size_t obstacle, const ric_ritz_options *options, ric_ritz **ritz,
                           ric_error *error) {
  REQUIRE(error, {"system", system}, {"ritz", ritz});
  ric_ritz_options o = options ? *options : ric_ritz_options_default();
  *ritz = NULL;
  RIC_TRY(check_options(&o, error));
  RIC_TRY(check_obstacle(system, obstacle, error));
  ric_ritz *r = calloc(1, sizeof *r);
  if (!r)
    return ric_fail(error, RIC_ENOMEM, "no memory for Ritz's method");
  *r = (ric_ritz){.system = system,
                  .revision = system->revision - 1, /* not yet checked */
                  .obstacle = obstacle,
                  .hit = system->obstacles[obstacle].coordinate,
                  .coordinates = system->coordinates,
                  .first = o.constants ? 0 : 1,
                  .most = o.functions,
                  .functions = o.functions,
                  .stride = o.constants ? o.functions + 1 : o.functions,
                  .points = choose_points(&o)};
  ric_status status = build_ritz(r, error);
  if (status == RIC_OK)
    *ritz = r;
  else
    ric_ritz_destroy(&r);
  return status;
}

/* --- numbers of functions ----------------------------------------------------------------------------------------- */

size_t ric_ritz_functions(const ric_ritz *ritz) {
  return ritz->functions;
}

size_t ric_ritz_points(const ric_ritz *ritz) {
  return ritz->points;
}

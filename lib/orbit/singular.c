/* Parameters at which the contact matrix of a pattern is singular. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include "solver.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

enum { MOST_RESONANCES = 100000 };

/* The contact matrix of the unit cell as a function of the parameter. */
typedef struct family {
  ric_orbit_solver *solver; /* its cell is set up */
  ric_along along;
  double period;
  size_t index;        /* of the eigenvalue whose zero is searched */
  double *eigenvalues; /* [impacts of the cell] */
  ric_status status;
  ric_error *error;
} family;

/* List of results: counts all, stores as many as fit. */
typedef struct collection {
  double *points, unit; /* results are divided by `unit` */
  size_t capacity, count;
} collection;

static ric_status evaluate_eigenvalues(family *f, double parameter) {
  unit_cell *cell = &f->solver->cell;
  if (f->along == RIC_ALONG_GAMMA)
    cell->chain.gamma = parameter;
  return impulse_eigenvalues(&f->solver->impulse, cell, f->along == RIC_ALONG_GAMMA ? f->period : parameter,
                             f->eigenvalues, f->solver->options.poll, f->error);
}

static double eigenvalue_at(double parameter, void *user) {
  family *f = user;
  if (f->status == RIC_OK)
    f->status = evaluate_eigenvalues(f, parameter);
  return f->status == RIC_OK ? f->eigenvalues[f->index] : NAN;
}

static ric_status count_negative(family *f, double parameter, size_t *negative) {
  RIC_TRY(evaluate_eigenvalues(f, parameter));
  *negative = 0;
  while (*negative < f->solver->cell.impacts && f->eigenvalues[*negative] < 0)
    (*negative)++;
  return RIC_OK;
}

/* The zero of eigenvalue f->index, which falls from + to - in [low, high]. */
static ric_status find_zero(family *f, gsl_root_fsolver *brent, double low, double high, double *zero) {
  gsl_function g = {.function = eigenvalue_at, .params = f};
  int code = gsl_root_fsolver_set(brent, &g, low, high);
  for (int i = 0; i < 200 && !code && f->status == RIC_OK; i++) {
    code = gsl_root_fsolver_iterate(brent);
    double a = gsl_root_fsolver_x_lower(brent), b = gsl_root_fsolver_x_upper(brent);
    if (b - a <= 2 * DBL_EPSILON * fabs(b))
      break;
  }
  *zero = gsl_root_fsolver_root(brent);
  RIC_TRY(f->status);
  return code ? ric_fail(f->error, gsl_status(code), "zero of the contact determinant in [%.17g, %.17g]: %s", low, high,
                         gsl_text(code))
              : RIC_OK;
}

/* All zeros between two neighbouring resonances: eigenvalues decrease there, so each one that is positive on the left
 * and negative on the right has one. */
static ric_status search_interval(family *f, gsl_root_fsolver *brent, double low, double high, collection *c) {
  size_t before, after;
  if (!(low < high))
    return RIC_OK;
  RIC_TRY(count_negative(f, low, &before));
  RIC_TRY(count_negative(f, high, &after));
  for (size_t k = after; k-- > before;) { /* the lowest eigenvalues cross first */
    f->index = before + (after - 1 - k);
    double zero;
    RIC_TRY(find_zero(f, brent, low, high, &zero));
    if (c->count < c->capacity)
      c->points[c->count] = zero / c->unit;
    c->count++;
  }
  return RIC_OK;
}

static ric_status search(family *f, const ric_resonance *poles, size_t pole_count, double low, double high,
                         collection *c) {
  gsl_root_fsolver *brent = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!brent)
    return ric_fail(f->error, RIC_ENOMEM, "no memory for a root finder");
  double margin = 1e-12 * (high - low), left = low > 0 || f->along == RIC_ALONG_GAMMA ? low : margin;
  ric_status status = RIC_OK;
  for (size_t i = 0; i <= pole_count && status == RIC_OK; i++) {
    double right = i < pole_count ? poles[i].parameter - margin : high;
    status = search_interval(f, brent, left, right, c);
    if (i < pole_count)
      left = fmax(left, poles[i].parameter + margin);
    if (ric_poll_stops(f->solver->options.poll))
      status = ric_fail(f->error, RIC_ESTOPPED, "stopped at parameter %g", left);
  }
  gsl_root_fsolver_free(brent);
  return status;
}

/* Resonances of the unit cell: the poles of its contact matrix. */
static ric_status find_poles(const family *f, double low, double high, ric_resonance **poles, size_t *count) {
  const ric_chain *cell = &f->solver->cell.chain;
  RIC_TRY(ric_chain_resonances(cell, f->along, f->period, low, high, NULL, 0, count, f->error));
  if (*count > MOST_RESONANCES)
    return ric_fail(f->error, RIC_ELIMIT, "%zu resonances in [%g, %g], expected at most %d", *count, low, high,
                    MOST_RESONANCES);
  *poles = malloc((*count + 1) * sizeof **poles);
  if (!*poles)
    return ric_fail(f->error, RIC_ENOMEM, "no memory for %zu resonances", *count);
  return ric_chain_resonances(cell, f->along, f->period, low, high, *poles, *count, count, f->error);
}

static ric_status search_range(family *f, double low, double high, collection *c) {
  ric_resonance *poles = NULL;
  size_t pole_count = 0, m = f->solver->cell.impacts;
  ric_status status = find_poles(f, low, high, &poles, &pole_count);
  if (status == RIC_OK) {
    f->eigenvalues = malloc(m * sizeof *f->eigenvalues);
    status = f->eigenvalues ? search(f, poles, pole_count, low, high, c)
                            : ric_fail(f->error, RIC_ENOMEM, "no memory for %zu eigenvalues", m);
  }
  free(poles);
  free(f->eigenvalues);
  return status;
}

ric_status ric_orbit_singular_points(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                                     ric_along along, double period, double low, double high, double *points,
                                     size_t capacity, size_t *count, ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"chain", chain}, {"pattern", pattern}, {"points", unless_empty(capacity, points)},
          {"count", count});
  RIC_TRY(ric_chain_check(chain, error));
  if (ric_pattern_particles(pattern) != chain->particles)
    return ric_fail(error, RIC_EINVAL, "pattern of %zu particles, expected %zu", ric_pattern_particles(pattern),
                    chain->particles);
  ric_chain coupled = *chain;
  if (along == RIC_ALONG_GAMMA)
    coupled.gamma = 1; /* one cell for the whole range; its coupling may be a multiple of the chain's */
  RIC_TRY(unit_cell_find(&solver->cell, &coupled, pattern, error));
  collection c = {.points = points, .capacity = capacity, .unit = 1};
  if (along == RIC_ALONG_GAMMA)
    c.unit = solver->cell.chain.gamma;
  family f = {.solver = solver, .along = along, .period = period, .error = error};
  keep_gsl_quiet();
  ric_status status = search_range(&f, low * c.unit, high * c.unit, &c);
  *count = c.count;
  return status;
}

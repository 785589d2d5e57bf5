#include "ricochet/orbit_multipliers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "determinant.h"
#include "multipliers.h"
#include "orbit_multipliers.h"
#include "ricochet/monodromy.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

ric_orbit_multiplier_options ric_orbit_multiplier_options_default(void) {
  return (ric_orbit_multiplier_options){.method = RIC_MULTIPLIERS_AUTO, .judge = ric_multiplier_options_default()};
}

/* With a larger closure error the state is not on an orbit; errors of strongly unstable orbits grow by the largest
 * multiplier. */
static const double closure_tol = 1e-6;
/* Relative to an entry of M: a thousand times its rounding. */
static const double determinant_tol = 1e-12;

static ric_multiplier_method method_for(const ric_orbit_multiplier_options *o, size_t n) {
  if (o->method != RIC_MULTIPLIERS_AUTO)
    return o->method;
  return n <= RIC_REDUCED_PARTICLES ? RIC_MULTIPLIERS_REDUCED : RIC_MULTIPLIERS_DETERMINANT;
}

static ric_status check_orbit(const ric_chain *chain, const ric_pattern *pattern, const ric_orbit *orbit,
                              const ric_orbit_multiplier_options *o, const ric_multipliers *m, ric_error *error) {
  size_t n = chain->particles;
  RIC_TRY(ric_chain_check(chain, error));
  RIC_TRY(multiplier_options_check(&o->judge, error));
  if (ric_pattern_particles(pattern) != n || orbit->particles != n)
    return ric_fail(error, RIC_EINVAL, "pattern of %zu and orbit of %zu particles, expected %zu",
                    ric_pattern_particles(pattern), orbit->particles, n);
  if (orbit->impacts != ric_pattern_impacts(pattern))
    return ric_fail(error, RIC_EINVAL, "orbit of %zu impacts, expected %zu", orbit->impacts,
                    ric_pattern_impacts(pattern));
  if (m->dimension != 2 * n)
    return ric_fail(error, RIC_EINVAL, "room for %zu multipliers, expected %zu", m->dimension, 2 * n);
  if ((int)o->method < RIC_MULTIPLIERS_AUTO || o->method > RIC_MULTIPLIERS_DETERMINANT)
    return ric_fail(error, RIC_EINVAL, "method = %d, expected auto, reduced, monodromy or determinant", (int)o->method);
  if (method_for(o, n) != RIC_MULTIPLIERS_DETERMINANT && n > RIC_REDUCED_PARTICLES)
    return ric_fail(error, RIC_ELIMIT, "matrix of %zu particles, expected at most %d", n, RIC_REDUCED_PARTICLES);
  return RIC_OK;
}

static void fail_outcome(const ric_orbit *orbit, ric_multipliers *m) {
  char reason[sizeof m->reason];
  snprintf(reason, sizeof reason, "%s orbit: %.*s", ric_outcome_name(orbit->outcome), (int)sizeof reason - 32,
           orbit->reason);
  ric_multipliers_fail(m, reason);
}

/* Without a state, or with a contact of gap rate 0, there is no derivative. */
static bool has_derivative(const ric_orbit *orbit) {
  return orbit->outcome == RIC_ADMISSIBLE || orbit->outcome == RIC_INADMISSIBLE || orbit->outcome == RIC_RESONANT;
}

static void destroy_spectrum(void *workspace) {
  orbit_spectrum *s = workspace;
  orbit_impacts_clear(&s->impacts);
  reduced_clear(&s->reduced);
  secular_clear(&s->secular);
  free(s);
}

ric_status orbit_spectrum_of(ric_orbit_solver *solver, orbit_spectrum **spectrum, ric_error *error) {
  if (!solver->multipliers) {
    solver->multipliers = calloc(1, sizeof **spectrum);
    if (!solver->multipliers)
      return ric_fail(error, RIC_ENOMEM, "no memory for the multipliers' workspace");
    solver->destroy_multipliers = destroy_spectrum;
  }
  *spectrum = solver->multipliers;
  return RIC_OK;
}

static ric_status by_reduced(orbit_spectrum *s, const ric_chain *chain, const ric_orbit *orbit,
                             const ric_multiplier_options *o, ric_multipliers *m, ric_error *error) {
  RIC_TRY(reduced_compute(&s->reduced, chain, &s->impacts, orbit, error));
  even_spectrum_multipliers(&s->reduced.spectrum, o, m);
  return RIC_OK;
}

/* The orbit is conservative: the determinant is 1, up to the rounding of the smallest multiplier. */
static void check_determinant(ric_multipliers *m) {
  char reason[sizeof m->reason];
  double error = fabs(m->log_determinant), allowed = determinant_tol * (double)m->dimension * m->largest * m->largest;
  if (error <= allowed)
    return;
  snprintf(reason, sizeof reason, "the logarithm of the determinant is %.3g, expected 0 within %.3g", error, allowed);
  ric_multipliers_fail(m, reason);
}

/* Whether the run stayed on the orbit. */
static bool follows(const ric_monodromy *run, const ric_orbit *orbit, ric_multipliers *m) {
  char reason[sizeof m->reason];
  if (run->outcome != RIC_RUN_COMPLETED)
    snprintf(reason, sizeof reason, "%s: %.*s", ric_run_outcome_name(run->outcome), (int)sizeof reason - 32,
             run->reason);
  else if (run->impacts != orbit->impacts || !(run->closure_error <= closure_tol))
    snprintf(reason, sizeof reason, "an event-driven run has %zu impacts, expected %zu, and closes within %.3g",
             run->impacts, orbit->impacts, run->closure_error);
  else
    return true;
  ric_multipliers_fail(m, reason);
  return false;
}

static ric_status by_monodromy(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                               const ric_orbit_multiplier_options *o, ric_multipliers *m, ric_error *error) {
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_monodromy run;
  if (orbit->outcome == RIC_INADMISSIBLE) {
    ric_multipliers_fail(m, "inadmissible: an event-driven run cannot follow the orbit");
    return RIC_OK;
  }
  double *M = malloc(m->dimension * m->dimension * sizeof *M);
  options.poll = o->poll;
  if (!M)
    return ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", m->dimension);
  ric_status status = ric_orbit_monodromy(solver, chain, orbit, &options, M, &run, error);
  if (status == RIC_OK && follows(&run, orbit, m))
    status = ric_multipliers_of_matrix(M, m->dimension, 2, &o->judge, m, error);
  if (status == RIC_OK && m->stable != RIC_STABILITY_UNKNOWN)
    check_determinant(m);
  free(M);
  return status;
}

static ric_status compute(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                          const ric_orbit *orbit, const ric_orbit_multiplier_options *o, ric_multipliers *m,
                          ric_error *error) {
  size_t grazing;
  orbit_spectrum *s = NULL;
  RIC_TRY(orbit_spectrum_of(solver, &s, error));
  RIC_TRY(orbit_impacts_find(&s->impacts, chain, pattern, orbit, solver->options.grazing_tol, &grazing, error));
  if (grazing < orbit->impacts) {
    char reason[sizeof m->reason];
    snprintf(reason, sizeof reason, "grazing: impulse %.3g of particle %zu", orbit->impulse[grazing],
             ric_pattern_impact(pattern, grazing));
    ric_multipliers_fail(m, reason);
    return RIC_OK;
  }
  switch (method_for(o, chain->particles)) {
  case RIC_MULTIPLIERS_MONODROMY:
    return by_monodromy(solver, chain, orbit, o, m, error);
  case RIC_MULTIPLIERS_DETERMINANT:
    RIC_TRY(secular_prepare(&s->secular, chain, &s->impacts, orbit->period, error));
    return determinant_multipliers(&s->secular, o, m, error);
  case RIC_MULTIPLIERS_AUTO:
  case RIC_MULTIPLIERS_REDUCED:
    break;
  }
  return by_reduced(s, chain, orbit, &o->judge, m, error);
}

ric_status ric_orbit_multipliers(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                                 const ric_orbit *orbit, const ric_orbit_multiplier_options *options,
                                 ric_multipliers *m, ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"chain", chain}, {"pattern", pattern}, {"orbit", orbit}, {"multipliers", m});
  ric_error own, *e = error ? error : &own;
  ric_orbit_multiplier_options o = options ? *options : ric_orbit_multiplier_options_default();
  RIC_TRY(check_orbit(chain, pattern, orbit, &o, m, e));
  ric_multipliers_fail(m, "not computed");
  if (!has_derivative(orbit)) {
    fail_outcome(orbit, m);
    return RIC_OK;
  }
  if (ric_poll_stops(o.poll))
    return ric_fail(e, RIC_ESTOPPED, "stopped before the multipliers");
  keep_gsl_quiet();
  ric_status status = compute(solver, chain, pattern, orbit, &o, m, e);
  if (status != RIC_OK)
    ric_multipliers_fail(m, e->message);
  return status;
}

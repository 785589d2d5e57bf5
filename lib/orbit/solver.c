#include "solver.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>

#include "dense.h"
#include "verdict.h"
#include "numeric/constants.h"

static ric_status check_options(const ric_orbit_options *o, ric_error *error) {
  const struct {
    const char *name;
    double value;
  } tolerances[] = {{"clearance_tol", o->clearance_tol},
                    {"grazing_tol", o->grazing_tol},
                    {"residual_tol", o->residual_tol},
                    {"resonance_tol", o->resonance_tol}};
  for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++)
    if (!(tolerances[i].value > 0 && tolerances[i].value < 1))
      return ric_fail(error, RIC_EINVAL, "%s = %g, expected 0 < %s < 1", tolerances[i].name, tolerances[i].value,
                      tolerances[i].name);
  if (!(o->singular_condition > 1))
    return ric_fail(error, RIC_EINVAL, "singular_condition = %g, expected a number above 1", o->singular_condition);
  if (o->method != RIC_METHOD_IMPULSE && o->method != RIC_METHOD_DENSE)
    return ric_fail(error, RIC_EINVAL, "method = %d, expected impulse or dense", (int)o->method);
  return RIC_OK;
}

ric_status ric_orbit_solver_create(const ric_orbit_options *options, ric_orbit_solver **solver, ric_error *error) {
  ric_orbit_options o = options ? *options : ric_orbit_options_default();
  *solver = NULL;
  RIC_TRY(check_options(&o, error));
  *solver = calloc(1, sizeof **solver);
  if (!*solver)
    return ric_fail(error, RIC_ENOMEM, "no memory for the solver");
  (*solver)->options = o;
  return RIC_OK;
}

void ric_orbit_solver_destroy(ric_orbit_solver **solver) {
  if (!solver || !*solver)
    return;
  unit_cell_clear(&(*solver)->cell);
  impulse_clear(&(*solver)->impulse);
  motion_clear(&(*solver)->motion);
  if ((*solver)->multipliers)
    (*solver)->destroy_multipliers((*solver)->multipliers);
  free((*solver)->store);
  free(*solver);
  *solver = NULL;
}

double ric_orbit_bytes(const ric_chain *chain, const ric_pattern *pattern, ric_orbit_method method) {
  double n = (double)chain->particles, m = (double)ric_pattern_impacts(pattern), word = sizeof(double);
  if (method == RIC_METHOD_DENSE) /* two matrices of size 2n, two of size n */
    return word * (10 * n * n + 40 * n + m);
  double c = (double)unit_cell_sites(chain, pattern), contacts = fmax(1, m * c / n) + BORDER_MODES;
  return word * (17 * c + 4 * n + m + contacts * (contacts + 9)) + n;
}

static ric_status check_problem(const ric_orbit_solver *s, const ric_chain *chain, const ric_pattern *pattern,
                                double period, const ric_orbit *orbit, ric_error *error) {
  size_t n = chain->particles, m = ric_pattern_impacts(pattern);
  RIC_TRY(ric_chain_check(chain, error));
  if (!(period > 0 && period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected 0 < period < infinity", period);
  double turns = ric_chain_frequency_max(chain) * period / two_pi;
  if (!(turns <= RIC_MOST_HARMONICS))
    return ric_fail(error, RIC_ELIMIT, "fastest mode with %.3g oscillations per period, expected at most %d", turns,
                    RIC_MOST_HARMONICS);
  if (ric_pattern_particles(pattern) != n)
    return ric_fail(error, RIC_EINVAL, "pattern of %zu particles, expected %zu", ric_pattern_particles(pattern), n);
  if (orbit->particles != n || orbit->impacts != m)
    return ric_fail(error, RIC_EINVAL, "orbit with room for %zu particles and %zu impacts, expected %zu and %zu",
                    orbit->particles, orbit->impacts, n, m);
  for (size_t r = 0; r < m; r++)
    if (!(ric_chain_floor(chain, ric_pattern_impact(pattern, r)) > -INFINITY))
      return ric_fail(error, RIC_EINVAL, "impacting particle %zu has no floor", ric_pattern_impact(pattern, r));
  if (s->options.method == RIC_METHOD_DENSE && n > RIC_DENSE_PARTICLES)
    return ric_fail(error, RIC_ELIMIT, "dense method with %zu particles, expected at most %d", n, RIC_DENSE_PARTICLES);
  return RIC_OK;
}

/* The state arrays: those of the orbit when the cell is the chain, otherwise arrays of the cell. */
static ric_status place_state(ric_orbit_solver *s, ric_orbit *orbit, boundary_state *state, ric_error *error) {
  size_t sites = s->cell.chain.particles;
  if (sites == orbit->particles) {
    *state = (boundary_state){.q = orbit->q, .v = orbit->v, .q_half = orbit->q_half, .v_half = orbit->v_half};
    return RIC_OK;
  }
  if (sites > s->capacity) {
    free(s->store);
    s->capacity = 0;
    s->store = malloc(4 * sites * sizeof *s->store);
    if (!s->store)
      return ric_fail(error, RIC_ENOMEM, "no memory for a cell of %zu particles", sites);
    s->capacity = sites;
  }
  *state = (boundary_state){
      .q = s->store, .v = s->store + sites, .q_half = s->store + 2 * sites, .v_half = s->store + 3 * sites};
  return RIC_OK;
}

/* Cell -> chain, and the impulses from the velocities: they jump from -p/2 to p/2. */
static void unfold(const unit_cell *cell, const ric_pattern *pattern, const boundary_state *state, ric_orbit *orbit) {
  for (size_t i = 0; i < orbit->particles && state->q != orbit->q; i++) {
    size_t site = unit_cell_site(cell, i);
    orbit->q[i] = state->q[site];
    orbit->v[i] = state->v[site];
    orbit->q_half[i] = state->q_half[site];
    orbit->v_half[i] = state->v_half[site];
  }
  for (size_t r = 0; r < orbit->impacts; r++) {
    size_t k = ric_pattern_impact(pattern, r);
    bool at_start = ric_pattern_role(pattern, k) == RIC_ROLE_START;
    orbit->impulse[r] = at_start ? 2 * orbit->v[k] : -2 * orbit->v_half[k];
    orbit->gap_rate[r] = -orbit->impulse[r] / 2;
    orbit->impact_time[r] = at_start ? 0 : orbit->period / 2;
    orbit->impact_obstacle[r] = k;
  }
}

static ric_status solve(ric_orbit_solver *s, const ric_chain *chain, const ric_pattern *pattern, double period,
                        ric_orbit *orbit, ric_error *error) {
  const ric_orbit_options *o = &s->options;
  boundary_state state;
  linear_outcome solution;
  bool dense = o->method == RIC_METHOD_DENSE;
  RIC_TRY(dense ? unit_cell_whole(&s->cell, chain, pattern, error) : unit_cell_find(&s->cell, chain, pattern, error));
  RIC_TRY(place_state(s, orbit, &state, error));
  RIC_TRY(motion_prepare(&s->motion, s->cell.chain.particles, error));
  if (ric_poll_stops(o->poll))
    return ric_fail(error, RIC_ESTOPPED, "stopped before the contact equations");
  RIC_TRY(dense ? dense_solve(chain, pattern, period, o, &state, &solution, error)
                : impulse_solve(&s->impulse, &s->cell, period, o, &state, &solution, error));
  orbit->condition = solution.condition;
  if (solution.singular && !solution.solvable) {
    verdict_without_state(orbit, RIC_SINGULAR);
    snprintf(orbit->reason, sizeof orbit->reason,
             "equations are singular and have no solution: condition %.3g, limit %.3g", orbit->condition,
             o->singular_condition);
    return RIC_OK;
  }
  if (!dense && s->impulse.response.near_dropped > 0 && solution.singular)
    return ric_fail(error, RIC_ENUMERIC, "more than %d wave numbers at resonance: condition %.3g", RESPONSE_NEAR,
                    solution.condition);
  unfold(&s->cell, pattern, &state, orbit);
  orbit->energy = ric_chain_energy(chain, orbit->q, orbit->v);
  if (!isfinite(orbit->energy))
    return ric_fail(error, RIC_ENUMERIC, "energy is not finite: the displacements overflow");
  return verdict_find(&s->motion, &s->cell, chain, pattern, &state, solution.singular, o, orbit, error);
}

ric_status ric_orbit_solve(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern, double period,
                           ric_orbit *orbit, ric_error *error) {
  ric_error own, *e = error ? error : &own;
  orbit->period = period;
  orbit->mode = -1;
  orbit->harmonic = 0;
  orbit->reason[0] = '\0';
  orbit->condition = NAN;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  ric_status status = check_problem(solver, chain, pattern, period, orbit, e);
  if (status == RIC_OK)
    status = solve(solver, chain, pattern, period, orbit, e);
  gsl_set_error_handler(handler);
  if (status != RIC_OK)
    ric_orbit_fail(orbit, e->message);
  return status;
}

/* Orbits of chains: their arrays, the dense reference, and the solver with both methods. */
#include "solver.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_permutation.h>

#include "motion.h"
#include "numeric/constants.h"
#include "numeric/linear.h"
#include "ricochet/elementary.h"
#include "ricochet/orbit.h"
#include "unit_cell.h"
#include "admissibility.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

ric_orbit_options ric_orbit_options_default(void) {
  return (ric_orbit_options){.method = RIC_METHOD_IMPULSE,
                             .clearance_tol = 1e-12,
                             .grazing_tol = 1e-10,
                             .residual_tol = 1e-9,
                             .resonance_tol = 1e-10,
                             .singular_condition = 1e9};
}

static ric_status allocate_orbit(ric_orbit *orbit, size_t coordinates, size_t speeds, size_t impacts,
                                 ric_error *error) {
  size_t numbers = 2 * (coordinates + speeds) + 3 * impacts;
  *orbit = (ric_orbit){.particles = coordinates, .speeds = speeds, .impacts = impacts};
  bool fits = coordinates < SIZE_MAX / 128 && speeds < SIZE_MAX / 128 && impacts < SIZE_MAX / 128;
  double *store = fits ? calloc(numbers, sizeof *store) : NULL;
  orbit->impact_obstacle = store ? calloc(impacts + 1, sizeof *orbit->impact_obstacle) : NULL;
  if (!orbit->impact_obstacle) {
    free(store);
    return ric_fail(error, RIC_ENOMEM, "no memory for an orbit of %zu particles", coordinates);
  }
  orbit->q = store;
  orbit->v = orbit->q + coordinates;
  orbit->q_half = orbit->v + speeds;
  orbit->v_half = orbit->q_half + coordinates;
  orbit->impulse = orbit->v_half + speeds;
  orbit->impact_time = orbit->impulse + impacts;
  orbit->gap_rate = orbit->impact_time + impacts;
  return RIC_OK;
}

ric_status ric_orbit_init(ric_orbit *orbit, size_t particles, size_t impacts, ric_error *error) {
  REQUIRE(error, {"orbit", orbit});
  *orbit = (ric_orbit){.particles = particles, .impacts = impacts};
  if (particles < 1 || impacts < 1 || impacts > particles)
    return ric_fail(error, RIC_EINVAL, "orbit of %zu particles and %zu impacts, expected 1 <= impacts <= particles",
                    particles, impacts);
  return allocate_orbit(orbit, particles, particles, impacts, error);
}

ric_status ric_orbit_init_for(ric_orbit *orbit, const ric_system *system, size_t impacts, ric_error *error) {
  REQUIRE(error, {"orbit", orbit}, {"system", system});
  return allocate_orbit(orbit, ric_system_coordinates(system), ric_system_speeds(system), impacts, error);
}

void ric_orbit_clear(ric_orbit *orbit) {
  if (!orbit)
    return;
  free(orbit->q); /* the one block behind all arrays of numbers */
  free(orbit->impact_obstacle);
  *orbit = (ric_orbit){0};
}

/* The boundary-value problem (10)-(11) of [JAP], solved with a matrix exponential: the reference. */

/* Matrices and vectors, in one allocation each. */
typedef struct dense_equations {
  size_t n;
  gsl_matrix *a, *modes;     /* [n][n]: K, work; eigenvectors of K */
  gsl_matrix *flow, *system; /* [2n][2n]: exp(A T/2), M + N exp(A T/2) */
  gsl_vector *rhs, *x, *x_half, *tau, *norm, *work;
  gsl_permutation *permutation;
} dense_equations;

static void dense_free(dense_equations *d) {
  gsl_matrix *matrices[] = {d->a, d->modes, d->flow, d->system};
  gsl_vector *vectors[] = {d->rhs, d->x, d->x_half, d->tau, d->norm, d->work};
  for (size_t i = 0; i < sizeof matrices / sizeof *matrices; i++)
    if (matrices[i])
      gsl_matrix_free(matrices[i]);
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    if (vectors[i])
      gsl_vector_free(vectors[i]);
  if (d->permutation)
    gsl_permutation_free(d->permutation);
}

static ric_status dense_alloc(dense_equations *d, size_t n, ric_error *error) {
  size_t size = 2 * n;
  *d = (dense_equations){.n = n};
  d->a = gsl_matrix_calloc(n, n);
  d->modes = gsl_matrix_calloc(n, n);
  d->flow = gsl_matrix_calloc(size, size);
  d->system = gsl_matrix_calloc(size, size);
  d->rhs = gsl_vector_calloc(size);
  d->x = gsl_vector_calloc(size);
  d->x_half = gsl_vector_calloc(size);
  d->tau = gsl_vector_calloc(size);
  d->norm = gsl_vector_calloc(size);
  d->work = gsl_vector_calloc(3 * size);
  d->permutation = gsl_permutation_calloc(size);
  if (d->a && d->modes && d->flow && d->system && d->rhs && d->x && d->x_half && d->tau && d->norm && d->work &&
      d->permutation)
    return RIC_OK;
  dense_free(d);
  return ric_fail(error, RIC_ENOMEM, "no memory for matrices of size %zu", size);
}

/* -K from accelerations at unit displacements, symmetric. */
static void stiffness(dense_equations *d, const ric_chain *chain) {
  size_t n = d->n;
  double *unit = d->x->data, *acceleration = d->x_half->data;
  for (size_t j = 0; j < n; j++) {
    for (size_t i = 0; i < n; i++)
      unit[i] = i == j;
    ric_chain_acceleration(chain, unit, acceleration);
    for (size_t i = 0; i < n; i++)
      gsl_matrix_set(d->a, i, j, -acceleration[i]);
  }
}

/* exp(A t) with A = (0, I; -K, 0), block by block from the numerical eigenvectors of K: cos(wt), sin(wt)/w, -w sin(wt).
 * A Taylor series with squaring loses a digit for every doubling of the time. */
static int exponentiate(dense_equations *d, const ric_chain *chain, double t) {
  size_t n = d->n;
  stiffness(d, chain);
  gsl_eigen_symmv_workspace *w = gsl_eigen_symmv_alloc(n);
  gsl_vector_view values = gsl_vector_subvector(d->rhs, 0, n);
  int code = w ? gsl_eigen_symmv(d->a, &values.vector, d->modes, w) : GSL_ENOMEM;
  gsl_eigen_symmv_free(w);
  for (int block = 0; block < 3 && !code; block++) {
    for (size_t j = 0; j < n; j++) { /* a := modes times the function of the frequencies */
      double omega = sqrt(gsl_vector_get(&values.vector, j));
      double sine, cosine;
      ric_sincos(omega * t, &sine, &cosine);
      double f = block == 0 ? cosine : block == 1 ? sine / omega : -omega * sine;
      for (size_t i = 0; i < n; i++)
        gsl_matrix_set(d->a, i, j, f * gsl_matrix_get(d->modes, i, j));
    }
    gsl_matrix_view to = gsl_matrix_submatrix(d->flow, block == 2 ? n : 0, block == 1 ? n : 0, n, n);
    code = gsl_blas_dgemm(CblasNoTrans, CblasTrans, 1, d->a, d->modes, 0, &to.matrix);
  }
  gsl_matrix_view upper = gsl_matrix_submatrix(d->flow, 0, 0, n, n), lower = gsl_matrix_submatrix(d->flow, n, n, n, n);
  return code ? code : gsl_matrix_memcpy(&lower.matrix, &upper.matrix);
}

/* Row `row` of the system := row `source` of the flow, or of the identity. */
static void set_row(dense_equations *d, size_t row, size_t source, int from_flow) {
  for (size_t j = 0; j < 2 * d->n; j++)
    gsl_matrix_set(d->system, row, j, from_flow ? gsl_matrix_get(d->flow, source, j) : j == source);
}

/* The boundary conditions (8): q(0) = b of particles hit at t = 0, v(0) = 0 of others; q(T/2) = b of particles hit
 * at T/2, v(T/2) = 0 of others. */
static void impose_boundary_conditions(dense_equations *d, const ric_chain *chain, const ric_pattern *pattern) {
  size_t n = d->n;
  for (size_t i = 0; i < n; i++) {
    ric_role role = ric_pattern_role(pattern, i);
    if (role == RIC_ROLE_START)
      set_row(d, i, i, 0); /* q(0) = b */
    else
      set_row(d, i, n + i, 0); /* v(0) = 0 */
    if (role == RIC_ROLE_HALF)
      set_row(d, n + i, i, 1); /* q(T/2) = b */
    else
      set_row(d, n + i, n + i, 1); /* v(T/2) = 0 */
    gsl_vector_set(d->rhs, i, role == RIC_ROLE_START ? ric_chain_floor(chain, i) : 0);
    gsl_vector_set(d->rhs, n + i, role == RIC_ROLE_HALF ? ric_chain_floor(chain, i) : 0);
  }
}

static ric_status solve_matrix(dense_equations *d, const ric_chain *chain, const ric_pattern *pattern,
                               const ric_orbit_options *options, linear_outcome *solution, ric_error *error) {
  linear_work work = {.tau = d->tau->data,
                      .norm = d->norm->data,
                      .work = d->work->data,
                      .permutation = d->permutation->data,
                      .poll = options->poll};
  linear_factor factor;
  double residual;
  size_t size = 2 * d->n;
  impose_boundary_conditions(d, chain, pattern);
  RIC_TRY(linear_solve(d->system->data, size, d->rhs->data, d->x->data, &work, &factor, error));
  *solution = (linear_outcome){.condition = factor.norm * factor.inverse_norm};
  solution->singular = !(solution->condition < options->singular_condition);
  if (!solution->singular)
    return RIC_OK;
  impose_boundary_conditions(d, chain, pattern); /* the factorisation has overwritten it */
  RIC_TRY(linear_least_norm(d->system->data, size, d->rhs->data, d->x->data, factor.norm / options->singular_condition,
                            factor.last, &residual, error));
  solution->solvable = residual <= options->residual_tol;
  return RIC_OK;
}

/** State of the orbit of a pattern on the whole chain, O(n^3); allocates its workspace.
 *
 *  Beyond options->singular_condition it returns the solution of least norm if that satisfies the equations to
 *  residual_tol.
 *  @param solution  set; the condition number is that of the matrix of (11)
 *  Source: (M + N exp(A T/2)) x(0) = B, [JAP] (11), with the boundary conditions (8). */
static ric_status dense_solve(const ric_chain *chain, const ric_pattern *pattern, double period,
                              const ric_orbit_options *options, const boundary_state *state, linear_outcome *solution,
                              ric_error *error) {
  dense_equations d;
  size_t n = chain->particles;
  RIC_TRY(dense_alloc(&d, n, error));
  int code = exponentiate(&d, chain, period / 2);
  ric_status status =
      code ? ric_fail(error, gsl_status(code), "matrix exponential of size %zu: %s", 2 * n, gsl_text(code))
           : solve_matrix(&d, chain, pattern, options, solution, error);
  if (status == RIC_OK)
    gsl_blas_dgemv(CblasNoTrans, 1, d.flow, d.x, 0, d.x_half);
  for (size_t i = 0; i < n && status == RIC_OK; i++) {
    state->q[i] = gsl_vector_get(d.x, i);
    state->v[i] = gsl_vector_get(d.x, n + i);
    state->q_half[i] = gsl_vector_get(d.x_half, i);
    state->v_half[i] = gsl_vector_get(d.x_half, n + i);
  }
  dense_free(&d);
  return status;
}

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
  REQUIRE(error, {"solver", solver});
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
  return word * (17 * c + 4 * n + m + contacts * (contacts + 9)) + n + (double)lattice_transform_bytes((size_t)c);
}

static ric_status check_problem(const ric_orbit_solver *s, const ric_chain *chain, const ric_pattern *pattern,
                                double period, const ric_orbit *orbit, ric_error *error) {
  REQUIRE(error, {"solver", s}, {"chain", chain}, {"pattern", pattern});
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
static void expand_cell(const unit_cell *cell, const ric_pattern *pattern, const boundary_state *state,
                        ric_orbit *orbit) {
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

static ric_status solve_on_cell(ric_orbit_solver *s, const ric_chain *chain, const ric_pattern *pattern, double period,
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
    admissibility_without_state(orbit, RIC_SINGULAR);
    snprintf(orbit->reason, sizeof orbit->reason,
             "equations are singular and have no solution: condition %.3g, limit %.3g", orbit->condition,
             o->singular_condition);
    return RIC_OK;
  }
  if (!dense && s->impulse.response.near_dropped > 0 && solution.singular)
    return ric_fail(error, RIC_ENUMERIC, "more than %d wave numbers at resonance: condition %.3g", RESPONSE_NEAR,
                    solution.condition);
  expand_cell(&s->cell, pattern, &state, orbit);
  orbit->energy = ric_chain_energy(chain, orbit->q, orbit->v);
  if (!isfinite(orbit->energy))
    return ric_fail(error, RIC_ENUMERIC, "energy is not finite: the displacements overflow");
  return chain_verdict(s, chain, pattern, &state, solution.singular, orbit, error);
}

ric_status ric_orbit_solve(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern, double period,
                           ric_orbit *orbit, ric_error *error) {
  REQUIRE(error, {"orbit", orbit});
  ric_error own, *e = error ? error : &own;
  orbit->period = period;
  orbit->mode = -1;
  orbit->harmonic = 0;
  orbit->reason[0] = '\0';
  orbit->condition = NAN;
  keep_gsl_quiet();
  ric_status status = check_problem(solver, chain, pattern, period, orbit, e);
  if (status == RIC_OK)
    status = solve_on_cell(solver, chain, pattern, period, orbit, e);
  if (status != RIC_OK)
    ric_orbit_fail(orbit, e->message);
  return status;
}

#include "ricochet/monodromy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/required.h"
#include "numeric/vector.h"

/* Sets M to the unit matrix: the initial tangent vectors. */
static void set_unit(double *M, size_t size) {
  memset(M, 0, size * size * sizeof *M);
  for (size_t i = 0; i < size; i++)
    M[i * size + i] = 1;
}

/* Largest difference of two states, relative to the largest number of the first. */
static double difference(const double *x, const double *y, size_t count) {
  double most = 0, size = largest(x, count);
  for (size_t i = 0; i < count; i++)
    most = fmax(most, fabs(x[i] - y[i]));
  return size > 0 ? most / size : most;
}

static size_t jumps(const ric_run *run) {
  size_t count = 0;
  for (int kind = RIC_EVENT_TRANSVERSAL; kind <= RIC_EVENT_REST; kind++)
    count += kind == RIC_EVENT_GRAZING ? 0 : (size_t)run->events[kind];
  return count;
}

static ric_status run_period(ric_trajectory *trajectory, const ric_system *system, double start, const double *q,
                             const double *u, double period, double *M, ric_monodromy *monodromy, ric_error *error) {
  size_t n = ric_system_coordinates(system), m = ric_system_speeds(system), size = n + m;
  ric_run run;
  set_unit(M, size);
  RIC_TRY(ric_trajectory_start(trajectory, start, q, u, error));
  RIC_TRY(ric_trajectory_carry(trajectory, size, M, M + n * size, error));
  RIC_TRY(ric_trajectory_run(trajectory, start + period, NULL, &run, error));
  monodromy->outcome = run.outcome;
  monodromy->impacts = jumps(&run);
  memcpy(monodromy->reason, run.reason, sizeof monodromy->reason);
  if (run.outcome != RIC_RUN_COMPLETED)
    return RIC_OK;
  monodromy->closure_error = difference(q, ric_trajectory_q(trajectory), n);
  if (m > 0)
    monodromy->closure_error = fmax(monodromy->closure_error, difference(u, ric_trajectory_u(trajectory), m));
  memcpy(M, ric_trajectory_dq(trajectory), n * size * sizeof *M);
  if (m > 0)
    memcpy(M + n * size, ric_trajectory_du(trajectory), m * size * sizeof *M);
  return RIC_OK;
}

ric_status ric_monodromy_find(const ric_system *system, double start, const double *q, const double *u, double period,
                              const ric_trajectory_options *options, double *M, ric_monodromy *monodromy,
                              ric_error *error) {
  REQUIRE(error, {"system", system}, {"q", q}, {"M", M}, {"monodromy", monodromy});
  ric_trajectory *trajectory = NULL;
  *monodromy = (ric_monodromy){.closure_error = NAN};
  if (!(period > 0 && period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected > 0", period);
  RIC_TRY(ric_trajectory_create(system, options, &trajectory, error));
  ric_status status = run_period(trajectory, system, start, q, u, period, M, monodromy, error);
  ric_trajectory_destroy(&trajectory);
  return status;
}

ric_status ric_orbit_monodromy(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                               const ric_trajectory_options *options, double *M, ric_monodromy *monodromy,
                               ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"chain", chain}, {"orbit", orbit}, {"M", M}, {"monodromy", monodromy});
  size_t n = chain->particles;
  double quarter = orbit->period / 4, *q = malloc(2 * n * sizeof *q);
  ric_system *system = NULL;
  *monodromy = (ric_monodromy){.closure_error = NAN};
  if (!q)
    return ric_fail(error, RIC_ENOMEM, "no memory for a state of %zu particles", n);
  ric_status status = ric_orbit_states(solver, chain, orbit, &quarter, 1, q, q + n, error);
  if (status == RIC_OK)
    status = ric_system_create_chain(chain, &system, error);
  if (status == RIC_OK)
    status = ric_monodromy_find(system, quarter, q, q + n, orbit->period, options, M, monodromy, error);
  ric_system_destroy(&system);
  free(q);
  return status;
}

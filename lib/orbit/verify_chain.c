/* The verifier applied to the orbits of chains. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/verify.h"
#include "solver.h"

/* What a run needs: the chain's system, the state at T/4, the impacts that follow it. */
typedef struct task {
  ric_system *system;
  size_t *obstacle_of; /* [n] */
  ric_promise *promises;
  double *q, *v;
} task;

static void task_clear(task *t) {
  ric_system_destroy(&t->system);
  free(t->obstacle_of);
  free(t->promises);
  free(t->q);
  free(t->v);
}

static ric_status task_init(task *t, size_t n, size_t impacts, ric_error *error) {
  *t = (task){.obstacle_of = malloc(n * sizeof *t->obstacle_of),
              .promises = malloc(impacts * sizeof *t->promises),
              .q = malloc(n * sizeof *t->q),
              .v = malloc(n * sizeof *t->v)};
  if (t->obstacle_of && t->promises && t->q && t->v)
    return RIC_OK;
  return ric_fail(error, RIC_ENOMEM, "no memory to verify an orbit of %zu particles", n);
}

/* Obstacles of a chain's system are the particles with a floor, in order. */
static void find_obstacles(task *t, const ric_chain *chain) {
  size_t count = 0;
  for (size_t i = 0; i < chain->particles; i++)
    t->obstacle_of[i] = ric_chain_floor(chain, i) > -INFINITY ? count++ : SIZE_MAX;
}

static void make_promises(task *t, const ric_pattern *pattern, double period) {
  for (size_t k = 0; k < ric_pattern_impacts(pattern); k++) {
    size_t particle = ric_pattern_impact(pattern, k);
    bool at_half = ric_pattern_role(pattern, particle) == RIC_ROLE_HALF;
    t->promises[k] = (ric_promise){.time = at_half ? period / 2 : period, .obstacle = t->obstacle_of[particle]};
  }
}

static ric_status verify(task *t, ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                         const ric_orbit *orbit, const ric_verify_options *options, ric_verification *verification,
                         ric_error *error) {
  double quarter = orbit->period / 4;
  RIC_TRY(ric_orbit_states(solver, chain, orbit, &quarter, 1, t->q, t->v, error));
  RIC_TRY(ric_system_create_chain(chain, &t->system, error));
  find_obstacles(t, chain);
  make_promises(t, pattern, orbit->period);
  return ric_verify(t->system, quarter, t->q, t->v, orbit->period, t->promises, ric_pattern_impacts(pattern), options,
                    verification, error);
}

ric_status ric_orbit_verify(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                            const ric_orbit *orbit, const ric_verify_options *options, ric_verification *verification,
                            ric_error *error) {
  task t;
  *verification = (ric_verification){.result = RIC_NOT_RUN, .closure_error = NAN};
  RIC_TRY(ric_chain_check(chain, error));
  if (ric_pattern_particles(pattern) != chain->particles)
    return ric_fail(error, RIC_EINVAL, "pattern of %zu particles, expected %zu", ric_pattern_particles(pattern),
                    chain->particles);
  if (orbit->outcome != RIC_ADMISSIBLE) {
    strcpy(verification->reason, "the orbit is not admissible");
    return RIC_OK;
  }
  ric_status status = task_init(&t, chain->particles, ric_pattern_impacts(pattern), error);
  if (status == RIC_OK)
    status = verify(&t, solver, chain, pattern, orbit, options, verification, error);
  task_clear(&t);
  return status;
}

/* The verifier: compares event-driven runs with the impacts of an orbit; and its application to chains. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/verify.h"
#include "solver.h"
#include "numeric/required.h"

const char *ric_verification_name(ric_verification_result result) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_VERIFICATION_LIST(X)
#undef X
  };
  return (unsigned)result < RIC_VERIFICATION_RESULTS ? names[result] : "unknown result";
}

ric_verify_options ric_verify_options_default(void) {
  return (ric_verify_options){.closure_tol = 1e-8, .impact_time_tol = 1e-7, .motion = ric_trajectory_options_default()};
}

/* A predicted impact, and whether the run had it. */
typedef struct predicted {
  double time;
  size_t obstacle;
  bool matched;
} predicted;

/* The predicted impacts of an orbit, in order of obstacle and time. */
typedef struct predictions {
  const ric_system *system;
  predicted *impacts;
  size_t count;
  double time_tol;
  ric_verification *verification;
} predictions;

/* Sets a result unless there is one already, since the first deviation counts. Returns whether it did. */
static bool set_result(ric_verification *v, ric_verification_result result) {
  if (v->result != RIC_VERIFIED)
    return false;
  v->result = result;
  return true;
}

static int by_obstacle_and_time(const void *a, const void *b) {
  const predicted *x = a, *y = b;
  if (x->obstacle != y->obstacle)
    return x->obstacle < y->obstacle ? -1 : 1;
  return x->time < y->time ? -1 : x->time > y->time;
}

static size_t first_of_obstacle(const predictions *l, size_t obstacle) {
  size_t low = 0, high = l->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (l->impacts[middle].obstacle < obstacle)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Every jump of the speeds must be predicted. */
static int match_event(const ric_event *event, void *user) {
  predictions *l = user;
  bool jumps = ric_event_jumps(event), found = false;
  l->verification->impacts += jumps;
  for (size_t i = first_of_obstacle(l, event->obstacle);
       i < l->count && l->impacts[i].obstacle == event->obstacle && !found; i++) {
    predicted *p = &l->impacts[i];
    found = !p->matched && fabs(event->time - p->time) <= l->time_tol;
    p->matched = p->matched || found;
  }
  ric_verification *v = l->verification;
  if (jumps && !found && set_result(v, RIC_IMPACT_EXTRA))
    snprintf(v->reason, sizeof v->reason, "obstacle %zu is hit at t = %.12g with gap rate %.3g, which is not predicted",
             event->obstacle, event->time, event->gap_rate);
  return 0;
}

/* @param obstacle_of  obstacle of the system for that of the orbit; NULL: they are the same */
static ric_status predictions_init(predictions *l, const ric_orbit *orbit, const size_t *obstacle_of, double start,
                                   ric_error *error) {
  size_t obstacles = ric_system_obstacles(l->system);
  double period = orbit->period;
  l->impacts = malloc((orbit->impacts + 1) * sizeof *l->impacts);
  if (!l->impacts)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu predicted impacts", orbit->impacts);
  l->count = orbit->impacts;
  for (size_t k = 0; k < l->count; k++) {
    size_t obstacle = obstacle_of ? obstacle_of[orbit->impact_obstacle[k]] : orbit->impact_obstacle[k];
    double late = fmod(orbit->impact_time[k] - start, period);
    late += late < 0 ? period : 0;
    if (obstacle >= obstacles)
      return ric_fail(error, RIC_EINVAL, "impact_obstacle[%zu] = %zu, expected less than %zu", k, obstacle, obstacles);
    if (!(late > l->time_tol && late < period - l->time_tol))
      return ric_fail(error, RIC_EINVAL, "impact_time[%zu] = %g, expected another time than start = %g", k,
                      orbit->impact_time[k], start);
    l->impacts[k] = (predicted){.time = start + late, .obstacle = obstacle};
  }
  qsort(l->impacts, l->count, sizeof *l->impacts, by_obstacle_and_time);
  return RIC_OK;
}

/* Largest difference of two vectors over the largest entry of the first. */
static double relative_difference(const double *a, const double *b, size_t count) {
  double largest = 0, difference = 0;
  for (size_t i = 0; i < count; i++) {
    largest = fmax(largest, fabs(a[i]));
    difference = fmax(difference, fabs(a[i] - b[i]));
  }
  return largest > 0 ? difference / largest : difference;
}

static void compare_run(const ric_trajectory *tr, const predictions *l, const ric_run *run, const double *q,
                        const double *u, double closure_tol) {
  ric_verification *v = l->verification;
  if (run->outcome != RIC_RUN_COMPLETED) {
    v->result = RIC_RUN_FAILED;
    snprintf(v->reason, sizeof v->reason, "the run ended at t = %.12g: %s", run->time, run->reason);
    return;
  }
  const ric_system *s = l->system;
  v->closure_error = fmax(relative_difference(q, ric_trajectory_q(tr), ric_system_coordinates(s)),
                          relative_difference(u, ric_trajectory_u(tr), ric_system_speeds(s)));
  for (size_t i = 0; i < l->count; i++)
    if (!l->impacts[i].matched && set_result(v, RIC_IMPACT_MISSING))
      snprintf(v->reason, sizeof v->reason, "obstacle %zu is not hit at t = %.12g (within %.1g)",
               l->impacts[i].obstacle, l->impacts[i].time, l->time_tol);
  if (!(v->closure_error <= closure_tol) && set_result(v, RIC_NOT_CLOSED))
    snprintf(v->reason, sizeof v->reason,
             "after one period the state differs by %.3g of its size, expected at most %.3g", v->closure_error,
             closure_tol);
}

static ric_status check_request(const ric_system *system, const ric_orbit *orbit, const ric_verify_options *o,
                                ric_error *error) {
  if (!(orbit->period > 0 && orbit->period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected a finite number > 0", orbit->period);
  if (!(o->closure_tol > 0) || !(o->impact_time_tol > 0))
    return ric_fail(error, RIC_EINVAL, "closure_tol = %g, impact_time_tol = %g, expected > 0", o->closure_tol,
                    o->impact_time_tol);
  if (orbit->particles != ric_system_coordinates(system) || orbit->speeds != ric_system_speeds(system))
    return ric_fail(error, RIC_EINVAL, "orbit of %zu coordinates and %zu speeds, expected %zu and %zu",
                    orbit->particles, orbit->speeds, ric_system_coordinates(system), ric_system_speeds(system));
  return RIC_OK;
}

/* A run that cannot start or continue is a result about the orbit; lack of memory, or a stop by the poll callback,
 * is none. */
static ric_status run_period(ric_trajectory *tr, const ric_orbit *orbit, double start, const double *q, const double *u,
                             predictions *l, double closure_tol, ric_error *error) {
  ric_observer observer = {.event = match_event, .user = l};
  ric_error own, *e = error ? error : &own;
  ric_run run;
  ric_status status = ric_trajectory_start(tr, start, q, u, e);
  if (status == RIC_OK)
    status = ric_trajectory_run(tr, start + orbit->period, &observer, &run, e);
  if (status == RIC_ENOMEM || status == RIC_ESTOPPED)
    return status;
  if (status == RIC_OK) {
    compare_run(tr, l, &run, q, u, closure_tol);
  } else {
    l->verification->result = RIC_RUN_FAILED;
    snprintf(l->verification->reason, sizeof l->verification->reason, "%s", e->message);
  }
  return RIC_OK;
}

static ric_status verify(const ric_system *system, const ric_orbit *orbit, const size_t *obstacle_of, double start,
                         const double *q, const double *u, const ric_verify_options *options,
                         ric_verification *verification, ric_error *error) {
  ric_verify_options o = options ? *options : ric_verify_options_default();
  ric_trajectory *tr = NULL;
  *verification = (ric_verification){.result = RIC_VERIFIED, .closure_error = NAN};
  RIC_TRY(check_request(system, orbit, &o, error));
  predictions l = {.system = system, .time_tol = o.impact_time_tol * orbit->period, .verification = verification};
  ric_status status = predictions_init(&l, orbit, obstacle_of, start, error);
  if (status == RIC_OK)
    status = ric_trajectory_create(system, &o.motion, &tr, error);
  if (status == RIC_OK)
    status = run_period(tr, orbit, start, q, u, &l, o.closure_tol, error);
  ric_trajectory_destroy(&tr);
  free(l.impacts);
  return status;
}

ric_status ric_verify(const ric_system *system, const ric_orbit *orbit, double start, const double *q, const double *u,
                      const ric_verify_options *options, ric_verification *verification, ric_error *error) {
  REQUIRE(error, {"system", system}, {"orbit", orbit}, {"q", q}, {"verification", verification});
  REQUIRE(error, {"u", unless_empty(system->speeds, u)});
  return verify(system, orbit, NULL, start, q, u, options, verification, error);
}

/* The verifier applied to the orbits of chains, whose impacts name particles. */

/* Obstacles of a chain's system are the particles with a floor, in order. */
static void find_obstacles(const ric_chain *chain, size_t *obstacle_of) {
  size_t count = 0;
  for (size_t i = 0; i < chain->particles; i++)
    obstacle_of[i] = ric_chain_floor(chain, i) > -INFINITY ? count++ : SIZE_MAX;
}

ric_status ric_orbit_verify(ric_orbit_solver *solver, const ric_chain *chain, const ric_orbit *orbit,
                            const ric_verify_options *options, ric_verification *verification, ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"chain", chain}, {"orbit", orbit}, {"verification", verification});
  *verification = (ric_verification){.result = RIC_NOT_RUN, .closure_error = NAN};
  RIC_TRY(ric_chain_check(chain, error));
  if (orbit->particles != chain->particles)
    return ric_fail(error, RIC_EINVAL, "orbit of %zu particles, expected %zu", orbit->particles, chain->particles);
  if (orbit->outcome != RIC_ADMISSIBLE) {
    strcpy(verification->reason, "the orbit is not admissible");
    return RIC_OK;
  }
  size_t n = chain->particles;
  double quarter = orbit->period / 4, *q = malloc(2 * n * sizeof *q);
  size_t *obstacle_of = malloc(n * sizeof *obstacle_of);
  ric_system *system = NULL;
  ric_status status = q && obstacle_of
                          ? ric_orbit_states(solver, chain, orbit, &quarter, 1, q, q + n, error)
                          : ric_fail(error, RIC_ENOMEM, "no memory to verify an orbit of %zu particles", n);
  if (status == RIC_OK)
    status = ric_system_create_chain(chain, &system, error);
  if (status == RIC_OK) {
    find_obstacles(chain, obstacle_of);
    status = verify(system, orbit, obstacle_of, quarter, q, q + n, options, verification, error);
  }
  ric_system_destroy(&system);
  free(obstacle_of);
  free(q);
  return status;
}

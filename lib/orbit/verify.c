/* The verifier: event-driven runs beside what an orbit promises; and its use for chains. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ricochet/verify.h"
#include "solver.h"

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

/* Promises in order of obstacle and time, each with a mark once it is kept. */
typedef struct ledger {
  const ric_promise **promises;
  unsigned char *kept;
  size_t count;
  double time_tol;
  ric_verification *verification;
} ledger;

/* The first finding stays. */
static bool is_first(ric_verification *v, ric_verification_result result) {
  if (v->result != RIC_VERIFIED)
    return false;
  v->result = result;
  return true;
}

static int by_obstacle_and_time(const void *a, const void *b) {
  const ric_promise *x = *(const ric_promise *const *)a, *y = *(const ric_promise *const *)b;
  if (x->obstacle != y->obstacle)
    return x->obstacle < y->obstacle ? -1 : 1;
  return x->time < y->time ? -1 : x->time > y->time;
}

static size_t first_of_obstacle(const ledger *l, size_t obstacle) {
  size_t low = 0, high = l->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (l->promises[middle]->obstacle < obstacle)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Every jump of the speeds must be promised. */
static int see_event(const ric_event *event, void *user) {
  ledger *l = user;
  bool jumps = ric_event_jumps(event), promised = false;
  l->verification->impacts += jumps;
  for (size_t i = first_of_obstacle(l, event->obstacle);
       i < l->count && l->promises[i]->obstacle == event->obstacle && !promised; i++) {
    promised = !l->kept[i] && fabs(event->time - l->promises[i]->time) <= l->time_tol;
    if (promised)
      l->kept[i] = 1;
  }
  ric_verification *v = l->verification;
  if (jumps && !promised && is_first(v, RIC_IMPACT_EXTRA))
    snprintf(v->reason, sizeof v->reason, "obstacle %zu is hit at t = %.12g with gap rate %.3g, which is not promised",
             event->obstacle, event->time, event->gap_rate);
  return 0;
}

static ric_status ledger_init(ledger *l, const ric_promise *promises, size_t count, double time_tol,
                              ric_verification *verification, ric_error *error) {
  *l = (ledger){.count = count, .time_tol = time_tol, .verification = verification};
  l->promises = malloc((count ? count : 1) * sizeof *l->promises);
  l->kept = calloc(count ? count : 1, 1);
  if (!l->promises || !l->kept)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu promised impacts", count);
  for (size_t i = 0; i < count; i++)
    l->promises[i] = &promises[i];
  qsort(l->promises, count, sizeof *l->promises, by_obstacle_and_time);
  return RIC_OK;
}

static void ledger_clear(ledger *l) {
  free(l->promises);
  free(l->kept);
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

static void give_verdict(const ric_trajectory *tr, const ledger *l, const ric_run *run, const double *q,
                         const double *u, size_t n, size_t m, double closure_tol) {
  ric_verification *v = l->verification;
  if (run->outcome != RIC_RUN_COMPLETED) {
    v->result = RIC_RUN_FAILED;
    snprintf(v->reason, sizeof v->reason, "the run ended at t = %.12g: %s", run->time, run->reason);
    return;
  }
  v->closure_error =
      fmax(relative_difference(q, ric_trajectory_q(tr), n), relative_difference(u, ric_trajectory_u(tr), m));
  for (size_t i = 0; i < l->count; i++)
    if (!l->kept[i] && is_first(v, RIC_IMPACT_MISSING))
      snprintf(v->reason, sizeof v->reason, "obstacle %zu is not hit at t = %.12g (within %.1g)",
               l->promises[i]->obstacle, l->promises[i]->time, l->time_tol);
  if (!(v->closure_error <= closure_tol) && is_first(v, RIC_NOT_CLOSED))
    snprintf(v->reason, sizeof v->reason,
             "after one period the state differs by %.3g of its size, expected at most %.3g", v->closure_error,
             closure_tol);
}

static ric_status check_promise(const ric_promise *p, size_t i, double start, double period, size_t obstacles,
                                ric_error *error) {
  if (p->obstacle >= obstacles)
    return ric_fail(error, RIC_EINVAL, "promises[%zu]: obstacle = %zu, expected less than %zu", i, p->obstacle,
                    obstacles);
  if (!(p->time > start && p->time < start + period))
    return ric_fail(error, RIC_EINVAL, "promises[%zu]: time = %g, expected between %g and %g", i, p->time, start,
                    start + period);
  return RIC_OK;
}

static ric_status check_request(double period, const ric_verify_options *o, ric_error *error) {
  if (!(period > 0 && period < INFINITY))
    return ric_fail(error, RIC_EINVAL, "period = %g, expected a finite number > 0", period);
  if (!(o->closure_tol > 0) || !(o->impact_time_tol > 0))
    return ric_fail(error, RIC_EINVAL, "closure_tol = %g, impact_time_tol = %g, expected > 0", o->closure_tol,
                    o->impact_time_tol);
  return RIC_OK;
}

static ric_status run_period(ric_trajectory *tr, double start, const double *q, const double *u, double period,
                             ledger *l, ric_run *run, ric_error *error) {
  ric_observer observer = {.event = see_event, .user = l};
  RIC_TRY(ric_trajectory_start(tr, start, q, u, error));
  return ric_trajectory_run(tr, start + period, &observer, run, error);
}

ric_status ric_verify(const ric_system *system, double start, const double *q, const double *u, double period,
                      const ric_promise *promises, size_t count, const ric_verify_options *options,
                      ric_verification *verification, ric_error *error) {
  ric_verify_options o = options ? *options : ric_verify_options_default();
  ric_trajectory *tr = NULL;
  ric_run run;
  ledger l = {0};
  *verification = (ric_verification){.result = RIC_VERIFIED, .closure_error = NAN};
  RIC_TRY(check_request(period, &o, error));
  for (size_t i = 0; i < count; i++)
    RIC_TRY(check_promise(&promises[i], i, start, period, ric_system_obstacles(system), error));
  ric_status status = ric_trajectory_create(system, &o.motion, &tr, error);
  if (status == RIC_OK)
    status = ledger_init(&l, promises, count, o.impact_time_tol * period, verification, error);
  if (status == RIC_OK)
    status = run_period(tr, start, q, u, period, &l, &run, error);
  if (status == RIC_OK)
    give_verdict(tr, &l, &run, q, u, ric_system_coordinates(system), ric_system_speeds(system), o.closure_tol);
  ledger_clear(&l);
  ric_trajectory_destroy(&tr);
  return status;
}

/* The verifier applied to the orbits of chains. */

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

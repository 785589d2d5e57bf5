/* Scenarios of motions with impacts. What counts is the run, from a start state to its end; making the orbit, the
 * system and the trajectory does not. */
#include <math.h>
#include <stdlib.h>

#include "bench.h"
#include "scenario/example1.h"
#include "scenario/scenario.h"

/* The simulation of the source: [0, 20 T] of a localised orbit. */
static const double source_gamma = 0.149153131912, source_period = 4.69756390941;

typedef struct motion {
  scenario s;
  ric_orbit orbit;
  ric_system *system;
  ric_trajectory *trajectory;
  ric_run run;
  double seconds;
  int failed;
} motion;

static ric_system *system_of(const ric_chain *chain) {
  ric_lattice lattice = ric_lattice_of_chain(chain);
  ric_system *system = NULL;
  ric_obstacle *floors = malloc(chain->particles * sizeof *floors);
  for (size_t i = 0; floors && i < chain->particles; i++)
    floors[i] = ric_obstacle_floor(i, ric_chain_floor(chain, i));
  if (floors)
    ric_system_create_lattice(&lattice, floors, chain->particles, &system, NULL);
  free(floors);
  return system;
}

static motion start(size_t n, double gamma, double period) {
  motion m = {.s = scenario_middle(n, RIC_ENDS_PERIODIC, gamma, period)};
  ric_orbit_solver *solver = NULL;
  m.failed = ric_orbit_solver_create(NULL, &solver, NULL) != RIC_OK ||
             scenario_solve(&m.s, solver, &m.orbit, NULL) != RIC_OK || m.orbit.outcome != RIC_ADMISSIBLE;
  ric_orbit_solver_destroy(&solver);
  m.system = m.failed ? NULL : system_of(&m.s.chain);
  m.failed |= !m.system || ric_trajectory_create(m.system, NULL, &m.trajectory, NULL) != RIC_OK;
  return m;
}

static void go(motion *m, double end) {
  if (m->failed)
    return;
  double began = bench_seconds();
  m->failed = ric_trajectory_start(m->trajectory, 0, m->orbit.q, m->orbit.v, NULL) != RIC_OK ||
              ric_trajectory_run(m->trajectory, end, NULL, &m->run, NULL) != RIC_OK ||
              m->run.outcome != RIC_RUN_COMPLETED;
  m->seconds = bench_seconds() - began;
}

static void finish(motion *m) {
  ric_trajectory_destroy(&m->trajectory);
  ric_system_destroy(&m->system);
  ric_orbit_clear(&m->orbit);
  scenario_clear(&m->s);
}

static work_done simulation(size_t n, int variant) {
  (void)variant;
  motion m = start(n, source_gamma, source_period);
  go(&m, 20 * source_period);
  m.failed |= m.run.events[RIC_EVENT_TRANSVERSAL] < 19;
  work_done done = {.tasks = 1, .n = n, .failed = m.failed, .seconds = m.seconds};
  finish(&m);
  return done;
}

/* Largest deviation from the orbit at 3 T / 2, after one impact. */
static work_done accuracy(size_t n, int variant) {
  (void)variant;
  motion m = start(n, source_gamma, source_period);
  double off = 0;
  go(&m, 1.5 * source_period);
  for (size_t i = 0; !m.failed && i < n; i++) {
    off = fmax(off, fabs(ric_trajectory_q(m.trajectory)[i] - m.orbit.q_half[i]));
    off = fmax(off, fabs(ric_trajectory_u(m.trajectory)[i] - m.orbit.v_half[i]));
  }
  work_done done = {.tasks = 1, .n = n, .failed = m.failed, .seconds = m.seconds, .measure = "error", .value = off};
  finish(&m);
  return done;
}

/* Many periods of a stable orbit. */
static work_done long_run(size_t periods, int variant) {
  (void)variant;
  motion m = start(30, 0.09, example1_period());
  go(&m, ((double)periods + 0.5) * example1_period());
  m.failed |= m.run.events[RIC_EVENT_TRANSVERSAL] != periods;
  work_done done = {.tasks = 1,
                    .n = 30,
                    .failed = m.failed,
                    .seconds = m.seconds,
                    .measure = "energy_drift",
                    .value = fabs(m.run.energy_end / m.run.energy_start - 1)};
  finish(&m);
  return done;
}

/* A driven chain of 8 masses whose intervals between impacts reach up to 3. */
static work_done driven(size_t n, int method) {
  double force[16] = {0}, q[16] = {0}, u[16] = {0};
  ric_lattice lattice = ric_lattice_default(n, RIC_ENDS_FIXED);
  ric_obstacle floor = ric_obstacle_floor(n / 2, -0.1);
  ric_trajectory_options options = ric_trajectory_options_default();
  work_done done = {.tasks = 1, .n = n, .failed = 1, .measure = "force_evaluations_per_impact"};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_run run = {0};
  force[n / 2] = 1;
  lattice.link.linear = 0.1;
  lattice.on_site.damping = 0.05;
  lattice.frequency = 2.1;
  lattice.force_cos = force;
  floor.restitution = 0.9;
  options.flow.method = (ric_flow_method)method;
  options.flow.tolerance = 1e-12;
  if (ric_system_create_lattice(&lattice, &floor, 1, &system, NULL) == RIC_OK &&
      ric_trajectory_create(system, &options, &trajectory, NULL) == RIC_OK) {
    double began = bench_seconds();
    done.failed = ric_trajectory_start(trajectory, 0, q, u, NULL) != RIC_OK ||
                  ric_trajectory_run(trajectory, 600, NULL, &run, NULL) != RIC_OK || run.outcome != RIC_RUN_COMPLETED;
    done.seconds = bench_seconds() - began;
  }
  double impacts = (double)(run.events[RIC_EVENT_TRANSVERSAL] + run.events[RIC_EVENT_GRAZING]);
  done.failed |= !(impacts >= 195); /* intervals of about 3 */
  done.value = (double)run.flow.force_evaluations / impacts;
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return done;
}

enum { PERIODS = 51 /* timed in turn with and without tangent vectors, for their medians */ };

/* One period from T / 4 on, with `columns` tangent vectors, those of the identity. */
static double time_period(motion *m, const double *q, const double *u, const double *identity, size_t columns) {
  const size_t n = m->orbit.particles;
  double began = bench_seconds();
  m->failed |= ric_trajectory_start(m->trajectory, source_period / 4, q, u, NULL) != RIC_OK ||
               ric_trajectory_carry(m->trajectory, columns, identity, identity + n * columns, NULL) != RIC_OK ||
               ric_trajectory_run(m->trajectory, 1.25 * source_period, NULL, &m->run, NULL) != RIC_OK ||
               m->run.outcome != RIC_RUN_COMPLETED || ric_trajectory_columns(m->trajectory) != columns ||
               m->run.events[RIC_EVENT_TRANSVERSAL] != 1;
  return bench_seconds() - began;
}

static double median_of_periods(double *seconds) {
  for (int i = 1; i < PERIODS; i++)
    for (int j = i; j > 0 && seconds[j] < seconds[j - 1]; j--) {
      const double swap = seconds[j];
      seconds[j] = seconds[j - 1];
      seconds[j - 1] = swap;
    }
  return seconds[PERIODS / 2];
}

/* What all tangent vectors cost over the motion alone. */
static work_done variational(size_t n, int variant) {
  (void)variant;
  motion m = start(n, source_gamma, source_period);
  const size_t size = 2 * n;
  double plain[PERIODS], carried[PERIODS];
  double *identity = calloc(size * size, sizeof *identity), *state = calloc(size, sizeof *state);
  go(&m, source_period / 4);
  m.failed |= !identity || !state;
  for (size_t i = 0; !m.failed && i < size; i++) {
    identity[i * size + i] = 1;
    state[i] = i < n ? ric_trajectory_q(m.trajectory)[i] : ric_trajectory_u(m.trajectory)[i - n];
  }
  for (int i = 0; !m.failed && i < PERIODS; i++) {
    plain[i] = time_period(&m, state, state + n, identity, 0);
    carried[i] = time_period(&m, state, state + n, identity, size);
  }
  work_done done = {.tasks = 1, .n = n, .failed = m.failed, .measure = "ratio"};
  if (!m.failed) {
    done.seconds = median_of_periods(carried);
    done.value = done.seconds / median_of_periods(plain);
  }
  free(identity);
  free(state);
  finish(&m);
  return done;
}

const benchmark trajectory_benchmarks[] = {
    {"motion_30", "[0, 20 T] of the source's localised orbit, n = 30", 101, 30, 0, simulation},
    {"motion_3000", "the same with n = 3000", 21, 3000, 0, simulation},
    {"motion_30000", "the same with n = 30 000", 5, 30000, 0, simulation},
    {"motion_1000000", "the same with n = 1 000 000", 3, 1000000, 0, simulation},
    {"motion_accuracy", "3 T / 2 of it, with the largest error there", 11, 30, 0, accuracy},
    {"motion_long", "100 000 periods of a stable orbit, with the drift of its energy", 1, 100000, 0, long_run},
    {"driven_taylor", "600 time units of a driven chain of 8, Taylor flow", 5, 8, RIC_FLOW_TAYLOR, driven},
    {"driven_cvodes", "the same with CVODES, with its force evaluations per impact", 5, 8, RIC_FLOW_CVODES, driven},
    {"variational_30", "a period of that orbit, n = 30, with 60 tangent vectors, and over that without", 11, 30, 0,
     variational},
    {0}};

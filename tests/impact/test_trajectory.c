/* Trajectories of chains: against exact motions, conservation, sampling, and what happens to bad input. */
#include "support.h"

#include "witness/recorded_run.h"
#include "scenario/example1.h"
#include "witness/solved_orbit.h"

static const double table_period = 4.69756390941, table_gamma = 0.149153131912;

static ric_system *chain_system(const ric_chain *chain) {
  ric_lattice lattice = ric_lattice_of_chain(chain);
  ric_obstacle *floors = calloc(chain->particles, sizeof *floors);
  for (size_t i = 0; i < chain->particles; i++)
    floors[i] = ric_obstacle_floor(i, ric_chain_floor(chain, i));
  ric_system *system = lattice_system(&lattice, floors, chain->particles);
  free(floors);
  return system;
}

/* An orbit and the system it moves in. */
typedef struct example {
  solved_orbit of;
  ric_system *system;
} example;

static example example_create(size_t n, double gamma, double period) {
  example e = {.of = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(n, RIC_ENDS_PERIODIC, gamma, period))};
  assert_int_equal(e.of.orbit.outcome, RIC_ADMISSIBLE);
  e.system = chain_system(&e.of.scenario.chain);
  return e;
}

static void example_destroy(example *e) {
  ric_system_destroy(&e->system);
  solved_orbit_clear(&e->of);
}

/* At 3 T / 2, after one impact, against the orbit at T / 2. */
static void orbit_is_followed_to_rounding_through_an_impact(void **state) {
  (void)state;
  example e = example_create(30, table_gamma, table_period);
  recorded_run r = record_run(e.system, NULL, e.of.orbit.q, e.of.orbit.v, 1.5 * table_period);
  assert_int_equal(recorded_run_impacts(&r), 1);
  assert_close(r.events[0].time, table_period, 1e-14);
  for (size_t i = 0; i < 30; i++) {
    assert_close(r.q[i], e.of.orbit.q_half[i], 1e-14);
    assert_close(r.u[i], e.of.orbit.v_half[i], 1e-14);
  }
  recorded_run_clear(&r);
  example_destroy(&e);
}

static void source_simulation_has_one_impact_per_period(void **state) {
  (void)state;
  example e = example_create(30, table_gamma, table_period);
  recorded_run r = record_run(e.system, NULL, e.of.orbit.q, e.of.orbit.v, 19.5 * table_period);
  assert_int_equal(r.count, 19);
  for (size_t k = 0; k < r.count; k++) {
    assert_int_equal(r.events[k].kind, RIC_EVENT_TRANSVERSAL);
    assert_int_equal(r.events[k].coordinate, 15);
    assert_close(r.events[k].time, (double)(k + 1) * table_period, 1e-9);
  }
  assert_close(r.run.energy_end, r.run.energy_start, 1e-14 * r.run.energy_start);
  recorded_run_clear(&r);
  example_destroy(&e);
}

static void elastic_run_conserves_energy_over_a_thousand_periods(void **state) {
  (void)state;
  example e = example_create(30, 0.09, example1_period());
  recorded_run r = record_run(e.system, NULL, e.of.orbit.q, e.of.orbit.v, 1000.5 * example1_period());
  assert_int_equal(recorded_run_impacts(&r), 1000);
  assert_close(r.run.energy_end / r.run.energy_start, 1, 1e-12);
  assert_true(r.run.impact_loss == 0);
  recorded_run_clear(&r);
  example_destroy(&e);
}

/* With speeds reversed the motion goes back through its impacts. */
static void elastic_motion_is_reversible(void **state) {
  (void)state;
  enum { N = 20 };
  random_source source = {.state = 5};
  ric_chain chain = ric_chain_default(N, 0.3);
  for (int k = 0; k < 50; k++) {
    double q[N], u[N], end = 8;
    chain.ends = (ric_ends)(k % 3);
    ric_system *system = chain_system(&chain);
    for (size_t i = 0; i < N; i++) {
      q[i] = random_uniform(&source, -0.9, 1);
      u[i] = random_uniform(&source, -2, 2);
    }
    recorded_run there = record_run(system, NULL, q, u, end);
    for (size_t i = 0; i < N; i++)
      there.u[i] = -there.u[i];
    recorded_run back = record_run(system, NULL, there.q, there.u, end);
    assert_int_equal(recorded_run_impacts(&there), recorded_run_impacts(&back));
    assert_true(recorded_run_impacts(&there) > 3);
    double off = 0, growth = growth_of(system, q, u, end);
    for (size_t i = 0; i < N; i++)
      off = fmax(off, fmax(fabs(back.q[i] - q[i]), fabs(back.u[i] + u[i])));
    if (!(off <= 1e-15 * growth * growth)) /* rounding, grown there and back */
      fail_msg("run %d: off by %g, growth %g, %zu events", k, off, growth, there.count);
    recorded_run_clear(&there);
    recorded_run_clear(&back);
    ric_system_destroy(&system);
  }
}

/* Samples of a motion with impacts agree with runs that end there. */
static void samples_are_the_states_at_their_times(void **state) {
  (void)state;
  enum { N = 30, TIMES = 101 };
  example e = example_create(N, 0.05, example1_period());
  double times[TIMES], q[TIMES * N], u[TIMES * N], end = 3 * example1_period();
  for (size_t k = 0; k < TIMES; k++)
    times[k] = end * (double)k / (TIMES - 1);
  ric_sampler sampler = {.times = times, .count = TIMES, .coordinates = N, .speeds = N, .q = q, .u = u};
  ric_observer observer = {.segment = ric_sampler_segment, .user = &sampler};
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_trajectory_create(e.system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, e.of.orbit.q, e.of.orbit.v, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, end, &observer, &run, NULL), RIC_OK);
  ric_sampler_finish(&sampler, trajectory);
  assert_int_equal(sampler.next, TIMES);
  for (size_t k = 0; k < TIMES; k += 7) {
    recorded_run r = record_run(e.system, NULL, e.of.orbit.q, e.of.orbit.v, times[k]);
    for (size_t i = 0; i < N; i++) {
      assert_close(q[k * N + i], r.q[i], 1e-13);
      assert_close(u[k * N + i], r.u[i], 1e-13);
    }
    recorded_run_clear(&r);
  }
  ric_trajectory_destroy(&trajectory);
  example_destroy(&e);
}

static int end_at_third(const ric_event *event, void *user) {
  (void)event;
  return ++*(int *)user >= 3;
}

static void observer_can_end_a_run_and_go_on(void **state) {
  (void)state;
  example e = example_create(30, 0.05, example1_period());
  int events = 0;
  ric_observer observer = {.event = end_at_third, .user = &events};
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_trajectory_create(e.system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, e.of.orbit.q, e.of.orbit.v, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 100, &observer, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_ENDED);
  assert_close(run.time, 3 * example1_period(), 1e-12);
  assert_int_equal(ric_trajectory_run(trajectory, 3.5 * example1_period(), NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  for (size_t i = 0; i < 30; i++)
    assert_close(ric_trajectory_q(trajectory)[i], e.of.orbit.q_half[i], 1e-13);
  ric_trajectory_destroy(&trajectory);
  example_destroy(&e);
}

/* A long chain comes in pieces, and gives the bits of the same chain looked at whole where nothing reaches it. */
static void long_chain_moves_like_a_short_one(void **state) {
  (void)state;
  example small = example_create(60, 0.05, example1_period()), large = example_create(2000, 0.05, example1_period());
  double end = 5.5 * example1_period();
  recorded_run a = record_run(small.system, NULL, small.of.orbit.q, small.of.orbit.v, end);
  recorded_run b = record_run(large.system, NULL, large.of.orbit.q, large.of.orbit.v, end);
  assert_int_equal(recorded_run_impacts(&a), 5);
  assert_int_equal(recorded_run_impacts(&b), 5);
  for (size_t i = 0; i < 60; i++)
    assert_close(a.q[i], b.q[970 + i], 1e-12);
  recorded_run_clear(&a);
  recorded_run_clear(&b);
  example_destroy(&small);
  example_destroy(&large);
}

/* q = sin(t + phase) over a floor at -1: every touch is told, whether rounding puts it above, below or at zero. */
static void touches_are_told_however_they_are_rounded(void **state) {
  (void)state;
  static const double pi = 3.14159265358979323846;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -1);
  ric_system *system = lattice_system(&mass, &floor, 1);
  for (int k = 0; k < 500; k++) {
    double phase = -1.5 + 0.006 * k, q = sin(phase), u = cos(phase), end = 6 * pi;
    recorded_run r = record_run(system, NULL, &q, &u, end);
    assert_int_equal(r.count, 3);
    for (size_t i = 0; i < 3; i++) {
      assert_int_equal(r.events[i].kind, RIC_EVENT_GRAZING);
      assert_close(r.events[i].time, 1.5 * pi - phase + 2 * pi * (double)i, 1e-6);
    }
    recorded_run_clear(&r);
  }
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(orbit_is_followed_to_rounding_through_an_impact),
      cmocka_unit_test(source_simulation_has_one_impact_per_period),
      cmocka_unit_test(elastic_run_conserves_energy_over_a_thousand_periods),
      cmocka_unit_test(elastic_motion_is_reversible),
      cmocka_unit_test(samples_are_the_states_at_their_times),
      cmocka_unit_test(observer_can_end_a_run_and_go_on),
      cmocka_unit_test(long_chain_moves_like_a_short_one),
      cmocka_unit_test(touches_are_told_however_they_are_rounded),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

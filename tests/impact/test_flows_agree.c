/* One motion, two flows: Taylor series and CVODES, with impacts, forcing, damping, nonlinear springs and Hertz
 * contacts. */
#include "support.h"

#include "witness/recorded_run.h"
#include "scenario/random_source.h"

enum { N = 8 };

typedef struct witness {
  ric_lattice lattice;
  ric_obstacle obstacles[2 * N];
  size_t count;
  double force[N], q[N], u[N];
} witness;

static witness witness_create(uint64_t seed, double stiffness) {
  random_source source = {.state = seed};
  witness w = {.lattice = ric_lattice_default(N, (ric_ends)(seed % 3))};
  w.lattice.link = (ric_spring){.linear = 0.2, .cubic = 0.1, .damping = 0.02};
  w.lattice.on_site = (ric_spring){.linear = 1, .quadratic = 0.1, .cubic = 0.3, .damping = 0.01};
  w.lattice.frequency = 1.3;
  for (size_t i = 0; i < N; i++) {
    w.obstacles[w.count] = ric_obstacle_floor(i, -0.7);
    w.obstacles[w.count].stiffness = stiffness;
    w.obstacles[w.count++].restitution = 0.8;
    if (i % 2)
      w.obstacles[w.count++] = ric_obstacle_wall(i, 0.9);
    w.force[i] = i == 3 ? 0.8 : 0;
    w.q[i] = random_uniform(&source, -0.5, 0.8);
    w.u[i] = random_uniform(&source, -1, 1);
  }
  return w;
}

static recorded_run run(witness *w, ric_flow_method method, double tolerance, double end) {
  w->lattice.force_cos = w->force;
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow.method = method;
  options.flow.tolerance = tolerance;
  options.chatter_tol = 1e-3;
  ric_system *system = lattice_system(&w->lattice, w->obstacles, w->count);
  recorded_run r = record_run(system, &options, w->q, w->u, end);
  ric_system_destroy(&system);
  return r;
}

static size_t agree(double stiffness, double end, double bound_per_tolerance) {
  size_t impacts = 0;
  for (uint64_t seed = 0; seed < 12; seed++) {
    witness w = witness_create(seed, stiffness);
    recorded_run taylor = run(&w, RIC_FLOW_TAYLOR, 0, end), cvodes = run(&w, RIC_FLOW_CVODES, 1e-12, end);
    assert_int_equal(taylor.run.outcome, RIC_RUN_COMPLETED);
    assert_int_equal(cvodes.run.outcome, RIC_RUN_COMPLETED);
    assert_int_equal(taylor.count, cvodes.count);
    for (size_t i = 0; i < taylor.count; i++) {
      assert_int_equal(taylor.events[i].kind, cvodes.events[i].kind);
      assert_int_equal(taylor.events[i].obstacle, cvodes.events[i].obstacle);
    }
    double difference = recorded_runs_difference(&taylor, &cvodes);
    if (!(difference <= bound_per_tolerance * 1e-12))
      fail_msg("seed %d: the flows differ by %g after %zu events", (int)seed, difference, taylor.count);
    impacts += taylor.count;
    recorded_run_clear(&taylor);
    recorded_run_clear(&cvodes);
  }
  print_message("[ %zu events ]\n", impacts);
  return impacts;
}

static void flows_agree_through_impacts(void **state) {
  (void)state;
  assert_true(agree(INFINITY, 15, 1e6) > 100);
}

static void flows_agree_through_hertz_contacts(void **state) {
  (void)state;
  assert_true(agree(500, 15, 1e6) > 100);
}

/* Hertz contacts that are touched with no speed: pushed in, pushed away, and in balance. */
static void hertz_contacts_touched_at_rest_go_on(void **state) {
  (void)state;
  for (int k = 0; k < 6; k++) {
    double place = (k % 3 - 1) * 0.5;
    ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
    ric_obstacle floor = ric_obstacle_floor(0, place);
    ric_trajectory_options options = ric_trajectory_options_default();
    floor.stiffness = 100;
    options.flow.method = k < 3 ? RIC_FLOW_TAYLOR : RIC_FLOW_CVODES;
    ric_system *system = lattice_system(&mass, &floor, 1);
    recorded_run r = record_run(system, &options, (double[]){place}, (double[]){0}, 10);
    assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
    assert_true(r.count < 30);
    assert_close(r.run.energy_end, r.run.energy_start, 1e-9);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

/* Masses that share inertia, floors and walls, e = 0.9: coupled impulses, forces through the mass matrix. */
static void flows_agree_on_coupled_masses(void **state) {
  (void)state;
  ric_obstacle sides[4] = {ric_obstacle_floor(0, -0.4), ric_obstacle_wall(1, 0.3), ric_obstacle_floor(2, -0.5),
                           ric_obstacle_wall(2, 0.6)};
  for (int i = 0; i < 4; i++)
    sides[i].restitution = 0.9;
  ric_system *system = coupled_masses(sides, 4);
  ric_trajectory_options options = ric_trajectory_options_default();
  recorded_run taylor = record_run(system, &options, (double[]){0.3, 0.1, -0.2}, (double[]){0, 0.4, 0.5}, 20);
  options.flow.method = RIC_FLOW_CVODES;
  recorded_run cvodes = record_run(system, &options, (double[]){0.3, 0.1, -0.2}, (double[]){0, 0.4, 0.5}, 20);
  assert_int_equal(taylor.count, cvodes.count);
  assert_true(recorded_run_impacts(&taylor) >= 8);
  for (size_t i = 0; i < taylor.count; i++)
    assert_close(taylor.events[i].time, cvodes.events[i].time, 1e-7);
  assert_true(recorded_runs_difference(&taylor, &cvodes) <= 1e-6);
  recorded_run_clear(&taylor);
  recorded_run_clear(&cvodes);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flows_agree_through_impacts),
      cmocka_unit_test(flows_agree_through_hertz_contacts),
      cmocka_unit_test(flows_agree_on_coupled_masses),
      cmocka_unit_test(hertz_contacts_touched_at_rest_go_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

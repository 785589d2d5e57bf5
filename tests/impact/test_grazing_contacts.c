/* Grazing contacts: none is missed above the floor that docs/theory.md derives for each flow, "What an integration
 * error can hide". */
#include "support.h"

#include <stdbool.h>

#include "witness/recorded_run.h"
#include "scenario/random_source.h"

static const double pi = 3.14159265358979323846;

enum { CONTACTS = 100000 };

typedef struct outcome {
  ric_event event;
  size_t events;
} outcome;

static int see(const ric_event *event, void *user) {
  outcome *o = user;
  if (o->events++ == 0)
    o->event = *event;
  return 0;
}

/* One oscillator q'' = -q over a floor at -1, one trajectory for all starts. */
typedef struct bench {
  ric_system *system;
  ric_trajectory *trajectory;
} bench;

static bench bench_create(ric_flow_method method, double tolerance, bool as_matrices) {
  bench b = {0};
  const double one = 1;
  const ric_mck matrices = {.coordinates = 1, .mass.values = &one, .stiffness.values = &one};
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, -1);
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow.method = method;
  options.flow.tolerance = tolerance;
  if (as_matrices)
    assert_int_equal(ric_system_create_mck(&matrices, &floor, 1, &b.system, NULL), RIC_OK);
  else
    b.system = lattice_system(&mass, &floor, 1);
  assert_int_equal(ric_trajectory_create(b.system, &options, &b.trajectory, NULL), RIC_OK);
  return b;
}

static void bench_destroy(bench *b) {
  ric_trajectory_destroy(&b->trajectory);
  ric_system_destroy(&b->system);
}

/* A motion of amplitude 1 + depth that meets the floor at `phase` after the start, run until 0.3 after that. */
static outcome pass(bench *b, double depth, double phase, unsigned long long *steps) {
  double q = -(1 + depth) * cos(phase), u = -(1 + depth) * sin(phase);
  outcome o = {0};
  ric_observer observer = {.event = see, .user = &o};
  ric_run run;
  assert_int_equal(ric_trajectory_start(b->trajectory, 0, &q, &u, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(b->trajectory, phase + 0.3, &observer, &run, NULL), RIC_OK);
  *steps = run.flow.steps;
  return o;
}

/* The floors of the theory page, for an amplitude A, s steps, N components. */
static double taylor_floor(double amplitude, double steps) {
  return 2.6e-14 * (steps + 1) * amplitude;
}
static double cvodes_floor(double amplitude, double steps, double tolerance) {
  return 2 * sqrt(2) * (steps + 1) * tolerance * (1 + amplitude);
}

static void none_missed(ric_flow_method method, double tolerance, bool as_matrices, size_t contacts) {
  random_source source = {.state = 1997};
  bench b = bench_create(method, tolerance, as_matrices);
  size_t missed = 0, below = 0;
  for (size_t i = 0; i < contacts; i++) {
    double depth = pow(10, random_uniform(&source, -12, -2)), phase = random_uniform(&source, 0.2, pi);
    unsigned long long steps;
    outcome o = pass(&b, depth, phase, &steps);
    double floor = method == RIC_FLOW_CVODES ? cvodes_floor(1 + depth, (double)steps, tolerance)
                                             : taylor_floor(1 + depth, (double)steps);
    bool seen = o.events > 0 && ric_event_jumps(&o.event);
    missed += !seen && depth > floor;
    below += !seen && depth <= floor;
    if (seen && depth > floor) /* the contact is where the motion comes down to the floor */
      assert_close(o.event.time, phase - acos(1 / (1 + depth)), 2 * floor / sqrt(2 * depth) + 1e-15 * phase);
  }
  print_message("[ method %d, tolerance %g: %zu missed above the floor, %zu below it, of %zu ]\n", (int)method,
                tolerance, missed, below, contacts);
  assert_int_equal(missed, 0);
  bench_destroy(&b);
}

static void taylor_misses_none_above_its_floor(void **state) {
  (void)state;
  none_missed(RIC_FLOW_TAYLOR, 1e-16, false, CONTACTS);
}

static void taylor_of_matrices_misses_none_above_its_floor(void **state) {
  (void)state;
  none_missed(RIC_FLOW_TAYLOR, 1e-16, true, CONTACTS);
}

static void cvodes_misses_none_above_its_floor(void **state) {
  (void)state;
  none_missed(RIC_FLOW_CVODES, 1e-12, false, CONTACTS);
}

static void cvodes_at_a_loose_tolerance_misses_none_above_its_floor(void **state) {
  (void)state;
  none_missed(RIC_FLOW_CVODES, 1e-8, false, CONTACTS / 20);
}

/* Minima within grazing_tol above zero are reported with their value, and nothing jumps. */
static void near_misses_are_reported_with_their_clearance(void **state) {
  (void)state;
  random_source source = {.state = 7};
  bench b = bench_create(RIC_FLOW_TAYLOR, 1e-16, false);
  for (int i = 0; i < 20000; i++) {
    double clearance = pow(10, random_uniform(&source, -12, -8)), phase = random_uniform(&source, 0.2, pi);
    unsigned long long steps;
    outcome o = pass(&b, -clearance, phase, &steps);
    double floor = taylor_floor(1, (double)steps);
    if (clearance > 1e-10 + floor) {
      assert_int_equal(o.events, 0);
    } else if (clearance < 1e-10 - floor) {
      assert_int_equal(o.events, 1);
      assert_int_equal(o.event.kind, RIC_EVENT_GRAZING);
      assert_false(ric_event_jumps(&o.event));
      assert_close(o.event.depth, clearance, floor);
      assert_close(o.event.time, phase, 2 * sqrt(2 * floor));
    }
  }
  bench_destroy(&b);
}

/* Shallow impacts are labelled grazing with the depth that the motion without the floor has. */
static void shallow_impacts_are_labelled_grazing(void **state) {
  (void)state;
  bench b = bench_create(RIC_FLOW_TAYLOR, 1e-16, false);
  for (int i = 0; i < 200; i++) {
    double depth = 1e-12 * pow(10, i / 50.0), phase = 0.3 + 0.01 * i;
    unsigned long long steps;
    outcome o = pass(&b, depth, phase, &steps);
    double floor = taylor_floor(1, (double)steps);
    assert_true(o.events == 1 && ric_event_jumps(&o.event));
    if (depth < 1e-10 - floor) {
      assert_int_equal(o.event.kind, RIC_EVENT_GRAZING);
      assert_close(o.event.depth, -depth, floor + 1e-6 * depth);
    } else if (depth > 1e-10 + floor)
      assert_int_equal(o.event.kind, RIC_EVENT_TRANSVERSAL);
  }
  bench_destroy(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(taylor_misses_none_above_its_floor),
      cmocka_unit_test(taylor_of_matrices_misses_none_above_its_floor),
      cmocka_unit_test(near_misses_are_reported_with_their_clearance),
      cmocka_unit_test(shallow_impacts_are_labelled_grazing),
      cmocka_unit_test(cvodes_misses_none_above_its_floor),
      cmocka_unit_test(cvodes_at_a_loose_tolerance_misses_none_above_its_floor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

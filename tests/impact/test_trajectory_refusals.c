/* Bad input and motions that cannot go on: named errors, or outcomes that keep the state. */
#include "support.h"

#include "witness/recorded_run.h"

static void expect(ric_status status, ric_status expected, const ric_error *error, const char *part) {
  assert_int_equal(status, expected);
  if (!strstr(error->message, part))
    fail_msg("message \"%s\" without \"%s\"", error->message, part);
}

static ric_status try_obstacle(ric_obstacle obstacle, ric_error *error) {
  ric_lattice pair = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_system *system = NULL;
  ric_status status = ric_system_create_lattice(&pair, &obstacle, 1, &system, error);
  assert_true((status == RIC_OK) == (system != NULL));
  ric_system_destroy(&system);
  return status;
}

static void obstacles_are_checked_field_by_field(void **state) {
  (void)state;
  ric_error error;
  ric_obstacle o = ric_obstacle_floor(0, -1);
  o.restitution = 1.2;
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "restitution = 1.2, expected 0 <= e <= 1");
  o.restitution = -0.1;
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "restitution = -0.1");
  o.restitution = NAN;
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "restitution = nan");
  o = ric_obstacle_floor(2, -1);
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "coordinate = 2, expected less than 2");
  o = ric_obstacle_floor(0, INFINITY);
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "position = inf");
  o = ric_obstacle_floor(0, -1);
  o.side = 0;
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "side = 0");
  o.side = 1;
  o.stiffness = 0;
  expect(try_obstacle(o, &error), RIC_EINVAL, &error, "stiffness = 0, expected > 0");
}

static void masses_and_springs_are_checked(void **state) {
  (void)state;
  ric_error error;
  ric_system *system = NULL;
  double masses[2] = {1, 0};
  ric_lattice pair = ric_lattice_default(2, RIC_ENDS_FREE);
  pair.masses = masses;
  expect(ric_system_create_lattice(&pair, NULL, 0, &system, &error), RIC_EINVAL, &error, "mass");
  masses[1] = -3;
  expect(ric_system_create_lattice(&pair, NULL, 0, &system, &error), RIC_EINVAL, &error, "-3");
  masses[1] = 1;
  pair.on_site.cubic = NAN;
  expect(ric_system_create_lattice(&pair, NULL, 0, &system, &error), RIC_EINVAL, &error, "cubic");
}

typedef struct ball {
  ric_system *system;
  ric_trajectory *trajectory;
} ball;

static ball ball_create(double restitution) {
  ball b = {.system = falling_ball(restitution)};
  assert_int_equal(ric_trajectory_create(b.system, NULL, &b.trajectory, NULL), RIC_OK);
  return b;
}

static void ball_destroy(ball *b) {
  ric_trajectory_destroy(&b->trajectory);
  ric_system_destroy(&b->system);
}

static void starts_are_checked(void **state) {
  (void)state;
  ball b = ball_create(1);
  ric_error error;
  ric_run run;
  double zero = 0, low = -0.25, nan = NAN;
  expect(ric_trajectory_run(b.trajectory, 1, NULL, &run, &error), RIC_EINVAL, &error, "has not been started");
  expect(ric_trajectory_start(b.trajectory, 0, &low, &zero, &error), RIC_EINVAL, &error,
         "the gap of obstacle 0 (a floor) is -0.25, expected >= 0");
  expect(ric_trajectory_start(b.trajectory, 0, &nan, &zero, &error), RIC_EINVAL, &error, "q[0] = nan");
  expect(ric_trajectory_start(b.trajectory, 0, &zero, &nan, &error), RIC_EINVAL, &error, "u[0] = nan");
  expect(ric_trajectory_start(b.trajectory, INFINITY, &zero, &zero, &error), RIC_EINVAL, &error, "t = inf");
  expect(ric_trajectory_run(b.trajectory, 1, NULL, &run, &error), RIC_EINVAL, &error, "has not been started");
  assert_int_equal(ric_trajectory_start(b.trajectory, 3, &zero, &zero, &error), RIC_OK);
  expect(ric_trajectory_run(b.trajectory, 2, NULL, &run, &error), RIC_EINVAL, &error, "end = 2");
  expect(ric_trajectory_run(b.trajectory, NAN, NULL, &run, &error), RIC_EINVAL, &error, "end = nan");
  ball_destroy(&b);
}

static void options_are_checked(void **state) {
  (void)state;
  ric_error error;
  ric_system *system = falling_ball(1);
  ric_trajectory *trajectory = NULL;
  ric_trajectory_options o = ric_trajectory_options_default();
  o.grazing_tol = -1;
  expect(ric_trajectory_create(system, &o, &trajectory, &error), RIC_EINVAL, &error, "grazing_tol = -1");
  o = ric_trajectory_options_default();
  o.events_per_time = 0;
  expect(ric_trajectory_create(system, &o, &trajectory, &error), RIC_EINVAL, &error, "events_per_time = 0");
  o = ric_trajectory_options_default();
  o.flow.tolerance = 1;
  expect(ric_trajectory_create(system, &o, &trajectory, &error), RIC_EINVAL, &error, "tolerance = 1");
  o.flow.tolerance = 0;
  o.flow.order = 3;
  expect(ric_trajectory_create(system, &o, &trajectory, &error), RIC_EINVAL, &error, "order = 3");
  assert_null(trajectory);
  ric_system_destroy(&system);
}

static void floor_and_wall_must_leave_room(void **state) {
  (void)state;
  ric_error error;
  ric_lattice pair = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_obstacle sides[2] = {ric_obstacle_wall(1, 0.25), ric_obstacle_floor(1, 0.25)};
  ric_system *system = lattice_system(&pair, sides, 2);
  ric_trajectory *trajectory = NULL;
  expect(ric_trajectory_create(system, NULL, &trajectory, &error), RIC_EINVAL, &error,
         "coordinate 1 has a floor at 0.25 and a wall at 0.25, expected room between them");
  ric_system_destroy(&system);
}

/* q'' = 2 q^3: infinite in finite time. */
static void blow_up_is_an_outcome_that_keeps_the_state(void **state) {
  (void)state;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  mass.on_site = (ric_spring){.cubic = -2}; /* q'' = 2 q^3, q = 1 / (1 - t) from (1, 1) */
  ric_system *system = lattice_system(&mass, NULL, 0);
  for (int method = RIC_FLOW_TAYLOR; method <= RIC_FLOW_CVODES; method++) {
    ric_trajectory_options o = ric_trajectory_options_default();
    o.flow.method = (ric_flow_method)method;
    recorded_run r = record_run(system, &o, (double[]){1}, (double[]){1}, 2);
    assert_int_equal(r.run.outcome, RIC_RUN_BLOW_UP);
    assert_true(strlen(r.run.reason) > 0);
    assert_true(r.run.time > 0.99 && r.run.time <= 1 + 1e-6);
    assert_true(isfinite(r.q[0]) && r.q[0] > 100);
    if (method == RIC_FLOW_TAYLOR) /* CVODES loses its accuracy on the way up */
      assert_close(r.q[0] * (1 - r.run.time), 1, 1e-3);
    recorded_run_clear(&r);
  }
  ric_system_destroy(&system);
}

/* A user's force that fails, by return value or NaN, after t = 0.5. */
static int fails_late(double t, const double *q, const double *u, double *f, void *user) {
  (void)q, (void)u;
  int by_value = *(int *)user;
  f[0] = t > 0.5 && !by_value ? NAN : -1;
  return t > 0.5 && by_value;
}

static int height(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0];
  return 0;
}

static void failing_callbacks_are_an_outcome_that_keeps_the_state(void **state) {
  (void)state;
  for (int by_value = 0; by_value <= 1; by_value++) {
    ric_mechanical model = {
        .coordinates = 1, .speeds = 1, .obstacles = 1, .force = fails_late, .gap = height, .user = &by_value};
    ric_system *system = NULL;
    assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
    recorded_run r = record_run(system, NULL, (double[]){5}, (double[]){0}, 2);
    assert_int_equal(r.run.outcome, RIC_RUN_CALLBACK_FAILED);
    assert_non_null(strstr(r.run.reason, "force"));
    assert_true(r.run.time >= 0 && r.run.time <= 0.5);
    assert_close(r.q[0], 5 - r.run.time * r.run.time / 2, 1e-10);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

static int stop_late(void *user) {
  return ++*(int *)user > 5;
}

static void poll_stops_a_run_which_can_go_on(void **state) {
  (void)state;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_system *system = lattice_system(&mass, NULL, 0);
  ric_trajectory_options o = ric_trajectory_options_default();
  ric_trajectory *trajectory = NULL;
  int calls = 0;
  ric_run run;
  ric_error error;
  o.poll = (ric_poll){.call = stop_late, .user = &calls};
  assert_int_equal(ric_trajectory_create(system, &o, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, (double[]){1}, (double[]){0}, NULL), RIC_OK);
  expect(ric_trajectory_run(trajectory, 100, NULL, &run, &error), RIC_ESTOPPED, &error, "stopped at t");
  double reached = ric_trajectory_time(trajectory);
  assert_true(reached > 0 && reached < 100);
  assert_close(ric_trajectory_q(trajectory)[0], cos(reached), 1e-14);
  calls = -1000;
  assert_int_equal(ric_trajectory_run(trajectory, 100, NULL, &run, NULL), RIC_OK);
  assert_close(ric_trajectory_q(trajectory)[0], cos(100.0), 1e-12);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(obstacles_are_checked_field_by_field),
      cmocka_unit_test(masses_and_springs_are_checked),
      cmocka_unit_test(starts_are_checked),
      cmocka_unit_test(options_are_checked),
      cmocka_unit_test(floor_and_wall_must_leave_room),
      cmocka_unit_test(blow_up_is_an_outcome_that_keeps_the_state),
      cmocka_unit_test(failing_callbacks_are_an_outcome_that_keeps_the_state),
      cmocka_unit_test(poll_stops_a_run_which_can_go_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

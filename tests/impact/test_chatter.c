/* Accumulating impacts: closed forms, and runs that follow more of the series. */
#include "support.h"

#include "witness/recorded_run.h"

/* From height h the first impact comes at sqrt(2 h) and the last at sqrt(2 h) (1 + e) / (1 - e). */
static void ball_on_a_fixed_table_rests_at_the_closed_form(void **state) {
  (void)state;
  for (int i = 1; i <= 9; i++) {
    double e = 0.1 * i, height = 0.7, last = sqrt(2 * height) * (1 + e) / (1 - e);
    ric_system *ball = falling_ball(e);
    recorded_run r = record_run(ball, NULL, &height, (double[]){0}, last + 5);
    const ric_event *chatter = recorded_run_first(&r, RIC_EVENT_CHATTER),
                    *rest = recorded_run_first(&r, RIC_EVENT_REST);
    assert_non_null(chatter);
    assert_non_null(rest);
    assert_close(chatter->accumulation, last, 2e-14 * last / (1 - e));
    assert_close(rest->time, chatter->accumulation, 1e-15 * last);
    assert_true(r.events[r.count - 1].kind == RIC_EVENT_REST);
    assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
    assert_true(r.q[0] == 0 && r.u[0] == 0);
    recorded_run_clear(&r);
    ric_system_destroy(&ball);
  }
}

/* Impacts before the summed-up ones shrink by e from one to the next. */
static void impact_speeds_shrink_by_the_restitution(void **state) {
  (void)state;
  double e = 0.6, height = 1;
  ric_system *ball = falling_ball(e);
  recorded_run r = record_run(ball, NULL, &height, (double[]){0}, 10);
  double speed = sqrt(2);
  for (size_t i = 0; i < recorded_run_impacts(&r); i++, speed *= e)
    assert_close(r.events[i].gap_rate, -speed, 1e-14);
  recorded_run_clear(&r);
  ric_system_destroy(&ball);
}

/* A mass on a spring over a floor above its equilibrium: the acceleration changes between impacts. */
static recorded_run pressed_mass(double chatter_tol, double end) {
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0.5);
  ric_trajectory_options options = ric_trajectory_options_default();
  floor.restitution = 0.5;
  options.chatter_tol = chatter_tol;
  ric_system *system = lattice_system(&mass, &floor, 1);
  recorded_run r = record_run(system, &options, (double[]){1}, (double[]){0.3}, end);
  ric_system_destroy(&system);
  return r;
}

static void accumulation_converges_with_the_duration_left_out(void **state) {
  (void)state;
  recorded_run witness = pressed_mass(1e-7, 10);
  double last = recorded_run_first(&witness, RIC_EVENT_CHATTER)->accumulation, error[3],
         tolerance[3] = {1e-1, 1e-2, 1e-3};
  for (int k = 0; k < 3; k++) {
    recorded_run r = pressed_mass(tolerance[k], 10);
    const ric_event *chatter = recorded_run_first(&r, RIC_EVENT_CHATTER);
    error[k] = fabs(chatter->accumulation - last);
    double duration = chatter->accumulation - chatter->time;
    assert_true(duration <= 1.01 * tolerance[k]);
    assert_true(error[k] <= duration * duration * duration); /* the first order in the jerk is summed exactly */
    assert_close(r.q[0], 0.5, 0);
    recorded_run_clear(&r);
  }
  recorded_run_clear(&witness);
}

/* A mass pressed to a floor by its spring (0.5 at the floor) and shaken with 0.8 sin(2 t): it chatters to rest where
 * the sine is low and is thrown off where it is high. */
static recorded_run shaken_mass(double tolerance, double events_per_time) {
  double shaking = 0.8;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0.5);
  ric_trajectory_options options = ric_trajectory_options_default();
  mass.frequency = 2;
  mass.force_sin = &shaking;
  floor.restitution = 0.2;
  options.flow.tolerance = tolerance;
  options.chatter_tol = 1e-7; /* the limit is the fourth root of the tolerance */
  options.events_per_time = events_per_time;
  ric_system *system = lattice_system(&mass, &floor, 1);
  recorded_run r = record_run(system, &options, (double[]){0.9}, (double[]){-0.2}, 40);
  ric_system_destroy(&system);
  return r;
}

static void shaken_mass_agrees_with_a_run_that_follows_the_series_further(void **state) {
  (void)state;
  recorded_run r = shaken_mass(1e-16, 1e5), witness = shaken_mass(1e-17, 4e5);
  assert_true(recorded_runs_stick_alike(&r, &witness, 1e-11) >= 4);
  assert_true(recorded_runs_difference(&r, &witness) <= 1e-11);
  recorded_run_clear(&r);
  recorded_run_clear(&witness);
}

/* A mass on a floor that leaves it with speed 1e-3 under the force -A - J sin t. The acceleration changes by its own
 * size within the series, so that it is not summed up at once; for CVODES the last bounces lose no more of their height
 * than the flow's errors give back. */
static recorded_run light_mass(double weight, double jerk, double restitution, ric_flow_method method) {
  double mass = 1, constant = -weight, sine = -jerk;
  ric_mck model = {.coordinates = 1, .mass.values = &mass, .frequency = 1, .force_cos = &constant, .force_sin = &sine};
  ric_obstacle floor = ric_obstacle_floor(0, 0.7);
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_system *system = NULL;
  floor.restitution = restitution;
  options.flow.method = method;
  assert_int_equal(ric_system_create_mck(&model, &floor, 1, &system, NULL), RIC_OK);
  recorded_run r = record_run(system, &options, (double[]){0.7}, (double[]){1e-3}, 1);
  ric_system_destroy(&system);
  return r;
}

/* Bounces of CVODES end where A w^2 (1 - e^2) is 20 times its tolerance: what is left lasts 1e-5 / (1 - e) or so, and
 * landings are off by that at most. */
static void bounces_kept_up_by_errors_of_the_flow_are_summed_up(void **state) {
  (void)state;
  static const double cases[][3] = {{0.06, 2, 0.952}, {0.18, 2, 0.952}, {0.18, -1, 0.8}, {0.54, -2, 0.952}};
  for (size_t k = 0; k < 4; k++) {
    const double *c = cases[k];
    recorded_run witness = light_mass(c[0], c[1], c[2], RIC_FLOW_TAYLOR);
    recorded_run r = light_mass(c[0], c[1], c[2], RIC_FLOW_CVODES);
    const ric_event *rest = recorded_run_first(&r, RIC_EVENT_REST),
                    *expected = recorded_run_first(&witness, RIC_EVENT_REST);
    assert_non_null(rest);
    assert_non_null(expected);
    assert_close(rest->time, expected->time, 1e-4);
    assert_true(recorded_run_impacts(&r) <= recorded_run_impacts(&witness));
    recorded_run_clear(&witness);
    recorded_run_clear(&r);
  }
}

/* With the summation off, the event limit ends the run and keeps the state. */
static void without_summation_the_event_limit_ends_the_run(void **state) {
  (void)state;
  ric_system *ball = falling_ball(0.5);
  ric_trajectory_options options = ric_trajectory_options_default();
  options.chatter_tol = 0;
  options.rest_tol = 0;
  options.events_per_time = 20;
  recorded_run r = record_run(ball, &options, (double[]){1}, (double[]){0}, 10);
  assert_int_equal(r.run.outcome, RIC_RUN_EVENT_LIMIT);
  assert_non_null(strstr(r.run.reason, "events at more than 20 times"));
  assert_true(r.run.time > 4 && r.run.time < 3 * sqrt(2) + 1e-9);
  assert_close(r.q[0], 0, 1e-9);
  recorded_run_clear(&r);
  ric_system_destroy(&ball);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ball_on_a_fixed_table_rests_at_the_closed_form),
      cmocka_unit_test(impact_speeds_shrink_by_the_restitution),
      cmocka_unit_test(accumulation_converges_with_the_duration_left_out),
      cmocka_unit_test(shaken_mass_agrees_with_a_run_that_follows_the_series_further),
      cmocka_unit_test(bounces_kept_up_by_errors_of_the_flow_are_summed_up),
      cmocka_unit_test(without_summation_the_event_limit_ends_the_run),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Persistent contacts: when they begin, what they carry, when they open. */
#include "support.h"

#include "witness/recorded_run.h"

static const double pi = 3.14159265358979323846;

/* A mass that rests on a floor at 0.5, pressed by its spring with 0.5, under the force a sin(w t): it lifts off when
 * a sin(w t) = 0.5. */
static recorded_run lift_off(double amplitude, double frequency, ric_flow_method method, double end) {
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0.5);
  ric_trajectory_options options = ric_trajectory_options_default();
  mass.frequency = frequency;
  mass.force_sin = &amplitude;
  floor.restitution = 0.3;
  options.flow.method = method;
  ric_system *system = lattice_system(&mass, &floor, 1);
  recorded_run r = record_run(system, &options, (double[]){0.5}, (double[]){0}, end);
  ric_system_destroy(&system);
  return r;
}

static void expect_lift_off(const recorded_run *r, double time, double tolerance) {
  assert_int_equal(r->count, 2);
  assert_int_equal(r->events[0].kind, RIC_EVENT_REST);
  assert_true(r->events[0].time == 0);
  assert_int_equal(r->events[1].kind, RIC_EVENT_RELEASE);
  assert_close(r->events[1].time, time, tolerance);
  assert_true(r->q[0] > 0.5 && r->u[0] > 0);
}

static void release_time_under_harmonic_force_is_the_closed_form(void **state) {
  (void)state;
  for (int k = 0; k < 16; k++) {
    double amplitude = 0.55 + 0.3 * (k % 8), frequency = 0.3 * pow(1.4, k), lift = asin(0.5 / amplitude) / frequency;
    for (int method = RIC_FLOW_TAYLOR; method <= RIC_FLOW_CVODES; method++) {
      recorded_run r = lift_off(amplitude, frequency, (ric_flow_method)method, lift + 0.1 / frequency);
      expect_lift_off(&r, lift, (method == RIC_FLOW_TAYLOR ? 1e-14 : 1e-11) / frequency);
      recorded_run_clear(&r);
    }
  }
}

/* The same in a user's words, where the force of the contact comes from differences. */
static int shaken(double t, const double *q, const double *u, double *f, void *user) {
  (void)u;
  f[0] = -q[0] + 0.7 * sin(*(double *)user * t);
  return 0;
}

static int over_half(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0] - 0.5;
  return 0;
}

static void release_time_of_a_user_system_is_the_closed_form(void **state) {
  (void)state;
  for (double frequency = 0.3; frequency < 40; frequency *= 1.7) {
    ric_mechanical model = {
        .coordinates = 1, .speeds = 1, .obstacles = 1, .force = shaken, .gap = over_half, .user = &frequency};
    double lift = asin(0.5 / 0.7) / frequency;
    ric_system *system = NULL;
    assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
    recorded_run r = record_run(system, NULL, (double[]){0.5}, (double[]){0}, lift + 0.1 / frequency);
    expect_lift_off(&r, lift, 1e-8);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

/* After the release the motion is that of a free mass that starts from rest there. */
static void released_mass_moves_freely(void **state) {
  (void)state;
  double amplitude = 0.8, lift = asin(0.5 / amplitude), after = 0.6;
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0.5);
  mass.on_site = (ric_spring){.linear = 4};
  floor.position = 0.125;
  mass.frequency = 1;
  mass.force_sin = &amplitude;
  ric_system *system = lattice_system(&mass, &floor, 1);
  recorded_run r = record_run(system, NULL, (double[]){0.125}, (double[]){0}, lift + after);
  /* q = p sin t + a cos 2(t - lift) + b sin 2(t - lift), p = amplitude / 3 */
  double p = amplitude / 3, a = 0.125 - p * sin(lift), b = -p * cos(lift) / 2;
  assert_close(r.q[0], p * sin(lift + after) + a * cos(2 * after) + b * sin(2 * after), 1e-14);
  assert_close(r.u[0], p * cos(lift + after) - 2 * a * sin(2 * after) + 2 * b * cos(2 * after), 1e-14);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

enum { CHAIN = 12 };

static ric_system *pressed_chain(double restitution) {
  ric_obstacle floors[CHAIN];
  ric_lattice chain = ric_lattice_default(CHAIN, RIC_ENDS_FIXED);
  chain.link.linear = 0.2;
  for (size_t i = 0; i < CHAIN; i++) {
    floors[i] = ric_obstacle_floor(i, 0.1);
    floors[i].restitution = restitution;
  }
  return lattice_system(&chain, floors, CHAIN);
}

static void chain_with_losses_comes_to_rest(void **state) {
  (void)state;
  ric_system *system = pressed_chain(0.5);
  double q[CHAIN], u[CHAIN];
  for (size_t i = 0; i < CHAIN; i++) {
    q[i] = 0.2 + 0.05 * (double)i;
    u[i] = i % 2 ? -0.1 : 0.3;
  }
  recorded_run r = record_run(system, NULL, q, u, 60);
  assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
  for (size_t i = 0; i < CHAIN; i++)
    assert_true(r.q[i] == 0.1 && r.u[i] == 0);
  double at_rest[CHAIN], zero[CHAIN] = {0};
  for (size_t i = 0; i < CHAIN; i++)
    at_rest[i] = 0.1;
  assert_close(r.run.energy_end, ric_system_energy(system, 0, at_rest, zero), 1e-16);
  assert_close(r.run.energy_start - r.run.impact_loss, r.run.energy_end, 1e-14);
  assert_int_equal(r.run.events[RIC_EVENT_REST], CHAIN + r.run.events[RIC_EVENT_RELEASE]);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

/* e = 0: every impact ends in rest or in leaving with rate zero. */
static void plastic_impacts_stick_at_once(void **state) {
  (void)state;
  ric_system *system = pressed_chain(0);
  double q[CHAIN], u[CHAIN] = {0};
  for (size_t i = 0; i < CHAIN; i++)
    q[i] = 0.2 + 0.1 * (double)(i % 3);
  recorded_run r = record_run(system, NULL, q, u, 40);
  for (size_t i = 0; i + 1 < r.count; i++)
    if (r.events[i].kind == RIC_EVENT_TRANSVERSAL)
      assert_true(r.events[i].gap_rate_end == 0);
  for (size_t i = 0; i < CHAIN; i++)
    assert_true(r.q[i] == 0.1 && r.u[i] == 0);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

/* A mass held between a floor and the pull of its neighbour opens when the neighbour has moved far enough. */
static void neighbour_lifts_a_resting_mass(void **state) {
  (void)state;
  ric_lattice pair = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0.2);
  pair.link.linear = 0.5;
  ric_system *system = lattice_system(&pair, &floor, 1);
  /* The force on mass 0 is -0.2 + 0.5 (q1 - 0.2) = 0 at q1 = 0.6; q1'' = -q1 - 0.5 (q1 - 0.2) while 0 rests. */
  double omega = sqrt(1.5), centre = 0.1 / 1.5, speed = 1.2;
  recorded_run r = record_run(system, NULL, (double[]){0.2, centre}, (double[]){0, speed}, 0.9);
  const ric_event *release = recorded_run_first(&r, RIC_EVENT_RELEASE);
  assert_non_null(release);
  assert_close(release->time, asin((0.6 - centre) * omega / speed) / omega, 1e-14);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

/* With e = 1 a mass that is put on the floor with no speed rests; it does not bounce. */
static void elastic_floor_holds_a_mass_put_down_on_it(void **state) {
  (void)state;
  ric_system *ball = falling_ball(1);
  recorded_run r = record_run(ball, NULL, (double[]){0}, (double[]){0}, 2 * pi);
  assert_int_equal(r.count, 1);
  assert_int_equal(r.events[0].kind, RIC_EVENT_REST);
  assert_true(r.q[0] == 0 && r.u[0] == 0);
  recorded_run_clear(&r);
  ric_system_destroy(&ball);
}

/* Far from the origin errors of the state are larger, and so is what counts as zero. */
static void balls_come_to_rest_at_any_height(void **state) {
  (void)state;
  static const double weight[] = {-1};
  for (double height = 1; height <= 1e4; height *= 10)
    for (int method = RIC_FLOW_TAYLOR; method <= RIC_FLOW_CVODES; method++) {
      ric_lattice ball = ric_lattice_default(1, RIC_ENDS_FREE);
      ric_obstacle floor = ric_obstacle_floor(0, height);
      ric_trajectory_options options = ric_trajectory_options_default();
      ball.on_site = (ric_spring){0};
      ball.force_cos = weight;
      floor.restitution = 0.5;
      options.flow.method = (ric_flow_method)method;
      ric_system *system = lattice_system(&ball, &floor, 1);
      recorded_run r = record_run(system, &options, (double[]){height + 0.5}, (double[]){0}, 20);
      assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
      assert_true(r.count < 60 && recorded_run_first(&r, RIC_EVENT_REST) != NULL);
      assert_true(r.q[0] == height && r.u[0] == 0);
      recorded_run_clear(&r);
      ric_system_destroy(&system);
    }
}

/* A start that is below the floor by less than grazing_tol, with no speed: held, or on its way without fuss. */
static void starts_a_little_below_the_floor_go_on(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
    ric_obstacle floor = ric_obstacle_floor(0, k == 0 ? 0.5 : k == 1 ? -0.5 : 0);
    ric_system *system = lattice_system(&mass, &floor, 1);
    recorded_run r = record_run(system, NULL, (double[]){floor.position - 1e-12}, (double[]){0}, 10);
    assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
    assert_true(r.count < 10);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

/* Mass 0 lies on mass 1 and both are pushed along, M = [[1, 0.3], [0.3, 3]]: as they go away, errors of the state grow
 * with it. */
static int pair_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  memcpy(M, (double[]){1, 0.3, 0.3, 3}, 4 * sizeof *M);
  return 0;
}

static int pair_push(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = 0.2;
  f[1] = 1.7;
  return 0;
}

static int pair_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0] - q[1];
  return 0;
}

/* Both have the acceleration 1.9 / 4.6. To put the contact on at every step would take thousands of restarts. */
static void noise_of_gaps_grows_with_the_state(void **state) {
  (void)state;
  double restitution = 0.5, end = 1000;
  ric_mechanical model = {.coordinates = 2,
                          .speeds = 2,
                          .obstacles = 1,
                          .restitution = &restitution,
                          .mass = pair_mass,
                          .force = pair_push,
                          .gap = pair_gap};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  recorded_run r = record_run(system, NULL, (double[]){0, 0}, (double[]){0.3, 0.3}, end);
  assert_int_equal(r.run.outcome, RIC_RUN_COMPLETED);
  assert_int_equal(r.count, 1);
  assert_int_equal(r.events[0].kind, RIC_EVENT_REST);
  assert_true(r.run.flow.starts < 100);
  assert_close(r.q[0], 0.3 * end + 0.95 / 4.6 * end * end, 1e-8 * end * end);
  recorded_run_clear(&r);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(release_time_under_harmonic_force_is_the_closed_form),
      cmocka_unit_test(release_time_of_a_user_system_is_the_closed_form),
      cmocka_unit_test(released_mass_moves_freely),
      cmocka_unit_test(chain_with_losses_comes_to_rest),
      cmocka_unit_test(plastic_impacts_stick_at_once),
      cmocka_unit_test(neighbour_lifts_a_resting_mass),
      cmocka_unit_test(elastic_floor_holds_a_mass_put_down_on_it),
      cmocka_unit_test(balls_come_to_rest_at_any_height),
      cmocka_unit_test(starts_a_little_below_the_floor_go_on),
      cmocka_unit_test(noise_of_gaps_grows_with_the_state),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

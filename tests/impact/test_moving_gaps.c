/* Gaps that move or curve: systems of users against closed forms, brute force and their own longer runs. */
#include "support.h"

#include "witness/recorded_run.h"
#include "scenario/random_source.h"

/* A ball under gravity 1 over a table at height a sin(w t). */
typedef struct table {
  double amplitude, frequency;
} table;

static int weight(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = -1;
  return 0;
}

static int over_table(double t, const double *q, size_t obstacle, double *h, void *user) {
  const table *a = user;
  (void)obstacle;
  *h = q[0] - a->amplitude * sin(a->frequency * t);
  return 0;
}

static int over_table_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time,
                               void *user) {
  const table *a = user;
  (void)q, (void)obstacle;
  gradient[0] = 1;
  *in_time = -a->amplitude * a->frequency * cos(a->frequency * t);
  return 0;
}

static int height_energy(double t, const double *q, const double *u, double *energy, void *user) {
  (void)t, (void)user;
  *energy = q[0] + u[0] * u[0] / 2;
  return 0;
}

static ric_system *ball_on_table(table *a, const double *restitution) {
  ric_mechanical model = {.coordinates = 1,
                          .speeds = 1,
                          .obstacles = 1,
                          .restitution = restitution,
                          .force = weight,
                          .gap = over_table,
                          .gap_gradient = over_table_gradient,
                          .energy = height_energy,
                          .user = a};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  return system;
}

static recorded_run shaken_ball(double tolerance, double events_per_time) {
  table a = {.amplitude = 0.12, .frequency = 3};
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow.tolerance = tolerance;
  options.events_per_time = events_per_time;
  ric_system *system = ball_on_table(&a, (double[]){0.8});
  recorded_run r = record_run(system, &options, (double[]){0.5}, (double[]){0}, 20);
  ric_system_destroy(&system);
  return r;
}

/* The times of rests and releases do not depend on how much of the series of impacts is followed. */
static void chatter_on_a_forced_table_agrees_with_a_run_that_follows_it_further(void **state) {
  (void)state;
  recorded_run r = shaken_ball(1e-12, 1e5), witness = shaken_ball(1e-14, 4e5);
  /* summed up at durations d = (1.4e-12)^(1/4), where the speed is w = d (1 - e) / 2 = 1.1e-4: errors of 1.4e-12 in the
   * gap shift landings by 1.4e-12 / w each, and the series of them by 1 / (1 - e) as much */
  assert_true(recorded_runs_stick_alike(&r, &witness, 6e-8) >= 8);
  recorded_run_clear(&r);
  recorded_run_clear(&witness);
}

/* The ball leaves where the table falls away faster than gravity: a w^2 sin(w t) = 1. */
static void ball_leaves_the_table_at_the_closed_form(void **state) {
  (void)state;
  recorded_run r = shaken_ball(1e-12, 1e5);
  for (size_t i = 0; i < r.count; i++)
    if (r.events[i].kind == RIC_EVENT_RELEASE)
      assert_close(sin(3 * r.events[i].time), 1 / (0.12 * 9), 1e-7);
  assert_true(r.run.events[RIC_EVENT_RELEASE] >= 4);
  recorded_run_clear(&r);
}

/* A table that moves does work: what impacts take, and what they give, is in the ledger. */
static void ledger_counts_the_work_of_a_moving_table(void **state) {
  (void)state;
  for (int k = 0; k <= 2; k++) {
    table a = {.amplitude = 0.3, .frequency = 2};
    double e = 0.5 * k;
    ric_system *system = ball_on_table(&a, &e);
    recorded_run r = record_run(system, NULL, (double[]){1}, (double[]){0}, 4);
    assert_true(recorded_run_impacts(&r) >= 1);
    if (r.run.events[RIC_EVENT_REST] == 0)
      assert_close(r.run.energy_start - r.run.impact_loss, r.run.energy_end, 1e-10);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

/* A free particle and a fast wall: steps of the flow are a thousand periods of the wall long. */
static int no_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = 0;
  return 0;
}

static int to_fast_wall(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle;
  *h = 10 + 0.5 * sin(*(double *)user * t) - q[0];
  return 0;
}

static void fast_wall_is_hit_where_brute_force_finds_it(void **state) {
  (void)state;
  for (double frequency = 1; frequency < 40; frequency *= 3) {
    double speed = 0.01, first = NAN;
    ric_mechanical model = {
        .coordinates = 1, .speeds = 1, .obstacles = 1, .force = no_force, .gap = to_fast_wall, .user = &frequency};
    for (double t = 940; isnan(first); t += 1e-4 / frequency)
      if (10 + 0.5 * sin(frequency * t) - speed * t <= 0)
        first = t;
    ric_system *system = NULL;
    assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
    recorded_run r = record_run(system, NULL, (double[]){0}, (double[]){speed}, first + 0.01);
    assert_true(r.count >= 1);
    assert_close(r.events[0].time, first, 2e-4 / frequency);
    recorded_run_clear(&r);
    ric_system_destroy(&system);
  }
}

/* Grazing of a curved gap: a particle passes a disc at distances that differ from its radius by the depth. */
static int to_disc(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = hypot(q[0], q[1]) - 1;
  return 0;
}

static int no_forces(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = f[1] = 0;
  return 0;
}

static void grazing_of_a_disc_is_seen_above_the_floor(void **state) {
  (void)state;
  random_source source = {.state = 9};
  ric_mechanical model = {.coordinates = 2, .speeds = 2, .obstacles = 1, .force = no_forces, .gap = to_disc};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  for (int i = 0; i < 2000; i++) {
    double depth = pow(10, random_uniform(&source, -9, -2)), from = random_uniform(&source, -3, -1);
    recorded_run r = record_run(system, NULL, (double[]){from, 1 - depth}, (double[]){1, 0}, 3);
    /* s steps at tolerance 1e-12: the floor of the flow, and that of the interpolation, as many tolerances */
    if (depth > 4e-12 * (double)(r.run.flow.steps + 2) * 5)
      assert_true(recorded_run_impacts(&r) >= 1);
    recorded_run_clear(&r);
  }
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(chatter_on_a_forced_table_agrees_with_a_run_that_follows_it_further),
      cmocka_unit_test(ball_leaves_the_table_at_the_closed_form),
      cmocka_unit_test(ledger_counts_the_work_of_a_moving_table),
      cmocka_unit_test(fast_wall_is_hit_where_brute_force_finds_it),
      cmocka_unit_test(grazing_of_a_disc_is_seen_above_the_floor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Lyapunov exponents against multipliers, divergence and what is known of conservative motion. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "witness/recorded_run.h"
#include "scenario/random_source.h"

static const double pi = 3.14159265358979323846;

/* x'' + c x' + x = a cos(w t) under a wall at 1. */
static ric_system *oscillator(double damping, double amplitude, double frequency, double restitution) {
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  mass.on_site.damping = damping;
  mass.frequency = frequency;
  mass.force_cos = &amplitude;
  wall.restitution = restitution;
  return lattice_system(&mass, &wall, 1);
}

static ric_trajectory *started(const ric_system *system, double t, const double *q, const double *u) {
  ric_trajectory *trajectory = NULL;
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, t, q, u, NULL), RIC_OK);
  return trajectory;
}

static ric_lyapunov exponents_of(ric_trajectory *trajectory, double end, const ric_lyapunov_options *options,
                                 double *exponents) {
  ric_lyapunov lyapunov;
  ric_error error = {0};
  if (ric_lyapunov_run(trajectory, end, options, exponents, &lyapunov, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return lyapunov;
}

/* Real multipliers of a 2 x 2 matrix, the larger modulus first. */
static void real_multipliers(const double *M, double *mu) {
  double half = (M[0] + M[3]) / 2, det = M[0] * M[3] - M[1] * M[2], root = sqrt(half * half - det);
  assert_true(root > 0);
  mu[0] = half + copysign(root, half);
  mu[1] = det / mu[0];
}

static void exponents_of_a_forced_orbit_are_logarithms_of_its_multipliers(void **state) {
  (void)state;
  double period = 3 * 2 * pi / 4, M[4], mu[2], exponents[2], q = 0, u = 0;
  ric_system *system = oscillator(3, 30, 4, 0.8); /* overdamped: one impact in three periods of the force */
  ric_trajectory *trajectory = started(system, 0, &q, &u);
  ric_run run;
  ric_monodromy monodromy;
  assert_int_equal(ric_trajectory_run(trajectory, 800 * period + 0.1, NULL, &run, NULL), RIC_OK);
  double x = *ric_trajectory_q(trajectory), v = *ric_trajectory_u(trajectory), t = ric_trajectory_time(trajectory);
  assert_int_equal(ric_monodromy_find(system, t, &x, &v, period, NULL, M, &monodromy, NULL), RIC_OK);
  assert_int_equal(monodromy.outcome, RIC_RUN_COMPLETED);
  assert_true(monodromy.impacts > 0);
  assert_true(monodromy.closure_error < 1e-10);
  real_multipliers(M, mu);
  ric_lyapunov_options options = ric_lyapunov_options_default();
  options.interval = period;
  options.transient = 40 * period;
  ric_lyapunov l = exponents_of(trajectory, t + 100 * period, &options, exponents);
  assert_int_equal(l.run.outcome, RIC_RUN_COMPLETED);
  assert_close(l.time, 60 * period, 1e-9);
  assert_close(exponents[0], log(fabs(mu[0])) / period, 1e-6);
  assert_close(exponents[1], log(fabs(mu[1])) / period, 1e-6);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

/* Chaos: the sum is minus the damping, plus ln e^2 for every impact; the largest is positive. */
static void exponents_add_up_to_the_divergence(void **state) {
  (void)state;
  double exponents[2], q = 0.2, u = 0.1, end = 3000;
  ric_system *system = oscillator(0.1, 7, 2.6, 0.8);
  ric_trajectory *trajectory = started(system, 0, &q, &u);
  ric_lyapunov l = exponents_of(trajectory, end, NULL, exponents);
  assert_int_equal(l.run.outcome, RIC_RUN_COMPLETED);
  double impacts = (double)l.run.events[RIC_EVENT_TRANSVERSAL];
  assert_true(impacts > 500);
  assert_close(exponents[0] + exponents[1], -0.1 + impacts * log(0.64) / end, 1e-9);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

typedef struct records {
  size_t count;
  double time, last;
} records;

static int keep(double time, const double *exponents, size_t count, void *user) {
  records *r = user;
  assert_int_equal(count, 2);
  assert_true(time > r->time);
  r->count++;
  r->time = time;
  r->last = exponents[0];
  return r->count == 10;
}

/* A ball bouncing elastically on a floor under gravity: a double multiplier 1 with a Jordan block. */
static void exponents_of_conservative_motion_vanish_like_ln_t_over_t(void **state) {
  (void)state;
  ric_system *ball = falling_ball(1);
  double exponents[2], q = 0.5, u = 0;
  for (double end = 100; end <= 10000; end *= 10) {
    ric_trajectory *trajectory = started(ball, 0, &q, &u);
    exponents_of(trajectory, end, NULL, exponents);
    assert_true(fabs(exponents[0]) < 2 * log(end) / end);
    assert_true(fabs(exponents[0]) > 0.2 * log(end) / end);
    assert_close(exponents[0] + exponents[1], 0, 1e-10);
    ric_trajectory_destroy(&trajectory);
  }
  ric_system_destroy(&ball);
}

static void history_sees_every_interval_and_may_end_the_run(void **state) {
  (void)state;
  records r = {0};
  double exponents[2], q = 0.5, u = 0;
  ric_system *ball = falling_ball(0.9);
  ric_trajectory *trajectory = started(ball, 0, &q, &u);
  ric_lyapunov_options options = ric_lyapunov_options_default();
  options.interval = 0.25;
  options.history = keep;
  options.user = &r;
  ric_lyapunov l = exponents_of(trajectory, 5, &options, exponents);
  assert_int_equal(l.run.outcome, RIC_RUN_ENDED);
  assert_int_equal(r.count, 10);
  assert_close(l.time, 2.5, 1e-12);
  assert_true(r.last == exponents[0]);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&ball);
}

/* x'' + 40 x' + x = 0 for the default interval: one direction shrinks by e^-40 in it. */
static void strong_damping_puts_nothing_out(void **state) {
  (void)state;
  double exponents[2], q = 0.5, u = 0, root = sqrt(399.0);
  ric_lattice mass = ric_lattice_default(1, RIC_ENDS_FREE);
  mass.on_site.damping = 40;
  ric_system *system = lattice_system(&mass, NULL, 0);
  ric_trajectory *trajectory = started(system, 0, &q, &u);
  ric_lyapunov_options options = ric_lyapunov_options_default();
  options.transient = 5;
  exponents_of(trajectory, 25, &options, exponents);
  assert_close(exponents[0], -20 + root, 1e-9);
  assert_close(exponents[1], -20 - root, 1e-9);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

static void rest_puts_directions_out(void **state) {
  (void)state;
  double exponents[2], q = 0.5, u = 0;
  ric_system *ball = falling_ball(0.3);
  ric_trajectory *trajectory = started(ball, 0, &q, &u);
  ric_lyapunov l = exponents_of(trajectory, 10, NULL, exponents);
  assert_int_equal(l.run.outcome, RIC_RUN_COMPLETED);
  assert_true(exponents[0] == -INFINITY && exponents[1] == -INFINITY);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&ball);
}

static void bad_options_are_refused(void **state) {
  (void)state;
  double exponents[2], q = 0.5, u = 0;
  ric_system *ball = falling_ball(0.3);
  ric_trajectory *trajectory = started(ball, 0, &q, &u);
  ric_lyapunov l;
  ric_error error;
  static const struct {
    ric_lyapunov_options options;
    const char *text;
  } bad[] = {{{.interval = 0}, "interval = 0"},
             {{.interval = 1, .count = 3}, "count = 3, expected at most 2"},
             {{.interval = 1, .transient = -1}, "transient = -1"}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    assert_int_equal(ric_lyapunov_run(trajectory, 1, &bad[k].options, exponents, &l, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, bad[k].text));
  }
  assert_int_equal(ric_lyapunov_run(trajectory, -1, NULL, exponents, &l, &error), RIC_EINVAL);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&ball);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exponents_of_a_forced_orbit_are_logarithms_of_its_multipliers),
      cmocka_unit_test(exponents_add_up_to_the_divergence),
      cmocka_unit_test(exponents_of_conservative_motion_vanish_like_ln_t_over_t),
      cmocka_unit_test(history_sees_every_interval_and_may_end_the_run),
      cmocka_unit_test(strong_damping_puts_nothing_out),
      cmocka_unit_test(rest_puts_directions_out),
      cmocka_unit_test(bad_options_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

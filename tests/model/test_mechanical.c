/* Mechanical systems of a user: rates, gaps, impulses and contact forces against equations written another way. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "model/system_model.h"
#include "scenario/random_source.h"

/* A double pendulum before a wall that moves: angles from the vertical; the gap is that of the lower mass. */
static const double m1 = 1, m2 = 0.6, l1 = 1, l2 = 0.7, gravity = 9.81;
static const double wall = 1.2, wall_amplitude = 0.3, wall_frequency = 2.5;

static int pendulum_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)user;
  M[0] = (m1 + m2) * l1 * l1;
  M[1] = M[2] = m2 * l1 * l2 * cos(q[0] - q[1]);
  M[3] = m2 * l2 * l2;
  return 0;
}

static int pendulum_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)user;
  double s = m2 * l1 * l2 * sin(q[0] - q[1]);
  f[0] = -s * u[1] * u[1] - (m1 + m2) * gravity * l1 * sin(q[0]);
  f[1] = s * u[0] * u[0] - m2 * gravity * l2 * sin(q[1]);
  return 0;
}

static int pendulum_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle, (void)user;
  *h = wall + wall_amplitude * cos(wall_frequency * t) - l1 * sin(q[0]) - l2 * sin(q[1]);
  return 0;
}

static int pendulum_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time,
                             void *user) {
  (void)obstacle, (void)user;
  gradient[0] = -l1 * cos(q[0]);
  gradient[1] = -l2 * cos(q[1]);
  *in_time = -wall_amplitude * wall_frequency * sin(wall_frequency * t);
  return 0;
}

static const ric_mechanical pendulum = {.coordinates = 2,
                                        .speeds = 2,
                                        .obstacles = 1,
                                        .mass = pendulum_mass,
                                        .force = pendulum_force,
                                        .gap = pendulum_gap,
                                        .gap_gradient = pendulum_gradient};

static ric_system *system_of(const ric_mechanical *model) {
  ric_system *s = NULL;
  ric_error error = {0};
  if (ric_system_create_mechanical(model, &s, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return s;
}

static void random_state(random_source *source, double *t, double *q, double *u, size_t n) {
  *t = random_uniform(source, 0, 10);
  for (size_t i = 0; i < n; i++) {
    q[i] = random_uniform(source, -3, 3);
    u[i] = random_uniform(source, -2, 2);
  }
}

/* Accelerations solved by hand. */
static void pendulum_accelerations(const double *q, const double *u, double *a) {
  double d = q[0] - q[1], below = 2 * m1 + m2 - m2 * cos(2 * d);
  a[0] = (-gravity * (2 * m1 + m2) * sin(q[0]) - m2 * gravity * sin(q[0] - 2 * q[1]) -
          2 * sin(d) * m2 * (u[1] * u[1] * l2 + u[0] * u[0] * l1 * cos(d))) /
         (l1 * below);
  a[1] = 2 * sin(d) *
         (u[0] * u[0] * l1 * (m1 + m2) + gravity * (m1 + m2) * cos(q[0]) + u[1] * u[1] * l2 * m2 * cos(d)) /
         (l2 * below);
}

static void rates_are_those_of_the_lagrangian_equations(void **state) {
  (void)state;
  ric_system *s = system_of(&pendulum);
  random_source source = {.state = 21};
  for (int k = 0; k < 200; k++) {
    double t, q[2], u[2], a[2], q_rate[2], u_rate[2];
    random_state(&source, &t, q, u, 2);
    pendulum_accelerations(q, u, a);
    assert_int_equal(ric_system_rate(s, t, q, u, q_rate, u_rate, NULL), RIC_OK);
    for (int i = 0; i < 2; i++) {
      assert_true(q_rate[i] == u[i]);
      assert_close(u_rate[i], a[i], 1e-13 * (1 + fabs(a[0]) + fabs(a[1])));
    }
  }
  ric_system_destroy(&s);
}

/* Differences err by h^4 / 480 = 2e-15 times a fifth derivative of at most 100 (from w = 2.5), and by rounding, eps * h
 * in size 4 over a step of 1e-3: 1e-12 in all. */
static void gap_rates_by_differences_agree_with_the_gradient(void **state) {
  (void)state;
  ric_mechanical without = pendulum;
  without.gap_gradient = NULL;
  ric_system *s = system_of(&pendulum), *d = system_of(&without);
  random_source source = {.state = 22};
  for (int k = 0; k < 200; k++) {
    double t, q[2], u[2];
    random_state(&source, &t, q, u, 2);
    double rate =
        -l1 * cos(q[0]) * u[0] - l2 * cos(q[1]) * u[1] - wall_amplitude * wall_frequency * sin(wall_frequency * t);
    assert_close(ric_system_gap_rate(s, 0, t, q, u), rate, 1e-14);
    assert_close(ric_system_gap_rate(d, 0, t, q, u), rate, 1e-11);
  }
  ric_system_destroy(&s);
  ric_system_destroy(&d);
}

static void gap_accelerations_agree_with_the_closed_form(void **state) {
  (void)state;
  ric_mechanical without = pendulum;
  without.gap_gradient = NULL;
  ric_system *s = system_of(&pendulum), *d = system_of(&without);
  random_source source = {.state = 23};
  for (int k = 0; k < 200; k++) {
    double t, q[2], u[2], q_rate[2], u_rate[2], found;
    random_state(&source, &t, q, u, 2);
    assert_int_equal(ric_system_rate(s, t, q, u, q_rate, u_rate, NULL), RIC_OK);
    double exact = -wall_amplitude * wall_frequency * wall_frequency * cos(wall_frequency * t);
    for (int i = 0; i < 2; i++)
      exact += (i ? l2 : l1) * (sin(q[i]) * u[i] * u[i] - cos(q[i]) * u_rate[i]);
    assert_null(s->model->gap_acceleration(s, 0, t, q, u, q_rate, u_rate, &found));
    assert_close(found, exact, 1e-11 * (1 + fabs(u_rate[0]) + fabs(u_rate[1])));
    assert_null(d->model->gap_acceleration(d, 0, t, q, u, q_rate, u_rate, &found));
    assert_close(found, exact, 2e-9 * (1 + fabs(u_rate[0]) + fabs(u_rate[1])));
  }
  ric_system_destroy(&s);
  ric_system_destroy(&d);
}

/* Three coordinates, two speeds, with B and b that depend on place and time. */
static int frame_kinematics(double t, const double *q, double *B, double *b, void *user) {
  (void)user;
  const double values[] = {cos(q[2]), 0.1, sin(q[2]), q[0], 0.3, 1};
  memcpy(B, values, sizeof values);
  b[0] = sin(t), b[1] = 0.5 * q[1], b[2] = 0.2;
  return 0;
}

static int frame_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  M[0] = 2, M[1] = M[2] = 0.5, M[3] = 1;
  return 0;
}

static int no_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = f[1] = 0;
  return 0;
}

static int frame_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle, (void)user;
  *h = q[0] * q[0] + 2 * q[1] * q[2] - t;
  return 0;
}

static const ric_mechanical frame = {.coordinates = 3,
                                     .speeds = 2,
                                     .obstacles = 1,
                                     .mass = frame_mass,
                                     .force = no_force,
                                     .kinematics = frame_kinematics,
                                     .gap = frame_gap};

/* [FN97] (2.9): the impulse -(1 + e) h' / (g^T M^-1 g) along g turns the gap rate h' into -e h'. */
static void impulses_along_the_direction_turn_the_gap_rate(void **state) {
  (void)state;
  ric_system *s = system_of(&frame);
  random_source source = {.state = 24};
  for (int k = 0; k < 100; k++) {
    double t, q[3], u[3], B[6], b[3], g[2], w[2];
    random_state(&source, &t, q, u, 3);
    frame_kinematics(t, q, B, b, NULL);
    const double gradient[] = {2 * q[0], 2 * q[2], 2 * q[1]};
    double rate = -1;
    for (int i = 0; i < 3; i++)
      rate += gradient[i] * (B[2 * i] * u[0] + B[2 * i + 1] * u[1] + b[i]);
    contact_direction d = {.g = g, .w = w};
    assert_null(s->model->direction(s, 0, t, q, &d));
    assert_int_equal(d.first, 0);
    assert_int_equal(d.count, 2);
    assert_close(2 * w[0] + 0.5 * w[1], g[0], 1e-13 * (1 + fabs(g[0])));
    assert_close(0.5 * w[0] + w[1], g[1], 1e-13 * (1 + fabs(g[1])));
    assert_close(g[0] * u[0] + g[1] * u[1] + d.offset, rate, 1e-10);
    double e = 0.7, impulse = -(1 + e) * rate / (g[0] * w[0] + g[1] * w[1]);
    const double after[] = {u[0] + impulse * w[0], u[1] + impulse * w[1]};
    assert_close(ric_system_gap_rate(s, 0, t, q, after), -e * rate, 1e-9);
  }
  ric_system_destroy(&s);
}

/* A bead of mass 2 inside a circle of radius 1.5, in Cartesian coordinates; obstacle 1 is the same circle again. */
static const double bead = 2, radius = 1.5;

static int bead_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  M[0] = M[3] = bead;
  M[1] = M[2] = 0;
  return 0;
}

static int bead_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = 0;
  f[1] = -bead * gravity;
  return 0;
}

static int bead_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = radius - hypot(q[0], q[1]);
  return 0;
}

static int bead_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)obstacle, (void)user;
  gradient[0] = -q[0] / hypot(q[0], q[1]);
  gradient[1] = -q[1] / hypot(q[0], q[1]);
  *in_time = 0;
  return 0;
}

/* The force is bead (v^2 / R + g cos a) at angle a from the bottom; what remains is a pendulum. */
static void check_bead(const ric_system *s, const unsigned char *contact, size_t carrier, double tolerance) {
  for (double a = -1.4; a < 3; a += 0.2) {
    double v = 2 + a, q[] = {radius * sin(a), -radius * cos(a)}, u[] = {v * cos(a), v * sin(a)}, q_rate[2], u_rate[2];
    double lambda, along = -gravity * sin(a), inwards = v * v / radius;
    assert_null(s->model->reaction(s, contact, carrier, 0, q, u, &lambda));
    assert_close(lambda, bead * (inwards + gravity * cos(a)), tolerance);
    assert_null(s->model->rate(s, contact, 0, q, u, q_rate, u_rate));
    assert_close(u_rate[0], along * cos(a) - inwards * sin(a), tolerance);
    assert_close(u_rate[1], along * sin(a) + inwards * cos(a), tolerance);
  }
}

static void held_bead_feels_the_force_of_its_circle(void **state) {
  (void)state;
  ric_mechanical model = {.coordinates = 2,
                          .speeds = 2,
                          .obstacles = 2,
                          .mass = bead_mass,
                          .force = bead_force,
                          .gap = bead_gap,
                          .gap_gradient = bead_gradient};
  const unsigned char one[] = {CONTACT_OPEN, CONTACT_HELD}, both[] = {CONTACT_HELD, CONTACT_HELD};
  ric_system *s = system_of(&model);
  check_bead(s, one, 1, 1e-9);
  check_bead(s, both, 0, 1e-9); /* the second contact depends on the first, which carries all */
  ric_system_destroy(&s);
  model.gap_gradient = NULL;
  s = system_of(&model);
  check_bead(s, one, 1, 1e-7);
  ric_system_destroy(&s);
}

/* Two planes that are not at right angles, the gaps of a particle of unit mass. */
static int corner_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)user;
  *h = obstacle ? q[1] : 0.6 * q[0] + 0.8 * q[1];
  return 0;
}

static int corner_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = -1.2, f[1] = -3;
  return 0;
}

static void particle_in_a_corner_is_held_by_both_planes(void **state) {
  (void)state;
  ric_mechanical model = {.coordinates = 2, .speeds = 2, .obstacles = 2, .force = corner_force, .gap = corner_gap};
  const unsigned char both[] = {CONTACT_HELD, CONTACT_HELD};
  ric_system *s = system_of(&model);
  double q[] = {0, 0}, u[] = {0, 0}, q_rate[2], u_rate[2], first, second;
  assert_false(s->uncoupled);
  assert_null(s->model->rate(s, both, 0, q, u, q_rate, u_rate));
  assert_close(u_rate[0], 0, 1e-9);
  assert_close(u_rate[1], 0, 1e-9);
  assert_null(s->model->reaction(s, both, 0, 0, q, u, &first));
  assert_null(s->model->reaction(s, both, 1, 0, q, u, &second));
  assert_close(first, 2, 1e-9); /* 0.6 first = 1.2, 0.8 first + second = 3 */
  assert_close(second, 1.4, 1e-9);
  ric_system_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rates_are_those_of_the_lagrangian_equations),
      cmocka_unit_test(gap_rates_by_differences_agree_with_the_gradient),
      cmocka_unit_test(gap_accelerations_agree_with_the_closed_form),
      cmocka_unit_test(impulses_along_the_direction_turn_the_gap_rate),
      cmocka_unit_test(held_bead_feels_the_force_of_its_circle),
      cmocka_unit_test(particle_in_a_corner_is_held_by_both_planes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

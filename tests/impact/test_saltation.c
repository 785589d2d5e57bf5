/* Tangent vectors through impacts, against differences of event-driven runs. */
#include "support.h"

#include "witness/derivative.h"
#include "witness/double_pendulum.h"
#include "witness/random_lattice.h"
#include "witness/recorded_run.h"

enum { MOST = 8, SIZE = 4 * MOST * MOST };

/* Compares both derivatives of a run. What differences with a step allow is told by those with half of it, and by
 * `bound`, the runs' own error over the step, which grows with the derivatives. */
typedef struct comparison {
  size_t compared, impacts;
  double worst;
} comparison;

static size_t impacts_of(const ric_system *system, const ric_trajectory_options *options, const double *x, double end) {
  size_t n = ric_system_coordinates(system);
  recorded_run r = record_run(system, options, x, x + n, end);
  size_t impacts = recorded_run_impacts(&r);
  recorded_run_clear(&r);
  return impacts;
}

static void compare(comparison *c, const ric_system *system, const ric_trajectory_options *options, const double *x,
                    double end, double step, double bound) {
  static double D[SIZE], coarse[SIZE], fine[SIZE];
  size_t size = ric_system_coordinates(system) + ric_system_speeds(system);
  int order = step > 1e-5 ? 4 : 2;
  assert_int_equal(derivative_by_tangents(system, options, 0, x, end, D), RIC_RUN_COMPLETED);
  derivative_by_differences(system, options, 0, x, end, step, order, coarse);
  derivative_by_differences(system, options, 0, x, end, step / 2, order, fine);
  double error = derivative_error(D, fine, size), allowed = derivative_error(coarse, fine, size), growth = 1;
  for (size_t i = 0; i < size * size; i++)
    growth = fmax(growth, fabs(D[i]));
  if (!(error <= allowed + bound * growth))
    fail_msg("case %zu: off by %g, differences by %g, derivatives up to %g", c->compared, error, allowed, growth);
  c->compared++;
  c->impacts += impacts_of(system, options, x, end);
  c->worst = fmax(c->worst, error / growth);
}

static size_t random_obstacles(random_source *source, size_t n, int elastic, ric_obstacle *obstacles) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    double e = elastic ? 1 : random_uniform(source, 0.3, 1);
    if (random_below(source, 3) > 0) {
      obstacles[count] = ric_obstacle_floor(i, random_uniform(source, -0.6, -0.4));
      obstacles[count++].restitution = e;
    }
    if (random_below(source, 3) == 0) {
      obstacles[count] = ric_obstacle_wall(i, random_uniform(source, 0.7, 1));
      obstacles[count++].restitution = e;
    }
  }
  return count;
}

static void tangents_pass_impacts_of_lattices(void **state) {
  (void)state;
  comparison c = {0};
  for (uint64_t seed = 0; seed < 150; seed++) {
    static random_lattice r;
    random_source source = {.state = seed};
    size_t n = 1 + random_below(&source, MOST);
    double x[2 * MOST];
    ric_obstacle obstacles[2 * MOST];
    random_lattice_set(&r, &source, n, (ric_ends)(seed % 3), seed % 5 ? WITH_ALL : 0);
    size_t count = random_obstacles(&source, n, seed % 2 == 0, obstacles);
    for (size_t i = 0; i < 2 * n; i++)
      x[i] = i < n ? random_uniform(&source, -0.35, 0.6) : random_uniform(&source, -1, 1);
    ric_system *system = lattice_system(&r.lattice, obstacles, count);
    compare(&c, system, NULL, x, 8, 1e-6, 1e-8);
    ric_system_destroy(&system);
  }
  print_message("[ %zu runs, %zu impacts, worst %g ]\n", c.compared, c.impacts, c.worst);
  assert_true(c.impacts > 300);
}

/* Contacts that give way: nothing jumps, but the stiffness begins like a square root. */
static void tangents_pass_hertz_contacts(void **state) {
  (void)state;
  static const double mass[] = {2, 0.5, 0.5, 1}, stiffness[] = {2, -1, -1, 2.5}, force[] = {0.4, 0};
  const ric_mck model = {
      .coordinates = 2, .mass.values = mass, .stiffness.values = stiffness, .frequency = 1.3, .force_cos = force};
  comparison taylor = {0}, cvodes = {0};
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow.method = RIC_FLOW_CVODES;
  options.flow.tolerance = 1e-13;
  for (uint64_t seed = 0; seed < 24; seed++) {
    static random_lattice r;
    random_source source = {.state = seed};
    double x[4];
    ric_obstacle obstacles[4];
    ric_system *system = NULL;
    size_t count = random_obstacles(&source, 2, 1, obstacles);
    for (size_t i = 0; i < count; i++)
      obstacles[i].stiffness = random_uniform(&source, 10, 500);
    for (int i = 0; i < 4; i++)
      x[i] = random_uniform(&source, -0.4, 1);
    random_lattice_set(&r, &source, 2, RIC_ENDS_FIXED, seed % 3 ? WITH_ALL : 0);
    if (seed % 2)
      assert_int_equal(ric_system_create_mck(&model, obstacles, count, &system, NULL), RIC_OK);
    else
      system = lattice_system(&r.lattice, obstacles, count);
    compare(&taylor, system, NULL, x, 5, 1e-6, 1e-7);
    if (seed < 8)
      compare(&cvodes, system, &options, x, 5, 1e-5, 1e-6);
    ric_system_destroy(&system);
  }
  print_message("[ worst %g with taylor, %g with cvodes ]\n", taylor.worst, cvodes.worst);
}

/* Masses that share inertia: one impulse moves all. */
static void tangents_pass_impacts_of_coupled_masses(void **state) {
  (void)state;
  comparison c = {0};
  for (uint64_t seed = 0; seed < 30; seed++) {
    random_source source = {.state = seed};
    ric_obstacle sides[6];
    double x[6];
    size_t count = random_obstacles(&source, 3, seed % 2 == 0, sides);
    for (int i = 0; i < 6; i++)
      x[i] = random_uniform(&source, -0.35, 0.6);
    ric_system *system = coupled_masses(sides, count);
    compare(&c, system, NULL, x, 12, 1e-6, 1e-8);
    ric_system_destroy(&system);
  }
  print_message("[ %zu runs, %zu impacts, worst %g ]\n", c.compared, c.impacts, c.worst);
  assert_true(c.impacts > 50);
}

/* A double pendulum before a wall that moves. The inverse of its mass matrix and the gap's
 * gradient depend on the angles: the impact map's derivative has parts from all of them. */
typedef struct pendulum {
  double restitution, amplitude;
} pendulum;

static int pendulum_force(double t, const double *q, const double *u, double *f, void *user) {
  double_pendulum_force(t, q, u, f, user);
  f[0] -= 0.1 * u[0];
  return 0;
}

static int pendulum_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle;
  *h = 0.3 + ((const pendulum *)user)->amplitude * sin(2 * t) - sin(q[0]) - sin(q[1]);
  return 0;
}

/* The same as x' = F(x, t) with an impact map. */
static int pendulum_rate(double t, const double *x, double *rate, void *user) {
  double f[2];
  pendulum_force(t, x, x + 2, f, user);
  rate[0] = x[2];
  rate[1] = x[3];
  double_pendulum_solve(x, f, rate + 2);
  return 0;
}

static int pendulum_impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  const pendulum *a = user;
  (void)obstacle;
  double gap_rate = -cos(x[0]) * x[2] - cos(x[1]) * x[3] + 2 * a->amplitude * cos(2 * t);
  memcpy(after, x, 4 * sizeof *x);
  double_pendulum_hit(x, a->restitution, gap_rate, after + 2);
  return 0;
}

static ric_system *pendulum_system(pendulum *a, int first_order) {
  ric_system *system = NULL;
  if (first_order) {
    ric_first_order model = {
        .states = 4, .obstacles = 1, .rate = pendulum_rate, .gap = pendulum_gap, .impact = pendulum_impact, .user = a};
    assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
    return system;
  }
  ric_mechanical model = {.coordinates = 2,
                          .speeds = 2,
                          .obstacles = 1,
                          .restitution = &a->restitution,
                          .mass = double_pendulum_mass,
                          .force = pendulum_force,
                          .gap = pendulum_gap,
                          .user = a};
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  return system;
}

static void tangents_pass_impacts_in_generalised_coordinates(void **state) {
  (void)state;
  comparison c = {0};
  ric_trajectory_options options = ric_trajectory_options_default();
  options.flow.tolerance = 1e-14;
  for (uint64_t seed = 0; seed < 24; seed++) {
    random_source source = {.state = seed};
    pendulum a = {.restitution = seed % 3 ? 0.8 : 1, .amplitude = seed % 2 ? 0.15 : 0};
    double x[4];
    for (int i = 0; i < 4; i++)
      x[i] = random_uniform(&source, -0.8, 0);
    ric_system *system = pendulum_system(&a, seed % 4 == 3);
    compare(&c, system, &options, x, 5, 3e-4, 1e-7);
    ric_system_destroy(&system);
  }
  print_message("[ %zu runs, %zu impacts, worst %g ]\n", c.compared, c.impacts, c.worst);
  assert_true(c.impacts >= 24);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangents_pass_impacts_of_lattices),
      cmocka_unit_test(tangents_pass_hertz_contacts),
      cmocka_unit_test(tangents_pass_impacts_of_coupled_masses),
      cmocka_unit_test(tangents_pass_impacts_in_generalised_coordinates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

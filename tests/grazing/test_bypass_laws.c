/* Coefficients of grazing, and impact maps of users. */
#include "support.h"

#include "witness/double_pendulum.h"
#include "grazing_point.h"

/* --- coefficients ------------------------------------------------------------------------------------------------- */

static double psi_at(ric_bypass *b, double t, const double *x) {
  ric_bypass_seen seen;
  assert_int_equal(ric_bypass_look(b, t, x, &seen, NULL), RIC_OK);
  return seen.psi;
}

/* At grazing the gradient of psi is that of the gap, and h'' at the minimum is A_g. */
static void eta_and_acceleration_match_differences_of_the_minimum(void **state) {
  (void)state;
  const double step = 1e-4;
  for (int kind = 0; kind < GRAZING_KINDS; kind++) {
    grazing_point p;
    ric_bypass_seen seen;
    grazing_point_make(&p, (grazing_kind)kind, 0.8, 41);
    ric_bypass *b = bypass_within(p.system, 1);
    assert_int_equal(ric_bypass_look(b, p.t, p.x, &seen, NULL), RIC_OK);
    assert_close(seen.psi, 0, 1e-15);
    assert_close(seen.curvature, p.local.acceleration, 1e-9);
    assert_close(p.local.gap, 0, 1e-15);
    assert_close(p.local.rate, 0, 1e-12);
    for (size_t i = 0; i < p.numbers; i++) {
      double x[GRAZING_MOST], above;
      memcpy(x, p.x, sizeof x);
      x[i] += step;
      above = psi_at(b, p.t, x);
      x[i] = p.x[i] - step;
      assert_close((above - psi_at(b, p.t, x)) / (2 * step), p.local.eta[i], 1e-6);
    }
    ric_bypass_destroy(&b);
    grazing_point_clear(&p);
  }
}

/* Of states a little before and after the minimum, straight on from it. */
static void tau_counts_from_the_time_of_the_state(void **state) {
  (void)state;
  for (int kind = 0; kind < GRAZING_KINDS; kind++) {
    grazing_point p;
    double F[GRAZING_MOST], x[GRAZING_MOST], step = 1e-4;
    grazing_point_make(&p, (grazing_kind)kind, 0.8, 43);
    ric_bypass *b = bypass_within(p.system, 1);
    size_t n = ric_system_coordinates(p.system);
    assert_int_equal(ric_system_rate(p.system, p.t, p.x, p.x + n, F, F + n, NULL), RIC_OK);
    for (int side = -1; side <= 1; side += 2) {
      ric_bypass_seen seen;
      for (size_t i = 0; i < p.numbers; i++)
        x[i] = p.x[i] + side * step * F[i];
      assert_int_equal(ric_bypass_look(b, p.t + side * step, x, &seen, NULL), RIC_OK);
      assert_close(seen.tau, -side * step, 100 * step * step);
    }
    ric_bypass_destroy(&b);
    grazing_point_clear(&p);
  }
}

static void restitution_of_every_law_is_found(void **state) {
  (void)state;
  for (int kind = 0; kind < GRAZING_KINDS; kind++)
    for (int k = 0; k <= 5; k++) {
      grazing_point p;
      grazing_point_make(&p, (grazing_kind)kind, 0.2 * k, 47);
      assert_close(p.local.restitution, 0.2 * k, 1e-9);
      double across = 0; /* eta xi = 0: positions do not jump */
      for (size_t i = 0; i < p.numbers; i++)
        across += p.local.eta[i] * p.local.xi[i];
      assert_close(across, 0, 1e-9);
      grazing_point_clear(&p);
    }
}

/* --- impact maps -------------------------------------------------------------------------------------------------- */

static void oscillator_as_a_map_has_the_same_bypass(void **state) {
  (void)state;
  random_source source = {3};
  for (int k = 0; k < 100; k++) {
    grazing_point p, q;
    double x[2], a[2], b[2], e = k % 3 ? 0.4 * (k % 3) : 1;
    ric_bypass_seen seen;
    grazing_point_make(&p, GRAZING_ONE_MASS, e, 1);
    grazing_point_make(&q, GRAZING_MAP, e, 1);
    ric_bypass *one = bypass_within(p.system, 1), *other = bypass_within(q.system, 1);
    x[0] = 1 + pow(10, random_uniform(&source, -8, -2));
    x[1] = random_uniform(&source, -0.05, 0.05);
    assert_int_equal(ric_bypass_map(one, p.t, x, a, &seen, NULL), RIC_OK);
    assert_int_equal(ric_bypass_map(other, p.t, x, b, NULL, NULL), RIC_OK);
    assert_true(largest_difference(a, b, 2) <= 1e-13 + 1e-14 / sqrt(-seen.psi));
    assert_true(largest_difference(p.local.xi, q.local.xi, 2) <= 1e-9);
    ric_bypass_destroy(&one);
    ric_bypass_destroy(&other);
    grazing_point_clear(&p);
    grazing_point_clear(&q);
  }
}

/* The double pendulum in first-order form: its restitution, and the wall. */
typedef struct pendulum_law {
  double restitution, wall;
} pendulum_law;

static int pendulum_rate(double t, const double *x, double *rate, void *user) {
  double f[2];
  double_pendulum_force(t, x, x + 2, f, user);
  f[0] += 0.5 * cos(1.3 * t);
  rate[0] = x[2];
  rate[1] = x[3];
  double_pendulum_solve(x, f, rate + 2);
  return 0;
}

static int pendulum_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = ((const pendulum_law *)user)->wall - sin(x[0]) - sin(x[1]);
  return 0;
}

static int pendulum_impact(double t, const double *x, size_t obstacle, double *x_after, void *user) {
  (void)t, (void)obstacle;
  double rate = -cos(x[0]) * x[2] - cos(x[1]) * x[3];
  memcpy(x_after, x, 4 * sizeof *x);
  double_pendulum_hit(x, ((const pendulum_law *)user)->restitution, rate, x_after + 2);
  return 0;
}

static void pendulum_as_a_map_has_the_same_coefficients_and_bypass(void **state) {
  (void)state;
  for (uint64_t seed = 50; seed < 60; seed++) {
    grazing_point p;
    grazing_point_make(&p, GRAZING_PENDULUM, 0.7, seed);
    pendulum_law law = {0.7, p.wall};
    ric_first_order model = {.states = 4,
                             .obstacles = 1,
                             .rate = pendulum_rate,
                             .gap = pendulum_gap,
                             .impact = pendulum_impact,
                             .user = &law};
    ric_system *system = NULL;
    ric_grazing_local local;
    double x[4], a[4], b[4];
    assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
    assert_int_equal(ric_grazing_local_init(&local, 4, NULL), RIC_OK);
    assert_int_equal(ric_grazing_local_find(system, 0, p.t, p.x, &local, NULL), RIC_OK);
    assert_true(largest_difference(local.xi, p.local.xi, 4) <= 1e-8);
    assert_true(largest_difference(local.eta, p.local.eta, 4) <= 1e-10);
    assert_close(local.acceleration, p.local.acceleration, 1e-8);
    ric_bypass *one = bypass_within(p.system, 1), *other = bypass_within(system, 1);
    for (int k = 3; k <= 10; k++) {
      grazing_point_behind(&p, pow(10, -k), x);
      assert_int_equal(ric_bypass_map(one, p.t, x, a, NULL, NULL), RIC_OK);
      assert_int_equal(ric_bypass_map(other, p.t, x, b, NULL, NULL), RIC_OK);
      assert_true(largest_difference(a, b, 4) <= 1e-10 * pow(10, -k / 2.0) + 3e-15 * pow(10, k / 2.0));
    }
    ric_bypass_destroy(&one);
    ric_bypass_destroy(&other);
    ric_grazing_local_clear(&local);
    ric_system_destroy(&system);
    grazing_point_clear(&p);
  }
}

/* A bead on a plane, (x, y, x', y'), pulled off the wall y = 0; what its speeds do at impacts is the user's. */
typedef void (*bead_law)(const double *before, double *after);

static int bead_rate(double t, const double *x, double *rate, void *user) {
  (void)t, (void)user;
  rate[0] = x[2];
  rate[1] = x[3];
  rate[2] = -x[0];
  rate[3] = 2;
  return 0;
}

static int bead_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = x[1];
  return 0;
}

static int bead_impact(double t, const double *x, size_t obstacle, double *x_after, void *user) {
  (void)t, (void)obstacle;
  memcpy(x_after, x, 4 * sizeof *x);
  (*(bead_law *)user)(x + 2, x_after + 2);
  return 0;
}

static ric_system *bead(bead_law *law) {
  ric_first_order model = {
      .states = 4, .obstacles = 1, .rate = bead_rate, .gap = bead_gap, .impact = bead_impact, .user = law};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
  return system;
}

/* Restitution falls with the speed, and the bead is dragged along the wall in proportion to the impulse. */
static void drags(const double *before, double *after) {
  double v = -before[1];
  after[1] = (0.9 - 3 * v + v * v) * v;
  after[0] = before[0] - 0.2 * (v - v * v);
}

static void sticks_in_x(const double *before, double *after) {
  after[1] = -before[1];
  after[0] = 0.25 * before[0]; /* however slow the impact */
}

static void kicks_with_a_root(const double *before, double *after) {
  after[1] = -before[1];
  after[0] = before[0] + 0.3 * sqrt(fabs(before[1]));
}

static void kicks_with_a_logarithm(const double *before, double *after) {
  after[1] = -before[1];
  after[0] = before[0] + (before[1] == 0 ? 0 : 0.3 * before[1] * log(fabs(before[1])));
}

static void passes(const double *before, double *after) {
  after[0] = before[0];
  after[1] = before[1];
}

static const double at_wall[4] = {0.3, 0, 0.8, 0};

static ric_status find_bead(bead_law law, const double *x, ric_grazing_local *local, ric_error *error) {
  ric_system *system = bead(&law);
  assert_int_equal(ric_grazing_local_init(local, 4, NULL), RIC_OK);
  ric_status status = ric_grazing_local_find(system, 0, 0, x, local, error);
  ric_system_destroy(&system);
  return status;
}

/* Also beside grazing, where it is that of the state of zero gap rate. */
static void xi_of_a_map_is_its_one_sided_derivative(void **state) {
  (void)state;
  const double rates[3] = {0, 0.02, -0.02};
  for (size_t k = 0; k < 3; k++) {
    ric_grazing_local local;
    double x[4] = {0.3, 0, 0.8, rates[k]}, expected[4] = {0, 0, -0.2, 1.9};
    assert_int_equal(find_bead(drags, x, &local, NULL), RIC_OK);
    assert_true(largest_difference(local.xi, expected, 4) <= 1e-9);
    assert_close(local.restitution, 0.9, 1e-9);
    assert_close(local.acceleration, 2, 1e-9);
    ric_grazing_local_clear(&local);
  }
}

static void maps_without_a_limit_are_refused_by_size(void **state) {
  (void)state;
  ric_grazing_local local;
  ric_error error = {0};
  assert_refused(find_bead(sticks_in_x, at_wall, &local, &error), RIC_EINVAL, &error,
                 "obstacle 0: the impact map moves the state by 0.6 at the gap rate -");
  assert_non_null(strstr(error.message, "tends to the identity"));
  assert_true(local.acceleration == 0 && local.xi[0] == 0);
  ric_grazing_local_clear(&local);
  assert_refused(find_bead(kicks_with_a_root, at_wall, &local, &error), RIC_EINVAL, &error, "as its power 0.50");
  assert_non_null(strstr(error.message, "obstacle 0: the impact map moves the state by "));
  ric_grazing_local_clear(&local);
  assert_refused(find_bead(kicks_with_a_logarithm, at_wall, &local, &error), RIC_EINVAL, &error,
                 "expected a derivative at vanishing gap rates");
  ric_grazing_local_clear(&local);
  assert_refused(find_bead(passes, at_wall, &local, &error), RIC_EINVAL, &error, "v, expected them >= 0");
  ric_grazing_local_clear(&local);
}

static void laws_that_leave_the_gap_rate_are_refused_by_the_map(void **state) {
  (void)state;
  bead_law law = passes;
  ric_system *system = bead(&law);
  ric_bypass *b = bypass_within(system, 1);
  double x[4] = {0.3, -0.01, 0.8, 0}, image[4] = {7, 7, 7, 7};
  ric_error error = {0};
  assert_refused(ric_bypass_map(b, 0, x, image, NULL, &error), RIC_EINVAL, &error,
                 "obstacle 0: an impact changes the gap rate");
  assert_true(image[0] == 7);
  ric_bypass_destroy(&b);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(eta_and_acceleration_match_differences_of_the_minimum),
      cmocka_unit_test(tau_counts_from_the_time_of_the_state),
      cmocka_unit_test(restitution_of_every_law_is_found),
      cmocka_unit_test(oscillator_as_a_map_has_the_same_bypass),
      cmocka_unit_test(pendulum_as_a_map_has_the_same_coefficients_and_bypass),
      cmocka_unit_test(xi_of_a_map_is_its_one_sided_derivative),
      cmocka_unit_test(maps_without_a_limit_are_refused_by_size),
      cmocka_unit_test(laws_that_leave_the_gap_rate_are_refused_by_the_map),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

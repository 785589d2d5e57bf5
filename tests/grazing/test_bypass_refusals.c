/* Which minimum the bypass map takes, on which systems, and what it refuses. */
#include "support.h"

#include "grazing_point.h"

/* --- which minimum ------------------------------------------------------------------------------------------------ */

/* Nothing moves but the wall: h = q + amplitude cos(w t), with minima at odd multiples of pi / w. */
typedef struct wave {
  double amplitude, w;
} wave;

static int no_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = 0;
  return 0;
}

static int wave_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  const wave *a = user;
  (void)obstacle;
  *h = q[0] + a->amplitude * cos(a->w * t);
  return 0;
}

static int wave_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  const wave *a = user;
  (void)q, (void)obstacle;
  gradient[0] = 1;
  *in_time = -a->amplitude * a->w * sin(a->w * t);
  return 0;
}

static ric_system *waving(wave *a) {
  ric_mechanical model = {.coordinates = 1,
                          .speeds = 1,
                          .obstacles = 1,
                          .force = no_force,
                          .gap = wave_gap,
                          .gap_gradient = wave_gradient,
                          .user = a};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  return system;
}

static void the_minimum_nearest_in_time_is_found(void **state) {
  (void)state;
  const double pi = 3.14159265358979323846;
  random_source source = {61};
  for (int k = 0; k < 300; k++) {
    wave a = {random_uniform(&source, 0.05, 1), random_uniform(&source, 0.5, 30)};
    double t = random_uniform(&source, -3, 3), x[2] = {0, 0}, reach = random_uniform(&source, 0.05, 3);
    double nearest = (2 * floor(a.w * t / (2 * pi)) + 1) * pi / a.w - t;
    ric_system *system = waving(&a);
    ric_bypass *b = bypass_within(system, reach);
    ric_bypass_seen seen;
    ric_error error = {0};
    ric_status status = ric_bypass_look(b, t, x, &seen, &error);
    if (fabs(nearest) > reach)
      assert_refused(status, RIC_ENUMERIC, &error, "the gap has no minimum within");
    else {
      assert_int_equal(status, RIC_OK);
      assert_close(seen.tau, nearest, 1e-13);
      assert_close(seen.psi, -a.amplitude, 1e-14);
      assert_close(seen.curvature, a.amplitude * a.w * a.w, 1e-7 * a.amplitude * a.w * a.w + 1e-9);
      assert_true(isnan(seen.t_C) && seen.gap_rate == 0);
    }
    ric_bypass_destroy(&b);
    ric_system_destroy(&system);
  }
}

static void a_gap_that_never_opens_is_refused(void **state) {
  (void)state;
  wave a = {0.1, 4};
  double x[2] = {-0.5, 0}, image[2];
  ric_error error = {0};
  ric_system *system = waving(&a);
  ric_bypass *b = bypass_within(system, 1);
  assert_refused(ric_bypass_map(b, 0.8, x, image, NULL, &error), RIC_ENUMERIC, &error, "does not open within 1");
  ric_bypass_destroy(&b);
  ric_system_destroy(&system);
}

/* A lattice whose flow hands out its steps in pieces, against another flow. */
static void long_lattices_have_the_map_of_the_other_flow(void **state) {
  (void)state;
  enum { LONG = 600, HIT = 401 };
  static random_lattice r;
  static double x[2 * LONG], image[2 * LONG], other[2 * LONG], rates[2 * LONG];
  random_source source = {71};
  ric_system *system = NULL;
  random_lattice_set(&r, &source, LONG, RIC_ENDS_FIXED, WITH_ALL);
  random_lattice_state(&source, LONG, x, x + LONG);
  x[LONG + HIT] = 0.03;
  assert_int_equal(ric_system_create_lattice(&r.lattice, NULL, 0, &system, NULL), RIC_OK);
  assert_int_equal(ric_system_rate(system, 0.2, x, x + LONG, rates, rates + LONG, NULL), RIC_OK);
  ric_system_destroy(&system);
  int side = rates[LONG + HIT] > 0 ? 1 : -1;
  ric_obstacle o = {
      .coordinate = HIT, .side = side, .position = x[HIT] + side * 1e-2, .stiffness = INFINITY, .restitution = 0.6};
  assert_int_equal(ric_system_create_lattice(&r.lattice, &o, 1, &system, NULL), RIC_OK);
  ric_bypass_options options = ric_bypass_options_default();
  ric_bypass *taylor = bypass_within(system, 1), *cvodes = NULL;
  ric_bypass_seen seen, seen_other;
  options.flow.method = RIC_FLOW_CVODES;
  options.flow.tolerance = 1e-14;
  assert_int_equal(ric_bypass_create(system, 0, &options, &cvodes, NULL), RIC_OK);
  assert_int_equal(ric_bypass_map(taylor, 0.2, x, image, &seen, NULL), RIC_OK);
  assert_int_equal(ric_bypass_map(cvodes, 0.2, x, other, &seen_other, NULL), RIC_OK);
  assert_true(seen.psi < -1e-2 && seen.gap_rate < 0);
  assert_close(seen.psi, seen_other.psi, 1e-12);
  assert_close(largest_difference(image, other, (size_t)2 * LONG), 0, 1e-11);
  ric_bypass_destroy(&taylor);
  ric_bypass_destroy(&cvodes);
  ric_system_destroy(&system);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void obstacles_that_are_unknown_or_compliant_are_refused(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_obstacle o[2] = {ric_obstacle_wall(0, 1), ric_obstacle_wall(1, 1)};
  ric_system *system = NULL;
  ric_bypass *b = NULL;
  ric_grazing_local local;
  ric_error error = {0};
  double x[4] = {1, 0, 0, 0};
  o[1].stiffness = 30;
  assert_int_equal(ric_system_create_lattice(&lattice, o, 2, &system, NULL), RIC_OK);
  assert_int_equal(ric_grazing_local_init(&local, 4, NULL), RIC_OK);
  assert_refused(ric_bypass_create(system, 2, NULL, &b, &error), RIC_EINVAL, &error, "obstacle = 2, expected less");
  assert_refused(ric_bypass_create(system, 1, NULL, &b, &error), RIC_EINVAL, &error, "obstacle 1: stiffness = 30");
  assert_refused(ric_bypass_create(system, 0, NULL, &b, &error), RIC_EINVAL, &error, "runs back in time");
  assert_null(b);
  assert_refused(ric_grazing_local_find(system, 2, 0, x, &local, &error), RIC_EINVAL, &error, "obstacle = 2");
  assert_refused(ric_grazing_local_find(system, 1, 0, x, &local, &error), RIC_EINVAL, &error, "stiffness = 30");
  assert_int_equal(ric_grazing_local_find(system, 0, 0, x, &local, NULL), RIC_OK);
  ric_grazing_local_clear(&local);
  ric_system_destroy(&system);
}

static void options_out_of_range_are_refused(void **state) {
  (void)state;
  const double reaches[4] = {0, -1, NAN, INFINITY};
  wave a = {1, 1};
  ric_system *system = waving(&a);
  ric_bypass_options options = ric_bypass_options_default();
  ric_bypass *b = NULL;
  ric_error error = {0};
  for (size_t k = 0; k < 4; k++) {
    options.reach = reaches[k];
    assert_refused(ric_bypass_create(system, 0, &options, &b, &error), RIC_EINVAL, &error, "reach = ");
    assert_null(b);
  }
  options = ric_bypass_options_default();
  options.flow.method = RIC_FLOW_TAYLOR;
  assert_refused(ric_bypass_create(system, 0, &options, &b, &error), RIC_EINVAL, &error, "flow method = taylor");
  assert_null(b);
  ric_system_destroy(&system);
}

static void states_and_points_that_do_not_fit_are_refused(void **state) {
  (void)state;
  grazing_point p;
  ric_grazing_local small;
  double image[2] = {7, 7}, kappa[2] = {7, 7}, bad[2] = {1, NAN};
  ric_error error = {0};
  grazing_point_make(&p, GRAZING_ONE_MASS, 0.8, 1);
  ric_bypass *b = bypass_within(p.system, 1);
  assert_int_equal(ric_grazing_local_init(&small, 1, NULL), RIC_OK);
  assert_refused(ric_bypass_map(b, p.t, bad, image, NULL, &error), RIC_EINVAL, &error, "u[0] = ");
  assert_refused(ric_bypass_map(b, NAN, p.x, image, NULL, &error), RIC_EINVAL, &error, "t = ");
  assert_refused(ric_bypass_leading(b, &p.local, p.t, bad, image, NULL, &error), RIC_EINVAL, &error, "u[0] = ");
  assert_refused(ric_grazing_local_find(p.system, 0, p.t, bad, &p.local, &error), RIC_EINVAL, &error, "x[1] = ");
  assert_refused(ric_grazing_local_find(p.system, 0, p.t, p.x, &small, &error), RIC_EINVAL, &error, "1 numbers");
  assert_refused(ric_bypass_leading(b, &small, p.t, p.x, image, NULL, &error), RIC_EINVAL, &error, "1 numbers");
  p.local.acceleration = -1;
  assert_refused(ric_bypass_second(b, &p.local, p.t, p.x, kappa, &error), RIC_EINVAL, &error, "grazing = -1");
  assert_refused(ric_bypass_leading(b, &p.local, p.t, p.x, image, NULL, &error), RIC_EINVAL, &error, "grazing = -1");
  assert_true(image[0] == 7 && kappa[0] == 7);
  ric_grazing_local_clear(&small);
  ric_bypass_destroy(&b);
  grazing_point_clear(&p);
}

/* The map may be written over its argument, and follows the numbers of its system. */
static void the_map_follows_its_system(void **state) {
  (void)state;
  grazing_point p;
  double x[2] = {1.01, 0}, image[2];
  ric_obstacle wall = ric_obstacle_wall(0, 1.02);
  grazing_point_make(&p, GRAZING_ONE_MASS, 0.8, 1);
  ric_bypass *b = bypass_within(p.system, 1);
  assert_int_equal(ric_bypass_map(b, p.t, x, image, NULL, NULL), RIC_OK);
  assert_true(largest_difference(x, image, 2) > 0.01);
  assert_int_equal(ric_system_set_obstacles(p.system, &wall, 1, NULL), RIC_OK);
  assert_int_equal(ric_bypass_map(b, p.t, x, x, NULL, NULL), RIC_OK);
  assert_true(x[0] == 1.01 && x[1] == 0);
  wall = ric_obstacle_wall(0, 1);
  wall.restitution = 0.8;
  assert_int_equal(ric_system_set_obstacles(p.system, &wall, 1, NULL), RIC_OK);
  assert_int_equal(ric_bypass_map(b, p.t, x, x, NULL, NULL), RIC_OK);
  assert_memory_equal(x, image, sizeof x);
  ric_bypass_destroy(&b);
  grazing_point_clear(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_minimum_nearest_in_time_is_found),
      cmocka_unit_test(a_gap_that_never_opens_is_refused),
      cmocka_unit_test(long_lattices_have_the_map_of_the_other_flow),
      cmocka_unit_test(obstacles_that_are_unknown_or_compliant_are_refused),
      cmocka_unit_test(options_out_of_range_are_refused),
      cmocka_unit_test(states_and_points_that_do_not_fit_are_refused),
      cmocka_unit_test(the_map_follows_its_system),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Sections near the impacts that a grazing motion has: two masses of which the second hits a wall and the first grazes
 * another one. Curves of grazing that come to where another obstacle is touched. */
#include "support.h"

#include <ricochet/ricochet.h>

static const double two_pi = 6.283185307179586;

enum { NUMBERS = 4 };

/* --- a motion with an impact of its own --- */

typedef struct two_masses {
  ric_lattice lattice;
  ric_obstacle obstacles[2]; /* the wall that is touched, the one that is hit */
  ric_system *system;
  ric_family *family;
  ric_grazing grazing;
} two_masses;

static ric_status move_first(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  two_masses *m = user;
  m->obstacles[0].position = p[0];
  *given = two_pi;
  return ric_system_set_obstacles(system, m->obstacles, 2, error);
}

static void graze(two_masses *m) {
  static const ric_spring links[3] = {{3, 0, 0, 0.2}, {1, 0, 0.1, 0.1}, {0, 0, 0, 0}};
  static const double force[2] = {0.2, 0.9};
  static const size_t hit = 1;
  *m = (two_masses){.lattice = ric_lattice_default(2, RIC_ENDS_FIXED),
                    .obstacles = {ric_obstacle_wall(0, 5), ric_obstacle_wall(1, 1)}};
  m->obstacles[0].restitution = 0.5;
  m->obstacles[1].restitution = 0.7;
  m->lattice.on_site = (ric_spring){0};
  m->lattice.links = links;
  m->lattice.force_cos = force;
  m->lattice.frequency = 1;
  ric_family_problem problem = {
      .motion = {.kind = RIC_MOTION_FORCED, .sequence = &hit, .count = 1, .flow = ric_flow_options_default()},
      .set = move_first,
      .user = m,
      .parameters = 1};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.p_low = 0.01;
  options.curve.p_high = 5;
  options.curve.step = options.curve.step_most = 0.2;
  options.curve.direction = -1;
  assert_int_equal(ric_system_create_lattice(&m->lattice, m->obstacles, 2, &m->system, NULL), RIC_OK);
  problem.system = m->system;
  assert_int_equal(ric_family_create(&problem, &options, &m->family, NULL), RIC_OK);
  const double q[2] = {0.1, 1}, u[2] = {0.1, -0.5}, time = 0.5;
  double z[NUMBERS + 1];
  ric_error error;
  assert_int_equal(ric_shooting_unknowns(ric_family_shooting(m->family)), NUMBERS + 1);
  assert_int_equal(ric_grazing_init(&m->grazing, ric_family_shooting(m->family), NULL), RIC_OK);
  if (ric_family_start(m->family, 5, q, u, &time, two_pi, z, NULL, &error) != RIC_OK ||
      ric_grazing_find(m->family, z, 5, NULL, &m->grazing, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

static void clear(two_masses *m) {
  ric_grazing_clear(&m->grazing);
  ric_family_destroy(&m->family);
  ric_system_destroy(&m->system);
}

static double hit_time(two_masses *m) {
  ric_orbit orbit;
  ric_shooting *s = ric_family_shooting(m->family);
  assert_int_equal(ric_orbit_init(&orbit, 2, ric_shooting_impacts(s), NULL), RIC_OK);
  assert_int_equal(ric_shooting_orbit(s, m->grazing.z, m->grazing.given, &orbit, NULL), RIC_OK);
  const double time = orbit.impact_time[0];
  ric_orbit_clear(&orbit);
  return time;
}

/* One period of the motion that begins at x + z. */
static void run_period(const two_masses *m, double from, const double *x, const double *z, double *next) {
  ric_trajectory *t = NULL;
  ric_run run;
  double begin[NUMBERS];
  for (size_t i = 0; i < NUMBERS; i++)
    begin[i] = x[i] + z[i];
  assert_int_equal(ric_trajectory_create(m->system, NULL, &t, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(t, from, begin, begin + 2, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(t, from + m->grazing.period, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  for (size_t i = 0; i < 2; i++) {
    next[i] = ric_trajectory_q(t)[i] - x[i];
    next[2 + i] = ric_trajectory_u(t)[i] - x[2 + i];
  }
  ric_trajectory_destroy(&t);
}

/* What the map leaves out of a motion that would pass the obstacle by y^2. */
static double left_out(const two_masses *m, const ric_grazing_map *map, double from, const double *x, double y) {
  double z[NUMBERS], by_map[NUMBERS], by_run[NUMBERS], square = 0, most = 0;
  for (size_t i = 0; i < NUMBERS; i++)
    square += map->eta[i] * map->eta[i];
  for (size_t i = 0; i < NUMBERS; i++)
    z[i] = -y * y * map->eta[i] / square;
  ric_grazing_map_step(map, 0, z, by_map);
  run_period(m, from, x, z, by_run);
  for (size_t i = 0; i < NUMBERS; i++)
    most = fmax(most, fabs(by_map[i] - by_run[i]));
  return most;
}

/* Motions a little farther from grazing have their impact on the other side of such sections. */
static void maps_beside_an_impact_are_the_motion_to_third_order(void **state) {
  (void)state;
  static const double beside[] = {-0.02, -0.004, 0.004, 0.02};
  two_masses m;
  ric_error error;
  graze(&m);
  for (size_t k = 0; k < sizeof beside / sizeof *beside; k++) {
    const ric_grazing_plane plane = {.time = fmod(hit_time(&m) + beside[k] + two_pi, two_pi)};
    ric_grazing_map map;
    double x[NUMBERS], errors[3];
    assert_int_equal(ric_grazing_map_init(&map, NUMBERS, NULL), RIC_OK);
    if (ric_grazing_section(m.family, &m.grazing, &plane, &map, NULL, &error) != RIC_OK)
      fail_msg("%s", error.message);
    assert_int_equal(ric_shooting_transfer(ric_family_shooting(m.family), m.grazing.z, m.grazing.given, plane.time,
                                           plane.time, x, NULL, NULL),
                     RIC_OK);
    for (int j = 0; j < 3; j++)
      errors[j] = left_out(&m, &map, plane.time, x, ldexp(1e-3, -j));
    print_message("[ section %g beside the impact: left out %.3g %.3g %.3g ]\n", beside[k], errors[0], errors[1],
                  errors[2]);
    for (int j = 1; j < 3; j++)
      assert_true(errors[j - 1] / errors[j] > 6 && errors[j - 1] / errors[j] < 10);
    ric_grazing_map_clear(&map);
  }
  clear(&m);
}

static void sections_at_an_impact_are_refused(void **state) {
  (void)state;
  two_masses m;
  ric_error error;
  ric_grazing_map map;
  graze(&m);
  const ric_grazing_plane plane = {.time = hit_time(&m)};
  assert_int_equal(ric_grazing_map_init(&map, NUMBERS, NULL), RIC_OK);
  assert_int_equal(ric_grazing_section(m.family, &m.grazing, &plane, &map, NULL, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "at which the motion has an impact"));
  assert_int_equal(ric_grazing_take(m.family, m.grazing.z, 1, 0, INFINITY, NULL, &m.grazing, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "time = inf"));
  ric_grazing_map_clear(&map);
  clear(&m);
}

/* Elastic impacts keep the energy, the one coordinate of the map: it is the identity. The motion has an impact at t =
 * 0: the section is at the touch then. */
static void elastic_touches_leave_the_energy_as_it_was(void **state) {
  (void)state;
  static const size_t hit = 1;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const ric_obstacle obstacles[2] = {ric_obstacle_wall(0, 1), ric_obstacle_floor(0, -0.5)};
  lattice.on_site = (ric_spring){1, 0, 1, 0};
  ric_family_problem problem = {.motion = {.kind = RIC_MOTION_CONSERVATIVE,
                                           .energy_given = true,
                                           .sequence = &hit,
                                           .count = 1,
                                           .flow = ric_flow_options_default()},
                                .parameters = 1};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.p_low = 0.3;
  options.curve.p_high = 5;
  options.curve.step = options.curve.step_most = 0.05;
  ric_family *family = NULL;
  ric_grazing g;
  ric_grazing_map map;
  ric_error error;
  double z[8];
  const double q = -0.5, u = 0.8, time = 0, energy = u * u / 2 + 0.125 + 0.015625;
  assert_int_equal(ric_system_create_lattice(&lattice, obstacles, 2, &problem.system, NULL), RIC_OK);
  assert_int_equal(ric_family_create(&problem, &options, &family, NULL), RIC_OK);
  assert_int_equal(ric_grazing_init(&g, ric_family_shooting(family), NULL), RIC_OK);
  assert_true(ric_shooting_unknowns(ric_family_shooting(family)) <= sizeof z / sizeof *z);
  if (ric_family_start(family, energy, &q, &u, &time, 3.6, z, NULL, &error) != RIC_OK ||
      ric_grazing_find(family, z, energy, NULL, &g, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_close(g.parameter, 0.75, 1e-13);
  assert_close(g.slope, -0.5, 1e-7);
  assert_int_equal(ric_grazing_coordinates(&g, ric_family_shooting(family)), 1);
  assert_int_equal(ric_grazing_map_init(&map, 1, NULL), RIC_OK);
  for (int k = 0; k < 5; k++) {
    const ric_grazing_plane plane = {.time = g.time + 0.3 * k};
    if (ric_grazing_section(family, &g, k > 0 ? &plane : NULL, &map, NULL, &error) != RIC_OK)
      fail_msg("%s", error.message);
    assert_close(map.L[0], 1, 1e-12);
    assert_close(map.xi[0], 0, 1e-13);
    assert_close(map.kappa[0], 0, 1e-7);
  }
  ric_grazing_map_clear(&map);
  ric_grazing_clear(&g);
  ric_family_destroy(&family);
  ric_system_destroy(&problem.system);
}

/* --- x'' + x' + x = p_0 cos t between a wall at 1 and a floor that comes nearer --- */

typedef struct between {
  ric_lattice lattice;
  ric_obstacle obstacles[2];
  double force;
} between;

static double floor_at(double second) {
  return -1 - 0.02 * (1.5 - second);
}

static ric_status move_floor(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  between *b = user;
  b->force = p[0];
  b->obstacles[1].position = floor_at(p[1]);
  *given = two_pi;
  const ric_status status = ric_system_set_lattice(system, &b->lattice, error);
  if (status != RIC_OK)
    return status;
  return ric_system_set_obstacles(system, b->obstacles, 2, error);
}

static int see_touch(const ric_grazing_curve_point *p, void *user) {
  double *last = user;
  assert_close(p->grazing->local.gap, 0, 1e-9);
  *last = p->grazing->second;
  return 0;
}

static void a_curve_ends_where_another_obstacle_is_touched(void **state) {
  (void)state;
  between b = {.lattice = ric_lattice_default(1, RIC_ENDS_FREE),
               .obstacles = {ric_obstacle_wall(0, 1), ric_obstacle_floor(0, -2)},
               .force = 0.5};
  b.lattice.on_site = (ric_spring){1, 0, 0, 1};
  b.lattice.force_cos = &b.force;
  b.lattice.frequency = 1;
  ric_family_problem problem = {.motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                .set = move_floor,
                                .user = &b,
                                .parameters = 2,
                                .second = 1};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.p_low = 0.1;
  options.curve.p_high = 4;
  options.curve.step = options.curve.step_most = 0.15;
  ric_family *family = NULL;
  ric_grazing g;
  ric_curve_run run;
  ric_error error;
  double z[2], last = 1;
  const double rest[2] = {0};
  assert_int_equal(ric_system_create_lattice(&b.lattice, b.obstacles, 2, &problem.system, NULL), RIC_OK);
  assert_int_equal(ric_family_create(&problem, &options, &family, NULL), RIC_OK);
  assert_int_equal(ric_grazing_init(&g, ric_family_shooting(family), NULL), RIC_OK);
  assert_int_equal(ric_family_start(family, 0.5, rest, rest + 1, NULL, two_pi, z, NULL, NULL), RIC_OK);
  if (ric_grazing_find(family, z, 0.5, NULL, &g, &error) != RIC_OK ||
      ric_grazing_trace(family, &g, &options.curve, 3, see_touch, &last, &run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  print_message("[ to a floor at %.9g: %s, %s ]\n", floor_at(last), ric_curve_end_name(run.end), run.reason);
  assert_close(last, 1.5, 1e-2);
  ric_grazing_clear(&g);
  ric_family_destroy(&family);
  ric_system_destroy(&problem.system);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(maps_beside_an_impact_are_the_motion_to_third_order),
                                     cmocka_unit_test(sections_at_an_impact_are_refused),
                                     cmocka_unit_test(elastic_touches_leave_the_energy_as_it_was),
                                     cmocka_unit_test(a_curve_ends_where_another_obstacle_is_touched)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

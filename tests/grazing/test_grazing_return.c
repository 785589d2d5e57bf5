/* The return map with all its coefficients against event-driven runs over a period: forced motions of a linear
 * oscillator, a nonlinear chain of five masses, a system with full M, C and K, and a double pendulum, whose impacts act
 * through a mass matrix that depends on the place and whose gap is curved. What the map leaves out is of third order in
 * the root of the penetration. */
#include "support.h"

#include "witness/double_pendulum.h"
#include "witness/grazing_family.h"

enum { MASSES = 5, MOST = 2 * MASSES };

static const double two_pi = 6.283185307179586;

/* --- systems, driven with the force p_0 --- */

typedef struct driven {
  const char *name;
  ric_system *system;
  ric_lattice lattice;
  ric_mck mck; /* of one without lattice */
  ric_spring links[MASSES + 1];
  double force[MASSES], frequency, wall;
  double low, high; /* the force sets out from `low` */
} driven;

static ric_status set_force(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  driven *d = user;
  d->force[0] = p[0];
  *given = two_pi / d->frequency;
  if (d->mck.coordinates > 0)
    return ric_system_set_mck(system, &d->mck, error);
  return d->lattice.particles > 0 ? ric_system_set_lattice(system, &d->lattice, error) : RIC_OK;
}

static void make_lattice(driven *d, size_t n, size_t wall, double cubic) {
  ric_obstacle obstacle = ric_obstacle_wall(wall, d->wall);
  obstacle.restitution = 0.7;
  d->lattice = ric_lattice_default(n, n > 1 ? RIC_ENDS_FIXED : RIC_ENDS_FREE);
  d->lattice.force_cos = d->force;
  d->lattice.frequency = d->frequency;
  if (n > 1) {
    d->lattice.on_site = (ric_spring){0};
    d->lattice.links = d->links;
  } else {
    d->lattice.on_site = (ric_spring){1, 0, 0, 0.5};
  }
  for (size_t i = 0; i <= n && n > 1; i++)
    d->links[i] = (ric_spring){1 + 0.1 * (double)i, 0, cubic, 0.3};
  assert_int_equal(ric_system_create_lattice(&d->lattice, &obstacle, 1, &d->system, NULL), RIC_OK);
}

/* Three coordinates with a mass matrix that couples all of them, and gyroscopic forces. */
static void make_mck(driven *d) {
  static const double mass[9] = {2, 0.3, 0.2, 0.3, 1.5, 0.4, 0.2, 0.4, 1};
  static const double damping[9] = {0.6, 0.5, 0, -0.5, 0.7, 0.1, 0, 0.1, 0.5};
  static const double stiffness[9] = {3, -1, 0, -1, 2.5, -0.5, 0, -0.5, 1.4};
  ric_obstacle floor = ric_obstacle_floor(2, -d->wall);
  floor.restitution = 0.7;
  d->mck = (ric_mck){.coordinates = 3,
                     .mass = {.values = mass},
                     .damping = {.values = damping},
                     .stiffness = {.values = stiffness},
                     .frequency = d->frequency,
                     .force_cos = d->force};
  assert_int_equal(ric_system_create_mck(&d->mck, &floor, 1, &d->system, NULL), RIC_OK);
}

static int pendulum_force(double t, const double *q, const double *u, double *f, void *user) {
  const driven *d = user;
  int code = double_pendulum_force(t, q, u, f, NULL);
  f[0] += d->force[0] * cos(d->frequency * t) - 0.4 * u[0];
  f[1] -= 0.4 * u[1];
  return code;
}

static int pendulum_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = ((const driven *)user)->wall - sin(q[0]) - sin(q[1]);
  return 0;
}

static void make_pendulum(driven *d) {
  static const double restitution = 0.7;
  const ric_mechanical model = {.coordinates = 2,
                                .speeds = 2,
                                .obstacles = 1,
                                .restitution = &restitution,
                                .mass = double_pendulum_mass,
                                .force = pendulum_force,
                                .gap = pendulum_gap,
                                .user = d};
  assert_int_equal(ric_system_create_mechanical(&model, &d->system, NULL), RIC_OK);
}

/* --- the motion at grazing, and its map --- */

typedef struct grazing_case {
  driven *d;
  grazing_family at;
  ric_grazing_map map;
} grazing_case;

static grazing_case graze(driven *d) {
  grazing_case k = {.d = d};
  const double rest[MOST] = {0};
  const size_t n = ric_system_coordinates(d->system);
  const ric_family_problem problem = {.system = d->system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set_force,
                                      .user = d,
                                      .parameters = 1};
  const ric_family_options options = grazing_family_options(d->low, d->high, 0.2);
  k.at = grazing_family_from(&problem, &options, d->low, rest, rest + n, NULL, two_pi / d->frequency);
  grazing_family_find(&k.at);
  k.map = grazing_family_map(&k.at, NULL);
  return k;
}

static void clear(grazing_case *k) {
  ric_grazing_map_clear(&k->map);
  grazing_family_clear(&k->at);
  ric_system_destroy(&k->d->system);
}

/* One period of the motion that begins at z beside the grazing one. */
static void run_period(const grazing_case *k, const double *z, double *next) {
  const size_t size = k->map.size, n = size / 2;
  const double *x = k->at.grazing.z, period = two_pi / k->d->frequency;
  ric_trajectory *t = NULL;
  ric_run run;
  double begin[MOST];
  for (size_t i = 0; i < size; i++)
    begin[i] = x[i] + z[i];
  assert_int_equal(ric_trajectory_create(k->d->system, NULL, &t, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(t, 0, begin, begin + n, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(t, period, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  for (size_t i = 0; i < n; i++) {
    next[i] = ric_trajectory_q(t)[i] - x[i];
    next[n + i] = ric_trajectory_u(t)[i] - x[n + i];
  }
  ric_trajectory_destroy(&t);
}

/* What the map leaves out of a motion that would pass the obstacle by y^2. */
static double left_out(const grazing_case *k, double y) {
  const ric_grazing_map *m = &k->map;
  double z[MOST], by_map[MOST], by_run[MOST], square = 0, most = 0;
  for (size_t i = 0; i < m->size; i++)
    square += m->eta[i] * m->eta[i];
  for (size_t i = 0; i < m->size; i++)
    z[i] = -y * y * m->eta[i] / square;
  ric_grazing_map_step(m, 0, z, by_map);
  run_period(k, z, by_run);
  for (size_t i = 0; i < m->size; i++)
    most = fmax(most, fabs(by_map[i] - by_run[i]));
  return most;
}

static void the_map_is_the_motion_to_third_order(void **state) {
  (void)state;
  driven all[] = {{.name = "oscillator", .frequency = 1.7, .wall = 1, .low = 0.1, .high = 20},
                  {.name = "five masses", .frequency = 1.3, .wall = 0.6, .low = 0.1, .high = 20},
                  {.name = "full M, C, K", .frequency = 1.6, .wall = 0.3, .low = 0.1, .high = 20},
                  {.name = "double pendulum", .frequency = 1.2, .wall = 0.5, .low = 0.05, .high = 5}};
  make_lattice(&all[0], 1, 0, 0);
  make_lattice(&all[1], MASSES, 2, 0.3);
  make_mck(&all[2]);
  make_pendulum(&all[3]);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    grazing_case k = graze(&all[i]);
    double errors[4];
    for (int j = 0; j < 4; j++)
      errors[j] = left_out(&k, ldexp(0.02, -j));
    print_message("[ %s: force %.9g, A_g = %.6g, left out %.3g %.3g %.3g %.3g ]\n", all[i].name, k.at.grazing.parameter,
                  k.at.grazing.local.acceleration, errors[0], errors[1], errors[2], errors[3]);
    for (int j = 1; j < 4; j++)
      assert_true(errors[j - 1] / errors[j] > 6.5 && errors[j - 1] / errors[j] < 10);
    clear(&k);
  }
}

/* --- windows --- */

enum { TRANSIENT = 4000, LONGEST = 40 };

/* Smallest number of forcing periods after which the settled motion at a force is where it was; 0: none up to the
 * longest. */
static size_t period_of(driven *d, const double *begin, double force) {
  const double period = two_pi / d->frequency;
  double given, seen[LONGEST + 1];
  ric_trajectory *t = NULL;
  ric_run run;
  assert_int_equal(set_force(d->system, &force, &given, d, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(d->system, NULL, &t, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(t, 0, begin, begin + 1, NULL), RIC_OK);
  for (int k = 0; k <= TRANSIENT + LONGEST; k++) {
    assert_int_equal(ric_trajectory_run(t, k * period, NULL, &run, NULL), RIC_OK);
    assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
    if (k >= TRANSIENT)
      seen[k - TRANSIENT] = ric_trajectory_u(t)[0];
  }
  ric_trajectory_destroy(&t);
  for (size_t n = 1; n <= LONGEST; n++)
    if (fabs(seen[n] - seen[0]) < 1e-9)
      return n;
  return 0;
}

/* x'' + 3 x' + x = a cos 4t before a wall: lambda = 0.549, windows of rising periods. In the middle of the map's window
 * the motion has its period; halfway, in ln d, to the next one none of them. */
static void windows_of_the_map_are_those_of_the_motion(void **state) {
  (void)state;
  driven d = {.name = "overdamped", .frequency = 4, .wall = 1, .low = 1, .high = 60};
  make_lattice(&d, 1, 0, 0);
  d.lattice.on_site.damping = 3;
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  wall.restitution = 0.8;
  assert_int_equal(ric_system_set_obstacles(d.system, &wall, 1, NULL), RIC_OK);
  grazing_case k = graze(&d);
  ric_grazing_window w, next;
  for (size_t n = 7; n <= 12; n++) {
    assert_int_equal(ric_grazing_window_find(&k.map, n, &w, NULL), RIC_OK);
    assert_int_equal(ric_grazing_window_find(&k.map, n + 1, &next, NULL), RIC_OK);
    assert_true(w.exists && next.exists);
    const double middle = sqrt(w.low.d * w.high.d), between = sqrt(w.low.d * next.high.d);
    const double in = k.at.grazing.parameter - middle / k.at.grazing.slope;
    const double out = k.at.grazing.parameter - between / k.at.grazing.slope;
    assert_int_equal(period_of(&d, k.at.grazing.z, in), n);
    const size_t beside = period_of(&d, k.at.grazing.z, out);
    print_message("[ window %zu: mu %.6g to %.6g; between it and the next: period %zu ]\n", n,
                  -w.low.d / k.at.grazing.slope / k.at.grazing.parameter,
                  -w.high.d / k.at.grazing.slope / k.at.grazing.parameter, beside);
    assert_true(beside != n && beside != n + 1);
  }
  clear(&k);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_map_is_the_motion_to_third_order),
                                     cmocka_unit_test(windows_of_the_map_are_those_of_the_motion)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

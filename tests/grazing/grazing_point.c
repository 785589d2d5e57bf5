#include "grazing_point.h"

#include "support.h"

#include "witness/double_pendulum.h"

static const double pull = 0.7, pull_frequency = 1.4; /* of the forced oscillator, x'' + 0.1 x' + x = ... */
static const double table_height = 0.2, table_frequency = 3;

static int oscillator_rate(double t, const double *x, double *rate, void *user) {
  (void)user;
  rate[0] = x[1];
  rate[1] = pull * cos(pull_frequency * t) - 0.1 * x[1] - x[0];
  return 0;
}

static int oscillator_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = ((const grazing_point *)user)->wall - x[0];
  return 0;
}

static int oscillator_impact(double t, const double *x, size_t obstacle, double *x_after, void *user) {
  (void)t, (void)obstacle;
  x_after[0] = x[0];
  x_after[1] = -((const grazing_point *)user)->restitution * x[1];
  return 0;
}

static int van_der_pol(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)user;
  f[0] = 0.5 * (1 - q[0] * q[0]) * u[0] - q[0];
  return 0;
}

static int van_der_pol_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = ((const grazing_point *)user)->wall - q[0];
  return 0;
}

static int driven_pendulum(double t, const double *q, const double *u, double *f, void *user) {
  double_pendulum_force(t, q, u, f, user);
  f[0] += 0.5 * cos(1.3 * t);
  return 0;
}

static int pendulum_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = ((const grazing_point *)user)->wall - sin(q[0]) - sin(q[1]);
  return 0;
}

static int pendulum_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time,
                             void *user) {
  (void)t, (void)obstacle, (void)user;
  gradient[0] = -cos(q[0]);
  gradient[1] = -cos(q[1]);
  *in_time = 0;
  return 0;
}

/* Position and heading; speeds forwards and turning. Mass 1, inertia 0.1, the nose 0.4 ahead. */
static int skate_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  M[0] = 1;
  M[1] = M[2] = 0;
  M[3] = 0.1;
  return 0;
}

static int skate_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)user;
  f[0] = -0.2 * u[0];
  f[1] = -0.01 * u[1] * u[0];
  return 0;
}

static int skate_kinematics(double t, const double *q, double *B, double *b, void *user) {
  (void)t, (void)user;
  const double columns[6] = {cos(q[2]), 0, sin(q[2]), 0, 0, 1};
  memcpy(B, columns, sizeof columns);
  b[0] = b[1] = b[2] = 0;
  return 0;
}

static int skate_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle;
  *h = ((const grazing_point *)user)->wall - q[0] - 0.4 * cos(q[2]);
  return 0;
}

static int weight(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = -1;
  return 0;
}

static int table_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle, (void)user;
  *h = q[0] - table_height * sin(table_frequency * t);
  return 0;
}

static int table_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)q, (void)obstacle, (void)user;
  gradient[0] = 1;
  *in_time = -table_height * table_frequency * cos(table_frequency * t);
  return 0;
}

static void make_mechanical(grazing_point *p, ric_mechanical model) {
  model.obstacles = 1;
  model.restitution = &p->restitution;
  model.user = p;
  assert_int_equal(ric_system_create_mechanical(&model, &p->system, NULL), RIC_OK);
}

static void make_map(grazing_point *p) {
  ric_first_order model = {.states = 2,
                           .obstacles = 1,
                           .rate = oscillator_rate,
                           .gap = oscillator_gap,
                           .impact = oscillator_impact,
                           .user = p};
  p->wall = p->x[0];
  assert_int_equal(ric_system_create_first_order(&model, &p->system, NULL), RIC_OK);
}

static void make_one_mass(grazing_point *p) {
  ric_obstacle wall = ric_obstacle_wall(0, p->x[0]);
  p->lattice.lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  p->lattice.lattice.on_site.damping = 0.1;
  p->lattice.lattice.frequency = pull_frequency;
  p->lattice.lattice.force_cos = p->lattice.force_cos;
  p->lattice.force_cos[0] = pull;
  wall.restitution = p->restitution;
  assert_int_equal(ric_system_create_lattice(&p->lattice.lattice, &wall, 1, &p->system, NULL), RIC_OK);
}

static ric_system *masses(const grazing_point *p, grazing_kind kind, const ric_obstacle *obstacles, size_t count) {
  ric_system *system = NULL;
  ric_status status = kind == GRAZING_TWO_MASSES
                          ? ric_system_create_lattice(&p->lattice.lattice, obstacles, count, &system, NULL)
                          : ric_system_create_mck(&p->mck.model, obstacles, count, &system, NULL);
  assert_int_equal(status, RIC_OK);
  return system;
}

/* A random state with one mass at rest, and the obstacle there on the side that it leaves. */
static void make_masses(grazing_point *p, grazing_kind kind, random_source *source) {
  size_t n = kind == GRAZING_TWO_MASSES ? 2 : 5, hit = n - 2;
  double rates[GRAZING_MOST] = {0};
  if (kind == GRAZING_TWO_MASSES)
    random_lattice_set(&p->lattice, source, n, RIC_ENDS_FIXED, WITH_ALL);
  else
    random_mck_make(&p->mck, n, 0, source);
  ric_system *unbounded = masses(p, kind, NULL, 0);
  while (!(fabs(rates[n + hit]) > 0.3)) {
    random_state(source, n, p->x, p->x + n);
    p->x[n + hit] = 0;
    assert_int_equal(ric_system_rate(unbounded, p->t, p->x, p->x + n, rates, rates + n, NULL), RIC_OK);
  }
  ric_system_destroy(&unbounded);
  ric_obstacle o = rates[n + hit] > 0 ? ric_obstacle_floor(hit, p->x[hit]) : ric_obstacle_wall(hit, p->x[hit]);
  o.restitution = p->restitution;
  p->system = masses(p, kind, &o, 1);
}

/* Random angles; speeds along the wall, which curves away from the bob or not: only the first will do. */
static void make_pendulum(grazing_point *p, random_source *source) {
  make_mechanical(p, (ric_mechanical){.coordinates = 2,
                                      .speeds = 2,
                                      .mass = double_pendulum_mass,
                                      .force = driven_pendulum,
                                      .gap = pendulum_gap,
                                      .gap_gradient = pendulum_gradient});
  ric_grazing_local at;
  assert_int_equal(ric_grazing_local_init(&at, 4, NULL), RIC_OK);
  while (!(at.acceleration > 0.5)) {
    double pace = random_uniform(source, -1.5, 1.5);
    p->x[0] = random_uniform(source, 0.1, 0.9);
    p->x[1] = random_uniform(source, 0.1, 0.9);
    p->x[2] = pace * cos(p->x[1]);
    p->x[3] = -pace * cos(p->x[0]);
    p->wall = sin(p->x[0]) + sin(p->x[1]);
    assert_int_equal(ric_grazing_local_find(p->system, 0, p->t, p->x, &at, NULL), RIC_OK);
  }
  ric_grazing_local_clear(&at);
}

/* The ball is overtaken by the table as it comes down, where the table slows down by more than gravity's pull. */
static void make_table(grazing_point *p) {
  make_mechanical(
      p, (ric_mechanical){
             .coordinates = 1, .speeds = 1, .force = weight, .gap = table_gap, .gap_gradient = table_gradient});
  p->x[0] = table_height * sin(table_frequency * p->t);
  p->x[1] = table_height * table_frequency * cos(table_frequency * p->t);
}

/* It turns the nose along the wall and away. */
static void make_skate(grazing_point *p) {
  const double state[5] = {0.2, -0.1, 0.6, 0.4 * tan(0.6) * 1.5, 1.5};
  make_mechanical(p, (ric_mechanical){.coordinates = 3,
                                      .speeds = 2,
                                      .mass = skate_mass,
                                      .force = skate_force,
                                      .kinematics = skate_kinematics,
                                      .gap = skate_gap});
  memcpy(p->x, state, sizeof state);
  p->wall = state[0] + 0.4 * cos(state[2]);
}

void grazing_point_make(grazing_point *p, grazing_kind kind, double restitution, uint64_t seed) {
  random_source source = {seed};
  ric_error error = {0};
  *p = (grazing_point){.t = 0.4, .restitution = restitution, .x = {1, 0}};
  switch (kind) {
  case GRAZING_ONE_MASS:
    make_one_mass(p);
    break;
  case GRAZING_VAN_DER_POL:
    make_mechanical(p, (ric_mechanical){.coordinates = 1, .speeds = 1, .force = van_der_pol, .gap = van_der_pol_gap});
    p->wall = p->x[0] = 1.8;
    break;
  case GRAZING_PENDULUM:
    make_pendulum(p, &source);
    break;
  case GRAZING_TABLE:
    make_table(p);
    break;
  case GRAZING_SKATE:
    make_skate(p);
    break;
  case GRAZING_MAP:
    make_map(p);
    break;
  default:
    make_masses(p, kind, &source);
  }
  p->numbers = ric_system_coordinates(p->system) + ric_system_speeds(p->system);
  assert_int_equal(ric_grazing_local_init(&p->local, p->numbers, NULL), RIC_OK);
  if (ric_grazing_local_find(p->system, 0, p->t, p->x, &p->local, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

void grazing_point_clear(grazing_point *p) {
  ric_grazing_local_clear(&p->local);
  ric_system_destroy(&p->system);
}

void grazing_point_behind(const grazing_point *p, double depth, double *x) {
  double square = 0;
  for (size_t i = 0; i < p->numbers; i++)
    square += p->local.eta[i] * p->local.eta[i];
  for (size_t i = 0; i < p->numbers; i++)
    x[i] = p->x[i] - depth * p->local.eta[i] / square;
}

double largest_difference(const double *a, const double *b, size_t size) {
  double most = 0;
  for (size_t i = 0; i < size; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

ric_bypass *bypass_within(ric_system *system, double reach) {
  ric_bypass *bypass = NULL;
  ric_bypass_options options = ric_bypass_options_default();
  ric_error error = {0};
  options.reach = reach;
  if (ric_bypass_create(system, 0, &options, &bypass, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return bypass;
}

void assert_refused(ric_status status, ric_status expected, const ric_error *error, const char *text) {
  assert_int_equal(status, expected);
  if (!strstr(error->message, text))
    fail_msg("\"%s\", expected \"%s\" in it", error->message, text);
}

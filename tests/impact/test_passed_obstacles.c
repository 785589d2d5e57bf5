/* Motions that pass rigid obstacles move as if these were not there, to the last bit, and Hertz contacts still act. */
#include "support.h"

#include "witness/random_lattice.h"
#include "witness/random_mck.h"
#include "ricochet/ricochet.h"

enum { MOST = 270, COLUMNS = 4 };

/* What a run did, and the coordinates of its events. */
typedef struct seen {
  ric_run run;
  size_t count, coordinates[4096];
  double times[4096];
} seen;

static int see(const ric_event *event, void *user) {
  seen *s = user;
  if (s->count < sizeof s->times / sizeof *s->times) {
    s->coordinates[s->count] = event->coordinate;
    s->times[s->count++] = event->time;
  }
  return 0;
}

static ric_trajectory *moved(const ric_system *system, const ric_trajectory_options *options, const double *x,
                             const double *d, double end, seen *s) {
  size_t n = ric_system_coordinates(system);
  const ric_observer observer = {.event = see, .user = s};
  ric_error error = {0};
  ric_trajectory *trajectory = NULL;
  s->count = 0;
  ric_status status = ric_trajectory_create(system, options, &trajectory, &error);
  if (status == RIC_OK)
    status = ric_trajectory_start(trajectory, 0, x, x + n, &error);
  if (status == RIC_OK)
    status = ric_trajectory_carry(trajectory, COLUMNS, d, d + n * COLUMNS, &error);
  if (status == RIC_OK)
    status = ric_trajectory_run(trajectory, end, &observer, &s->run, &error);
  if (status != RIC_OK)
    fail_msg("%s", error.message);
  return trajectory;
}

/* Floors of both kinds in turn, and the compliant ones alone. @returns how many are compliant */
static size_t mixed_floors(random_source *source, size_t n, ric_obstacle *all, ric_obstacle *compliant) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    all[i] = ric_obstacle_floor(i, random_uniform(source, -0.6, 0.2));
    all[i].stiffness = i % 2 ? INFINITY : 30;
    if (i % 2 == 0)
      compliant[count++] = all[i];
  }
  return count;
}

/* One run that passes the rigid obstacles, one without them. @returns the number of events */
static size_t check_passes(const ric_system *system, const ric_system *witness, ric_flow_method method,
                           random_source *source, double end) {
  static double x[2 * MOST], d[2 * MOST * COLUMNS];
  static seen s, w;
  size_t n = ric_system_coordinates(system), bytes = n * sizeof(double);
  ric_trajectory_options options = ric_trajectory_options_default(), passing = options;
  random_lattice_state(source, n, x, x + n);
  for (size_t i = 0; i < 2 * n * COLUMNS; i++)
    d[i] = random_uniform(source, -1, 1);
  options.flow.method = passing.flow.method = method;
  passing.pass_rigid = true;
  ric_trajectory *a = moved(system, &passing, x, d, end, &s), *b = moved(witness, &options, x, d, end, &w);
  assert_string_equal(ric_run_outcome_name(s.run.outcome), ric_run_outcome_name(w.run.outcome));
  assert_memory_equal(s.run.events, w.run.events, sizeof s.run.events);
  assert_int_equal(s.count, w.count);
  assert_memory_equal(s.coordinates, w.coordinates, s.count * sizeof *s.coordinates);
  assert_memory_equal(s.times, w.times, s.count * sizeof *s.times);
  assert_memory_equal(ric_trajectory_q(a), ric_trajectory_q(b), bytes);
  assert_memory_equal(ric_trajectory_u(a), ric_trajectory_u(b), bytes);
  assert_int_equal(ric_trajectory_columns(a), COLUMNS);
  assert_memory_equal(ric_trajectory_dq(a), ric_trajectory_dq(b), COLUMNS * bytes);
  assert_memory_equal(ric_trajectory_du(a), ric_trajectory_du(b), COLUMNS * bytes);
  ric_trajectory_destroy(&a);
  ric_trajectory_destroy(&b);
  return s.count;
}

static void lattices_pass_rigid_floors(void **state) {
  (void)state;
  static random_lattice r;
  static ric_obstacle all[MOST], compliant[MOST];
  const size_t sizes[] = {1, 2, 3, 9, 20, 270};
  size_t events = 0;
  for (uint64_t seed = 0; seed < 18; seed++) {
    random_source source = {.state = seed + 1};
    size_t n = sizes[seed % 6], count = mixed_floors(&source, n, all, compliant);
    random_lattice_set(&r, &source, n, (ric_ends)(seed / 6), (unsigned)random_below(&source, WITH_ALL + 1));
    ric_system *system = NULL, *witness = NULL;
    assert_int_equal(ric_system_create_lattice(&r.lattice, all, n, &system, NULL), RIC_OK);
    assert_int_equal(ric_system_create_lattice(&r.lattice, compliant, count, &witness, NULL), RIC_OK);
    events += check_passes(system, witness, RIC_FLOW_TAYLOR, &source, n > 100 ? 0.7 : 6);
    if (n < 10)
      events += check_passes(system, witness, RIC_FLOW_CVODES, &source, 4);
    ric_system_destroy(&system);
    ric_system_destroy(&witness);
  }
  print_message("%zu events\n", events);
  assert_true(events > 300);
}

static void mck_systems_pass_rigid_floors(void **state) {
  (void)state;
  static random_mck m;
  static ric_obstacle all[MOST], compliant[MOST];
  size_t events = 0;
  for (uint64_t seed = 0; seed < 12; seed++) {
    random_source source = {.state = seed + 1};
    size_t n = 1 + random_below(&source, 10), count = mixed_floors(&source, n, all, compliant);
    random_mck_make(&m, n, seed % 2, &source);
    ric_system *system = NULL, *witness = NULL;
    assert_int_equal(ric_system_create_mck(&m.model, all, n, &system, NULL), RIC_OK);
    assert_int_equal(ric_system_create_mck(&m.model, compliant, count, &witness, NULL), RIC_OK);
    events += check_passes(system, witness, seed % 4 < 2 ? RIC_FLOW_TAYLOR : RIC_FLOW_CVODES, &source, 10);
    ric_system_destroy(&system);
    ric_system_destroy(&witness);
  }
  print_message("%zu events\n", events);
  assert_true(events > 50);
}

static int fall(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = -1;
  return 0;
}

static int height(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0];
  return 0;
}

static void users_obstacles_are_passed(void **state) {
  (void)state;
  const ric_mechanical model = {.coordinates = 1, .speeds = 1, .obstacles = 1, .force = fall, .gap = height};
  const double q = 1, u = 0;
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_run run;
  options.pass_rigid = true;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(system, &options, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, &q, &u, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 4, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  assert_close(ric_trajectory_q(trajectory)[0], 1 - 8, 1e-10);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

/* Behind an obstacle, and between two that leave no room, motions start as elsewhere. */
static void motions_that_pass_start_anywhere(void **state) {
  (void)state;
  const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const ric_obstacle obstacles[] = {ric_obstacle_floor(0, 1), ric_obstacle_wall(0, -1)};
  const double q = 0.5, u = 0;
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_system_create_lattice(&lattice, obstacles, 2, &system, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(system, &options, &trajectory, NULL), RIC_EINVAL);
  options.pass_rigid = true;
  assert_int_equal(ric_trajectory_create(system, &options, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, &q, &u, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 3, NULL, &run, NULL), RIC_OK);
  assert_close(ric_trajectory_q(trajectory)[0], 0.5 * cos(3), 1e-14);
  assert_false(ric_trajectory_rests(trajectory, 0));
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattices_pass_rigid_floors),
      cmocka_unit_test(mck_systems_pass_rigid_floors),
      cmocka_unit_test(users_obstacles_are_passed),
      cmocka_unit_test(motions_that_pass_start_anywhere),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

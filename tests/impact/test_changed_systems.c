/* Systems whose numbers change: flows and trajectories that start again move as if they had been made of the new ones,
 * to the last bit. */
#include "support.h"

#include "witness/random_lattice.h"
#include "witness/random_mck.h"
#include "ricochet/ricochet.h"

enum { MOST = 640, COLUMNS = 3 };

/* Everything that a model has: the two kinds side by side, one of them used. */
typedef struct model {
  random_lattice lattice;
  random_mck mck;
  random_sparse sparse;
  bool is_mck;
  size_t n, count;
  ric_obstacle obstacles[MOST];
} model;

typedef struct start {
  double q[MOST], u[MOST], dq[MOST * COLUMNS], du[MOST * COLUMNS];
} start;

static ric_system *system_of(const model *m) {
  ric_system *system = NULL;
  ric_error error = {0};
  ric_status status = m->is_mck
                          ? ric_system_create_mck(&m->mck.model, m->obstacles, m->count, &system, &error)
                          : ric_system_create_lattice(&m->lattice.lattice, m->obstacles, m->count, &system, &error);
  if (status != RIC_OK)
    fail_msg("%s", error.message);
  return system;
}

static void set(ric_system *system, const model *m) {
  ric_error error = {0};
  ric_status status = m->is_mck ? ric_system_set_mck(system, &m->mck.model, &error)
                                : ric_system_set_lattice(system, &m->lattice.lattice, &error);
  if (status == RIC_OK)
    status = ric_system_set_obstacles(system, m->obstacles, m->count, &error);
  if (status != RIC_OK)
    fail_msg("%s", error.message);
}

/* Rigid floors below all states, Hertz floors and walls anywhere; on two of three particles, and on about ten where
 * there are many: events of each would take long. */
static void set_obstacles(model *m, random_source *source) {
  m->count = 0;
  for (size_t i = 0; i < m->n && m->count < MOST; i++) {
    size_t kind = random_below(source, 3);
    if (kind == 0 || random_below(source, 1 + m->n / 15) > 0)
      continue;
    m->obstacles[m->count] = ric_obstacle_floor(i, random_uniform(source, -1.4, -1));
    if (kind == 2)
      m->obstacles[m->count] =
          random_below(source, 2) ? ric_obstacle_floor(i, -0.3) : ric_obstacle_wall(i, random_uniform(source, 0, 1));
    m->obstacles[m->count].stiffness = kind == 1 ? INFINITY : 20;
    m->count++;
  }
}

/* Other numbers in the same places. */
static void change_obstacles(model *m, random_source *source) {
  for (size_t j = 0; j < m->count; j++) {
    ric_obstacle *o = &m->obstacles[j];
    bool rigid = o->stiffness == INFINITY;
    o->position = rigid ? random_uniform(source, -1.4, -1) : random_uniform(source, -0.5, 0.5);
    o->restitution = random_uniform(source, 0.3, 1);
    o->stiffness = rigid ? INFINITY : random_uniform(source, 5, 50);
  }
}

/* Two lattices with obstacles in the same places, and with the same terms or others. */
static void make_lattices(model *a, model *b, random_source *source, size_t n, ric_ends ends, bool same) {
  unsigned with = (unsigned)random_below(source, WITH_ALL + 1);
  a->is_mck = false;
  a->n = n;
  random_lattice_set(&a->lattice, source, n, ends, with);
  set_obstacles(a, source);
  memcpy(b, a, sizeof *b);
  random_lattice_set(&b->lattice, source, n, ends, same ? with : (unsigned)random_below(source, WITH_ALL + 1));
  if (!same && random_below(source, 2))
    b->lattice.lattice.masses = NULL;
  if (!same && random_below(source, 2))
    b->lattice.lattice.links = NULL;
  change_obstacles(b, source);
}

static void make_mck(model *m, random_source *source, bool diagonal) {
  random_mck_make(&m->mck, m->n, diagonal, source);
  size_t form = random_below(source, 4);
  if (form & 1)
    m->mck.model.stiffness = random_sparse_of(&m->sparse, m->mck.stiffness, m->n);
  if (form & 2)
    m->mck.model.damping = (ric_matrix){0};
  if (random_below(source, 2))
    m->mck.model.force_sin = NULL;
}

static void make_mcks(model *a, model *b, random_source *source) {
  a->is_mck = b->is_mck = true;
  a->n = b->n = 1 + random_below(source, 12);
  make_mck(a, source, random_below(source, 2));
  make_mck(b, source, random_below(source, 2));
  set_obstacles(a, source);
  memcpy(b->obstacles, a->obstacles, sizeof a->obstacles);
  b->count = a->count;
  change_obstacles(b, source);
}

static void make_start(start *s, random_source *source, size_t n) {
  random_lattice_state(source, n, s->q, s->u);
  for (size_t i = 0; i < n * COLUMNS; i++) {
    s->dq[i] = random_uniform(source, -1, 1);
    s->du[i] = random_uniform(source, -1, 1);
  }
}

/* A run with tangent vectors, which may be lost on the way. */
static ric_run move(ric_trajectory *trajectory, const start *s, double end) {
  ric_run run;
  ric_error error = {0};
  ric_status status = ric_trajectory_start(trajectory, 0, s->q, s->u, &error);
  if (status == RIC_OK)
    status = ric_trajectory_carry(trajectory, COLUMNS, s->dq, s->du, &error);
  if (status == RIC_OK)
    status = ric_trajectory_run(trajectory, end, NULL, &run, &error);
  if (status != RIC_OK)
    fail_msg("%s", error.message);
  return run;
}

/* Runs a trajectory, and one of a new system of the model, which must move in the same way. */
static void check_moves_as(ric_trajectory *trajectory, const model *m, const ric_trajectory_options *options,
                           const start *s, double end) {
  ric_system *system = system_of(m);
  ric_trajectory *fresh = NULL;
  assert_int_equal(ric_trajectory_create(system, options, &fresh, NULL), RIC_OK);
  ric_run expected = move(fresh, s, end), run = move(trajectory, s, end);
  size_t columns = ric_trajectory_columns(fresh), bytes = m->n * sizeof(double);
  assert_string_equal(ric_run_outcome_name(run.outcome), ric_run_outcome_name(expected.outcome));
  assert_true(run.time == expected.time);
  assert_int_equal(run.flow.steps, expected.flow.steps);
  assert_memory_equal(run.events, expected.events, sizeof run.events);
  assert_memory_equal(&run.energy_end, &expected.energy_end, sizeof run.energy_end);
  assert_memory_equal(ric_trajectory_q(trajectory), ric_trajectory_q(fresh), bytes);
  assert_memory_equal(ric_trajectory_u(trajectory), ric_trajectory_u(fresh), bytes);
  assert_int_equal(ric_trajectory_columns(trajectory), columns);
  if (columns > 0) {
    assert_memory_equal(ric_trajectory_dq(trajectory), ric_trajectory_dq(fresh), columns * bytes);
    assert_memory_equal(ric_trajectory_du(trajectory), ric_trajectory_du(fresh), columns * bytes);
  }
  ric_trajectory_destroy(&fresh);
  ric_system_destroy(&system);
}

/* From A to B, and back. @param moved  whether it has moved in between, up to the middle of a run */
static void check_change(const model *a, const model *b, ric_flow_method method, const start *s, double end,
                         bool moved) {
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_system *system = system_of(a);
  ric_trajectory *trajectory = NULL;
  options.flow.method = method;
  assert_int_equal(ric_trajectory_create(system, &options, &trajectory, NULL), RIC_OK);
  if (moved)
    move(trajectory, s, 0.7 * end);
  set(system, b);
  check_moves_as(trajectory, b, &options, s, end);
  check_moves_as(trajectory, b, &options, s, end); /* nothing is left of the run before */
  set(system, a);
  check_moves_as(trajectory, a, &options, s, end);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

static void check_lattices(const size_t *sizes, size_t count, ric_flow_method method, double end) {
  static model a, b;
  static start s;
  for (uint64_t seed = 0; seed < 12 * count; seed++) {
    random_source source = {.state = seed + 1};
    make_lattices(&a, &b, &source, sizes[seed % count], (ric_ends)(seed / count % 3), seed / count % 2);
    make_start(&s, &source, a.n);
    check_change(&a, &b, method, &s, end, seed / count % 4 < 2);
  }
}

static void lattices_move_as_new_ones(void **state) {
  (void)state;
  const size_t sizes[] = {1, 2, 3, 4, 7, 25, 100};
  check_lattices(sizes, sizeof sizes / sizeof *sizes, RIC_FLOW_TAYLOR, 3);
}

static void lattices_of_several_blocks_move_as_new_ones(void **state) {
  (void)state;
  const size_t sizes[] = {270, 520};
  check_lattices(sizes, sizeof sizes / sizeof *sizes, RIC_FLOW_TAYLOR, 0.7);
}

static void lattices_move_as_new_ones_with_cvodes(void **state) {
  (void)state;
  const size_t sizes[] = {1, 2, 7};
  check_lattices(sizes, sizeof sizes / sizeof *sizes, RIC_FLOW_CVODES, 2);
}

static void mck_systems_move_as_new_ones(void **state) {
  (void)state;
  static model a, b;
  static start s;
  for (uint64_t seed = 0; seed < 60; seed++) {
    random_source source = {.state = seed + 1};
    make_mcks(&a, &b, &source);
    make_start(&s, &source, a.n);
    check_change(&a, &b, seed % 3 ? RIC_FLOW_TAYLOR : RIC_FLOW_CVODES, &s, 3, seed % 2);
  }
}

/* Contacts at rest have caches of their own. */
static void contacts_that_persist_move_as_new_ones(void **state) {
  (void)state;
  static model a, b;
  static start s;
  for (uint64_t seed = 0; seed < 20; seed++) {
    random_source source = {.state = seed + 1};
    if (seed % 2)
      make_mcks(&a, &b, &source);
    else
      make_lattices(&a, &b, &source, seed % 5 ? 1 + random_below(&source, 10) : 280, (ric_ends)(seed % 3), false);
    make_start(&s, &source, a.n);
    for (size_t j = 0; j < a.count; j++) {
      a.obstacles[j].restitution = b.obstacles[j].restitution = 0;
      if (a.obstacles[j].stiffness == INFINITY)
        s.q[a.obstacles[j].coordinate] = s.u[a.obstacles[j].coordinate] = 0;
      if (a.obstacles[j].stiffness == INFINITY)
        a.obstacles[j].position = b.obstacles[j].position = 0;
    }
    check_change(&a, &b, RIC_FLOW_TAYLOR, &s, 3, seed % 4 < 2);
  }
}

static void flows_hand_out_the_segments_of_new_ones(void **state) {
  (void)state;
  static model a, b;
  static start s;
  random_source source = {.state = 5};
  make_lattices(&a, &b, &source, 600, RIC_ENDS_PERIODIC, false);
  make_start(&s, &source, a.n);
  ric_system *system = system_of(&a), *expected_system = system_of(&b);
  ric_flow *flow = NULL, *expected = NULL;
  assert_int_equal(ric_flow_create(system, NULL, &flow, NULL), RIC_OK);
  assert_int_equal(ric_flow_create(expected_system, NULL, &expected, NULL), RIC_OK);
  set(system, &b);
  assert_int_equal(ric_flow_start(flow, 0, s.q, s.u, NULL), RIC_OK);
  assert_int_equal(ric_flow_start(expected, 0, s.q, s.u, NULL), RIC_OK);
  assert_int_equal(ric_flow_step(flow, -3, NULL), RIC_OK);
  assert_int_equal(ric_flow_step(expected, -3, NULL), RIC_OK);
  assert_true(ric_flow_pieces(flow) > 1 && ric_flow_pieces(flow) == ric_flow_pieces(expected));
  for (size_t i = 0; i < ric_flow_pieces(flow); i++) {
    ric_segment p = ric_flow_piece(flow, i), e = ric_flow_piece(expected, i);
    assert_true(p.length == e.length && p.degree == e.degree && p.coordinates == e.coordinates);
    for (int j = 0; j <= p.degree; j++)
      assert_memory_equal(p.coef + (size_t)j * p.stride, e.coef + (size_t)j * e.stride, p.coordinates * sizeof *p.coef);
  }
  ric_flow_destroy(&flow);
  ric_flow_destroy(&expected);
  ric_system_destroy(&system);
  ric_system_destroy(&expected_system);
}

static void a_changed_system_refuses_to_go_on(void **state) {
  (void)state;
  static model a, b;
  static start s;
  ric_run run;
  ric_error error = {0};
  random_source source = {.state = 3};
  ric_trajectory *trajectory = NULL;
  ric_flow *flow = NULL;
  make_lattices(&a, &b, &source, 6, RIC_ENDS_FIXED, true);
  make_start(&s, &source, a.n);
  ric_system *system = system_of(&a);
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_flow_create(system, NULL, &flow, NULL), RIC_OK);
  assert_int_equal(ric_flow_start(flow, 0, s.q, s.u, NULL), RIC_OK);
  move(trajectory, &s, 1);
  set(system, &b);
  assert_int_equal(ric_flow_step(flow, 1, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "new start"));
  assert_int_equal(ric_flow_carry(flow, 1, s.dq, s.du, NULL), RIC_EINVAL);
  assert_int_equal(ric_trajectory_run(trajectory, 2, NULL, &run, NULL), RIC_EINVAL);
  assert_int_equal(ric_trajectory_carry(trajectory, 1, s.dq, s.du, NULL), RIC_EINVAL);
  assert_int_equal(ric_flow_start(flow, NAN, s.q, s.u, NULL), RIC_EINVAL);
  assert_int_equal(ric_flow_step(flow, 1, NULL), RIC_EINVAL);
  assert_int_equal(ric_flow_start(flow, 0, s.q, s.u, NULL), RIC_OK);
  assert_int_equal(ric_flow_step(flow, 1, NULL), RIC_OK);
  ric_flow_destroy(&flow);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

static void expect_refusal(ric_status status, ric_error *error, const char *text) {
  assert_int_equal(status, RIC_EINVAL);
  if (!strstr(error->message, text))
    fail_msg("\"%s\", expected \"%s\" in it", error->message, text);
}

static void lattices_refuse_what_does_not_fit(void **state) {
  (void)state;
  static model a, b;
  static start s;
  ric_error error = {0};
  random_source source = {.state = 4};
  ric_trajectory *trajectory = NULL;
  make_lattices(&a, &b, &source, 5, RIC_ENDS_FIXED, true);
  make_start(&s, &source, a.n);
  ric_system *system = system_of(&a);
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  ric_lattice other = ric_lattice_default(4, RIC_ENDS_FIXED);
  expect_refusal(ric_system_set_lattice(system, &other, &error), &error, "particles = 4, expected 5");
  other = ric_lattice_default(5, RIC_ENDS_FREE);
  expect_refusal(ric_system_set_lattice(system, &other, &error), &error, "ends = free, expected fixed");
  other = ric_lattice_default(5, RIC_ENDS_FIXED);
  other.link.cubic = NAN;
  expect_refusal(ric_system_set_lattice(system, &other, &error), &error, "cubic");
  random_mck_make(&b.mck, 5, 1, &source);
  expect_refusal(ric_system_set_mck(system, &b.mck.model, &error), &error, "M-C-K");
  check_moves_as(trajectory, &a, NULL, &s, 3);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

static void mck_systems_refuse_what_does_not_fit(void **state) {
  (void)state;
  static model a, b;
  static start s;
  ric_error error = {0};
  random_source source = {.state = 6};
  ric_trajectory *trajectory = NULL;
  make_mcks(&a, &b, &source);
  make_start(&s, &source, a.n);
  ric_system *system = system_of(&a);
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  random_mck_make(&b.mck, a.n + 1, 0, &source);
  expect_refusal(ric_system_set_mck(system, &b.mck.model, &error), &error, "coordinates");
  random_mck_make(&b.mck, a.n, 0, &source);
  b.mck.mass[0] = -1;
  expect_refusal(ric_system_set_mck(system, &b.mck.model, &error), &error, "mass is not positive definite");
  ric_lattice lattice = ric_lattice_default(a.n, RIC_ENDS_FREE);
  expect_refusal(ric_system_set_lattice(system, &lattice, &error), &error, "lattice");
  check_moves_as(trajectory, &a, NULL, &s, 3);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

static int no_force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = 0;
  return 0;
}

static void obstacles_stay_in_their_places(void **state) {
  (void)state;
  const ric_lattice lattice = ric_lattice_default(3, RIC_ENDS_FREE);
  const ric_obstacle given[] = {ric_obstacle_floor(0, -1), {2, -1, 1, 1, 50}};
  ric_obstacle o[2];
  ric_error error = {0};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_lattice(&lattice, given, 2, &system, NULL), RIC_OK);
  expect_refusal(ric_system_set_obstacles(system, given, 1, &error), &error, "1 obstacles, expected 2");
  memcpy(o, given, sizeof o);
  o[1].coordinate = 1;
  expect_refusal(ric_system_set_obstacles(system, o, 2, &error), &error, "obstacle 1: coordinate = 1, expected 2");
  memcpy(o, given, sizeof o);
  o[1].side = 1;
  expect_refusal(ric_system_set_obstacles(system, o, 2, &error), &error, "obstacle 1: side = 1, expected -1");
  memcpy(o, given, sizeof o);
  o[1].stiffness = INFINITY;
  expect_refusal(ric_system_set_obstacles(system, o, 2, &error), &error, "obstacle 1: stiffness = inf");
  memcpy(o, given, sizeof o);
  o[0].position = -2; /* a change before the one that is refused */
  o[1].position = NAN;
  expect_refusal(ric_system_set_obstacles(system, o, 2, &error), &error, "obstacle 1: position = nan");
  assert_true(ric_system_gap(system, 0, 0, (double[3]){0}) == 1);
  o[1].position = 1;
  assert_int_equal(ric_system_set_obstacles(system, o, 2, NULL), RIC_OK);
  assert_true(ric_system_gap(system, 0, 0, (double[3]){0}) == 2);
  ric_system_destroy(&system);
  const ric_mechanical free_mass = {.coordinates = 1, .speeds = 1, .force = no_force};
  assert_int_equal(ric_system_create_mechanical(&free_mass, &system, NULL), RIC_OK);
  expect_refusal(ric_system_set_obstacles(system, NULL, 0, &error), &error, "user's system");
  expect_refusal(ric_system_set_lattice(system, &lattice, &error), &error, "lattice");
  ric_system_destroy(&system);
}

static void obstacles_that_leave_no_room_are_refused_at_the_start(void **state) {
  (void)state;
  const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle o[] = {ric_obstacle_floor(0, -1), ric_obstacle_wall(0, 1)};
  const double q = 0, u = 0;
  ric_error error = {0};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  assert_int_equal(ric_system_create_lattice(&lattice, o, 2, &system, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  o[0].position = o[1].position = 0;
  assert_int_equal(ric_system_set_obstacles(system, o, 2, NULL), RIC_OK);
  expect_refusal(ric_trajectory_start(trajectory, 0, &q, &u, &error), &error, "expected room between them");
  o[1].position = 1;
  assert_int_equal(ric_system_set_obstacles(system, o, 2, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, &q, &u, NULL), RIC_OK);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lattices_move_as_new_ones),
      cmocka_unit_test(lattices_of_several_blocks_move_as_new_ones),
      cmocka_unit_test(lattices_move_as_new_ones_with_cvodes),
      cmocka_unit_test(mck_systems_move_as_new_ones),
      cmocka_unit_test(contacts_that_persist_move_as_new_ones),
      cmocka_unit_test(flows_hand_out_the_segments_of_new_ones),
      cmocka_unit_test(a_changed_system_refuses_to_go_on),
      cmocka_unit_test(lattices_refuse_what_does_not_fit),
      cmocka_unit_test(mck_systems_refuse_what_does_not_fit),
      cmocka_unit_test(obstacles_stay_in_their_places),
      cmocka_unit_test(obstacles_that_leave_no_room_are_refused_at_the_start),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

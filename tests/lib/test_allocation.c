/* Solving again allocates nothing, and what is refused memory says so. */
#include "support.h"

#include "witness/allocation_counter.h"
#include "witness/ritz_approximation.h"
#include "witness/forced_oscillator.h"
#include "scenario/family_scenario.h"
#include "witness/solved_orbit.h"

#ifndef ALLOCATIONS_ARE_COUNTED

static void another_allocator_stands_in_the_way(void **state) {
  (void)state;
  skip();
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(another_allocator_stands_in_the_way)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

/* Solves with changing coupling and period; returns the allocations of all but the first. */
static size_t allocations_of_repeats(scenario s) {
  enum { REPEATS = 100 };
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, s);
  size_t before = allocations;
  watching = true;
  for (int k = 0; k < REPEATS; k++) {
    s.chain.gamma = 0.02 + 0.011 * k;
    s.period = 3.5 + 0.023 * k;
    assert_int_equal(ric_orbit_solve(x.solver, &s.chain, s.pattern, s.period, &x.orbit, NULL), RIC_OK);
  }
  watching = false;
  size_t during = allocations - before;
  solved_orbit_clear(&x);
  return during;
}

static void the_counter_counts(void **state) {
  (void)state;
  size_t before = allocations;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_middle(9, RIC_ENDS_FREE, 0.1, 5));
  assert_true(allocations > before + 5);
  solved_orbit_clear(&x);
}

static void solving_again_on_a_ring_allocates_nothing(void **state) {
  (void)state;
  assert_int_equal(allocations_of_repeats(scenario_middle(30, RIC_ENDS_PERIODIC, 0.1, 5)), 0);
  assert_int_equal(allocations_of_repeats(scenario_word("s..h...s.h.", 1, RIC_ENDS_PERIODIC, 0.1, 5)), 0);
}

static void solving_again_on_a_fixed_chain_allocates_nothing(void **state) {
  (void)state;
  assert_int_equal(allocations_of_repeats(scenario_middle(30, RIC_ENDS_FIXED, 0.1, 5)), 0);
  assert_int_equal(allocations_of_repeats(scenario_word("s..h...s.h.", 1, RIC_ENDS_FIXED, 0.1, 5)), 0);
}

static void solving_again_on_a_free_chain_allocates_nothing(void **state) {
  (void)state;
  assert_int_equal(allocations_of_repeats(scenario_middle(30, RIC_ENDS_FREE, 0.1, 5)), 0);
  assert_int_equal(allocations_of_repeats(scenario_word("s..h...s.h.", 1, RIC_ENDS_FREE, 0.1, 5)), 0);
}

static void solving_again_with_an_awkward_number_of_particles_allocates_nothing(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    assert_int_equal(allocations_of_repeats(scenario_middle(101, (ric_ends)ends, 0.1, 5)), 0);
    assert_int_equal(allocations_of_repeats(scenario_middle(1021, (ric_ends)ends, 0.1, 5)), 0);
  }
}

static void solving_again_on_a_unit_cell_allocates_nothing(void **state) {
  (void)state;
  assert_int_equal(allocations_of_repeats(scenario_word("s.h", 10, RIC_ENDS_PERIODIC, 0.1, 5)), 0);
  assert_int_equal(allocations_of_repeats(scenario_word(".s.", 10, RIC_ENDS_FREE, 0.1, 5)), 0);
}

/* Allocations of multipliers once their workspaces are there, over a range of couplings. */
static size_t allocations_of_multipliers(scenario s, ric_multiplier_method method) {
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, s);
  ric_orbit_multiplier_options options = ric_orbit_multiplier_options_default();
  ric_multipliers m;
  size_t before = 0;
  options.method = method;
  assert_int_equal(ric_multipliers_init(&m, 2 * s.chain.particles, NULL), RIC_OK);
  watching = true;
  for (int i = 0; i < 4; i++) {
    if (i == 1)
      before = allocations;
    x.scenario.chain.gamma = 0.1 + 0.01 * i;
    ric_orbit_solve(x.solver, &x.scenario.chain, s.pattern, s.period, &x.orbit, NULL);
    ric_orbit_multipliers(x.solver, &x.scenario.chain, s.pattern, &x.orbit, &options, &m, NULL);
    assert_true(m.stable != RIC_STABILITY_UNKNOWN);
  }
  size_t during = allocations - before;
  watching = false;
  ric_multipliers_clear(&m);
  solved_orbit_clear(&x);
  return during;
}

static void multipliers_again_allocate_nothing(void **state) {
  (void)state;
  for (int method = RIC_MULTIPLIERS_REDUCED; method <= RIC_MULTIPLIERS_DETERMINANT; method += 2) {
    ric_multiplier_method by = (ric_multiplier_method)method;
    assert_int_equal(allocations_of_multipliers(scenario_middle(30, RIC_ENDS_PERIODIC, 0.1, 4.7), by), 0);
    assert_int_equal(allocations_of_multipliers(scenario_word("s..h...s.h.", 1, RIC_ENDS_FREE, 0.1, 4.7), by), 0);
  }
}

static int pull(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)u, (void)user;
  f[0] = -q[0];
  return 0;
}

static int height(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0] + 2;
  return 0;
}

static void moving_a_user_system_allocates_nothing(void **state) {
  (void)state;
  const ric_mechanical model = {.coordinates = 1, .speeds = 1, .obstacles = 1, .force = pull, .gap = height};
  const double q = 1, u = 0;
  ric_system *system = NULL;
  ric_flow *flow = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  assert_int_equal(ric_flow_create(system, NULL, &flow, NULL), RIC_OK);
  size_t before = allocations;
  for (int k = 0; k < 5; k++) {
    assert_int_equal(ric_flow_start(flow, k, &q, &u, NULL), RIC_OK);
    while (ric_flow_time(flow) < k + 2) {
      assert_int_equal(ric_flow_step(flow, k + 2, NULL), RIC_OK);
      ric_segment piece = ric_flow_piece(flow, 0);
      assert_true(ric_system_gap_rate(system, 0, piece.start, &q, &u) < 1);
      ric_flow_accept(flow, 1);
    }
  }
  assert_int_equal(allocations - before, 0);
  ric_flow_destroy(&flow);
  ric_system_destroy(&system);
}

/* The second run of a trajectory meets nothing that the first has not met. */
static size_t allocations_of_a_second_run(const ric_system *system, const double *q, const double *u, double end) {
  ric_trajectory *trajectory = NULL;
  ric_run run;
  assert_int_equal(ric_trajectory_create(system, NULL, &trajectory, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(trajectory, 0, q, u, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, end, NULL, &run, NULL), RIC_OK);
  size_t before = allocations;
  assert_int_equal(ric_trajectory_start(trajectory, 0, q, u, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, end, NULL, &run, NULL), RIC_OK);
  size_t during = allocations - before;
  assert_true(run.events[RIC_EVENT_TRANSVERSAL] > 3);
  ric_trajectory_destroy(&trajectory);
  return during;
}

/* Impacts, chatter, rest, Hertz contacts: all in one chain. */
static void following_a_motion_again_allocates_nothing(void **state) {
  (void)state;
  enum { N = 8 };
  ric_obstacle obstacles[N];
  double q[N], u[N];
  ric_lattice chain = ric_lattice_default(N, RIC_ENDS_FIXED);
  chain.link = (ric_spring){.linear = 0.2, .cubic = 0.1, .damping = 0.01};
  for (size_t i = 0; i < N; i++) {
    obstacles[i] = ric_obstacle_floor(i, i < 4 ? 0.1 : -0.3);
    obstacles[i].restitution = 0.5;
    obstacles[i].stiffness = i == 6 ? 1000 : INFINITY;
    q[i] = 0.3 + 0.1 * (double)i;
    u[i] = i % 2 ? 0.5 : -0.5;
  }
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_lattice(&chain, obstacles, N, &system, NULL), RIC_OK);
  assert_int_equal(allocations_of_a_second_run(system, q, u, 30), 0);
  ric_system_destroy(&system);
}

/* A chain with what its trajectory needs, started and run with tangent vectors. */
static void move_with_tangents(ric_trajectory *trajectory, const double *x, size_t n) {
  enum { COLUMNS = 4 };
  static double d[2 * 300 * COLUMNS];
  ric_run run;
  for (size_t i = 0; i < 2 * n * COLUMNS; i++)
    d[i] = i % (COLUMNS + 1) == 0;
  assert_int_equal(ric_trajectory_start(trajectory, 0, x, x + n, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_carry(trajectory, COLUMNS, d, d + n * COLUMNS, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_run(trajectory, 4, NULL, &run, NULL), RIC_OK);
  assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
  assert_int_equal(ric_trajectory_columns(trajectory), COLUMNS);
}

/* Allocations of all but the first two couplings, forth and back. */
static size_t allocations_of_changes(size_t n, ric_flow_method method, ric_spring link) {
  double x[2 * 300], forces[300];
  ric_obstacle floors[300];
  ric_trajectory_options options = ric_trajectory_options_default();
  ric_lattice lattice = ric_lattice_default(n, RIC_ENDS_PERIODIC);
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  size_t before = 0;
  options.flow.method = method;
  for (size_t i = 0; i < n; i++) {
    floors[i] = ric_obstacle_floor(i, -0.5 - 0.01 * (double)(i % 7));
    floors[i].stiffness = i % 2 ? 100 : INFINITY;
    forces[i] = 0.1;
    x[i] = 0.2 + 0.7 * sin((double)(i + 1)) * sin((double)(i + 1));
    x[n + i] = 0.6 * cos(3.3 * (double)i);
  }
  lattice.force_cos = forces;
  lattice.frequency = 1.1;
  assert_int_equal(ric_system_create_lattice(&lattice, floors, n, &system, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_create(system, &options, &trajectory, NULL), RIC_OK);
  for (int k = 0; k < 6; k++) {
    if (k == 2)
      before = allocations;
    lattice.link = link;
    lattice.link.linear = 0.1 + 0.05 * (k % 2);
    floors[0].position = -0.5 - 0.1 * (k % 2);
    assert_int_equal(ric_system_set_lattice(system, &lattice, NULL), RIC_OK);
    assert_int_equal(ric_system_set_obstacles(system, floors, n, NULL), RIC_OK);
    move_with_tangents(trajectory, x, n);
  }
  size_t during = allocations - before;
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return during;
}

static void moving_with_other_numbers_allocates_nothing(void **state) {
  (void)state;
  const ric_spring linear = {0}, nonlinear = {.quadratic = 0.05, .cubic = 0.1, .damping = 0.01};
  assert_int_equal(allocations_of_changes(9, RIC_FLOW_TAYLOR, linear), 0);
  assert_int_equal(allocations_of_changes(9, RIC_FLOW_TAYLOR, nonlinear), 0);
  assert_int_equal(allocations_of_changes(300, RIC_FLOW_TAYLOR, linear), 0);
  assert_int_equal(allocations_of_changes(9, RIC_FLOW_CVODES, nonlinear), 0);
}

/* A curve with folds, branch points and test functions, from create on. */
static ric_status kinked(const double *u, double p, double *F, double *J, double *F_p, void *user, ric_error *error) {
  double a = u[0] - u[1], b = u[0] + p * u[1];
  (void)user, (void)error;
  F[0] = a * b;
  F[1] = u[1] * u[1] + p * p - 1;
  J[0] = a + b;
  J[1] = -b + p * a;
  J[2] = 0;
  J[3] = 2 * u[1];
  F_p[0] = a * u[1];
  F_p[1] = 2 * p;
  return RIC_OK;
}

static ric_status where_p_is_small(const double *u, double p, const double *t_u, double t_p, double *values, void *user,
                                   ric_error *error) {
  (void)u, (void)t_u, (void)t_p, (void)user, (void)error;
  *values = p - 0.1;
  return RIC_OK;
}

static void following_a_curve_allocates_nothing(void **state) {
  (void)state;
  const ric_curve_problem problem = {.unknowns = 2, .residual = kinked, .tests = 1, .test = where_p_is_small};
  ric_curve *curve = NULL;
  ric_curve_run run;
  double u[2] = {1, 1};
  assert_int_equal(ric_curve_create(&problem, NULL, &curve, NULL), RIC_OK);
  size_t before = allocations;
  assert_int_equal(ric_curve_follow(curve, u, 0, NULL, NULL, NULL, &run, NULL), RIC_OK);
  assert_int_equal(ric_curve_solve(curve, u, 0.1, NULL, NULL), RIC_OK);
  assert_int_equal(allocations - before, 0);
  print_message("%zu points, %zu special, %s\n", run.points, run.special, ric_curve_end_name(run.end));
  assert_true(run.special >= 4);
  ric_curve_destroy(&curve);
}

/* The estimate leaves out the block of the flow, the descriptions of the plans, and buffers that FFTW takes for awkward
 * numbers of particles, up to two numbers per site. It serves to refuse what cannot fit. */
/* A family followed once more: between special points everything has its place. */
static size_t allocations_of_a_family(family_scenario *s, int failed, bool multipliers, size_t points) {
  ric_family *family = NULL;
  double *z = NULL;
  ric_curve_run run;
  size_t before = 0;
  s->options.multipliers = multipliers;
  s->options.curve.points = points;
  assert_false(failed);
  assert_int_equal(family_scenario_begin(s, &family, &z, NULL), RIC_OK);
  for (int k = 0; k < 2; k++) {
    before = allocations;
    assert_int_equal(ric_family_follow(family, z, s->start, NULL, NULL, NULL, &run, NULL), RIC_OK);
    assert_true(run.points > 3);
  }
  size_t during = allocations - before;
  ric_family_destroy(&family);
  family_scenario_clear(s);
  free(z);
  return during;
}

static void following_a_family_again_allocates_nothing(void **state) {
  (void)state;
  const double period = 4.71238898038469;
  family_scenario s;
  for (int multipliers = 0; multipliers < 2; multipliers++) {
    int failed = family_scenario_two_masses(&s, 7, 6.8);
    assert_int_equal(allocations_of_a_family(&s, failed, multipliers, 20), 0);
    failed = family_scenario_impact(&s, 20, period, 0.01, 0.1);
    assert_int_equal(allocations_of_a_family(&s, failed, multipliers, 20), 0);
    failed = family_scenario_hertz(&s, 10, 1000, period, 0.05);
    assert_int_equal(allocations_of_a_family(&s, failed, multipliers, 20), 0);
  }
}

/* A forced motion with an impact per period: another kind of multipliers. */
static void following_a_forced_family_again_allocates_nothing(void **state) {
  (void)state;
  forced_oscillator o;
  forced_oscillator_init(&o);
  ric_family_problem problem = forced_oscillator_problem(&o, 1, 1, 2);
  ric_family_options options = ric_family_options_default();
  double q = 1, u = 1, time = 0.5, z[3];
  size_t before = 0;
  ric_family *family = NULL;
  ric_curve_run run;
  options.curve.points = 20;
  assert_int_equal(ric_family_create(&problem, &options, &family, NULL), RIC_OK);
  assert_int_equal(ric_family_start(family, 5, &q, &u, &time, 1, z, NULL, NULL), RIC_OK);
  for (int k = 0; k < 2; k++) {
    before = allocations;
    assert_int_equal(ric_family_follow(family, z, 5, NULL, NULL, NULL, &run, NULL), RIC_OK);
    assert_true(run.points > 3);
  }
  assert_int_equal(allocations - before, 0);
  ric_family_destroy(&family);
  forced_oscillator_clear(&o);
}

/* A family of a given kind from nothing to its multipliers. */
static ric_status look_at_a_family(ric_system *system, ric_motion_kind kind) {
  const ric_family_problem problem = {
      .system = system, .motion = {.kind = kind, .flow = ric_flow_options_default()}, .parameters = 1, .given = 5};
  ric_multipliers m = {0};
  ric_family *family = NULL;
  const double z[4] = {0};
  ric_status status = ric_family_create(&problem, NULL, &family, NULL);
  if (status == RIC_OK)
    status = ric_multipliers_init(&m, 4, NULL);
  if (status == RIC_OK)
    status = ric_shooting_multipliers(ric_family_shooting(family), z, 5, NULL, &m, NULL);
  ric_multipliers_clear(&m);
  ric_family_destroy(&family);
  return status;
}

static void the_bypass_map_allocates_nothing(void **state) {
  (void)state;
  forced_oscillator o;
  ric_bypass *bypass = NULL;
  double image[2];
  forced_oscillator_init(&o);
  assert_int_equal(ric_bypass_create(o.system, 0, NULL, &bypass, NULL), RIC_OK);
  size_t before = allocations;
  for (int k = 1; k < 100; k++)
    assert_int_equal(ric_bypass_map(bypass, 2, (double[]){1 + 1e-4 * k, 0.01}, image, NULL, NULL), RIC_OK);
  assert_int_equal(allocations - before, 0);
  ric_bypass_destroy(&bypass);
  forced_oscillator_clear(&o);
}

static void families_without_memory_are_refused(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  for (int kind = RIC_MOTION_EVEN; kind <= RIC_MOTION_FORCED; kind++) {
    ric_system *system = NULL;
    ric_status status = RIC_ENOMEM;
    size_t k = 0;
    assert_int_equal(ric_system_create_lattice(&lattice, NULL, 0, &system, NULL), RIC_OK);
    for (; status == RIC_ENOMEM && k < 1000; k++) {
      until_refusal = k + 1;
      status = look_at_a_family(system, (ric_motion_kind)kind);
      if (until_refusal == 0)
        assert_int_equal(status, RIC_ENOMEM);
    }
    until_refusal = 0;
    assert_int_equal(status, RIC_OK);
    assert_true(k > 20);
    ric_system_destroy(&system);
  }
}

/* Newton's method of others may ask for F and J a thousand times. */
static void equations_of_ritz_allocate_nothing(void **state) {
  (void)state;
  shooting_solution s = duffing_mode(0.1, 0.4, -1);
  ritz_approximation a = ritz_approximate(&s, 4, true);
  double F[11], J[121], F_period[11], q[2], v[2];
  size_t before = allocations;
  assert_int_equal(ric_ritz_residual(a.ritz, a.c, s.given, F, J, F_period, NULL), RIC_OK);
  assert_int_equal(ric_ritz_use(a.ritz, 3, a.c, NULL), RIC_OK);
  assert_int_equal(ric_ritz_residual(a.ritz, a.c, s.given, F, J, F_period, NULL), RIC_OK);
  ric_ritz_state(a.ritz, a.c, s.given, 1, q, v);
  assert_true(ric_ritz_defect(a.ritz, a.c, s.given) > 0);
  assert_int_equal(allocations - before, 0);
  ritz_approximation_clear(&a);
  shooting_solution_clear(&s);
}

static ric_status fit_by_ritz(shooting_solution *s) {
  double c[35];
  ric_ritz *ritz = NULL;
  ric_status status = ric_ritz_create(s->system, 0, NULL, &ritz, NULL);
  if (status == RIC_OK)
    status = ric_ritz_fit(ritz, s->shooting, s->z, s->given, 0, c, NULL);
  ric_ritz_destroy(&ritz);
  return status;
}

static void fits_of_ritz_without_memory_are_refused(void **state) {
  (void)state;
  shooting_solution s = duffing_mode(0.1, 0.4, -1);
  ric_status status = RIC_ENOMEM;
  size_t k = 0;
  for (; status == RIC_ENOMEM && k < 1000; k++) {
    until_refusal = k + 1;
    status = fit_by_ritz(&s);
    if (until_refusal == 0)
      assert_int_equal(status, RIC_ENOMEM);
  }
  until_refusal = 0;
  assert_int_equal(status, RIC_OK);
  assert_true(k > 10);
  shooting_solution_clear(&s);
}

static void check_estimate(scenario s, ric_orbit_method method) {
  size_t before = most_live = live;
  solved_orbit x = solve_orbit(method, s);
  double taken = (double)(most_live - before), estimate = ric_orbit_bytes(&s.chain, s.pattern, method);
  print_message("n = %zu, ends %d: %.0f bytes taken, %.0f estimated\n", s.chain.particles, (int)s.chain.ends, taken,
                estimate);
  assert_true(taken <= 1.5 * estimate + 200e3);
  assert_true(taken >= 0.5 * estimate);
  solved_orbit_clear(&x);
}

static void memory_is_what_was_estimated(void **state) {
  (void)state;
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    check_estimate(scenario_middle(50000, (ric_ends)ends, 0.1, 5), RIC_METHOD_IMPULSE);
    check_estimate(scenario_middle(50021, (ric_ends)ends, 0.1, 5), RIC_METHOD_IMPULSE);
    check_estimate(scenario_word("s..h.s...hh..s", 25, (ric_ends)ends, 0.1, 5), RIC_METHOD_IMPULSE);
    check_estimate(scenario_middle(150, (ric_ends)ends, 0.1, 5), RIC_METHOD_DENSE);
  }
  check_estimate(scenario_word("s.h", 50000, RIC_ENDS_PERIODIC, 0.1, 5), RIC_METHOD_IMPULSE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_counter_counts),
      cmocka_unit_test(solving_again_on_a_ring_allocates_nothing),
      cmocka_unit_test(solving_again_on_a_fixed_chain_allocates_nothing),
      cmocka_unit_test(solving_again_on_a_free_chain_allocates_nothing),
      cmocka_unit_test(solving_again_with_an_awkward_number_of_particles_allocates_nothing),
      cmocka_unit_test(solving_again_on_a_unit_cell_allocates_nothing),
      cmocka_unit_test(multipliers_again_allocate_nothing),
      cmocka_unit_test(moving_a_user_system_allocates_nothing),
      cmocka_unit_test(following_a_motion_again_allocates_nothing),
      cmocka_unit_test(moving_with_other_numbers_allocates_nothing),
      cmocka_unit_test(following_a_family_again_allocates_nothing),
      cmocka_unit_test(following_a_forced_family_again_allocates_nothing),
      cmocka_unit_test(the_bypass_map_allocates_nothing),
      cmocka_unit_test(families_without_memory_are_refused),
      cmocka_unit_test(following_a_curve_allocates_nothing),
      cmocka_unit_test(equations_of_ritz_allocate_nothing),
      cmocka_unit_test(fits_of_ritz_without_memory_are_refused),
      cmocka_unit_test(memory_is_what_was_estimated),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif

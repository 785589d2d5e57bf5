/* Families of smooth motions against reference values: Duffing's oscillator, breathers, Hertz contact; and two masses
 * with a cubic spring before a wall. */
#include "support.h"

#include "reference.h"
#include "witness/solved_orbit.h"

enum { MOST_PARTICLES = 30, MOST_SPECIAL = 32 };

static const double turn = 6.283185307179586;

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

/* A lattice with its obstacles and one parameter, which `put` writes. */
typedef struct model {
  ric_lattice lattice;
  ric_obstacle obstacles[MOST_PARTICLES];
  size_t obstacle_count;
  double force, period;
  void (*put)(struct model *m, double p);
  ric_system *system;
} model;

static ric_status set(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  model *m = user;
  m->put(m, p[0]);
  *given = m->period;
  RIC_TRY(ric_system_set_lattice(system, &m->lattice, error));
  return m->obstacle_count ? ric_system_set_obstacles(system, m->obstacles, m->obstacle_count, error) : RIC_OK;
}

static ric_family *family_of(model *m, const ric_shooting_problem *motion, const ric_family_options *options) {
  ric_family *family = NULL;
  ric_error error;
  if (!m->system)
    check(ric_system_create_lattice(&m->lattice, m->obstacles, m->obstacle_count, &m->system, &error), &error);
  const ric_family_problem problem = {
      .system = m->system, .motion = *motion, .set = set, .user = m, .parameters = 1, .given = m->period};
  check(ric_family_create(&problem, options, &family, &error), &error);
  return family;
}

/* What a walk has seen. */
typedef struct seen {
  ric_family_kind kind[MOST_SPECIAL];
  double parameter[MOST_SPECIAL], z[MOST_SPECIAL][2];
  size_t special, points;
  double last, z_last[MOST_PARTICLES], energy, largest;
  ric_stability stable;
} seen;

static int look(const ric_family_point *point, void *user) {
  seen *s = user;
  if (point->kind != RIC_FAMILY_REGULAR && s->special < MOST_SPECIAL) {
    s->kind[s->special] = point->kind;
    s->parameter[s->special] = point->parameter;
    memcpy(s->z[s->special++], point->z, (point->unknowns < 2 ? 1 : 2) * sizeof(double));
  }
  s->points += point->kind == RIC_FAMILY_REGULAR;
  s->last = point->parameter;
  s->energy = point->orbit->energy;
  memcpy(s->z_last, point->z, point->unknowns * sizeof(double));
  s->largest = point->multipliers ? point->multipliers->largest : NAN;
  s->stable = point->multipliers ? point->multipliers->stable : RIC_STABILITY_UNKNOWN;
  return 0;
}

/* --- Duffing's oscillator ----------------------------------------------------------------------------------------- */

static void put_frequency(model *m, double p) {
  m->lattice.frequency = p;
  m->period = turn / p;
}

static model duffing(double force) {
  model m = {.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .force = force, .put = put_frequency};
  m.lattice.on_site = (ric_spring){.linear = 1, .cubic = 1, .damping = 0.1};
  put_frequency(&m, 1);
  return m;
}

static const ric_shooting_problem forced = {.kind = RIC_MOTION_FORCED, .flow = {.longest_step = INFINITY}};

static ric_family_options range(double low, double high, double step_most) {
  ric_family_options o = ric_family_options_default();
  o.curve.p_low = low;
  o.curve.p_high = high;
  o.curve.step_most = step_most;
  o.curve.step = fmin(o.curve.step, step_most);
  o.curve.points = 5000;
  return o;
}

static ric_family_kind kind_of(const char *word) {
  return strcmp(word, "fold") == 0       ? RIC_FAMILY_FOLD
         : strcmp(word, "branch") == 0   ? RIC_FAMILY_BRANCH_POINT
         : strcmp(word, "doubling") == 0 ? RIC_FAMILY_PERIOD_DOUBLING
                                         : RIC_FAMILY_REGULAR;
}

/* Columns: kind, A, m, symmetric, w, x0, v0, ... */
static void assert_row_is_seen(const seen *s, const reference_row *r) {
  const double *x = r->value;
  for (size_t k = 0; k < s->special; k++)
    if (s->kind[k] == kind_of(r->word) && fabs(s->parameter[k] - x[4]) < 1e-8 &&
        hypot(s->z[k][0] - x[5], s->z[k][1] - x[6]) < 1e-6 * (1 + fabs(x[6])))
      return;
  fail_msg("A = %g: the %s at w = %.12g is not found", x[1], r->word, x[4]);
}

static void frequency_response_has_the_folds_and_branch_points_of_the_reference(void **state) {
  (void)state;
  static const double forces[] = {0.3, 0.5, 1.5};
  reference table = reference_read("duffing");
  for (size_t i = 0; i < 3; i++) {
    model m = duffing(forces[i]);
    ric_error error;
    m.lattice.force_cos = &m.force;
    ric_family_options options = range(0.45, 2.5 + forces[i], 0.02);
    ric_family *family = family_of(&m, &forced, &options);
    double x = 0, v = 0, z[2], start = 2.5 + forces[i];
    seen s = {0};
    ric_curve_run run;
    size_t compared = 0;
    m.put(&m, start);
    check(ric_family_start(family, start, &x, &v, NULL, 1, z, NULL, &error), &error);
    options.curve.direction = -1;
    ric_family_destroy(&family);
    family = family_of(&m, &forced, &options);
    check(ric_family_follow(family, z, start, NULL, look, &s, &run, &error), &error);
    assert_int_equal(run.end, RIC_CURVE_BOUND);
    for (size_t k = 0; k < table.count; k++) {
      const reference_row *r = &table.rows[k];
      if (r->value[1] != forces[i] || r->value[2] != 1 || r->value[3] != 1 || kind_of(r->word) == RIC_FAMILY_REGULAR)
        continue;
      assert_row_is_seen(&s, r);
      compared++;
    }
    print_message("[ A = %g: %zu points, %zu special points compared ]\n", forces[i], s.points, compared);
    assert_true(compared >= 2);
    ric_family_destroy(&family);
    ric_system_destroy(&m.system);
  }
  reference_clear(&table);
}

static void regular_points_have_the_multipliers_of_the_reference(void **state) {
  (void)state;
  reference table = reference_read("duffing");
  size_t compared = 0;
  for (size_t k = 0; k < table.count; k++) {
    const reference_row *r = &table.rows[k];
    const double *x = r->value;
    if (strcmp(r->word, "regular") != 0 || x[2] != 1)
      continue;
    model m = duffing(x[1]);
    m.lattice.force_cos = &m.force;
    ric_family *family = family_of(&m, &forced, NULL);
    double z[2];
    ric_multipliers mu;
    ric_error error;
    check(ric_family_start(family, x[4], &x[5], &x[6], NULL, turn / x[4], z, NULL, &error), &error);
    check(ric_multipliers_init(&mu, 2, &error), &error);
    check(ric_shooting_multipliers(ric_family_shooting(family), z, turn / x[4], NULL, &mu, &error), &error);
    assert_close(z[0], x[5], 1e-10 * (1 + fabs(x[5])));
    assert_close(z[1], x[6], 1e-10 * (1 + fabs(x[6])));
    double size = 1 + fabs(x[8]);
    assert_true(fmin(hypot(mu.mu[0].re - x[8], mu.mu[0].im - x[9]), hypot(mu.mu[0].re - x[10], mu.mu[0].im - x[11])) <
                1e-7 * size);
    compared++;
    ric_multipliers_clear(&mu);
    ric_family_destroy(&family);
    ric_system_destroy(&m.system);
  }
  print_message("[ %zu points ]\n", compared);
  assert_true(compared > 40);
  reference_clear(&table);
}

/* From the doubling of the asymmetric branch to the motion of twice the period. */
typedef struct doubled_walk {
  ric_family *family;
  seen seen;
  size_t doublings;
} doubled_walk;

static int double_there(const ric_family_point *point, void *user) {
  doubled_walk *w = user;
  ric_family_junction j;
  ric_curve_run run;
  ric_error error;
  (void)look(point, &w->seen);
  if (point->kind != RIC_FAMILY_PERIOD_DOUBLING)
    return 0;
  check(ric_family_double(w->family, point, &j, &error), &error);
  seen s = {0};
  check(ric_family_follow(j.family, j.z, j.parameter, j.tangent, look, &s, &run, &error), &error);
  assert_true(s.points > 3);
  w->doublings++;
  ric_family_junction_clear(&j);
  return 0;
}

static void asymmetric_branch_doubles_where_the_reference_says(void **state) {
  (void)state;
  reference table = reference_read("duffing");
  model m = duffing(14);
  ric_error error;
  doubled_walk w = {0};
  m.lattice.force_cos = &m.force;
  ric_family_options options = range(0.61, 0.73, 0.005);
  options.curve.points = 400;
  w.family = family_of(&m, &forced, &options);
  for (size_t k = 0; k < table.count; k++) {
    const reference_row *r = &table.rows[k];
    const double *x = r->value;
    if (x[1] != 14 || x[2] != 1 || strcmp(r->word, "doubling") != 0)
      continue;
    double z[2];
    ric_curve_run run;
    w.seen = (seen){0};
    check(ric_family_start(w.family, x[4] - 1e-3, &x[5], &x[6], NULL, turn / x[4], z, NULL, &error), &error);
    check(ric_family_follow(w.family, z, x[4] - 1e-3, NULL, double_there, &w, &run, &error), &error);
    assert_row_is_seen(&w.seen, r);
  }
  assert_true(w.doublings >= 2);
  ric_family_destroy(&w.family);
  ric_system_destroy(&m.system);
  reference_clear(&table);
}

/* --- two masses and a wall ---------------------------------------------------------------------------------------- */

/* Columns: ratio, eps, T, q1, V, energy, h1, h2, admissible. */
static void two_masses_move_as_the_reference_says(void **state) {
  (void)state;
  reference table = reference_read("two_mass_cubic");
  static const size_t wall = 0;
  for (size_t k = 0; k < table.count; k++) {
    const double *x = table.rows[k].value;
    const ric_spring links[3] = {{3, 0, 0, 0}, {1, 0, x[1], 0}, {0, 0, 0, 0}};
    ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
    ric_obstacle obstacle = ric_obstacle_wall(1, 2);
    ric_system *system = NULL;
    ric_error error;
    ric_orbit orbit;
    ric_shooting *shooting = NULL;
    lattice.on_site = (ric_spring){0};
    lattice.links = links;
    check(ric_system_create_lattice(&lattice, &obstacle, 1, &system, &error), &error);
    for (int energy = 0; energy < 2; energy++) {
      const ric_shooting_problem problem = {.kind = RIC_MOTION_EVEN,
                                            .energy_given = energy,
                                            .at_start = &wall,
                                            .start_count = 1,
                                            .flow = ric_flow_options_default()};
      double q[2] = {x[3] + 1e-3, 2}, u[2] = {0, -x[4]}, z[3], given = energy ? x[5] : x[2];
      check(ric_shooting_create(system, &problem, &shooting, &error), &error);
      check(ric_orbit_init_for(&orbit, system, 1, &error), &error);
      check(ric_shooting_guess(shooting, q, u, NULL, x[2], z, &error), &error);
      check(ric_shooting_solve(shooting, z, given, 0, NULL, &error), &error);
      check(ric_shooting_orbit(shooting, z, given, &orbit, &error), &error);
      assert_close(orbit.period, x[2], 1e-9);
      assert_close(orbit.q[0], x[3], 1e-9);
      assert_close(-orbit.v[1], x[4], 1e-9);
      assert_close(orbit.energy, x[5], 1e-9);
      assert_close(orbit.q_half[0], x[6], 1e-9);
      assert_close(orbit.q_half[1], x[7], 1e-9);
      assert_int_equal(orbit.outcome == RIC_ADMISSIBLE, x[8] == 1);
      ric_orbit_clear(&orbit);
      ric_shooting_destroy(&shooting);
    }
    ric_system_destroy(&system);
  }
  reference_clear(&table);
}

/* --- breathers and Hertz contact ---------------------------------------------------------------------------------- */

static const ric_shooting_problem even = {.kind = RIC_MOTION_EVEN, .flow = {.longest_step = INFINITY}};

static void put_coupling(model *m, double p) {
  m->lattice.link.linear = p;
}

static double distance(const double *a, const double *b, size_t count) {
  double worst = 0;
  for (size_t i = 0; i < count; i++)
    worst = fmax(worst, fabs(a[i] - b[i]));
  return worst;
}

/* Columns: s, T, b, gamma, energy, largest, unstable, q0, ... */
static void breathers_follow_from_the_limit_without_coupling(void **state) {
  (void)state;
  reference table = reference_read("breathers");
  double worst = 0;
  for (size_t k = 0; k < table.count; k++) {
    const double *x = table.rows[k].value;
    model m = {.lattice = ric_lattice_default(21, RIC_ENDS_PERIODIC), .period = x[1], .put = put_coupling};
    ric_error error;
    m.lattice.on_site.cubic = x[0];
    m.lattice.link.cubic = x[2];
    ric_family_options options = range(0, fmax(x[3], 1e-3), 0.02);
    ric_family *family = family_of(&m, &even, &options);
    double q[21] = {0}, u[21] = {0}, z[21];
    seen s = {0};
    ric_curve_run run;
    q[10] = sqrt(8 / 3.0 * (1 - x[1] / turn) / x[0]);
    check(ric_family_start(family, 0, q, u, NULL, x[1], z, NULL, &error), &error);
    if (x[3] > 0) {
      check(ric_family_follow(family, z, 0, NULL, look, &s, &run, &error), &error);
      assert_int_equal(run.end, RIC_CURVE_BOUND);
      assert_true(s.last == x[3]);
      assert_close(s.energy, x[4], 1e-10);
      assert_close(s.largest, x[5], 1e-6);
      worst = fmax(worst, distance(s.z_last, x + 7, 21));
    } else
      worst = fmax(worst, distance(z, x + 7, 21));
    ric_family_destroy(&family);
    ric_system_destroy(&m.system);
  }
  print_message("[ %zu breathers, worst %.3g ]\n", table.count, worst);
  assert_true(worst < 1e-10);
  reference_clear(&table);
}

static model hertz_ring(size_t n, double stiffness, double period) {
  model m = {
      .lattice = ric_lattice_default(n, RIC_ENDS_PERIODIC), .obstacle_count = n, .period = period, .put = put_coupling};
  for (size_t i = 0; i < n; i++) {
    m.obstacles[i] = ric_obstacle_floor(i, -1);
    m.obstacles[i].stiffness = stiffness;
  }
  return m;
}

/* The single oscillator presses as deep as its energy takes it. */
static void start_pressed(ric_family *family, double at, size_t particle, double stiffness, double period, double *z) {
  double q[MOST_PARTICLES] = {0}, u[MOST_PARTICLES] = {0}, v = fabs(tan(period / 2));
  ric_error error;
  q[particle] = -1 - pow(5 * v * v / (4 * stiffness), 0.4);
  check(ric_family_start(family, at, q, u, NULL, period, z, NULL, &error), &error);
}

/* Columns: n, p, k, gamma, tc, energy, q0, ... */
static void compare_hertz(const char *name) {
  reference table = reference_read(name);
  const double period = 0.75 * turn;
  double worst = 0, closure = 0;
  for (size_t k = 0; k < table.count; k++) {
    const double *x = table.rows[k].value;
    size_t n = (size_t)x[0];
    model m = hertz_ring(n, x[2], period);
    ric_error error;
    ric_curve_run run;
    seen s = {0};
    double z[MOST_PARTICLES], u[MOST_PARTICLES] = {0};
    ric_family_options options = range(0, fmax(x[3], 1e-3), 0.02);
    ric_family *family = family_of(&m, &even, &options);
    start_pressed(family, 0, (size_t)x[1], x[2], period, z);
    if (x[3] > 0) {
      check(ric_family_follow(family, z, 0, NULL, look, &s, &run, &error), &error);
      memcpy(z, s.z_last, n * sizeof *z);
      assert_close(s.energy, x[5], 1e-10 * x[5]);
    }
    worst = fmax(worst, distance(z, x + 6, n));
    /* Another flow, at a tighter tolerance, over the whole period. */
    ric_verify_options verify = ric_verify_options_default();
    ric_verification v;
    verify.motion.flow.method = RIC_FLOW_CVODES;
    verify.motion.flow.tolerance = 1e-13;
    m.put(&m, x[3]);
    check(ric_system_set_lattice(m.system, &m.lattice, &error), &error);
    ric_orbit free_motion;
    check(ric_orbit_init_for(&free_motion, m.system, 0, &error), &error);
    free_motion.period = period;
    check(ric_verify(m.system, &free_motion, 0, z, u, &verify, &v, &error), &error);
    ric_orbit_clear(&free_motion);
    assert_int_equal(v.result, RIC_VERIFIED);
    closure = fmax(closure, v.closure_error);
    ric_family_destroy(&family);
    ric_system_destroy(&m.system);
  }
  print_message("[ %s: worst %.3g, closure by CVODES %.3g ]\n", name, worst, closure);
  assert_true(worst < 1e-10);
  reference_clear(&table);
}

static void hertz_orbits_are_those_of_the_reference(void **state) {
  (void)state;
  compare_hertz("hertz_orbits_4");
  compare_hertz("hertz_orbits_30");
}

static void hertz_orbits_converge_near_the_first_resonance(void **state) {
  (void)state;
  const double period = 0.75 * turn, end = 0.999 * ric_gamma_c(period);
  static const double stiffness[] = {100, 1e4, 1e6};
  for (int k = 0; k < 3; k++) {
    model m = hertz_ring(30, stiffness[k], period);
    ric_family_options options = range(0, end, 0.02);
    options.multipliers = false;
    ric_family *family = family_of(&m, &even, &options);
    double z[MOST_PARTICLES];
    seen s = {0};
    ric_curve_run run;
    ric_error error;
    start_pressed(family, 0, 15, stiffness[k], period, z);
    check(ric_family_follow(family, z, 0, NULL, look, &s, &run, &error), &error);
    if (run.end != RIC_CURVE_BOUND)
      fail_msg("k = %g: %s at gamma = %g: %s", stiffness[k], ric_curve_end_name(run.end), s.last, run.reason);
    assert_true(s.last == end);
    ric_family_destroy(&family);
    ric_system_destroy(&m.system);
  }
}

static void put_stiffness(model *m, double p) {
  for (size_t i = 0; i < m->obstacle_count; i++)
    m->obstacles[i].stiffness = exp(p);
}

/* Differences from the orbit of the impact law along the stiffness. */
typedef struct approach {
  const ric_orbit *orbit;
  double stiffness[2], error[2];
} approach;

static int measure(const ric_family_point *point, void *user) {
  approach *a = user;
  double k = exp(point->parameter), worst = 0;
  size_t n = a->orbit->particles;
  for (size_t i = 0; i < n; i++)
    if (i != 15)
      worst = fmax(worst, fabs(point->z[i] - a->orbit->q[i]));
  int which = k > 9.9e5 ? 1 : 0;
  if (k > 9e3 && (which == 1 || a->error[0] == 0)) {
    a->stiffness[which] = k;
    a->error[which] = worst;
  }
  return 0;
}

static void hertz_orbits_tend_to_those_of_the_impact_law_as_the_stiffness_to_the_minus_two_fifths(void **state) {
  (void)state;
  const double period = 0.75 * turn;
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_single(30, RIC_ENDS_PERIODIC, 0.1, period, 15));
  model m = hertz_ring(30, 100, period);
  ric_family_options options = range(0, 0.1, 0.02);
  ric_family *family = family_of(&m, &even, &options);
  double z[MOST_PARTICLES];
  seen s = {0};
  ric_curve_run run;
  ric_error error;
  start_pressed(family, 0, 15, 100, period, z);
  check(ric_family_follow(family, z, 0, NULL, look, &s, &run, &error), &error);
  ric_family_destroy(&family);
  m.put = put_stiffness;
  options = range(log(100), log(1e6), 0.5);
  family = family_of(&m, &even, &options);
  approach a = {.orbit = &x.orbit};
  check(ric_family_follow(family, s.z_last, log(100), NULL, measure, &a, &run, &error), &error);
  assert_int_equal(run.end, RIC_CURVE_BOUND);
  double rate = log(a.error[1] / a.error[0]) / log(a.stiffness[1] / a.stiffness[0]);
  print_message("[ rate %.4f, error %.3g at k = %.3g ]\n", rate, a.error[1], a.stiffness[1]);
  assert_close(rate, -0.4, 0.01);
  ric_family_destroy(&family);
  ric_system_destroy(&m.system);
  solved_orbit_clear(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frequency_response_has_the_folds_and_branch_points_of_the_reference),
      cmocka_unit_test(regular_points_have_the_multipliers_of_the_reference),
      cmocka_unit_test(asymmetric_branch_doubles_where_the_reference_says),
      cmocka_unit_test(two_masses_move_as_the_reference_says),
      cmocka_unit_test(breathers_follow_from_the_limit_without_coupling),
      cmocka_unit_test(hertz_orbits_are_those_of_the_reference),
      cmocka_unit_test(hertz_orbits_converge_near_the_first_resonance),
      cmocka_unit_test(hertz_orbits_tend_to_those_of_the_impact_law_as_the_stiffness_to_the_minus_two_fifths),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

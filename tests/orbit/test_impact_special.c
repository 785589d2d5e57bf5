/* Resonances, blow-ups and modes that do not move the coordinate; what has no orbits in closed form is named. */
#include "support.h"

#include "witness/double_pendulum.h"
#include "witness/impact_study.h"

static const double pi = 3.14159265358979323846;

static ric_system *chain_system(size_t n, ric_ends ends, double gamma) {
  ric_chain chain = ric_chain_default(n, gamma);
  ric_system *system;
  chain.ends = ends;
  assert_int_equal(ric_system_create_chain(&chain, &system, NULL), RIC_OK);
  return system;
}

/* The middle one of three alike: modes of w^2 = 1 and 4, and between them one of 1.2 that does not move it. */
static ric_impact_modes *middle_of_three(ric_system **system) {
  const double half = 0.5, root = sqrt(half), unit[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double square[] = {1, 1.2, 4}, phi[3][3] = {{half, root, half}, {root, 0, -root}, {half, -root, half}};
  const ric_obstacle wall = ric_obstacle_wall(1, 1);
  double stiffness[9] = {0};
  ric_impact_modes *modes;
  for (size_t e = 0; e < 9; e++)
    for (size_t j = 0; j < 3; j++)
      stiffness[e] += square[j] * phi[j][e / 3] * phi[j][e % 3];
  ric_mck mck = {.coordinates = 3, .mass.values = unit, .stiffness.values = stiffness};
  assert_int_equal(ric_system_create_mck(&mck, &wall, 1, system, NULL), RIC_OK);
  assert_int_equal(ric_impact_modes_create(*system, 0, &modes, NULL), RIC_OK);
  return modes;
}

static void orbit_of_a_blow_up_is_singular_without_a_state(void **state) {
  (void)state;
  const double one = 1;
  ric_mck mck = {.coordinates = 1, .mass.values = &one, .stiffness.values = &one};
  ric_obstacle floor = ric_obstacle_floor(0, -1);
  ric_system *system;
  assert_int_equal(ric_system_create_mck(&mck, &floor, 1, &system, NULL), RIC_OK);
  impact_study s = impact_study_of(system, &floor);
  impact_study_solve(&s, pi); /* cot(pi / 2) */
  assert_int_equal(s.orbit.outcome, RIC_SINGULAR);
  assert_true(isnan(s.orbit.q[0]) && isnan(s.orbit.impulse[0]) && isnan(s.orbit.energy));
  assert_true(s.orbit.condition > 1e9);
  assert_non_null(strstr(s.orbit.reason, "blow up"));
  double q, v;
  ric_error error;
  assert_int_equal(ric_impact_modes_state(s.modes, pi, 0, &q, &v, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "blow up"));
  impact_study_clear(&s);
}

static void mode_that_does_not_move_the_coordinate_has_a_free_amplitude(void **state) {
  (void)state;
  ric_system *system;
  ric_impact_modes *modes = middle_of_three(&system);
  ric_orbit orbit, beside;
  double period = 2 * pi / ric_impact_modes_frequencies(modes)[1];
  ric_orbit_init(&orbit, 3, 1, NULL);
  ric_orbit_init(&beside, 3, 1, NULL);
  assert_int_equal(ric_impact_modes_orbit(modes, period, &orbit, NULL), RIC_OK);
  assert_int_equal(orbit.outcome, RIC_RESONANT);
  assert_int_equal(orbit.mode, 1);
  assert_int_equal(orbit.harmonic, 1);
  assert_non_null(strstr(orbit.reason, "its amplitude is free"));
  assert_int_equal(ric_impact_modes_orbit(modes, period * (1 + 1e-9), &beside, NULL), RIC_OK);
  assert_int_equal(beside.outcome, RIC_ADMISSIBLE);
  for (size_t i = 0; i < 3; i++)
    assert_close(beside.q[i], orbit.q[i], 1e-7);
  ric_orbit_clear(&orbit);
  ric_orbit_clear(&beside);
  ric_impact_modes_destroy(&modes);
  ric_system_destroy(&system);
}

static int count_ends(const ric_impact_interval *interval, void *user) {
  int *count = user;
  *count += interval->high_end != RIC_INTERVAL_BOUND;
  return 0;
}

static void mode_that_does_not_move_the_coordinate_ends_no_interval(void **state) {
  (void)state;
  ric_system *system;
  ric_impact_modes *modes = middle_of_three(&system);
  double period = 2 * pi / ric_impact_modes_frequencies(modes)[1];
  int count = 0;
  assert_int_equal(ric_impact_modes_intervals(modes, 0.99 * period, 1.01 * period, 0, count_ends, &count, NULL),
                   RIC_OK);
  assert_int_equal(count, 0);
  ric_impact_modes_destroy(&modes);
  ric_system_destroy(&system);
}

/* Modes of a ring come in pairs; of each only one moves a given particle. */
static void modes_of_one_frequency_are_chosen_so_that_one_moves_the_coordinate(void **state) {
  (void)state;
  enum { N = 8 };
  ric_system *system = chain_system(N, RIC_ENDS_PERIODIC, 0.3);
  ric_impact_modes *modes;
  assert_int_equal(ric_impact_modes_create(system, 3, &modes, NULL), RIC_OK);
  const double *w = ric_impact_modes_frequencies(modes);
  size_t moving = 0;
  for (size_t j = 0; j < N; j++) {
    const double *phi = ric_impact_modes_shape(modes, j);
    double length = 0;
    for (size_t i = 0; i < N; i++)
      length += phi[i] * phi[i];
    assert_close(length, 1, 1e-13);
    moving += fabs(phi[3]) > 1e-12;
    for (size_t i = 0; i < N; i++) { /* K phi = w^2 phi */
      double force = phi[i] - 0.3 * (phi[(i + 1) % N] - 2 * phi[i] + phi[(i + N - 1) % N]);
      assert_close(force, w[j] * w[j] * phi[i], 1e-13);
    }
  }
  assert_int_equal(moving, N / 2 + 1);
  assert_null(ric_impact_modes_shape(modes, N));
  ric_impact_modes_destroy(&modes);
  ric_system_destroy(&system);
}

/* Two masses on a stiff link are one of twice the mass, but for 3e-13, before one of 1 on springs 1.3 and 0.7. */
static void slow_modes_of_stiff_systems_keep_their_own_frequencies(void **state) {
  (void)state;
  const double masses[] = {1, 1, 1}, rigid[] = {2, 1};
  const ric_spring links[] = {{.linear = 1}, {.linear = 3e12}, {.linear = 1.3}, {.linear = 0.7}};
  const ric_spring others[] = {{.linear = 1}, {.linear = 1.3}, {.linear = 0.7}};
  const ric_obstacle walls[] = {ric_obstacle_wall(2, 1), ric_obstacle_wall(1, 1)};
  ric_lattice lattice = ric_lattice_default(3, RIC_ENDS_FIXED), two = ric_lattice_default(2, RIC_ENDS_FIXED);
  ric_system *systems[2];
  ric_impact_modes *modes[2];
  lattice.on_site = two.on_site = (ric_spring){0};
  lattice.masses = masses;
  lattice.links = links;
  two.masses = rigid;
  two.links = others;
  assert_int_equal(ric_system_create_lattice(&lattice, &walls[0], 1, &systems[0], NULL), RIC_OK);
  assert_int_equal(ric_system_create_lattice(&two, &walls[1], 1, &systems[1], NULL), RIC_OK);
  for (int k = 0; k < 2; k++)
    assert_int_equal(ric_impact_modes_create(systems[k], 0, &modes[k], NULL), RIC_OK);
  const double *w = ric_impact_modes_frequencies(modes[0]), *expected = ric_impact_modes_frequencies(modes[1]);
  for (size_t j = 0; j < 2; j++) /* w^2 are 0.56 and 2.59; their rounding is 2e-16 of 6e12 */
    assert_close(w[j] * w[j], expected[j] * expected[j], 1e-2);
  for (int k = 0; k < 2; k++) {
    ric_impact_modes_destroy(&modes[k]);
    ric_system_destroy(&systems[k]);
  }
}

/* Impulses of periods that are hardly numbers are zero. */
static void orbits_that_do_not_reach_the_obstacle_are_failed(void **state) {
  (void)state;
  impact_study s = impact_study_two_masses();
  impact_study_solve(&s, 1e-320);
  assert_int_equal(s.orbit.outcome, RIC_FAILED);
  assert_non_null(strstr(s.orbit.reason, "equations are violated by 2,"));
  impact_study_clear(&s);
}

/* Frequencies 1 and 2: at T = 2 pi both are at resonance, and the family tends to one combination of them. */
static void modes_at_resonance_together_share_the_limit(void **state) {
  (void)state;
  const double unit[] = {1, 0, 0, 1}, stiffness[] = {2.5, -1.5, -1.5, 2.5};
  ric_mck mck = {.coordinates = 2, .mass.values = unit, .stiffness.values = stiffness};
  ric_obstacle wall = ric_obstacle_wall(0, 1.5);
  ric_system *system;
  ric_orbit beside;
  assert_int_equal(ric_system_create_mck(&mck, &wall, 1, &system, NULL), RIC_OK);
  impact_study s = impact_study_of(system, &wall);
  ric_orbit_init(&beside, 2, 1, NULL);
  impact_study_solve(&s, 2 * pi);
  assert_int_equal(s.orbit.outcome, RIC_GRAZING);
  assert_close(s.orbit.q[0], 1.5, 1e-14);
  for (int side = -1; side <= 1; side += 2) {
    assert_int_equal(ric_impact_modes_orbit(s.modes, 2 * pi * (1 + side * 1e-8), &beside, NULL), RIC_OK);
    for (size_t i = 0; i < 2; i++) {
      assert_close(beside.q[i], s.orbit.q[i], 1e-6);
      assert_close(beside.q_half[i], s.orbit.q_half[i], 1e-6);
    }
  }
  ric_orbit_clear(&beside);
  impact_study_clear(&s);
}

/* --- refusals ----------------------------------------------------------------------------------------------------- */

static void check_refused(ric_system *system, size_t obstacle, ric_status expected, const char *named) {
  ric_impact_modes *modes;
  ric_error error;
  assert_non_null(system);
  assert_int_equal(ric_impact_modes_create(system, obstacle, &modes, &error), expected);
  assert_null(modes);
  if (!strstr(error.message, named))
    fail_msg("'%s' does not name '%s'", error.message, named);
  ric_system_destroy(&system);
}

/* Two particles with one thing of their own. */
static ric_system *pair(ric_spring site, ric_spring link, ric_obstacle obstacle) {
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_system *system;
  lattice.on_site = site;
  lattice.link = link;
  assert_int_equal(ric_system_create_lattice(&lattice, &obstacle, 1, &system, NULL), RIC_OK);
  return system;
}

static void systems_that_are_not_linear_and_conservative_are_named(void **state) {
  (void)state;
  const ric_spring site = {.linear = 1}, none = {0};
  const ric_obstacle wall = ric_obstacle_wall(0, 1);
  check_refused(pair((ric_spring){.linear = 1, .damping = 0.1}, none, wall), 0, RIC_EINVAL,
                "on-site spring 0: damping = 0.1");
  check_refused(pair(site, (ric_spring){.linear = 1, .cubic = 0.2}, wall), 0, RIC_EINVAL, "link 1: cubic = 0.2");
  check_refused(pair((ric_spring){.linear = 1, .quadratic = -1}, none, wall), 0, RIC_EINVAL, "quadratic = -1");
  check_refused(pair(none, (ric_spring){.linear = 1}, wall), 0, RIC_EINVAL, "singular");
  check_refused(pair((ric_spring){.linear = -1}, none, wall), 0, RIC_ENUMERIC, "w^2 = -1");
}

static void forcing_and_matrices_that_damp_are_named(void **state) {
  (void)state;
  const double one = 1, force = 0.5, nothing = 0;
  const ric_obstacle wall = ric_obstacle_wall(0, 1);
  ric_mck mck = {.coordinates = 1, .mass.values = &one, .stiffness.values = &one, .damping.values = &force};
  ric_system *system;
  assert_int_equal(ric_system_create_mck(&mck, &wall, 1, &system, NULL), RIC_OK);
  check_refused(system, 0, RIC_EINVAL, "damping matrix");
  mck.damping.values = &nothing;
  mck.force_sin = &force;
  assert_int_equal(ric_system_create_mck(&mck, &wall, 1, &system, NULL), RIC_OK);
  check_refused(system, 0, RIC_EINVAL, "force_sin");
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.force_cos = &force;
  assert_int_equal(ric_system_create_lattice(&lattice, &wall, 1, &system, NULL), RIC_OK);
  check_refused(system, 0, RIC_EINVAL, "force_cos[0] = 0.5");
  /* A force of zero and a damping matrix of zeros are none. */
  mck.force_sin = &nothing;
  assert_int_equal(ric_system_create_mck(&mck, &wall, 1, &system, NULL), RIC_OK);
  impact_study s = impact_study_of(system, &wall);
  impact_study_clear(&s);
}

static void obstacles_that_are_not_hit_elastically_are_named(void **state) {
  (void)state;
  const ric_spring site = {.linear = 1}, none = {0};
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  check_refused(pair(site, none, wall), 1, RIC_EINVAL, "obstacle = 1, expected less than 1");
  wall.restitution = 0.9;
  check_refused(pair(site, none, wall), 0, RIC_EINVAL, "restitution = 0.9");
  wall = ric_obstacle_wall(0, 0);
  check_refused(pair(site, none, wall), 0, RIC_EINVAL, "position = 0");
  wall = ric_obstacle_wall(0, 1);
  wall.stiffness = 100;
  check_refused(pair(site, none, wall), 0, RIC_EINVAL, "stiffness = 100, expected a rigid one");
}

/* It would be touched whenever the other one is hit. */
static void obstacles_where_the_one_that_is_hit_stands_are_named(void **state) {
  (void)state;
  const ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  const ric_obstacle floor = ric_obstacle_floor(1, -1), away = ric_obstacle_floor(0, -1);
  const ric_obstacle twice[] = {floor, away, floor}, opposite[] = {floor, away, ric_obstacle_wall(1, -1)};
  ric_system *system;
  ric_impact_modes *modes;
  for (size_t hit = 0; hit <= 2; hit += 2) {
    assert_int_equal(ric_system_create_lattice(&lattice, twice, 3, &system, NULL), RIC_OK);
    check_refused(system, hit, RIC_EINVAL, hit == 0 ? "obstacle 2: position = -1" : "obstacle 0: position = -1");
  }
  assert_int_equal(ric_system_create_lattice(&lattice, opposite, 3, &system, NULL), RIC_OK);
  assert_int_equal(ric_impact_modes_create(system, 0, &modes, NULL), RIC_OK);
  ric_impact_modes_destroy(&modes);
  ric_system_destroy(&system);
}

static void user_systems_are_refused(void **state) {
  (void)state;
  const ric_mechanical pendulum = {
      .coordinates = 2, .speeds = 2, .mass = double_pendulum_mass, .force = double_pendulum_force};
  ric_system *system;
  assert_int_equal(ric_system_create_mechanical(&pendulum, &system, NULL), RIC_OK);
  check_refused(system, 0, RIC_EINVAL, "user system");
}

static void requests_out_of_range_are_refused_by_name(void **state) {
  (void)state;
  static const double periods[] = {0, -1, NAN, INFINITY};
  impact_study s = impact_study_two_masses();
  ric_orbit large;
  ric_error error;
  double q[2], v[2];
  for (size_t i = 0; i < 4; i++) {
    assert_int_equal(ric_impact_modes_orbit(s.modes, periods[i], &s.orbit, &error), RIC_EINVAL);
    assert_non_null(strstr(error.message, "period = "));
    assert_int_equal(ric_impact_modes_state(s.modes, periods[i], 0, q, v, &error), RIC_EINVAL);
  }
  assert_int_equal(ric_impact_modes_state(s.modes, 7, INFINITY, q, v, &error), RIC_EINVAL);
  assert_int_equal(ric_impact_modes_orbit(s.modes, 1e8, &s.orbit, &error), RIC_ELIMIT);
  ric_orbit_init(&large, 3, 1, NULL);
  assert_int_equal(ric_impact_modes_orbit(s.modes, 7, &large, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "room for 3"));
  ric_orbit_clear(&large);
  int count = 0;
  static const double ranges[][2] = {{0, 1}, {2, 2}, {3, 2}, {NAN, 1}, {1, INFINITY}};
  for (size_t i = 0; i < 5; i++) {
    assert_int_equal(ric_impact_modes_intervals(s.modes, ranges[i][0], ranges[i][1], 0, count_ends, &count, &error),
                     RIC_EINVAL);
    assert_non_null(strstr(error.message, "range ["));
  }
  assert_int_equal(ric_impact_modes_intervals(s.modes, 1, 2, SIZE_MAX, count_ends, &count, &error), RIC_ELIMIT);
  assert_int_equal(ric_impact_modes_intervals(s.modes, 1, 1e8, 0, count_ends, &count, &error), RIC_ELIMIT);
  impact_study_clear(&s);
  ric_impact_modes_destroy(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(orbit_of_a_blow_up_is_singular_without_a_state),
      cmocka_unit_test(mode_that_does_not_move_the_coordinate_has_a_free_amplitude),
      cmocka_unit_test(mode_that_does_not_move_the_coordinate_ends_no_interval),
      cmocka_unit_test(modes_of_one_frequency_are_chosen_so_that_one_moves_the_coordinate),
      cmocka_unit_test(slow_modes_of_stiff_systems_keep_their_own_frequencies),
      cmocka_unit_test(orbits_that_do_not_reach_the_obstacle_are_failed),
      cmocka_unit_test(modes_at_resonance_together_share_the_limit),
      cmocka_unit_test(systems_that_are_not_linear_and_conservative_are_named),
      cmocka_unit_test(forcing_and_matrices_that_damp_are_named),
      cmocka_unit_test(obstacles_that_are_not_hit_elastically_are_named),
      cmocka_unit_test(obstacles_where_the_one_that_is_hit_stands_are_named),
      cmocka_unit_test(user_systems_are_refused),
      cmocka_unit_test(requests_out_of_range_are_refused_by_name),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

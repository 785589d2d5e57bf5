/* What Ritz's method refuses: named, with the value received. */
#include "support.h"

#include "witness/ritz_approximation.h"
#include "witness/recorded_run.h"

static void assert_says(ric_status status, ric_status expected, const ric_error *error, const char *part) {
  assert_int_equal(status, expected);
  assert_int_equal(error->status, expected);
  if (!strstr(error->message, part))
    fail_msg("'%s' not in '%s'", part, error->message);
}

/* Takes the system over. */
static void assert_refused(ric_system *system, size_t obstacle, const ric_ritz_options *options, const char *part) {
  ric_error error = {0};
  ric_ritz *ritz = (ric_ritz *)(uintptr_t)1;
  assert_says(ric_ritz_create(system, obstacle, options, &ritz, &error), RIC_EINVAL, &error, part);
  assert_null(ritz);
  assert_int_equal(ric_ritz_create(system, obstacle, options, &ritz, NULL), RIC_EINVAL);
  ric_system_destroy(&system);
}

static void options_out_of_range_are_refused(void **state) {
  (void)state;
  ric_ritz_options options = ric_ritz_options_default();
  options.functions = 0;
  assert_refused(duffing_masses(0.1, -1), 0, &options, "functions = 0, expected 1 to 300");
  options.functions = 301;
  assert_refused(duffing_masses(0.1, -1), 0, &options, "functions = 301, expected 1 to 300");
  options = (ric_ritz_options){.functions = 4, .points = 1025};
  assert_refused(duffing_masses(0.1, -1), 0, &options, "points = 1025, expected 0 or 8 to 1024");
  options.points = 7;
  assert_refused(duffing_masses(0.1, -1), 0, &options, "points = 7, expected 0 or 8 to 1024");
}

static void most_functions_have_their_rule(void **state) {
  (void)state;
  const ric_ritz_options options = {.functions = RIC_RITZ_MOST};
  ric_system *system = duffing_masses(0.1, -1);
  ric_ritz *ritz = NULL;
  assert_int_equal(ric_ritz_create(system, 0, &options, &ritz, NULL), RIC_OK);
  assert_int_equal(ric_ritz_points(ritz), 1024);
  ric_ritz_destroy(&ritz);
  ric_ritz_destroy(&ritz);
  ric_system_destroy(&system);
}

static int drift(double t, const double *x, double *rate, void *user) {
  (void)t, (void)x, (void)user;
  rate[0] = 1;
  return 0;
}

static void systems_that_are_no_lattices_are_refused(void **state) {
  (void)state;
  const ric_first_order model = {.states = 1, .rate = drift};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
  assert_refused(system, 0, NULL, "needs a lattice");
  const ric_obstacle wall = ric_obstacle_wall(0, 1);
  assert_refused(coupled_masses(&wall, 1), 0, NULL, "needs a lattice");
}

static ric_lattice masses(void) {
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  lattice.link.linear = 1;
  return lattice;
}

static void losses_and_forcing_are_refused(void **state) {
  (void)state;
  static const double push[2] = {0, 0.3};
  const ric_obstacle wall = ric_obstacle_wall(1, 2);
  ric_lattice lattice = masses();
  lattice.on_site.damping = 0.1;
  assert_refused(lattice_system(&lattice, &wall, 1), 0, NULL, "on-site spring 0: damping = 0.1, expected 0");
  lattice = masses();
  lattice.link.damping = 0.2;
  assert_refused(lattice_system(&lattice, &wall, 1), 0, NULL, "link 0: damping = 0.2, expected 0");
  lattice = masses();
  lattice.force_cos = push;
  assert_refused(lattice_system(&lattice, &wall, 1), 0, NULL, "force_cos[1] = 0.3, expected 0");
  lattice = masses();
  lattice.force_sin = push;
  assert_refused(lattice_system(&lattice, &wall, 1), 0, NULL, "force_sin[1] = 0.3, expected 0");
}

static void other_obstacles_are_refused(void **state) {
  (void)state;
  const ric_lattice lattice = masses();
  ric_obstacle obstacles[2] = {ric_obstacle_wall(1, 2), ric_obstacle_floor(0, -2)};
  assert_refused(lattice_system(&lattice, obstacles, 2), 2, NULL, "obstacle = 2, expected one of 2");
  assert_refused(lattice_system(&lattice, NULL, 0), 0, NULL, "obstacle = 0, expected one of 0");
  obstacles[0].restitution = 0.9;
  assert_refused(lattice_system(&lattice, obstacles, 2), 0, NULL, "restitution = 0.9 of obstacle 0, expected 1");
  obstacles[0].restitution = 1;
  obstacles[1].stiffness = 100;
  assert_refused(lattice_system(&lattice, obstacles, 2), 0, NULL, "obstacle 1 is compliant (stiffness 100)");
}

/* --- calls -------------------------------------------------------------------------------------------------------- */

typedef struct fixture {
  shooting_solution s;
  ritz_approximation a;
  double F[64];
  ric_error error;
} fixture;

static fixture good_case(void) {
  fixture f = {.s = duffing_mode(0.1, 0.4, -1)};
  f.a = ritz_approximate(&f.s, 4, true);
  return f;
}

static void clear(fixture *f) {
  ritz_approximation_clear(&f->a);
  shooting_solution_clear(&f->s);
}

static void numbers_that_have_no_residual_are_refused(void **state) {
  (void)state;
  static const double periods[4] = {0, -1, NAN, INFINITY};
  static const char *const texts[4] = {"period = 0,", "period = -1,", "nan", "inf"};
  fixture f = good_case();
  ric_ritz *r = f.a.ritz;
  for (size_t k = 0; k < 4; k++) {
    assert_says(ric_ritz_residual(r, f.a.c, periods[k], f.F, NULL, NULL, &f.error), RIC_ENUMERIC, &f.error, texts[k]);
    assert_true(isnan(ric_ritz_defect(r, f.a.c, periods[k])));
  }
  f.a.c[3] = NAN;
  assert_says(ric_ritz_residual(r, f.a.c, 7, f.F, NULL, NULL, &f.error), RIC_ENUMERIC, &f.error, "c[3] = ");
  assert_says(ric_ritz_solve(r, f.a.c, 7, NULL, &f.error), RIC_ENUMERIC, &f.error, "c[3] = ");
  assert_says(ric_ritz_error(r, f.a.c, 7, f.s.shooting, f.s.z, NULL, NULL, &f.error), RIC_ENUMERIC, &f.error, "c[3]");
  assert_true(isnan(ric_ritz_defect(r, f.a.c, 7)));
  clear(&f);
}

static void numbers_of_functions_out_of_range_are_refused(void **state) {
  (void)state;
  fixture f = good_case();
  assert_says(ric_ritz_use(f.a.ritz, 0, NULL, &f.error), RIC_EINVAL, &f.error, "functions = 0, expected 1 to 4");
  assert_says(ric_ritz_use(f.a.ritz, 5, f.a.c, &f.error), RIC_EINVAL, &f.error, "functions = 5, expected 1 to 4");
  assert_int_equal(ric_ritz_functions(f.a.ritz), 4);
  clear(&f);
}

static void frequencies_and_tolerances_out_of_range_are_refused(void **state) {
  (void)state;
  fixture f = good_case();
  static const double bad[3] = {-0.1, 1, NAN}; /* 2 pi / T = 0.92 */
  for (size_t k = 0; k < 3; k++)
    assert_says(ric_ritz_fit(f.a.ritz, f.s.shooting, f.s.z, f.s.given, bad[k], f.a.c, &f.error), RIC_EINVAL, &f.error,
                "frequency = ");
  assert_says(ric_ritz_refine(f.a.ritz, f.s.shooting, f.s.z, f.s.given, -1, f.a.c, NULL, &f.error), RIC_EINVAL,
              &f.error, "tolerance = -1, expected >= 0");
  clear(&f);
}

static void assert_shooting_refused(fixture *f, ric_system *system, const ric_shooting_problem *problem,
                                    const char *part) {
  ric_shooting *other = NULL;
  double z[16] = {0};
  assert_int_equal(ric_shooting_create(system, problem, &other, NULL), RIC_OK);
  assert_says(ric_ritz_fit(f->a.ritz, other, z, 7, 0, f->a.c, &f->error), RIC_EINVAL, &f->error, part);
  assert_says(ric_ritz_error(f->a.ritz, f->a.c, 7, other, z, NULL, NULL, &f->error), RIC_EINVAL, &f->error, part);
  assert_says(ric_ritz_refine(f->a.ritz, other, z, 7, 0, f->a.c, NULL, &f->error), RIC_EINVAL, &f->error, part);
  ric_shooting_destroy(&other);
}

static void motions_of_another_kind_are_refused(void **state) {
  (void)state;
  static const size_t wall = 0;
  fixture f = good_case();
  ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &wall, .start_count = 1, .flow = ric_flow_options_default()};
  ric_system *other = duffing_masses(0.1, -1);
  assert_shooting_refused(&f, other, &problem, "another system");
  problem.energy_given = true;
  assert_shooting_refused(&f, f.s.system, &problem, "expected even ones with a given period");
  problem = (ric_shooting_problem){
      .kind = RIC_MOTION_CONSERVATIVE, .sequence = &wall, .count = 1, .flow = ric_flow_options_default()};
  assert_shooting_refused(&f, f.s.system, &problem, "expected even ones with a given period");
  problem = (ric_shooting_problem){.kind = RIC_MOTION_EVEN, .flow = ric_flow_options_default()};
  assert_shooting_refused(&f, f.s.system, &problem, "expected the one of obstacle 0 at t = 0");
  problem.at_half = &wall;
  problem.half_count = 1;
  assert_shooting_refused(&f, f.s.system, &problem, "expected the one of obstacle 0 at t = 0");
  problem.at_start = &wall;
  problem.start_count = 1;
  assert_shooting_refused(&f, f.s.system, &problem, "expected the one of obstacle 0 at t = 0");
  ric_system_destroy(&other);
  clear(&f);
}

static void numbers_that_have_become_unfit_are_refused(void **state) {
  (void)state;
  fixture f = good_case();
  ric_lattice lattice = masses();
  ric_obstacle wall = ric_obstacle_wall(1, 2);
  lattice.on_site.damping = 0.1;
  assert_int_equal(ric_system_set_lattice(f.s.system, &lattice, NULL), RIC_OK);
  for (int k = 0; k < 2; k++) /* and stay refused */
    assert_says(ric_ritz_residual(f.a.ritz, f.a.c, 7, f.F, NULL, NULL, &f.error), RIC_EINVAL, &f.error, "damping");
  assert_says(ric_ritz_solve(f.a.ritz, f.a.c, 7, NULL, &f.error), RIC_EINVAL, &f.error, "damping");
  assert_says(ric_ritz_fit(f.a.ritz, f.s.shooting, f.s.z, 7, 0, f.a.c, &f.error), RIC_EINVAL, &f.error, "damping");
  assert_says(ric_ritz_error(f.a.ritz, f.a.c, 7, f.s.shooting, f.s.z, NULL, NULL, &f.error), RIC_EINVAL, &f.error,
              "damping");
  lattice.on_site.damping = 0;
  wall.restitution = 0.5;
  assert_int_equal(ric_system_set_lattice(f.s.system, &lattice, NULL), RIC_OK);
  assert_int_equal(ric_system_set_obstacles(f.s.system, &wall, 1, NULL), RIC_OK);
  assert_says(ric_ritz_residual(f.a.ritz, f.a.c, 7, f.F, NULL, NULL, &f.error), RIC_EINVAL, &f.error, "restitution");
  clear(&f);
}

/* --- outcomes of the search --------------------------------------------------------------------------------------- */

/* A spring that pushes away lets no mass come back to where it was. */
static void searches_without_an_end_say_so(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const ric_obstacle floor = ric_obstacle_floor(0, 1);
  const ric_ritz_options options = {.functions = 1, .constants = true};
  ric_ritz *ritz = NULL;
  ric_error error;
  double c[3] = {0.5, 0.5, 0.7};
  int iterations = 0;
  lattice.on_site.linear = -1;
  ric_system *system = lattice_system(&lattice, &floor, 1);
  assert_int_equal(ric_ritz_create(system, 0, &options, &ritz, NULL), RIC_OK);
  assert_says(ric_ritz_solve(ritz, c, 5, &iterations, &error), RIC_ENUMERIC, &error, "Ritz's method does not converge");
  assert_true(iterations > 0);
  ric_ritz_destroy(&ritz);
  ric_system_destroy(&system);
}

/* w = 1 is a solution of the linear oscillator, and above 2 pi / T for T > 2 pi. */
static void solutions_beyond_the_frequency_of_the_period_are_refused(void **state) {
  (void)state;
  const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  const ric_obstacle floor = ric_obstacle_floor(0, -1);
  const ric_ritz_options options = {.functions = 1, .constants = true};
  ric_ritz *ritz = NULL;
  ric_error error;
  double c[3] = {0, 1.2, 1.01};
  ric_system *system = lattice_system(&lattice, &floor, 1);
  assert_int_equal(ric_ritz_create(system, 0, &options, &ritz, NULL), RIC_OK);
  assert_says(ric_ritz_solve(ritz, c, 7, NULL, &error), RIC_ENUMERIC, &error, "converges to w = 1, expected 0 to 2 pi");
  ric_ritz_destroy(&ritz);
  ric_system_destroy(&system);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(options_out_of_range_are_refused),
      cmocka_unit_test(most_functions_have_their_rule),
      cmocka_unit_test(systems_that_are_no_lattices_are_refused),
      cmocka_unit_test(losses_and_forcing_are_refused),
      cmocka_unit_test(other_obstacles_are_refused),
      cmocka_unit_test(numbers_that_have_no_residual_are_refused),
      cmocka_unit_test(numbers_of_functions_out_of_range_are_refused),
      cmocka_unit_test(frequencies_and_tolerances_out_of_range_are_refused),
      cmocka_unit_test(motions_of_another_kind_are_refused),
      cmocka_unit_test(numbers_that_have_become_unfit_are_refused),
      cmocka_unit_test(searches_without_an_end_say_so),
      cmocka_unit_test(solutions_beyond_the_frequency_of_the_period_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

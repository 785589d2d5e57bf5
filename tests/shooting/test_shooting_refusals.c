/* Solutions of the shooting equations that are no motions, because the system has not the symmetry that its kind takes
 * for granted, or because the ends of a conservative motion are apart. */
#include "support.h"

#include "witness/shooting_solution.h"

#include "witness/recorded_run.h"

static const double turn = 6.283185307179586;

/* The equations hold, and yet it is no motion. */
static void assert_no_motion(const shooting_solution *s, const char *word) {
  assert_true(s->orbit.residual < 1e-11);
  if (s->orbit.outcome != RIC_FAILED || !strstr(s->orbit.reason, word))
    fail_msg("%s \"%s\", expected a failure that says \"%s\"", ric_outcome_name(s->orbit.outcome), s->orbit.reason,
             word);
}

/* --- even --------------------------------------------------------------------------------------------------------- */

/* Half a motion of two masses, the first of which hits a wall at t = 0 when `hits`. Takes the system over. */
static shooting_solution even_shot(ric_system *system, bool hits) {
  static const size_t wall = 0;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &wall, .start_count = hits, .flow = ric_flow_options_default()};
  const double q[2] = {1, 0.2}, u[2] = {-0.5, 0};
  shooting_solution s = shooting_solution_of_system(system, &problem);
  shooting_solution_guess(&s, q, u, NULL, turn / 1.3);
  shooting_solution_solve(&s);
  return s;
}

static ric_lattice pushed_masses(const double *push) {
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  lattice.link.linear = 0.3;
  lattice.force_cos = push;
  lattice.frequency = 1.3;
  return lattice;
}

static void assert_even_shot_fails(const ric_lattice *lattice) {
  const ric_obstacle wall = ric_obstacle_wall(0, 1);
  for (int hits = 0; hits < 2; hits++) {
    shooting_solution s = even_shot(lattice_system(lattice, &wall, 1), hits);
    assert_no_motion(&s, "is not reversible");
    shooting_solution_clear(&s);
  }
}

static void even_motions_of_systems_that_run_backwards_as_forwards_are_motions(void **state) {
  (void)state;
  static const double push[2] = {0.2, -0.1};
  const ric_lattice lattice = pushed_masses(push);
  const ric_obstacle wall = ric_obstacle_wall(0, 1);
  for (int hits = 0; hits < 2; hits++) {
    shooting_solution s = even_shot(lattice_system(&lattice, &wall, 1), hits);
    assert_true(s.orbit.outcome != RIC_FAILED);
    shooting_solution_clear(&s);
  }
}

static void even_motions_of_damped_systems_are_none(void **state) {
  (void)state;
  static const double push[2] = {0.2, -0.1};
  ric_lattice lattice = pushed_masses(push);
  lattice.on_site.damping = 1e-3;
  assert_even_shot_fails(&lattice);
  lattice.on_site.damping = 0;
  lattice.link.damping = 1e-3; /* moves on with the difference of two speeds only */
  assert_even_shot_fails(&lattice);
}

static void even_motions_under_sines_are_none(void **state) {
  (void)state;
  static const double push[2] = {0.2, -0.1}, sines[2] = {0, 1e-3};
  ric_lattice lattice = pushed_masses(push);
  lattice.force_sin = sines;
  assert_even_shot_fails(&lattice);
}

/* A force across the speed does no work, and yet turns the other way round when time runs back. */
static void even_motions_of_gyroscopic_systems_are_none(void **state) {
  (void)state;
  static const double mass[4] = {1, 0, 0, 1}, gyroscopic[4] = {0, 0.2, -0.2, 0}, stiffness[4] = {2, -0.3, -0.3, 1};
  static const double push[2] = {0.2, -0.1};
  const ric_mck model = {.coordinates = 2,
                         .mass.values = mass,
                         .damping.values = gyroscopic,
                         .stiffness.values = stiffness,
                         .frequency = 1.3,
                         .force_cos = push};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mck(&model, NULL, 0, &system, NULL), RIC_OK);
  shooting_solution s = even_shot(system, false);
  assert_no_motion(&s, "is not reversible");
  shooting_solution_clear(&s);
}

/* --- forced ------------------------------------------------------------------------------------------------------- */

/* Two damped masses, pushed, over a period of the caller's. The equations have a solution for any. */
static shooting_solution forced_shot(double period, size_t impacts) {
  static const double push[2] = {1.5, 0};
  static const size_t wall = 0;
  ric_lattice lattice = pushed_masses(push);
  ric_obstacle obstacle = ric_obstacle_wall(0, 0.5);
  lattice.on_site.damping = 0.1;
  obstacle.restitution = 0.8;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_FORCED, .sequence = &wall, .count = impacts, .flow = ric_flow_options_default()};
  const double q[2] = {0.5, 0}, u[2] = {-1, 0}, time = 0.4;
  shooting_solution s = shooting_solution_of_system(lattice_system(&lattice, &obstacle, 1), &problem);
  shooting_solution_guess(&s, q, u, &time, period);
  shooting_solution_solve(&s);
  return s;
}

static void forced_motions_of_a_period_that_the_forcing_has_not_are_none(void **state) {
  (void)state;
  static const double wrong[] = {0.5, 0.999, 1.5, 2 + 1e-3}, right[] = {1, 2};
  for (size_t impacts = 0; impacts < 2; impacts++) {
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
      shooting_solution s = forced_shot(wrong[k] * turn / 1.3, impacts);
      assert_no_motion(&s, "the forcing does not repeat");
      shooting_solution_clear(&s);
    }
    for (size_t k = 0; k < sizeof right / sizeof *right; k++) {
      shooting_solution s = forced_shot(right[k] * turn / 1.3, impacts);
      assert_true(s.orbit.outcome != RIC_FAILED);
      shooting_solution_clear(&s);
    }
  }
}

/* --- the others --------------------------------------------------------------------------------------------------- */

/* An oscillator whose force and wall may both move with cos(1.6 t), even about the impacts at t = 0 and T: so that
 * a motion of the kinds that know no time closes too. */
typedef struct shaken {
  double force, wall;
} shaken;

static int force(double t, const double *q, const double *u, double *f, void *user) {
  (void)u;
  f[0] = -q[0] + ((const shaken *)user)->force * cos(1.6 * t);
  return 0;
}

static int gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle;
  *h = 1 + ((const shaken *)user)->wall * cos(1.6 * t) - q[0];
  return 0;
}

static int energy(double t, const double *q, const double *u, double *e, void *user) {
  (void)t, (void)user;
  *e = (q[0] * q[0] + u[0] * u[0]) / 2;
  return 0;
}

static shooting_solution shaken_shot(shaken *user, ric_motion_kind kind) {
  static const size_t wall = 0;
  const ric_mechanical model = {
      .coordinates = 1, .speeds = 1, .obstacles = 1, .force = force, .gap = gap, .energy = energy, .user = user};
  const ric_shooting_problem problem = {
      .kind = kind, .sequence = &wall, .count = 1, .flow = {.tolerance = 1e-13, .longest_step = INFINITY}};
  const double q = 1 + user->wall, u = -2.5, time = 0;
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
  shooting_solution s = shooting_solution_of_system(system, &problem);
  shooting_solution_guess(&s, &q, &u, &time, turn / 1.6);
  shooting_solution_solve(&s);
  return s;
}

static void conservative_motions_where_time_matters_are_none(void **state) {
  (void)state;
  shaken still = {0}, pushed = {.force = 0.1}, moved = {.wall = 0.1};
  shaken *users[3] = {&still, &pushed, &moved};
  for (int k = 0; k < 3; k++) {
    shooting_solution s = shaken_shot(users[k], RIC_MOTION_CONSERVATIVE);
    if (k == 0)
      assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
    else
      assert_no_motion(&s, "depend on time");
    shooting_solution_clear(&s);
  }
}

/* Van der Pol's oscillator, pushed; a gap far away that moves. */
static int rate(double t, const double *x, double *out, void *user) {
  out[0] = x[1];
  out[1] = 0.5 * (1 - x[0] * x[0]) * x[1] - x[0] + ((const shaken *)user)->force * cos(1.6 * t);
  return 0;
}

static int far_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)obstacle;
  *h = 5 + ((const shaken *)user)->wall * cos(1.6 * t) - x[0];
  return 0;
}

static int bounce(double t, const double *x, size_t obstacle, double *after, void *user) {
  (void)t, (void)obstacle, (void)user;
  after[0] = x[0];
  after[1] = -x[1];
  return 0;
}

static shooting_solution self_excited_shot(shaken *user) {
  const ric_first_order model = {
      .states = 2, .obstacles = 1, .rate = rate, .gap = far_gap, .impact = bounce, .user = user};
  const ric_shooting_problem problem = {.kind = RIC_MOTION_AUTONOMOUS,
                                        .flow = {.tolerance = 1e-13, .longest_step = INFINITY}};
  const double x[2] = {2, 0};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
  shooting_solution s = shooting_solution_of_system(system, &problem);
  shooting_solution_guess(&s, x, NULL, NULL, 6.4);
  shooting_solution_solve(&s);
  return s;
}

static void autonomous_motions_where_time_matters_are_none(void **state) {
  (void)state;
  shaken still = {0}, pushed = {.force = 1e-3}, moved = {.wall = 1e-3};
  shaken *users[3] = {&still, &pushed, &moved};
  for (int k = 0; k < 3; k++) {
    shooting_solution s = self_excited_shot(users[k]);
    if (k == 0)
      assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
    else
      assert_no_motion(&s, "depend on time");
    shooting_solution_clear(&s);
  }
}

/* --- lambda ------------------------------------------------------------------------------------------------------- */

/* x'' = -x - x^3 from (a, 0) is at (-a, 0) after half its period, and the gradient of the energy, (a + a^3, 0), takes
 * it back with lambda = 2 / (1 + a^2): the equations for a motion of half the period hold. Begun at 0.35. */
static shooting_solution swing(double period) {
  const ric_shooting_problem problem = {.kind = RIC_MOTION_CONSERVATIVE, .flow = ric_flow_options_default()};
  const double q = 0.35, u = 0;
  ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
  lattice.on_site.cubic = 1;
  shooting_solution s = shooting_solution_of_system(lattice_system(&lattice, NULL, 0), &problem);
  shooting_solution_guess(&s, &q, &u, NULL, period);
  return s;
}

static void conservative_motions_whose_ends_stay_apart_along_the_gradient_are_refused(void **state) {
  (void)state;
  shooting_solution s = swing(2.98), whole = swing(2 * 2.98);
  double F[3];
  ric_error error;
  assert_int_equal(ric_shooting_solve(s.shooting, s.z, s.given, 0, NULL, &error), RIC_ENUMERIC);
  if (!strstr(error.message, "not closed: its ends differ by 0.772"))
    fail_msg("\"%s\" does not say that the ends are apart", error.message);
  /* Not for want of convergence: the equations hold, with the lambda of the closed form. */
  assert_int_equal(ric_shooting_residual(s.shooting, s.z, s.given, F, NULL, NULL, NULL), RIC_OK);
  for (int i = 0; i < 3; i++)
    assert_close(F[i], 0, 1e-12);
  assert_close(s.z[2], 2 / (1 + s.z[0] * s.z[0]), 1e-11);
  assert_int_equal(ric_shooting_orbit(s.shooting, s.z, s.given, &s.orbit, NULL), RIC_OK);
  assert_no_motion(&s, "energy is not conserved");
  /* The motion of the whole period, from the same start. */
  shooting_solution_solve(&whole);
  assert_int_equal(whole.orbit.outcome, RIC_ADMISSIBLE);
  assert_close(whole.z[0], s.z[0], 1e-10);
  assert_close(whole.z[2], 0, 1e-12);
  shooting_solution_clear(&s);
  shooting_solution_clear(&whole);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(even_motions_of_systems_that_run_backwards_as_forwards_are_motions),
      cmocka_unit_test(even_motions_of_damped_systems_are_none),
      cmocka_unit_test(even_motions_under_sines_are_none),
      cmocka_unit_test(even_motions_of_gyroscopic_systems_are_none),
      cmocka_unit_test(forced_motions_of_a_period_that_the_forcing_has_not_are_none),
      cmocka_unit_test(conservative_motions_where_time_matters_are_none),
      cmocka_unit_test(autonomous_motions_where_time_matters_are_none),
      cmocka_unit_test(conservative_motions_whose_ends_stay_apart_along_the_gradient_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

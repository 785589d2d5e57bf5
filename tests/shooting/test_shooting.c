/* Shooting against impulse responses, closed forms and event-driven runs. */
#include "support.h"

#include "witness/double_pendulum.h"
#include "witness/multiplier_witness.h"
#include "witness/recorded_run.h"
#include "witness/shooting_solution.h"
#include "scenario/example1.h"

enum { PATTERNS = 200 };

static const scenario_ranges ranges = {
    .most_particles = 24, .highest_gamma = 1, .shortest_period = 0.5, .longest_period = 6.2};

/* [JAP]: Newton's method converges in one iteration, wherever it starts. */
static void shooting_meets_impulse_responses_in_one_iteration(void **state) {
  (void)state;
  random_source source = {.state = 5};
  double worst = 0;
  int compared = 0;
  for (int i = 0; compared < PATTERNS; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    if (solved_orbit_has_state(&x) && x.orbit.outcome != RIC_RESONANT && x.orbit.condition < 100) {
      size_t n = x.scenario.chain.particles;
      double q[24], v[24];
      for (size_t k = 0; k < n; k++) {
        q[k] = random_uniform(&source, -1, 1);
        v[k] = random_uniform(&source, -1, 1);
      }
      shooting_solution s = shooting_solution_of_chain(&x.scenario.chain, x.scenario.pattern);
      shooting_solution_guess(&s, q, v, NULL, x.scenario.period);
      shooting_solution_solve(&s);
      assert_int_equal(s.iterations, 1);
      worst = fmax(worst, state_difference(&x.orbit, &s.orbit) / solved_orbit_scale(&x));
      assert_int_equal(s.orbit.outcome, x.orbit.outcome);
      for (size_t k = 0; k < s.orbit.impacts; k++) {
        assert_close(s.orbit.impulse[k], impulse_of(&x, s.orbit.impact_obstacle[k]), 1e-11 * solved_orbit_scale(&x));
      }
      compared++;
      shooting_solution_clear(&s);
    }
    solved_orbit_clear(&x);
  }
  print_message("[ %d patterns, worst %.3g of the displacement ]\n", compared, worst);
  assert_true(worst <= 1e-12);
}

static void clearances_are_those_of_the_chain(void **state) {
  (void)state;
  random_source source = {.state = 6};
  for (int i = 0; i < 60; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_random(&source, &ranges));
    if (solved_orbit_has_state(&x) && x.orbit.condition < 100 && x.orbit.outcome != RIC_RESONANT) {
      shooting_solution s = shooting_solution_of_chain(&x.scenario.chain, x.scenario.pattern);
      shooting_solution_guess(&s, x.orbit.q, x.orbit.v, NULL, x.scenario.period);
      shooting_solution_solve(&s);
      if (isnan(x.orbit.clearance))
        assert_true(isnan(s.orbit.clearance));
      else
        assert_close(s.orbit.clearance, x.orbit.clearance, 1e-11 * solved_orbit_scale(&x));
      assert_close(s.orbit.energy, x.orbit.energy, 1e-11 * x.orbit.energy);
      shooting_solution_clear(&s);
    }
    solved_orbit_clear(&x);
  }
}

static void even_multipliers_are_those_of_the_chain(void **state) {
  (void)state;
  random_source source = {.state = 7};
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < 200; i++) {
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_few(&source, &ranges, 6));
    if (solved_orbit_has_state(&x) && x.orbit.condition < 100 && x.orbit.outcome != RIC_RESONANT) {
      ric_multipliers a = multipliers_by(RIC_MULTIPLIERS_REDUCED, &x, false), b;
      shooting_solution s = shooting_solution_of_chain(&x.scenario.chain, x.scenario.pattern);
      shooting_solution_guess(&s, x.orbit.q, x.orbit.v, NULL, x.scenario.period);
      assert_int_equal(ric_multipliers_init(&b, 2 * x.scenario.chain.particles, NULL), RIC_OK);
      assert_int_equal(ric_shooting_multipliers(s.shooting, s.z, s.given, NULL, &b, NULL), RIC_OK);
      assert_int_equal(a.stable == RIC_STABILITY_UNKNOWN, b.stable == RIC_STABILITY_UNKNOWN);
      if (a.stable != RIC_STABILITY_UNKNOWN && a.largest < 1e4) {
        worst = fmax(worst, multipliers_distance(&a, a.count, &b) / fmax(1, a.largest));
        compared++;
      }
      ric_multipliers_clear(&a);
      ric_multipliers_clear(&b);
      shooting_solution_clear(&s);
    }
    solved_orbit_clear(&x);
  }
  print_message("[ %d orbits, worst %.3g of the largest multiplier ]\n", compared, worst);
  assert_true(compared > 100);
  assert_true(worst < 1e-6);
}

/* --- Jacobians ---------------------------------------------------------------------------------------------------- */

static const double wall_amplitude = 0.05;

/* Two masses, cubic springs, a wall at the second; forced and damped at will. */
static ric_system *two_masses(bool forced, double restitution) {
  static const ric_spring sites[2] = {{.linear = 3, .damping = 0.05}, {.cubic = 0.2}},
                          quiet[2] = {{.linear = 3}, {.cubic = 0.2}};
  static const double force[2] = {0.3, 0.8};
  ric_lattice l = ric_lattice_default(2, RIC_ENDS_FREE);
  ric_obstacle wall = ric_obstacle_wall(1, 1.2);
  wall.restitution = restitution;
  l.on_sites = forced ? sites : quiet;
  l.link = (ric_spring){.linear = 1, .cubic = 0.3};
  l.frequency = 0.9;
  l.force_sin = forced ? force : NULL;
  return lattice_system(&l, &wall, 1);
}

static void fill_z(shooting_solution *s, double period, size_t impacts) {
  random_source source = {.state = 3};
  double q[8], u[8], times[8];
  for (size_t i = 0; i < 8; i++) {
    q[i] = random_uniform(&source, -0.7, 0.7);
    u[i] = random_uniform(&source, -0.7, 0.7);
    times[i] = 0.1 * period + (double)i / (double)(impacts ? impacts : 1) * 0.4 * period;
  }
  shooting_solution_guess(s, q, u, times, period);
  for (size_t i = 0; i < s->unknowns; i++)
    s->z[i] += random_uniform(&source, -0.02, 0.02);
}

static void assert_jacobian(ric_system *system, const ric_shooting_problem *problem, double period, double bound) {
  shooting_solution s = shooting_solution_of_system(system, problem);
  fill_z(&s, period, problem->count);
  if (problem->kind == RIC_MOTION_CONSERVATIVE) /* what it multiplies moves, too, and is left out: zero at solutions */
    s.z[s.unknowns - 1] = 0;
  double error = shooting_jacobian_error(&s, 1e-5);
  if (!(error < bound))
    fail_msg("kind %d, %zu impacts, %zu pieces: error %g, expected below %g", (int)problem->kind, problem->count,
             problem->pieces, error, bound);
  shooting_solution_clear(&s);
}

static void jacobians_are_derivatives(void **state) {
  (void)state;
  static const size_t hits[3] = {0, 0, 0};
  for (int kind = RIC_MOTION_EVEN; kind <= RIC_MOTION_CONSERVATIVE; kind++)
    for (size_t count = 0; count < 3; count++)
      for (size_t pieces = 0; pieces < 4; pieces += 3)
        for (int energy = 0; energy < 2; energy++) {
          bool even = kind == RIC_MOTION_EVEN, conserves = even || kind == RIC_MOTION_CONSERVATIVE;
          const ric_shooting_problem problem = {.kind = (ric_motion_kind)kind,
                                                .energy_given = energy && conserves,
                                                .at_start = hits,
                                                .start_count = even ? count % 2 : 0,
                                                .at_half = hits,
                                                .half_count = even && count == 2,
                                                .sequence = hits,
                                                .count = count,
                                                .pieces = pieces,
                                                .flow = ric_flow_options_default()};
          assert_jacobian(two_masses(kind == RIC_MOTION_FORCED, conserves ? 1 : 0.7), &problem, 5.3, 1e-8);
        }
}

/* A double pendulum before a wall that moves: the impact map and the gap depend on everything. */
static int moving_wall(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)obstacle, (void)user;
  *h = 0.6 + wall_amplitude * sin(2 * t) - sin(q[0]) - sin(q[1]);
  return 0;
}

static void jacobians_of_user_systems_are_derivatives(void **state) {
  (void)state;
  static const double restitution = 0.8;
  static const size_t hits[2] = {0, 0};
  for (size_t count = 0; count < 3; count++) {
    const ric_mechanical model = {.coordinates = 2,
                                  .speeds = 2,
                                  .obstacles = 1,
                                  .restitution = &restitution,
                                  .mass = double_pendulum_mass,
                                  .force = double_pendulum_force,
                                  .gap = moving_wall};
    const ric_shooting_problem problem = {
        .kind = RIC_MOTION_FORCED, .sequence = hits, .count = count, .flow = {.tolerance = 1e-14, .longest_step = 1}};
    ric_system *system = NULL;
    assert_int_equal(ric_system_create_mechanical(&model, &system, NULL), RIC_OK);
    assert_jacobian(system, &problem, 3.1, 1e-6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shooting_meets_impulse_responses_in_one_iteration),
      cmocka_unit_test(clearances_are_those_of_the_chain),
      cmocka_unit_test(even_multipliers_are_those_of_the_chain),
      cmocka_unit_test(jacobians_are_derivatives),
      cmocka_unit_test(jacobians_of_user_systems_are_derivatives),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

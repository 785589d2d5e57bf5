/* Orbits with one impact in closed form, against the equations, shooting, the solver of chains and the verifier. */
#include "support.h"

#include "witness/impact_study.h"
#include "witness/solved_orbit.h"

enum { MOST = 12, TRIALS = 400 };

static const double pi = 3.14159265358979323846;

/* Random systems at random periods away from blow-ups and from resonances, of which there are other tests. */
static void for_random_orbits(uint64_t seed, void (*holds)(impact_study *)) {
  random_source source = {.state = seed};
  for (int trial = 0; trial < TRIALS; trial++) {
    impact_study s = impact_study_random(&source);
    double period = impact_study_period(&s, &source);
    impact_study_solve(&s, period);
    if (s.orbit.condition < 1e3 && impact_study_detuning(&s, period) > 1e-4)
      holds(&s);
    impact_study_clear(&s);
  }
}

/* --- the system of the source ------------------------------------------------------------------------------------- */

/* Figures of a program of its own, which solves the boundary-value problem of half a period by the exponential of a
 * matrix. */
static void two_masses_have_their_energies(void **state) {
  (void)state;
  impact_study s = impact_study_two_masses();
  double slowest = ric_impact_modes_frequencies(s.modes)[0];
  impact_study_solve(&s, 2 * pi / slowest / 1.1);
  assert_close(s.orbit.energy, 1.7113950296, 5e-11);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  impact_study_solve(&s, 2 * pi / slowest / 1.3);
  assert_close(s.orbit.energy, 3.3478782064, 5e-11);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  impact_study_clear(&s);
}

static void first_mode_alone_touches_the_wall(void **state) {
  (void)state;
  impact_study s = impact_study_two_masses();
  double slowest = ric_impact_modes_frequencies(s.modes)[0];
  const double *phi = ric_impact_modes_shape(s.modes, 0);
  impact_study_solve(&s, 2 * pi / slowest);
  assert_close(s.orbit.energy, 1.5222821435, 5e-11);
  assert_int_equal(s.orbit.outcome, RIC_GRAZING);
  assert_int_equal(s.orbit.mode, 0);
  assert_int_equal(s.orbit.harmonic, 1);
  assert_true(s.orbit.impulse[0] == 0);
  assert_close(s.orbit.q[0], 2 * phi[0] / phi[1], 1e-15);
  assert_close(s.orbit.q[1], 2, 1e-15);
  /* The energy of the family tends to it. */
  impact_study_solve(&s, 2 * pi / slowest * (1 - 1e-8));
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  assert_close(s.orbit.energy, 1.5222821435, 1e-7);
  impact_study_clear(&s);
}

static void one_oscillator_is_a_cosine(void **state) {
  (void)state;
  const double mass = 2, stiffness = 3, w = sqrt(stiffness / mass), period = 0.8 * 2 * pi / w;
  ric_mck mck = {.coordinates = 1, .mass.values = &mass, .stiffness.values = &stiffness};
  ric_obstacle floor = ric_obstacle_floor(0, -0.7);
  ric_system *system;
  assert_int_equal(ric_system_create_mck(&mck, &floor, 1, &system, NULL), RIC_OK);
  impact_study s = impact_study_of(system, &floor);
  impact_study_solve(&s, period);
  assert_int_equal(s.orbit.outcome, RIC_ADMISSIBLE);
  assert_close(s.orbit.q_half[0], -0.7 / cos(w * period / 2), 1e-15);
  assert_close(s.orbit.v[0], -0.7 * w * tan(w * period / 2), 1e-15);
  assert_close(s.orbit.impulse[0], 2 * mass * s.orbit.v[0], 1e-15);
  assert_close(s.orbit.energy, stiffness * pow(s.orbit.q_half[0], 2) / 2, 1e-15);
  assert_true(isnan(s.orbit.clearance) && s.orbit.clearance_particle == -1);
  impact_study_clear(&s);
}

/* --- equations ---------------------------------------------------------------------------------------------------- */

static void state_at(const impact_study *s, double t, double *q, double *v) {
  ric_error error;
  if (ric_impact_modes_state(s->modes, s->orbit.period, t, q, v, &error) != RIC_OK)
    fail_msg("%s", error.message);
}

/* Central differences of positions and speeds against the rates of the system. */
static void check_motion(impact_study *s) {
  double q[MOST], v[MOST], before[MOST], after[MOST], v_before[MOST], v_after[MOST], q_rate[MOST], u_rate[MOST];
  double fastest = ric_impact_modes_frequencies(s->modes)[s->n - 1], step = 1e-4 / fastest;
  double size = impact_study_scale(s) * 20; /* of displacements between both ends, where modes come together */
  for (double part = 0.07; part < 1; part += 0.217) {
    double t = part * s->orbit.period;
    if (t < 2 * step)
      continue;
    state_at(s, t, q, v);
    state_at(s, t - step, before, v_before);
    state_at(s, t + step, after, v_after);
    assert_int_equal(ric_system_rate(s->system, t, q, v, q_rate, u_rate, NULL), RIC_OK);
    for (size_t i = 0; i < s->n; i++) { /* step^2 / 6 = 2e-9 of third derivatives, rounding 1e-16 / 1e-4 */
      assert_close((after[i] - before[i]) / (2 * step), v[i], 1e-8 * size * fastest);
      assert_close((v_after[i] - v_before[i]) / (2 * step), u_rate[i], 1e-8 * size * fastest * fastest);
    }
  }
}

static void motion_satisfies_its_equations(void **state) {
  (void)state;
  for_random_orbits(81, check_motion);
}

/* The obstacle is reached, the impulse explains the jump, the energy is that of every state, time runs backwards. */
static void check_consistency(impact_study *s) {
  const ric_orbit *o = &s->orbit;
  double tolerance = impact_study_agreement(s), q[MOST], v[MOST], mirrored[MOST], rate[MOST], none[MOST] = {0};
  double fastest = ric_impact_modes_frequencies(s->modes)[s->n - 1], speed = tolerance * fastest;
  assert_close(o->q[s->hit], s->obstacle.position, tolerance);
  assert_close(o->gap_rate[0], -s->obstacle.side * o->v[s->hit], speed);
  assert_int_equal(o->impact_obstacle[0], 0);
  state_at(s, 0.3 * o->period, q, v);
  assert_close(ric_system_energy(s->system, 0, q, v) / o->energy, 1, 1e-10 * fmax(1, o->condition));
  assert_close(ric_system_energy(s->system, 0, o->q, o->v) / o->energy, 1, 1e-10 * fmax(1, o->condition));
  state_at(s, -0.3 * o->period, mirrored, rate);
  for (size_t i = 0; i < s->n; i++) {
    assert_close(mirrored[i], q[i], tolerance * 10);
    assert_close(rate[i], -v[i], speed * 10);
    assert_close(o->v_half[i], 0, 0);
  }
  /* The speeds jump by 2 v; the energy of that is p^T M^-1 p / 2, and v^T M 2 v = p v_k. */
  double twice = 2 * ric_system_energy(s->system, 0, none, o->v);
  assert_close(2 * twice, s->obstacle.side * o->impulse[0] * o->v[s->hit], 1e-10 * fabs(twice) + speed * speed);
}

static void impulse_energy_and_states_are_consistent(void **state) {
  (void)state;
  for_random_orbits(82, check_consistency);
}

/* --- other solvers ------------------------------------------------------------------------------------------------ */

static int compared, outcomes[RIC_OUTCOME_COUNT];

/* Verdicts differ where tolerances do, absolute ones there and relative ones here. */
static bool is_clear(const impact_study *s) {
  const ric_orbit *o = &s->orbit;
  return !(fabs(o->clearance) < 1e-6) && fabs(o->gap_rate[0]) > 1e-6 && !strstr(o->reason, "touches");
}

static void check_shooting(impact_study *s) {
  if (!impact_study_random_is_diagonal(s)) /* others have speeds at t = 0, too */
    return;
  const size_t zero = 0;
  const ric_shooting_problem problem = {
      .kind = RIC_MOTION_EVEN, .at_start = &zero, .start_count = 1, .flow = ric_flow_options_default()};
  ric_shooting *shooting;
  ric_orbit shooting_solution;
  ric_error error;
  double z[MOST] = {0}, tolerance = impact_study_agreement(s);
  assert_int_equal(ric_shooting_create(s->system, &problem, &shooting, &error), RIC_OK);
  assert_int_equal(ric_orbit_init(&shooting_solution, s->n, 1, &error), RIC_OK);
  if (ric_shooting_solve(shooting, z, s->orbit.period, 0, NULL, &error) != RIC_OK ||
      ric_shooting_orbit(shooting, z, s->orbit.period, &shooting_solution, &error) != RIC_OK)
    fail_msg("%s", error.message);
  if (!(state_difference(&s->orbit, &shooting_solution) <= tolerance))
    fail_msg("n %zu, period %.17g, condition %g: differs by %g, scale %g", s->n, s->orbit.period, s->orbit.condition,
             state_difference(&s->orbit, &shooting_solution), impact_study_scale(s));
  assert_close(s->orbit.energy, shooting_solution.energy, 1e-10 * s->orbit.energy);
  if (is_clear(s) && s->orbit.outcome != shooting_solution.outcome)
    fail_msg("%s (%s), by shooting %s (%s)", ric_outcome_name(s->orbit.outcome), s->orbit.reason,
             ric_outcome_name(shooting_solution.outcome), shooting_solution.reason);
  if (s->orbit.clearance > -1e3) { /* not NaN */
    assert_close(s->orbit.clearance, shooting_solution.clearance, tolerance * 10);
    assert_int_equal(s->orbit.clearance_particle, shooting_solution.clearance_particle);
  }
  compared++;
  outcomes[shooting_solution.outcome]++;
  ric_orbit_clear(&shooting_solution);
  ric_shooting_destroy(&shooting);
}

static void closed_form_is_what_shooting_finds(void **state) {
  (void)state;
  for_random_orbits(83, check_shooting);
  for_random_orbits(10003, check_shooting); /* among them gaps of -100, where 1e-14 is less than rounding */
  assert_in_range(compared, TRIALS, 2 * TRIALS);
  assert_in_range(outcomes[RIC_ADMISSIBLE], 60, 2 * TRIALS);
  assert_in_range(outcomes[RIC_INADMISSIBLE], 60, 2 * TRIALS);
}

static void uniform_chains_have_the_orbits_of_their_solver(void **state) {
  (void)state;
  random_source source = {.state = 84};
  const scenario_ranges ranges = {
      .most_particles = 12, .highest_gamma = 0.5, .shortest_period = 2, .longest_period = 9};
  for (int trial = 0; trial < 200; trial++) {
    scenario r = scenario_few(&source, &ranges, 1);
    size_t n = r.chain.particles, hit = random_below(&source, n);
    ric_chain chain = r.chain;
    double period = r.period;
    scenario_clear(&r);
    solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_single(n, chain.ends, chain.gamma, period, hit));
    ric_system *system;
    ric_impact_modes *modes;
    ric_orbit orbit;
    assert_int_equal(ric_system_create_chain(&x.scenario.chain, &system, NULL), RIC_OK);
    assert_int_equal(ric_impact_modes_create(system, hit, &modes, NULL), RIC_OK);
    assert_int_equal(ric_orbit_init(&orbit, n, 1, NULL), RIC_OK);
    assert_int_equal(ric_impact_modes_orbit(modes, period, &orbit, NULL), RIC_OK);
    double tolerance = method_tolerance(&x) * fmax(1, orbit.condition / 10);
    assert_close(state_difference(&orbit, &x.orbit), 0, tolerance);
    assert_close(orbit.energy, x.orbit.energy, 1e-10 * orbit.energy);
    assert_int_equal(orbit.outcome, x.orbit.outcome);
    if (n > 1)
      assert_close(orbit.clearance, x.orbit.clearance, 2 * tolerance);
    ric_orbit_clear(&orbit);
    ric_impact_modes_destroy(&modes);
    ric_system_destroy(&system);
    solved_orbit_clear(&x);
  }
}

/* --- the verifier ------------------------------------------------------------------------------------------------- */

static int confirmed, denied;

static void check_verifier(impact_study *s) {
  const ric_orbit *o = &s->orbit;
  double q[MOST], v[MOST];
  ric_verification found;
  if (!is_clear(s) && o->outcome != RIC_ADMISSIBLE)
    return;
  state_at(s, o->period / 4, q, v);
  ric_error error;
  ric_status status = ric_verify(s->system, o, o->period / 4, q, v, NULL, &found, &error);
  bool verified = status == RIC_OK && found.result == RIC_VERIFIED; /* it cannot start beyond an obstacle */
  if (verified != (o->outcome == RIC_ADMISSIBLE))
    fail_msg("%s (%s), but the verifier says %s", ric_outcome_name(o->outcome), o->reason,
             status == RIC_OK ? found.reason : error.message);
  confirmed += verified;
  denied += !verified;
}

static void verifier_confirms_what_is_admissible_and_nothing_else(void **state) {
  (void)state;
  for_random_orbits(85, check_verifier);
  assert_in_range(confirmed, 30, TRIALS);
  assert_in_range(denied, 30, TRIALS);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_masses_have_their_energies),
      cmocka_unit_test(first_mode_alone_touches_the_wall),
      cmocka_unit_test(one_oscillator_is_a_cosine),
      cmocka_unit_test(motion_satisfies_its_equations),
      cmocka_unit_test(impulse_energy_and_states_are_consistent),
      cmocka_unit_test(closed_form_is_what_shooting_finds),
      cmocka_unit_test(uniform_chains_have_the_orbits_of_their_solver),
      cmocka_unit_test(verifier_confirms_what_is_admissible_and_nothing_else),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The poll callback: asked during every computation, and obeyed at any moment. */
#include "support.h"

#include "witness/countdown.h"
#include "witness/solved_orbit.h"

static ric_orbit_solver *polled_solver(countdown *c, ric_orbit_method method) {
  ric_orbit_options options = ric_orbit_options_default();
  ric_orbit_solver *solver = NULL;
  options.method = method;
  options.poll = (ric_poll){.call = count, .user = c};
  assert_int_equal(ric_orbit_solver_create(&options, &solver, NULL), RIC_OK);
  return solver;
}

/* An inadmissible orbit, so that the search for the first violation is polled too. */
static void stops_at_every_call(ric_orbit_method method) {
  scenario s = scenario_word("s....h..", 1, RIC_ENDS_PERIODIC, 0.9, 5);
  ric_orbit reference = {0};
  countdown all = {.limit = INT32_MAX};
  ric_orbit_solver *undisturbed = polled_solver(&all, method);
  assert_int_equal(scenario_solve(&s, undisturbed, &reference, NULL), RIC_OK);
  assert_int_equal(reference.outcome, RIC_INADMISSIBLE);
  assert_true(all.calls >= 4);
  for (int limit = 1; limit <= all.calls; limit++) {
    countdown c = {.limit = limit};
    ric_orbit_solver *solver = polled_solver(&c, method);
    ric_orbit orbit;
    ric_error error;
    assert_int_equal(scenario_solve(&s, solver, &orbit, &error), RIC_ESTOPPED);
    assert_int_equal(c.calls, limit);
    assert_int_equal(orbit.outcome, RIC_FAILED);
    assert_true(isnan(orbit.q[0]) && isnan(orbit.energy));
    assert_non_null(strstr(error.message, "stopped"));
    c.limit = INT32_MAX; /* the solver is as good as new */
    assert_int_equal(ric_orbit_solve(solver, &s.chain, s.pattern, s.period, &orbit, &error), RIC_OK);
    assert_true(state_difference(&orbit, &reference) == 0);
    ric_orbit_clear(&orbit);
    ric_orbit_solver_destroy(&solver);
  }
  ric_orbit_clear(&reference);
  ric_orbit_solver_destroy(&undisturbed);
  scenario_clear(&s);
}

static void solving_stops_at_every_call_and_can_be_repeated(void **state) {
  (void)state;
  stops_at_every_call(RIC_METHOD_IMPULSE);
  stops_at_every_call(RIC_METHOD_DENSE);
}

/* Where there is nothing to admit or refuse, the equations alone ask. */
static void contact_equations_stop(void **state) {
  (void)state;
  for (int limit = 1; limit <= 8; limit++) {
    countdown c = {.limit = limit};
    scenario s = scenario_middle(9, RIC_ENDS_FREE, 0.3, 5);
    ric_orbit_solver *solver = polled_solver(&c, RIC_METHOD_IMPULSE);
    ric_orbit orbit;
    ric_error error;
    assert_int_equal(scenario_solve(&s, solver, &orbit, &error), RIC_ESTOPPED);
    assert_non_null(strstr(error.message, "contact equations"));
    ric_orbit_clear(&orbit);
    ric_orbit_solver_destroy(&solver);
    scenario_clear(&s);
  }
}

static void asking_for_states_stops(void **state) {
  (void)state;
  countdown c = {.limit = INT32_MAX};
  scenario s = scenario_middle(9, RIC_ENDS_FREE, 0.3, 5);
  ric_orbit_solver *solver = polled_solver(&c, RIC_METHOD_IMPULSE);
  ric_orbit orbit;
  double time = 1, q[9];
  assert_int_equal(scenario_solve(&s, solver, &orbit, NULL), RIC_OK);
  c.limit = c.calls + 1;
  assert_int_equal(ric_orbit_states(solver, &s.chain, &orbit, &time, 1, q, NULL, NULL), RIC_ESTOPPED);
  ric_orbit_clear(&orbit);
  ric_orbit_solver_destroy(&solver);
  scenario_clear(&s);
}

static void search_for_singular_points_stops(void **state) {
  (void)state;
  countdown c = {.limit = 3};
  scenario s = scenario_middle(30, RIC_ENDS_FREE, 0.3, 5);
  ric_orbit_solver *solver = polled_solver(&c, RIC_METHOD_IMPULSE);
  double points[8];
  size_t found;
  assert_int_equal(
      ric_orbit_singular_points(solver, &s.chain, s.pattern, RIC_ALONG_GAMMA, 5, 0, 1, points, 8, &found, NULL),
      RIC_ESTOPPED);
  assert_int_equal(c.calls, 3);
  ric_orbit_solver_destroy(&solver);
  scenario_clear(&s);
}

static void absent_callback_never_stops(void **state) {
  (void)state;
  assert_int_equal(ric_poll_stops((ric_poll){0}), 0);
}

/* The determinant method is asked at every value of the determinant. */
static void multipliers_stop_at_any_call(void **state) {
  (void)state;
  countdown all = {.limit = INT32_MAX};
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_word("s.........", 4, RIC_ENDS_PERIODIC, 0.3, 5));
  ric_orbit_multiplier_options options = ric_orbit_multiplier_options_default();
  ric_multipliers m;
  ric_error error;
  options.method = RIC_MULTIPLIERS_DETERMINANT;
  assert_int_equal(ric_multipliers_init(&m, 80, NULL), RIC_OK);
  options.poll = (ric_poll){.call = count, .user = &all};
  assert_int_equal(
      ric_orbit_multipliers(x.solver, &x.scenario.chain, x.scenario.pattern, &x.orbit, &options, &m, &error), RIC_OK);
  assert_true(all.calls > 100);
  for (int limit = 1; limit < all.calls; limit += all.calls / 10) {
    countdown c = {.limit = limit};
    options.poll.user = &c;
    assert_int_equal(
        ric_orbit_multipliers(x.solver, &x.scenario.chain, x.scenario.pattern, &x.orbit, &options, &m, &error),
        RIC_ESTOPPED);
    assert_int_equal(m.stable, RIC_STABILITY_UNKNOWN);
    assert_true(c.calls < limit + 3);
  }
  ric_multipliers_clear(&m);
  solved_orbit_clear(&x);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solving_stops_at_every_call_and_can_be_repeated),
      cmocka_unit_test(contact_equations_stop),
      cmocka_unit_test(asking_for_states_stops),
      cmocka_unit_test(search_for_singular_points_stops),
      cmocka_unit_test(absent_callback_never_stops),
      cmocka_unit_test(multipliers_stop_at_any_call),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

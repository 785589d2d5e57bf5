/* Bad arguments of the orbit room: refused with the value received, outputs untouched. */
#include "support.h"

#include "scenario/scenario.h"

/* A problem that is fine, with its solver. */
typedef struct fixture {
  scenario s;
  ric_orbit_solver *solver;
  ric_orbit orbit;
  ric_error error;
} fixture;

static fixture good_problem(void) {
  fixture f = {.s = scenario_word("..s..", 1, RIC_ENDS_PERIODIC, 0.1, 5)};
  assert_int_equal(ric_orbit_solver_create(NULL, &f.solver, &f.error), RIC_OK);
  assert_int_equal(ric_orbit_init(&f.orbit, 5, 1, &f.error), RIC_OK);
  return f;
}

static void clear(fixture *f) {
  ric_orbit_clear(&f->orbit);
  ric_orbit_solver_destroy(&f->solver);
  scenario_clear(&f->s);
}

static void expect_refusal(fixture *f, ric_status status, const char *part) {
  f->error = (ric_error){0};
  assert_int_equal(ric_orbit_solve(f->solver, &f->s.chain, f->s.pattern, f->s.period, &f->orbit, &f->error), status);
  assert_int_equal(f->error.status, status);
  if (!strstr(f->error.message, part))
    fail_msg("'%s' not in '%s'", part, f->error.message);
  assert_int_equal(ric_orbit_solve(f->solver, &f->s.chain, f->s.pattern, f->s.period, &f->orbit, NULL), status);
}

static void periods_that_are_not_positive_and_finite_are_refused(void **state) {
  (void)state;
  const struct {
    double period;
    const char *text;
  } cases[] = {{0, "period = 0"}, {-1.5, "period = -1.5"}, {NAN, "nan"}, {INFINITY, "period = inf"}};
  fixture f = good_problem();
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    f.s.period = cases[k].period;
    expect_refusal(&f, RIC_EINVAL, cases[k].text);
  }
  clear(&f);
}

/* They would run for years: refused before any work. */
static void motions_with_too_many_oscillations_are_refused(void **state) {
  (void)state;
  fixture f = good_problem();
  f.s.period = 1e300;
  expect_refusal(&f, RIC_ELIMIT, "expected at most 1000000");
  f.s.period = 5;
  f.s.chain.gamma = 1e300;
  expect_refusal(&f, RIC_ELIMIT, "expected at most 1000000");
  clear(&f);
}

static void chains_that_make_no_sense_are_refused(void **state) {
  (void)state;
  fixture f = good_problem();
  f.s.chain.gamma = -0.25;
  expect_refusal(&f, RIC_EINVAL, "gamma = -0.25");
  f.s.chain.gamma = NAN;
  expect_refusal(&f, RIC_EINVAL, "nan");
  f.s.chain.gamma = 0.1;
  f.s.chain.floor = NAN;
  expect_refusal(&f, RIC_EINVAL, "floor");
  clear(&f);
}

static void sizes_that_do_not_match_are_refused(void **state) {
  (void)state;
  fixture f = good_problem();
  f.s.chain.particles = 6;
  expect_refusal(&f, RIC_EINVAL, "pattern of 5 particles, expected 6");
  f.s.chain.particles = 5;
  ric_orbit_clear(&f.orbit);
  assert_int_equal(ric_orbit_init(&f.orbit, 5, 2, NULL), RIC_OK);
  expect_refusal(&f, RIC_EINVAL, "2 impacts, expected 5 and 1");
  ric_orbit_clear(&f.orbit);
  assert_int_equal(ric_orbit_init(&f.orbit, 4, 1, NULL), RIC_OK);
  expect_refusal(&f, RIC_EINVAL, "4 particles");
  clear(&f);
}

static void impacting_particles_need_a_floor(void **state) {
  (void)state;
  const double floors[] = {-1, -1, -INFINITY, -1, -1};
  fixture f = good_problem();
  f.s.chain.floors = floors;
  expect_refusal(&f, RIC_EINVAL, "particle 2");
  f.s.chain.floors = NULL;
  f.s.chain.floor = -INFINITY;
  expect_refusal(&f, RIC_EINVAL, "particle 2");
  clear(&f);
}

static void dense_method_is_limited(void **state) {
  (void)state;
  ric_orbit_options options = ric_orbit_options_default();
  options.method = RIC_METHOD_DENSE;
  fixture f = {.s = scenario_middle(RIC_DENSE_PARTICLES + 1, RIC_ENDS_FREE, 0.1, 5)};
  assert_int_equal(ric_orbit_solver_create(&options, &f.solver, NULL), RIC_OK);
  assert_int_equal(ric_orbit_init(&f.orbit, RIC_DENSE_PARTICLES + 1, 1, NULL), RIC_OK);
  expect_refusal(&f, RIC_ELIMIT, "401 particles, expected at most 400");
  clear(&f);
}

static void refused_arguments_fail_the_orbit_with_their_message(void **state) {
  (void)state;
  fixture f = good_problem();
  assert_int_equal(ric_orbit_solve(f.solver, &f.s.chain, f.s.pattern, 5, &f.orbit, NULL), RIC_OK);
  f.s.period = -1;
  expect_refusal(&f, RIC_EINVAL, "period");
  assert_int_equal(f.orbit.outcome, RIC_FAILED);
  assert_string_equal(f.orbit.reason, f.error.message);
  assert_true(isnan(f.orbit.q[0]) && isnan(f.orbit.impulse[0]) && isnan(f.orbit.energy));
  assert_int_equal(f.orbit.clearance_particle, -1);
  clear(&f);
}

static void orbits_failed_by_hand_have_no_state(void **state) {
  (void)state;
  double time = 1, q[5];
  fixture f = good_problem();
  assert_int_equal(ric_orbit_solve(f.solver, &f.s.chain, f.s.pattern, 5, &f.orbit, NULL), RIC_OK);
  ric_orbit_fail(&f.orbit, "does not fit");
  assert_int_equal(f.orbit.outcome, RIC_FAILED);
  assert_string_equal(f.orbit.reason, "does not fit");
  for (size_t i = 0; i < 5; i++)
    assert_true(isnan(f.orbit.q[i]) && isnan(f.orbit.v[i]) && isnan(f.orbit.q_half[i]) && isnan(f.orbit.v_half[i]));
  assert_int_equal(ric_orbit_states(f.solver, &f.s.chain, &f.orbit, &time, 1, q, NULL, NULL), RIC_EINVAL);
  clear(&f);
}

static void options_out_of_range_are_refused_by_name(void **state) {
  (void)state;
  const double bad[] = {0, -1e-9, 1, NAN, INFINITY};
  for (size_t field = 0; field < 5; field++)
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
      ric_orbit_options o = ric_orbit_options_default();
      double *fields[] = {&o.clearance_tol, &o.grazing_tol, &o.residual_tol, &o.resonance_tol, &o.singular_condition};
      const char *names[] = {"clearance_tol", "grazing_tol", "residual_tol", "resonance_tol", "singular_condition"};
      ric_orbit_solver *solver = NULL;
      ric_error error;
      *fields[field] = bad[k];
      if (field == 4 && bad[k] == INFINITY)
        continue; /* never singular: allowed */
      assert_int_equal(ric_orbit_solver_create(&o, &solver, &error), RIC_EINVAL);
      assert_null(solver);
      assert_non_null(strstr(error.message, names[field]));
    }
  ric_orbit_options o = ric_orbit_options_default();
  ric_orbit_solver *solver = NULL;
  o.method = (ric_orbit_method)7;
  assert_int_equal(ric_orbit_solver_create(&o, &solver, NULL), RIC_EINVAL);
}

static void orbits_of_impossible_sizes_are_refused(void **state) {
  (void)state;
  const size_t bad[][2] = {{0, 0}, {0, 1}, {5, 0}, {5, 6}};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    ric_orbit orbit;
    assert_int_equal(ric_orbit_init(&orbit, bad[k][0], bad[k][1], NULL), RIC_EINVAL);
    assert_null(orbit.q);
    ric_orbit_clear(&orbit);
  }
}

/* 4 n + m must not wrap around: such sizes cannot fit. */
static void orbits_beyond_the_address_space_are_refused(void **state) {
  (void)state;
  const size_t sizes[] = {SIZE_MAX / 16, SIZE_MAX / 4 + 1, SIZE_MAX / 2, SIZE_MAX};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    ric_orbit orbit;
    assert_int_equal(ric_orbit_init(&orbit, sizes[k], 1, NULL), RIC_ENOMEM);
    ric_orbit_clear(&orbit);
  }
}

static void times_that_are_not_finite_are_refused(void **state) {
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  fixture f = good_problem();
  assert_int_equal(ric_orbit_solve(f.solver, &f.s.chain, f.s.pattern, 5, &f.orbit, NULL), RIC_OK);
  for (size_t k = 0; k < 3; k++) {
    double times[] = {1, bad[k]}, q[10];
    assert_int_equal(ric_orbit_states(f.solver, &f.s.chain, &f.orbit, times, 2, q, NULL, &f.error), RIC_EINVAL);
    assert_non_null(strstr(f.error.message, "times[1]"));
  }
  clear(&f);
}

static void states_of_an_unsolved_orbit_are_refused(void **state) {
  (void)state;
  double time = 1, q[6];
  fixture f = good_problem();
  assert_int_equal(ric_orbit_states(f.solver, &f.s.chain, &f.orbit, &time, 1, q, NULL, &f.error), RIC_EINVAL);
  assert_int_equal(ric_orbit_solve(f.solver, &f.s.chain, f.s.pattern, 5, &f.orbit, NULL), RIC_OK);
  f.s.chain.particles = 6;
  assert_int_equal(ric_orbit_states(f.solver, &f.s.chain, &f.orbit, &time, 1, q, NULL, &f.error), RIC_EINVAL);
  assert_non_null(strstr(f.error.message, "orbit of 5 particles, expected 6"));
  clear(&f);
}

static void destroying_nothing_is_allowed(void **state) {
  (void)state;
  ric_orbit_solver *solver = NULL;
  ric_pattern *pattern = NULL;
  ric_flow *flow = NULL;
  ric_orbit_solver_destroy(&solver);
  ric_orbit_solver_destroy(NULL);
  ric_pattern_destroy(&pattern);
  ric_pattern_destroy(NULL);
  ric_flow_destroy(&flow);
  ric_flow_destroy(NULL);
  fixture f = good_problem();
  clear(&f);
  assert_null(f.solver);
  assert_null(f.s.pattern);
  ric_orbit_clear(&f.orbit);
}

static void every_outcome_has_its_name(void **state) {
  (void)state;
  const char *names[] = {"admissible", "inadmissible", "grazing", "resonant", "singular", "not_converged", "failed"};
  assert_int_equal(RIC_OUTCOME_COUNT, 7);
  for (int k = 0; k < RIC_OUTCOME_COUNT; k++)
    assert_string_equal(ric_outcome_name((ric_outcome)k), names[k]);
  assert_non_null(ric_outcome_name((ric_outcome)99));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(periods_that_are_not_positive_and_finite_are_refused),
      cmocka_unit_test(motions_with_too_many_oscillations_are_refused),
      cmocka_unit_test(chains_that_make_no_sense_are_refused),
      cmocka_unit_test(sizes_that_do_not_match_are_refused),
      cmocka_unit_test(impacting_particles_need_a_floor),
      cmocka_unit_test(dense_method_is_limited),
      cmocka_unit_test(refused_arguments_fail_the_orbit_with_their_message),
      cmocka_unit_test(orbits_failed_by_hand_have_no_state),
      cmocka_unit_test(options_out_of_range_are_refused_by_name),
      cmocka_unit_test(orbits_of_impossible_sizes_are_refused),
      cmocka_unit_test(orbits_beyond_the_address_space_are_refused),
      cmocka_unit_test(times_that_are_not_finite_are_refused),
      cmocka_unit_test(states_of_an_unsolved_orbit_are_refused),
      cmocka_unit_test(destroying_nothing_is_allowed),
      cmocka_unit_test(every_outcome_has_its_name),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Special points along a sweep, beside the three searches that they are made of. */
#include "support.h"

#include "scenario/example1.h"
#include "scenario/scenario.h"

enum { ROOM = 400 };

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

typedef struct told {
  ric_special_point points[ROOM];
  size_t count, stop_at; /* 0: never */
} told;

static int keep(const ric_special_point *point, void *user) {
  told *t = user;
  assert_true(t->count < ROOM && (t->stop_at == 0 || t->count < t->stop_at));
  t->points[t->count++] = *point;
  return t->count == t->stop_at;
}

static ric_orbit_solver *solver_with(ric_poll poll) {
  ric_orbit_solver *solver = NULL;
  ric_orbit_options options = ric_orbit_options_default();
  ric_error error;
  options.poll = poll;
  check(ric_orbit_solver_create(&options, &solver, &error), &error);
  return solver;
}

static ric_special_range range_of(const scenario *s, ric_along along, double low, double high, size_t points) {
  return (ric_special_range){.chain = &s->chain,
                             .pattern = s->pattern,
                             .along = along,
                             .period = s->period,
                             .low = low,
                             .high = high,
                             .points = points};
}

static told points_of(const ric_special_range *range) {
  ric_orbit_solver *solver = solver_with((ric_poll){0});
  told t = {0};
  ric_error error;
  check(ric_orbit_special_points(solver, range, keep, &t, &error), &error);
  ric_orbit_solver_destroy(&solver);
  return t;
}

/* --- one list of three -------------------------------------------------------------------------------------------- */

/* The point of a kind at a parameter that is told, once. */
static const ric_special_point *point_at(const told *t, ric_special_kind kind, double parameter, size_t mode) {
  const ric_special_point *found = NULL;
  for (size_t i = 0; i < t->count; i++)
    if (t->points[i].kind == kind && t->points[i].parameter == parameter && t->points[i].mode == mode) {
      assert_null(found);
      found = &t->points[i];
    }
  assert_non_null(found);
  return found;
}

static size_t check_resonances(const told *t, const ric_special_range *r) {
  ric_resonance found[ROOM];
  size_t count;
  ric_error error;
  check(ric_chain_resonances(r->chain, r->along, r->period, r->low, r->high, found, ROOM, &count, &error), &error);
  for (size_t i = 0; i < count; i++)
    assert_int_equal(point_at(t, RIC_SPECIAL_RESONANCE, found[i].parameter, found[i].mode)->harmonic,
                     found[i].harmonic);
  return count;
}

static size_t check_singular(const told *t, const ric_special_range *r) {
  ric_orbit_solver *solver = solver_with((ric_poll){0});
  double found[ROOM];
  size_t count;
  ric_error error;
  check(ric_orbit_singular_points(solver, r->chain, r->pattern, r->along, r->period, r->low, r->high, found, ROOM,
                                  &count, &error),
        &error);
  for (size_t i = 0; i < count; i++)
    point_at(t, RIC_SPECIAL_SINGULAR, found[i], SIZE_MAX);
  ric_orbit_solver_destroy(&solver);
  return count;
}

static size_t check_critical(const told *t, const ric_special_range *r) {
  ric_orbit_solver *solver = solver_with((ric_poll){0});
  ric_critical found[ROOM];
  size_t count;
  ric_error error;
  check(ric_orbit_critical_points(solver, r->chain, r->pattern, r->along, r->period, r->low, r->high, r->points, found,
                                  ROOM, &count, &error),
        &error);
  for (size_t i = 0; i < count; i++) {
    const ric_special_kind kind = (ric_special_kind)(RIC_SPECIAL_PLUS_ONE + (int)found[i].kind);
    const ric_special_point *p = point_at(t, kind, found[i].parameter, SIZE_MAX);
    assert_true(p->change == (found[i].outwards ? 1 : -1) && p->uncertainty == found[i].uncertainty);
    assert_true(p->multiplier.re == found[i].mu.re && p->multiplier.im == found[i].mu.im);
    assert_string_equal(ric_special_name(kind), ric_critical_name(found[i].kind));
  }
  ric_orbit_solver_destroy(&solver);
  return count;
}

/* Told in order, with what the orbit there is to a solver that has solved nothing else. */
static void check_order_and_outcomes(const told *t, const ric_special_range *r) {
  for (size_t i = 0; i < t->count; i++) {
    const ric_special_point *p = &t->points[i];
    ric_orbit_solver *solver = solver_with((ric_poll){0});
    ric_orbit orbit = {0};
    ric_chain chain = *r->chain;
    ric_error error;
    if (i > 0)
      assert_true(p[-1].parameter < p->parameter || (p[-1].parameter == p->parameter && p[-1].kind <= p->kind));
    if (r->along == RIC_ALONG_GAMMA)
      chain.gamma = p->parameter;
    check(ric_orbit_init(&orbit, chain.particles, ric_pattern_impacts(r->pattern), &error), &error);
    check(ric_orbit_solve(solver, &chain, r->pattern, r->along == RIC_ALONG_GAMMA ? r->period : p->parameter, &orbit,
                          &error),
          &error);
    assert_int_equal(p->outcome, orbit.outcome);
    ric_orbit_clear(&orbit);
    ric_orbit_solver_destroy(&solver);
  }
}

static void check_range(const ric_special_range *r, size_t least_of_each) {
  const told t = points_of(r);
  const size_t resonances = check_resonances(&t, r), singular = check_singular(&t, r),
               critical = r->points > 0 ? check_critical(&t, r) : 0;
  print_message("[ %zu resonances, %zu singular, %zu critical ]\n", resonances, singular, critical);
  assert_int_equal(t.count, resonances + singular + critical);
  assert_true(resonances >= least_of_each && singular >= least_of_each);
  assert_true(r->points == 0 || critical >= least_of_each);
  check_order_and_outcomes(&t, r);
}

static void the_list_holds_what_the_three_searches_find(void **state) {
  (void)state;
  scenario few = scenario_word("s.h..s.", 1, RIC_ENDS_FREE, 0.1, 5.1),
           middle = scenario_middle(12, RIC_ENDS_FREE, 0, 4.4);
  const ric_special_range ranges[] = {
      range_of(&few, RIC_ALONG_GAMMA, 0, 3, 40),
      range_of(&few, RIC_ALONG_PERIOD, 3, 14, 40),
      range_of(&few, RIC_ALONG_GAMMA, 0, 3, 0),
      range_of(&middle, RIC_ALONG_GAMMA, 0.01, 0.5, 200),
  };
  for (size_t i = 0; i < 4; i++)
    check_range(&ranges[i], i < 3);
  scenario_clear(&few);
  scenario_clear(&middle);
}

static void example_1_has_its_critical_coupling_and_its_resonance(void **state) {
  (void)state;
  scenario s = example1_at(0);
  const ric_special_range range = range_of(&s, RIC_ALONG_GAMMA, 0, 0.21, 20);
  const told t = points_of(&range);
  const double gamma_c = ric_chain_first_resonance(&s.chain, s.period);
  bool critical = false, resonance = false;
  for (size_t i = 0; i < t.count; i++) {
    critical = critical || (t.points[i].kind == RIC_SPECIAL_PLUS_ONE &&
                            fabs(t.points[i].parameter - 0.1320819448778) < 1e-10 && t.points[i].change == 1);
    resonance = resonance || (t.points[i].kind == RIC_SPECIAL_RESONANCE && t.points[i].parameter == gamma_c &&
                              t.points[i].harmonic == 1);
  }
  assert_true(critical && resonance == (gamma_c <= 0.21));
  scenario_clear(&s);
}

static void a_range_of_one_value_has_no_critical_points(void **state) {
  (void)state;
  scenario s = example1_at(0);
  const double gamma_c = ric_chain_first_resonance(&s.chain, s.period);
  const ric_special_range range = range_of(&s, RIC_ALONG_GAMMA, gamma_c, gamma_c, 20);
  const told t = points_of(&range);
  assert_true(t.count >= 1);
  for (size_t i = 0; i < t.count; i++) {
    assert_int_equal(t.points[i].kind, RIC_SPECIAL_RESONANCE);
    assert_true(isnan(t.points[i].multiplier.re) && isnan(t.points[i].uncertainty) && t.points[i].change == 0);
  }
  scenario_clear(&s);
}

/* --- how it ends -------------------------------------------------------------------------------------------------- */

static int stop(void *user) {
  (void)user;
  return 1;
}

static void it_ends_where_the_callback_or_the_poll_says(void **state) {
  (void)state;
  scenario s = scenario_word("s.h..s.", 1, RIC_ENDS_FREE, 0.1, 5.1);
  const ric_special_range range = range_of(&s, RIC_ALONG_GAMMA, 0, 3, 0);
  ric_orbit_solver *solver = solver_with((ric_poll){0}), *stopped = solver_with((ric_poll){stop, NULL});
  told t = {.stop_at = 2};
  ric_error error;
  check(ric_orbit_special_points(solver, &range, keep, &t, &error), &error);
  assert_int_equal(t.count, 2);
  t = (told){0};
  assert_int_equal(ric_orbit_special_points(stopped, &range, keep, &t, &error), RIC_ESTOPPED);
  ric_orbit_solver_destroy(&solver);
  ric_orbit_solver_destroy(&stopped);
  scenario_clear(&s);
}

static void ranges_that_make_no_sense_are_refused(void **state) {
  (void)state;
  scenario s = example1_at(0);
  const ric_special_range ranges[] = {
      range_of(&s, RIC_ALONG_GAMMA, 0.2, 0.1, 0), range_of(&s, RIC_ALONG_GAMMA, -1, 0.1, 0),
      range_of(&s, RIC_ALONG_GAMMA, 0, NAN, 0), range_of(&s, RIC_ALONG_GAMMA, 0, 0.1, 1)};
  ric_orbit_solver *solver = solver_with((ric_poll){0});
  for (size_t i = 0; i < 4; i++) {
    told t = {0};
    ric_error error;
    assert_int_equal(ric_orbit_special_points(solver, &ranges[i], keep, &t, &error), RIC_EINVAL);
    assert_int_equal(t.count, 0);
  }
  assert_non_null(ric_special_name(RIC_SPECIAL_KINDS));
  ric_orbit_solver_destroy(&solver);
  scenario_clear(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_list_holds_what_the_three_searches_find),
      cmocka_unit_test(example_1_has_its_critical_coupling_and_its_resonance),
      cmocka_unit_test(a_range_of_one_value_has_no_critical_points),
      cmocka_unit_test(it_ends_where_the_callback_or_the_poll_says),
      cmocka_unit_test(ranges_that_make_no_sense_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

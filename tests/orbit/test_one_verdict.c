/* One orbit found in three ways, by impulse response, in closed form and by shooting, has one verdict: the same
 * clearance, place and time, the same outcome and the same words for it, over floors and, mirrored, under walls. Dense
 * sampling of the modes is the witness of the clearance. */
#include "support.h"

#include "sampled_gaps.h"
#include "witness/shooting_solution.h"

enum { MOST = 12, SAMPLES = 4000 };

/* A pattern with its floors. */
typedef struct example {
  const char *word;
  ric_ends ends;
  double gamma, period;
  double floors[MOST]; /* all 0: -1 */
  ric_outcome outcome;
  const char *reason; /* how it begins */
} example;

static const example examples[] = {
    /* Symmetric neighbours: ties go to the first particle. */
    {"....s....", RIC_ENDS_FREE, 0.1, 5, {0}, RIC_ADMISSIBLE, ""},
    {"....s....", RIC_ENDS_FIXED, 0.1, 5, {0}, RIC_ADMISSIBLE, ""},
    {"s........", RIC_ENDS_PERIODIC, 0.1, 5, {0}, RIC_ADMISSIBLE, ""},
    {"...h....", RIC_ENDS_PERIODIC, 0.05, 5.4, {0}, RIC_ADMISSIBLE, ""},
    /* Two impacts, together and half a period apart. */
    {"s...s..", RIC_ENDS_FREE, 0.08, 5.2, {0}, RIC_ADMISSIBLE, ""},
    {"s...h.", RIC_ENDS_FIXED, 0.08, 5.2, {0}, RIC_ADMISSIBLE, ""},
    {"s.h.s.h.", RIC_ENDS_PERIODIC, 0.05, 5.4, {0}, RIC_ADMISSIBLE, ""},
    /* Every particle in the pattern: there is no clearance. */
    {"s", RIC_ENDS_FREE, 0, 5, {0}, RIC_ADMISSIBLE, ""},
    {"sh", RIC_ENDS_FREE, 0.05, 5.4, {0}, RIC_ADMISSIBLE, ""},
    {"shsh", RIC_ENDS_PERIODIC, 0.1, 5, {0}, RIC_ADMISSIBLE, ""},
    /* A free particle passes its floor, before another one, between the ends; it is beyond from the start on. */
    {"..s..", RIC_ENDS_FREE, 0.1, 5, {-1, -0.2, -1, -1, -1}, RIC_INADMISSIBLE, "particle 1 passes its floor"},
    {"..s..", RIC_ENDS_FREE, 0.1, 5, {-1, -0.2, -1, -0.15, -1}, RIC_INADMISSIBLE, "particle 3 passes its floor"},
    {"s.h.", RIC_ENDS_PERIODIC, 0.05, 5.4, {-1, 0.0091, -1, -1}, RIC_INADMISSIBLE, "particle 1 passes its floor"},
    {"s..h.", RIC_ENDS_FIXED, 0.1, 5, {-1, -1, -0.02, -1, -1}, RIC_INADMISSIBLE, "particle 2 is below its floor"},
    /* Above the linear mode the impulse pulls; at T/2 the floor has been passed before. */
    {"s", RIC_ENDS_FREE, 0, 8, {0}, RIC_INADMISSIBLE, "impulse of particle 0 at t = 0 is -"},
    {"..s..", RIC_ENDS_FREE, 0.02, 7.5, {0}, RIC_INADMISSIBLE, "impulse of particle 2 at t = 0 is -"},
    {"..h..", RIC_ENDS_PERIODIC, 0.02, 7.5, {0}, RIC_INADMISSIBLE, "particle 2 passes its floor"},
};

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

static solved_orbit solve(const example *e, double *floors) {
  solved_orbit x = solve_orbit(RIC_METHOD_IMPULSE, scenario_word(e->word, 1, e->ends, e->gamma, e->period));
  for (size_t i = 0; i < x.scenario.chain.particles; i++)
    floors[i] = e->floors[0] != 0 ? e->floors[i] : -1;
  x.scenario.chain.floors = floors;
  check(ric_orbit_solve(x.solver, &x.scenario.chain, x.scenario.pattern, e->period, &x.orbit, NULL),
        &(ric_error){.message = "not solved"});
  return x;
}

/* The same words, and the same numbers but for rounding of what is printed. */
static void assert_same_words(const char *a, const char *b) {
  const char *whole = a, *other = b;
  while (*a && *b) {
    char *a_end, *b_end;
    bool number = (*a >= '0' && *a <= '9') || *a == '-';
    double x = number ? strtod(a, &a_end) : 0, y = number ? strtod(b, &b_end) : 0;
    if (number ? !(fabs(x - y) <= 1e-9 + 1e-4 * fabs(x)) : *a != *b)
      fail_msg("\"%s\" is not \"%s\"", whole, other);
    a = number ? a_end : a + 1;
    b = number ? b_end : b + 1;
  }
  if (*a || *b)
    fail_msg("\"%s\" is not \"%s\"", whole, other);
}

/* Once, by a word that is not longer. */
static void replace(char *text, const char *word, const char *other) {
  char *at = strstr(text, word);
  if (!at)
    return;
  memmove(at + strlen(other), at + strlen(word), strlen(at + strlen(word)) + 1);
  memcpy(at, other, strlen(other));
}

/* @param mirrored  the other orbit is over walls: its numbers are those of `a` with the other sign */
static void assert_same(const ric_orbit *a, const ric_orbit *b, double scale, bool mirrored) {
  char words[RIC_REASON_BYTES];
  snprintf(words, sizeof words, "%s", a->reason);
  if (mirrored) {
    replace(words, "its floor", "its wall");
    replace(words, "is below", "is above");
  }
  assert_same_words(words, b->reason);
  assert_int_equal(a->outcome, b->outcome);
  assert_int_equal(a->clearance_particle, b->clearance_particle);
  assert_int_equal(isnan(a->clearance), isnan(b->clearance));
  assert_int_equal(isnan(a->clearance_time), isnan(b->clearance_time));
  if (isnan(a->clearance))
    return;
  assert_close(a->clearance, b->clearance, 1e-11 * scale);
  assert_close(a->clearance_time, b->clearance_time, 1e-5 * a->period);
}

/* By shooting, in a chain or with its mirror image under walls. */
static ric_orbit *shoot(const solved_orbit *x, double scale, bool mirrored, shooting_solution *s) {
  const ric_chain *chain = &x->scenario.chain;
  const ric_lattice lattice = ric_lattice_of_chain(chain);
  size_t n = chain->particles, count[2] = {0}, hit[2][MOST];
  ric_obstacle obstacles[MOST];
  double q[MOST], v[MOST], sign = mirrored ? -1 : 1;
  ric_system *system;
  ric_error error;
  for (size_t i = 0; i < n; i++) {
    ric_role role = ric_pattern_role(x->scenario.pattern, i);
    obstacles[i] = mirrored ? ric_obstacle_wall(i, -chain->floors[i]) : ric_obstacle_floor(i, chain->floors[i]);
    q[i] = sign * x->orbit.q[i];
    v[i] = sign * x->orbit.v[i];
    if (role != RIC_ROLE_FREE)
      hit[role == RIC_ROLE_HALF][count[role == RIC_ROLE_HALF]++] = i;
  }
  check(ric_system_create_lattice(&lattice, obstacles, n, &system, &error), &error);
  const ric_shooting_problem problem = {.kind = RIC_MOTION_EVEN,
                                        .at_start = hit[0],
                                        .start_count = count[0],
                                        .at_half = hit[1],
                                        .half_count = count[1],
                                        .flow = ric_flow_options_default(),
                                        .grazing_tol = ric_orbit_options_default().grazing_tol * scale};
  *s = shooting_solution_of_system(system, &problem);
  shooting_solution_guess(s, q, v, NULL, x->orbit.period);
  shooting_solution_solve(s);
  return &s->orbit;
}

/* In closed form, of orbits with one impact at t = 0. @returns whether it is one */
static bool closed_form(const solved_orbit *x, bool mirrored, ric_orbit *orbit) {
  const ric_chain *chain = &x->scenario.chain;
  const ric_pattern *pattern = x->scenario.pattern;
  const ric_lattice lattice = ric_lattice_of_chain(chain);
  ric_obstacle obstacles[MOST];
  ric_impact_modes *modes;
  ric_system *system;
  ric_error error;
  size_t hit = ric_pattern_impact(pattern, 0);
  if (ric_pattern_impacts(pattern) != 1 || ric_pattern_role(pattern, hit) != RIC_ROLE_START)
    return false;
  for (size_t i = 0; i < chain->particles; i++)
    obstacles[i] = mirrored ? ric_obstacle_wall(i, -chain->floors[i]) : ric_obstacle_floor(i, chain->floors[i]);
  check(ric_system_create_lattice(&lattice, obstacles, chain->particles, &system, &error), &error);
  check(ric_impact_modes_create(system, hit, &modes, &error), &error);
  check(ric_orbit_init(orbit, chain->particles, 1, &error), &error);
  check(ric_impact_modes_orbit(modes, x->orbit.period, orbit, &error), &error);
  ric_impact_modes_destroy(&modes);
  ric_system_destroy(&system);
  return true;
}

static void check_witness(const solved_orbit *x, double scale) {
  modal_motion motion = modal_motion_create(&x->scenario.chain);
  modal_motion_set(&motion, x->orbit.q, x->orbit.v);
  sampled_gap sampled = sampled_clearance(x, &motion, SAMPLES);
  if (sampled.gap == INFINITY) {
    assert_true(isnan(x->orbit.clearance) && isnan(x->orbit.clearance_time) && x->orbit.clearance_particle == -1);
  } else {
    sampled_gap refined = refined_gap(x, &motion, sampled, x->orbit.period / 2 / SAMPLES);
    assert_close(x->orbit.clearance, fmin(sampled.gap, refined.gap), 1e-11 * scale);
  }
  modal_motion_clear(&motion);
}

static int in_closed_form;

static void check_clients(const solved_orbit *x) {
  double scale = solved_orbit_scale(x);
  check_witness(x, scale);
  for (int mirrored = 0; mirrored < 2; mirrored++) {
    shooting_solution s;
    ric_orbit closed;
    assert_same(&x->orbit, shoot(x, scale, mirrored, &s), scale, mirrored);
    shooting_solution_clear(&s);
    if (!closed_form(x, mirrored, &closed))
      continue;
    assert_same(&x->orbit, &closed, scale, mirrored);
    ric_orbit_clear(&closed);
    in_closed_form++;
  }
}

static void one_orbit_has_one_verdict_however_it_was_found(void **state) {
  (void)state;
  double floors[MOST];
  for (size_t k = 0; k < sizeof examples / sizeof *examples; k++) {
    const example *e = &examples[k];
    solved_orbit x = solve(e, floors);
    print_message("%s: %s %s, clearance %.6g of %lld at %.6g\n", e->word, ric_outcome_name(x.orbit.outcome),
                  x.orbit.reason, x.orbit.clearance, x.orbit.clearance_particle, x.orbit.clearance_time);
    assert_int_equal(x.orbit.outcome, e->outcome);
    assert_memory_equal(x.orbit.reason, e->reason, strlen(e->reason));
    check_clients(&x);
    solved_orbit_clear(&x);
  }
  assert_int_equal(in_closed_form, 16);
}

/* A floor moved to the smallest gap of a free particle, but for more and less than the tolerance. */
static void gaps_within_the_tolerance_graze_for_all(void **state) {
  (void)state;
  const example e = {"..s...", RIC_ENDS_FREE, 0.1, 5, {0}, RIC_ADMISSIBLE, ""};
  static const struct {
    double share;
    ric_outcome outcome;
  } cases[] = {{-3, RIC_INADMISSIBLE}, {-0.5, RIC_GRAZING}, {0, RIC_GRAZING}, {0.5, RIC_GRAZING}, {3, RIC_ADMISSIBLE}};
  double floors[MOST];
  solved_orbit x = solve(&e, floors);
  double clearance = x.orbit.clearance, zero = ric_orbit_options_default().grazing_tol * solved_orbit_scale(&x);
  size_t particle = (size_t)x.orbit.clearance_particle;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    floors[particle] = -1 + clearance - cases[k].share * zero;
    check(ric_orbit_solve(x.solver, &x.scenario.chain, x.scenario.pattern, e.period, &x.orbit, NULL),
          &(ric_error){.message = "not solved"});
    assert_int_equal(x.orbit.outcome, cases[k].outcome);
    assert_int_equal(x.orbit.clearance_particle, particle);
    if (cases[k].outcome == RIC_GRAZING)
      assert_non_null(strstr(x.orbit.reason, "touches its floor at t = "));
    check_clients(&x);
  }
  solved_orbit_clear(&x);
}

/* An event-driven run confirms what is admissible, from the orbit alone. */
static void admissible_orbits_are_verified_however_they_were_found(void **state) {
  (void)state;
  double floors[MOST];
  size_t verified = 0;
  for (size_t k = 0; k < sizeof examples / sizeof *examples; k++) {
    solved_orbit x = solve(&examples[k], floors);
    shooting_solution s;
    ric_verification of_chain, of_shot;
    ric_error error;
    shoot(&x, solved_orbit_scale(&x), k % 2, &s);
    check(ric_orbit_verify(x.solver, &x.scenario.chain, &x.orbit, NULL, &of_chain, &error), &error);
    check(ric_shooting_verify(s.shooting, s.z, s.given, &s.orbit, NULL, &of_shot, &error), &error);
    assert_int_equal(of_chain.result, examples[k].outcome == RIC_ADMISSIBLE ? RIC_VERIFIED : RIC_NOT_RUN);
    assert_int_equal(of_shot.result, of_chain.result);
    assert_int_equal(of_shot.impacts, of_chain.impacts);
    verified += of_shot.result == RIC_VERIFIED;
    shooting_solution_clear(&s);
    solved_orbit_clear(&x);
  }
  assert_int_equal(verified, 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_orbit_has_one_verdict_however_it_was_found),
      cmocka_unit_test(gaps_within_the_tolerance_graze_for_all),
      cmocka_unit_test(admissible_orbits_are_verified_however_they_were_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
